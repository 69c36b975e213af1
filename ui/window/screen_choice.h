#pragma once

#include <QtCore/QObject>
#include <QtCore/QSettings>
#include <QtCore/QStringList>
#include <QtQuick/QQuickWindow>

#include "ui/window/desk.h"
#include "ui/window/places.h"
#include "ui/window/screen.h"

namespace passung::window {

/// On which screen the participant's window fills, never the one that the experimenter's window is on; remembered.
class ScreenChoice : public QObject {
    Q_OBJECT
    Q_PROPERTY(QStringList names READ names NOTIFY changed)  // of the screens to choose from
    Q_PROPERTY(int chosen READ chosen WRITE choose NOTIFY changed)

public:
    /// `memory`: keeps the choice.
    ScreenChoice(Desk& desk, Screen& screen, QSettings& memory);

    QStringList names() const;
    int chosen() const;
    void choose(int index);
    void attach(QQuickWindow* experimenter, QQuickWindow* participant);

signals:
    void changed();

private:
    QList<ScreenArea> screens() const;
    QRect experimenterPlace() const;
    void place();
    void lose(const QScreen* gone);

    Desk& desk_;
    Screen& screen_;
    QSettings& memory_;
    QQuickWindow* experimenter_ = nullptr;
    QQuickWindow* participant_ = nullptr;
};

}  // namespace passung::window
