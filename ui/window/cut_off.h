#pragma once

#include <QtCore/QObject>
#include <QtCore/QSettings>

#include "ui/window/desk.h"
#include "ui/window/participants_model.h"
#include "ui/window/studies.h"

namespace passung::window {

/// Asks at the start whether to go on with the session during which the program ended without being closed.
class CutOff : public QObject {
    Q_OBJECT
    Q_PROPERTY(QString question READ question NOTIFY changed)  // empty: there is none
    Q_PROPERTY(QString whyNot READ whyNot NOTIFY changed)      // to go on; empty: possible

public:
    /// `memory`: keeps whose session runs, for the next start.
    CutOff(Desk& desk, Studies& studies, ParticipantsModel& participants, QSettings& memory);

    QString question() const { return about("cutOff"); }
    QString whyNot() const { return about("whyNotResume"); }
    /// Shows whose session it was, among the participants. False: nothing was cut off.
    bool find();
    /// False: it may not go on now.
    Q_INVOKABLE bool resume(const QString& language);
    Q_INVOKABLE void leave();
    /// Somebody closes the program: what runs is not cut off. A question without an answer is asked again.
    void close();

signals:
    void changed();

private:
    QString about(const char* what) const;
    void forget();

    Desk& desk_;
    Studies& studies_;
    ParticipantsModel& participants_;
    QSettings& memory_;
    QString code_;  // whose session it was; empty: nothing is asked
};

}  // namespace passung::window
