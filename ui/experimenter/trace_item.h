#pragma once

#include <QtQuick/QQuickItem>
#include <vector>

#include "ui/presenter/trace.h"

namespace passung::experimenter {

/// Draws a trace: from left (oldest) to right (now), a stroke per stretch from its smallest to its largest value, zero
/// at the bottom.
class TraceItem : public QQuickItem {
    Q_OBJECT
    Q_PROPERTY(QColor color MEMBER color_ NOTIFY changed)
    Q_PROPERTY(double full READ full NOTIFY changed)
    Q_PROPERTY(double least MEMBER least_ NOTIFY changed)  // that the upper edge stands for

public:
    explicit TraceItem(QQuickItem* parent = nullptr);

    void show(const presenter::Trace& trace);
    /// As many stretches as a trace has at most, the oldest first.
    void show(std::vector<presenter::Trace::Span> spans);
    /// What the upper edge stands for: 1, 2 or 5 times a power of ten.
    double full() const { return top_; }

signals:
    void changed();

protected:
    QSGNode* updatePaintNode(QSGNode* old, UpdatePaintNodeData*) override;

private:
    void take(std::vector<presenter::Trace::Span> spans, double peak);

    std::vector<presenter::Trace::Span> spans_;
    QColor color_{Qt::white};
    double top_ = 1.0, least_ = 0.5;
};

}  // namespace passung::experimenter
