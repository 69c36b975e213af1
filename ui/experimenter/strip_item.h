#pragma once

#include <QtGui/QColor>
#include <QtQuick/QQuickPaintedItem>

namespace passung::experimenter {

/// A sample as dots along an axis from `low` to `high`, with its quartiles as a box, the median a stroke, and whiskers
/// to its ends. Dots stand beside one another only so that they can be told apart.
class StripItem : public QQuickPaintedItem {
    Q_OBJECT
    Q_PROPERTY(QList<qreal> values MEMBER values_ NOTIFY changed)
    Q_PROPERTY(QList<qreal> box MEMBER box_ NOTIFY changed)  // least, quartiles, most; or empty
    Q_PROPERTY(qreal low MEMBER low_ NOTIFY changed)
    Q_PROPERTY(qreal high MEMBER high_ NOTIFY changed)
    Q_PROPERTY(QColor ink MEMBER ink_ NOTIFY changed)
    Q_PROPERTY(QColor line MEMBER line_ NOTIFY changed)

public:
    explicit StripItem(QQuickItem* parent = nullptr);
    void paint(QPainter* painter) override;

signals:
    void changed();

private:
    qreal xOf(qreal value) const;

    QList<qreal> values_, box_;
    qreal low_ = 0.0, high_ = 1.0;
    QColor ink_{Qt::white}, line_{Qt::gray};
};

}  // namespace passung::experimenter
