#include "ui/experimenter/strip_item.h"

#include <QtGui/QPainter>
#include <cmath>

namespace passung::experimenter {

namespace {

constexpr qreal kDot = 3.0;   // radius [px]
constexpr qreal kEdge = 6.0;  // room for half a dot at both ends [px]

/// Low-discrepancy numbers in 0 … 1: neighbours in the list lie apart.
qreal spread(qsizetype index) { return std::fmod(0.5 + 0.6180339887498949 * static_cast<qreal>(index), 1.0); }

}  // namespace

StripItem::StripItem(QQuickItem* parent) : QQuickPaintedItem(parent) {
    setAntialiasing(true);
    connect(this, &StripItem::changed, this, [this] { update(); });
}

qreal StripItem::xOf(qreal value) const {
    const qreal share = high_ > low_ ? (value - low_) / (high_ - low_) : 0.5;
    return kEdge + share * (width() - 2.0 * kEdge);
}

void StripItem::paint(QPainter* painter) {
    const qreal middle = 0.5 * height();
    const qreal half = 0.36 * height();
    painter->setRenderHint(QPainter::Antialiasing);
    if (box_.size() == 5) {
        painter->setPen(QPen(line_, 1.0));
        painter->drawLine(QPointF(xOf(box_[0]), middle), QPointF(xOf(box_[4]), middle));
        QColor fill = ink_;
        fill.setAlphaF(0.16f);
        painter->setBrush(fill);
        painter->setPen(QPen(ink_, 1.0));
        painter->drawRect(QRectF(QPointF(xOf(box_[1]), middle - half), QPointF(xOf(box_[3]), middle + half)));
    }
    QColor dot = ink_;
    dot.setAlphaF(values_.size() > 60 ? 0.45f : 0.7f);
    painter->setPen(Qt::NoPen);
    painter->setBrush(dot);
    for (qsizetype i = 0; i < values_.size(); ++i)
        painter->drawEllipse(QPointF(xOf(values_[i]), middle + 1.4 * half * (spread(i) - 0.5)), kDot, kDot);
    if (box_.size() == 5) {
        painter->setPen(QPen(line_, 3.0));
        painter->drawLine(QPointF(xOf(box_[2]), middle - half - 2.0), QPointF(xOf(box_[2]), middle + half + 2.0));
    }
}

}  // namespace passung::experimenter
