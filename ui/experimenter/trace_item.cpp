#include "ui/experimenter/trace_item.h"

#include <QtQuick/QSGFlatColorMaterial>
#include <QtQuick/QSGGeometryNode>
#include <algorithm>

namespace passung::experimenter {

namespace {

constexpr int kCorners = 6;  // of a stroke, as two triangles

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
    const double top = presenter::traceTop(peak, least_);
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
        node->geometry()->setDrawingMode(QSGGeometry::DrawTriangles);
        node->setMaterial(new QSGFlatColorMaterial);
        node->setFlags(QSGNode::OwnsGeometry | QSGNode::OwnsMaterial);
    }
    static_cast<QSGFlatColorMaterial*>(node->material())->setColor(color_);
    node->markDirty(QSGNode::DirtyMaterial);

    const auto strokes = presenter::strokesOf(spans_, width(), height(), top_);
    QSGGeometry& geometry = *node->geometry();
    geometry.allocate(kCorners * static_cast<int>(strokes.size()));
    QSGGeometry::Point2D* corner = geometry.vertexDataAsPoint2D();
    for (const presenter::Stroke& s : strokes) {
        const float x[kCorners] = {s.left, s.right, s.left, s.left, s.right, s.right};
        const float y[kCorners] = {s.upper, s.upper, s.lower, s.lower, s.upper, s.lower};
        for (int i = 0; i < kCorners; ++i) corner++->set(x[i], y[i]);
    }
    node->markDirty(QSGNode::DirtyGeometry);
    return node;
}

}  // namespace passung::experimenter
