#include "ui/experimenter/trace_item.h"

#include <QtQuick/QSGFlatColorMaterial>
#include <QtQuick/QSGGeometryNode>
#include <algorithm>

#include "ui/presenter/axis.h"

namespace passung::experimenter {

namespace {

constexpr double kLeastTop = 0.5;
constexpr float kStroke = 1.6f;  // thickness of what does not change [px]

}  // namespace

TraceItem::TraceItem(QQuickItem* parent) : QQuickItem(parent) {
    setFlag(ItemHasContents);
    connect(this, &TraceItem::changed, this, &QQuickItem::update);
}

void TraceItem::show(const presenter::Trace& trace) { take(trace.spans(), trace.peak()); }

void TraceItem::show(std::vector<presenter::Trace::Span> spans) {
    double peak = 0.0;
    for (const auto& span : spans) peak = std::max(peak, static_cast<double>(span.high));
    take(std::move(spans), peak);
}

void TraceItem::take(std::vector<presenter::Trace::Span> spans, double peak) {
    spans_ = std::move(spans);
    const double top = presenter::roundScale(std::max(kLeastTop, 1.08 * peak));
    if (top != top_) {
        top_ = top;
        emit changed();
    }
    update();
}

QSGNode* TraceItem::updatePaintNode(QSGNode* old, UpdatePaintNodeData*) {
    if (spans_.size() < 2 || width() <= 0) {
        delete old;
        return nullptr;
    }
    auto* node = static_cast<QSGGeometryNode*>(old);
    if (node == nullptr) {
        node = new QSGGeometryNode;
        node->setGeometry(new QSGGeometry(QSGGeometry::defaultAttributes_Point2D(), 0));
        node->geometry()->setDrawingMode(QSGGeometry::DrawTriangleStrip);
        node->setMaterial(new QSGFlatColorMaterial);
        node->setFlags(QSGNode::OwnsGeometry | QSGNode::OwnsMaterial);
    }
    static_cast<QSGFlatColorMaterial*>(node->material())->setColor(color_);
    node->markDirty(QSGNode::DirtyMaterial);

    QSGGeometry& geometry = *node->geometry();
    geometry.allocate(static_cast<int>(2 * spans_.size()));
    QSGGeometry::Point2D* point = geometry.vertexDataAsPoint2D();
    const double whole = presenter::Trace::kSeconds / presenter::Trace::kStretch;
    const double step = width() / (whole - 1.0);
    const double left = width() - step * static_cast<double>(spans_.size() - 1);
    using Span = presenter::Trace::Span;
    const auto yOf = [this](float value) {
        return static_cast<float>(height() * (1.0 - std::clamp(static_cast<double>(value) / top_, 0.0, 1.0)));
    };
    for (std::size_t i = 0; i < spans_.size(); ++i) {
        const auto x = static_cast<float>(left + step * static_cast<double>(i));
        // Neighbouring strokes overlap, so that a rise is a line and not a gap.
        const Span& before = spans_[i > 0 ? i - 1 : 0];
        const float upper = yOf(std::max(spans_[i].high, before.low));
        const float lower = yOf(std::min(spans_[i].low, before.high));
        const float thin = std::max(0.0f, 0.5f * (kStroke - (lower - upper)));
        point[2 * i].set(x, upper - thin);
        point[2 * i + 1].set(x, lower + thin);
    }
    node->markDirty(QSGNode::DirtyGeometry);
    return node;
}

}  // namespace passung::experimenter
