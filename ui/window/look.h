#pragma once

#include <QtCore/QObject>
#include <QtGui/QColor>

namespace passung::window {

/// Colours and type of all windows, light and dark. The colours with a meaning are those of Okabe and Ito (2008), which
/// people with any kind of colour vision can tell apart; where they stand for a state, a sign or a word stands beside.
class Look : public QObject {
    Q_OBJECT
    Q_PROPERTY(bool dark READ dark WRITE setDark NOTIFY changed)
    Q_PROPERTY(double scale READ scale WRITE setScale NOTIFY changed)  // of all text
    Q_PROPERTY(QString family READ family CONSTANT)
    Q_PROPERTY(QString digits READ digits CONSTANT)
    Q_PROPERTY(QColor ground READ ground NOTIFY changed)  // behind everything
    Q_PROPERTY(QColor panel READ panel NOTIFY changed)
    Q_PROPERTY(QColor raised READ raised NOTIFY changed)  // on a panel
    Q_PROPERTY(QColor edge READ edge NOTIFY changed)
    Q_PROPERTY(QColor text READ text NOTIFY changed)
    Q_PROPERTY(QColor dim READ dim NOTIFY changed)  // less important text
    Q_PROPERTY(QColor accent READ accent NOTIFY changed)
    Q_PROPERTY(QColor onAccent READ onAccent NOTIFY changed)
    Q_PROPERTY(QColor good READ good NOTIFY changed)
    Q_PROPERTY(QColor care READ care NOTIFY changed)
    Q_PROPERTY(QColor bad READ bad NOTIFY changed)
    Q_PROPERTY(QColor veil READ veil NOTIFY changed)  // under text on a picture

public:
    explicit Look(bool dark);
    bool dark() const { return dark_; }
    void setDark(bool dark);
    double scale() const { return scale_; }
    void setScale(double scale);
    const QString& family() const { return family_; }
    const QString& digits() const { return digits_; }

    QColor ground() const { return pick("#11171c", "#f2f5f7"); }
    QColor panel() const { return pick("#182027", "#ffffff"); }
    QColor raised() const { return pick("#222d36", "#eef2f5"); }
    QColor edge() const { return pick("#2e3b46", "#d5dde3"); }
    QColor text() const { return pick("#e8eef3", "#17212a"); }
    QColor dim() const { return pick("#93a3b1", "#566572"); }
    QColor accent() const { return pick("#56b4e9", "#0072b2"); }
    QColor onAccent() const { return pick("#0b1a24", "#ffffff"); }
    QColor good() const { return pick("#2bb58b", "#007a5a"); }
    QColor care() const { return pick("#e69f00", "#a66f00"); }
    QColor bad() const { return pick("#ee7733", "#c04a00"); }
    QColor veil() const { return pick("#c8141b21", "#d8ffffff"); }

signals:
    void changed();

private:
    QColor pick(const char* dark, const char* light) const { return QColor(QLatin1String(dark_ ? dark : light)); }

    bool dark_;
    double scale_ = 1.0;
    QString family_, digits_;
};

}  // namespace passung::window
