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

std::optional<qsizetype> participantScreen(const QList<QRect>& screens, const QRect& experimenter) {
    for (qsizetype i = 0; i < screens.size(); ++i)
        if (screens.size() > 1 && !screens[i].contains(experimenter.center())) return i;
    return std::nullopt;
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
