#pragma once

#include <QtCore/QList>
#include <QtCore/QRect>
#include <QtCore/QSettings>
#include <QtCore/QString>
#include <QtGui/QWindow>
#include <optional>

namespace passung::window {

struct ScreenArea {
    QString name;
    QRect area;
};

/// The screens that the participant may get for themselves: all that the middle of the experimenter's window is not on.
QList<qsizetype> freeScreens(const QList<ScreenArea>& screens, const QRect& experimenter);
/// Which of them they get: the one of the chosen name, else the first; none: there is no other.
std::optional<qsizetype> participantScreen(const QList<ScreenArea>& screens, const QRect& experimenter,
                                           const QString& chosen);

/// `wanted`, made smaller and moved until all of it lies in `area`, with room for a title bar above it.
QRect fitting(const QRect& wanted, const QRect& area);

/// Remembers where windows stand, for each arrangement of screens.
class Places {
public:
    explicit Places(const QString& file) : settings_(file, QSettings::IniFormat) {}

    /// Puts the window where it stood with the screens of now, if that can be seen on one of them.
    void restore(const QString& name, QWindow& window) const;
    void keep(const QString& name, const QWindow& window);

private:
    QSettings settings_;
};

}  // namespace passung::window
