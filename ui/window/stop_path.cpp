#include "ui/window/stop_path.h"

#include <QtCore/QEvent>
#include <QtGui/QGuiApplication>
#include <cmath>

namespace passung::window {

QByteArray platformFor(const QByteArray& display, const QByteArray& chosen) {
    if (!chosen.isEmpty()) return chosen;
    return display.isEmpty() ? QByteArray() : QByteArray("xcb;wayland");  // the second if no server answers there
}

StopPath::StopPath(Desk& desk)
    : listener_([&desk] { desk.stopNow(); }),
      apart_(listener_.listens() && QGuiApplication::platformName() == QLatin1String("xcb")) {}

void StopPath::attach(const QList<QQuickWindow*>& windows, QQuickItem* button) {
    if (!apart_) return;
    windows_ = windows;
    button_ = button;
    for (QQuickWindow* window : windows_) {
        window->installEventFilter(this);
        connect(window, &QQuickWindow::afterAnimating, this, &StopPath::publish);
    }
    publish();
}

void StopPath::detach() {
    for (QQuickWindow* window : windows_) {
        window->removeEventFilter(this);
        disconnect(window, nullptr, this, nullptr);
    }
    windows_.clear();
    button_ = nullptr;
    publish();
}

bool StopPath::eventFilter(QObject* window, QEvent* event) {
    switch (event->type()) {
        case QEvent::PlatformSurface:  // the window gets another id
            if (static_cast<QPlatformSurfaceEvent*>(event)->surfaceEventType() ==
                QPlatformSurfaceEvent::SurfaceAboutToBeDestroyed)
                break;
            [[fallthrough]];
        case QEvent::Show:
        case QEvent::Hide:
        case QEvent::Resize:
            publish();
            break;
        default:
            break;
    }
    return QObject::eventFilter(window, event);
}

void StopPath::publish() {
    StopTargets targets;
    for (const QQuickWindow* window : windows_)
        if (window->handle() != nullptr) targets.windows.push_back(static_cast<std::uint32_t>(window->winId()));
    const QQuickWindow* holder = button_ == nullptr ? nullptr : button_->window();
    if (holder != nullptr && holder->handle() != nullptr && holder->isVisible() && button_->isVisible()) {
        const double scale = holder->devicePixelRatio();
        const QRectF place = button_->mapRectToScene({0, 0, button_->width(), button_->height()});
        targets.window = static_cast<std::uint32_t>(holder->winId());
        targets.left = static_cast<int>(std::floor(scale * place.left()));
        targets.top = static_cast<int>(std::floor(scale * place.top()));
        targets.width = static_cast<int>(std::ceil(scale * place.width()));
        targets.height = static_cast<int>(std::ceil(scale * place.height()));
    }
    if (targets == told_) return;
    told_ = targets;
    listener_.watch(std::move(targets));
}

}  // namespace passung::window
