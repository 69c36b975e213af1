#pragma once

#include <QtCore/QElapsedTimer>
#include <QtCore/QObject>
#include <QtCore/QVariant>
#include <optional>

#include "ui/presenter/form.h"
#include "ui/window/desk.h"
#include "ui/window/speech.h"

namespace passung::window {

/// What the participant is asked, for QML, and what they answer.
class FormModel : public QObject {
    Q_OBJECT
    Q_PROPERTY(bool shown READ shown NOTIFY changed)
    Q_PROPERTY(QString title READ title NOTIFY changed)
    Q_PROPERTY(QString instruction READ instruction NOTIFY changed)
    Q_PROPERTY(bool consent READ consent NOTIFY changed)
    Q_PROPERTY(int page READ page NOTIFY changed)
    Q_PROPERTY(int pages READ pages NOTIFY changed)
    Q_PROPERTY(double share READ share NOTIFY changed)
    Q_PROPERTY(int count READ count NOTIFY turned)  // of the rows
    Q_PROPERTY(QVariantList rows READ rows NOTIFY changed)
    Q_PROPERTY(int focus READ focus NOTIFY changed)
    Q_PROPERTY(QString notice READ notice NOTIFY changed)  // what keeps the page from being turned
    Q_PROPERTY(QString backWord READ backWord NOTIFY changed)
    Q_PROPERTY(QString nextWord READ nextWord NOTIFY changed)
    Q_PROPERTY(QString pageWord READ pageWord NOTIFY changed)

public:
    FormModel(Desk& desk, Speech& speech);

    bool shown() const { return form_.has_value() && visible_; }
    QString title() const;
    QString instruction() const { return QString::fromStdString(view_.instruction); }
    bool consent() const { return view_.consent; }
    int page() const { return static_cast<int>(view_.page); }
    int pages() const { return static_cast<int>(view_.pages); }
    double share() const { return view_.share; }
    int count() const { return static_cast<int>(view_.rows.size()); }
    QVariantList rows() const;
    int focus() const { return static_cast<int>(view_.focus); }
    QString notice() const;
    QString backWord() const;
    QString nextWord() const;
    QString pageWord() const;

    Q_INVOKABLE void pick(int row, int label);
    Q_INVOKABLE void place(int row, double value);
    Q_INVOKABLE void type(int row, const QString& text);
    Q_INVOKABLE void focusOn(int row);
    Q_INVOKABLE void enter();
    Q_INVOKABLE void next();
    Q_INVOKABLE void back();
    /// True if the key answered the row.
    Q_INVOKABLE bool key(int row, int key);
    /// A button of the haptic device, from 1.
    Q_INVOKABLE void button(int number);
    void retranslate() { emit changed(); }

signals:
    void changed();
    void turned();  // another page

private:
    void refresh();
    void show();
    std::int64_t now() const { return clock_.elapsed(); }
    QString faultWord(const presenter::FormRow& row) const;

    Desk& desk_;
    Speech& speech_;
    QElapsedTimer clock_;
    std::optional<presenter::Form> form_;
    presenter::FormView view_;
    std::optional<std::size_t> turned_to_;
    bool visible_ = false;
};

}  // namespace passung::window
