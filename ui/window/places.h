#pragma once

#include <QtCore/QList>
#include <QtCore/QRect>
#include <QtCore/QSettings>
#include <QtCore/QString>
#include <QtGui/QWindow>
#include <optional>

namespace passung::window {

/// Which of these screens the participant gets for themselves: the first one that the middle of the experimenter's
/// window is not on; none: there is no other.
std::optional<qsizetype> participantScreen(const QList<QRect>& screens, const QRect& experimenter);

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
