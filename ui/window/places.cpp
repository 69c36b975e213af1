#include "ui/window/places.h"

#include <QtGui/QGuiApplication>
#include <QtGui/QScreen>
#include <algorithm>

namespace passung::window {

namespace {

/// The screens of now, as a key of the settings.
QString arrangement() {
    QStringList all;
    for (const QScreen* screen : QGuiApplication::screens()) {
        const QRect area = screen->geometry();
        all.append(QStringLiteral("%1_%2x%3+%4+%5")
                       .arg(screen->name())
                       .arg(area.width())
                       .arg(area.height())
                       .arg(area.x())
                       .arg(area.y()));
    }
    all.sort();
    return all.join(QLatin1Char(' ')).replace(QLatin1Char('/'), QLatin1Char('_'));
}

}  // namespace

QList<qsizetype> freeScreens(const QList<ScreenArea>& screens, const QRect& experimenter) {
    QList<qsizetype> free;
    for (qsizetype i = 0; i < screens.size(); ++i)
        if (screens.size() > 1 && !screens[i].area.contains(experimenter.center())) free.append(i);
    return free;
}

std::optional<qsizetype> participantScreen(const QList<ScreenArea>& screens, const QRect& experimenter,
                                           const QString& chosen) {
    const QList<qsizetype> free = freeScreens(screens, experimenter);
    for (const qsizetype i : free)
        if (screens[i].name == chosen) return i;
    if (free.isEmpty()) return std::nullopt;
    return free.front();
}

QRect fitting(const QRect& wanted, const QRect& area) {
    constexpr int kTitleBar = 32;  // [px]
    if (area.contains(wanted) && wanted.height() <= area.height() - kTitleBar) return wanted;
    const QSize size = wanted.size().boundedTo({area.width(), area.height() - kTitleBar});
    const auto within = [](int at, int low, int high) { return std::max(low, std::min(at, high)); };
    return {{within(wanted.x(), area.left(), area.left() + area.width() - size.width()),
             within(wanted.y(), area.top() + kTitleBar, area.top() + area.height() - size.height())},
            size};
}

void Places::restore(const QString& name, QWindow& window) const {
    const QRect place = settings_.value(arrangement() + "/" + name).toRect();
    const auto screens = QGuiApplication::screens();
    const bool seen = std::any_of(screens.begin(), screens.end(),
                                  [&](const QScreen* screen) { return screen->geometry().contains(place.center()); });
    if (place.isValid() && seen) window.setGeometry(place);
}

void Places::keep(const QString& name, const QWindow& window) {
    if (window.visibility() == QWindow::Windowed) settings_.setValue(arrangement() + "/" + name, window.geometry());
}

}  // namespace passung::window
