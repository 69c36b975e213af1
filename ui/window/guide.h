#pragma once

#include <QtCore/QElapsedTimer>
#include <QtCore/QObject>
#include <QtCore/QUrl>
#include <QtCore/QVariant>

#include "ui/presenter/participant.h"
#include "ui/window/desk.h"
#include "ui/window/speech.h"

namespace passung::window {

/// What the participant is told apart from scene and forms, for QML: what to do now, pages of instructions, rests,
/// questions, results.
class Guide : public QObject {
    Q_OBJECT
    Q_PROPERTY(QString line READ line NOTIFY changed)
    Q_PROPERTY(QString hint READ hint NOTIFY changed)
    Q_PROPERTY(QVariantList steps READ steps NOTIFY changed)     // of an assembly: "name", "done", "next"
    Q_PROPERTY(QString stepsLine READ stepsLine NOTIFY changed)  // how many are done
    Q_PROPERTY(QString result READ result NOTIFY changed)
    Q_PROPERTY(bool succeeded READ succeeded NOTIFY changed)
    Q_PROPERTY(bool handling READ handling NOTIFY changed)  // mouse and keys move the part
    Q_PROPERTY(bool reading READ reading NOTIFY changed)
    Q_PROPERTY(QString pageText READ pageText NOTIFY changed)
    Q_PROPERTY(QUrl pagePicture READ pagePicture NOTIFY changed)
    Q_PROPERTY(bool resting READ resting NOTIFY changed)
    Q_PROPERTY(int restSeconds READ restSeconds NOTIFY changed)
    Q_PROPERTY(bool mayGoOn READ mayGoOn NOTIFY changed)  // the participant ends the rest
    Q_PROPERTY(QString goOnWord READ goOnWord NOTIFY changed)
    Q_PROPERTY(QStringList answers READ answers NOTIFY changed)  // to a pair's question; else none
    Q_PROPERTY(int answered READ answered NOTIFY changed)

public:
    Guide(Desk& desk, Speech& speech);

    QString line() const;
    QString hint() const;
    QString keysLine() const;
    QString pickLine() const;
    QVariantList steps() const;
    QString stepsLine() const;
    QString result() const;
    bool succeeded() const { return view_.result && view_.result->success; }
    bool handling() const;
    bool reading() const { return view_.screen == presenter::ParticipantScreen::Page; }
    QString pageText() const;
    QUrl pagePicture() const;
    bool resting() const { return view_.screen == presenter::ParticipantScreen::Rest && view_.rest; }
    int restSeconds() const { return view_.rest ? static_cast<int>(view_.rest->seconds) : 0; }
    bool mayGoOn() const;
    QString goOnWord() const;
    QStringList answers() const;
    int answered() const { return pressed_; }

    /// The page was read, or the rest is over for the participant.
    Q_INVOKABLE void goOn();
    /// Names an interval, 1 or 2, as the device's buttons do.
    Q_INVOKABLE void answer(int interval, bool down);
    void retranslate() { refresh(); }

signals:
    void changed();

private:
    void refresh();
    QString taskLine() const;

    Desk& desk_;
    Speech& speech_;
    presenter::ParticipantView view_;
    std::int64_t page_ = 0;  // that is shown
    QElapsedTimer page_clock_;
    int pressed_ = 0;
};

}  // namespace passung::window
