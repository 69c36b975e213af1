#pragma once

#include <QtCore/QObject>
#include <QtCore/QPointer>
#include <QtQuick/QQuickItem>
#include <QtQuick/QQuickWindow>

#include "ui/window/desk.h"
#include "ui/window/stop_listener.h"

namespace passung::window {

/// The platform plugin that the windows run on: X, also under Wayland where it is at hand, because only there an
/// emergency stop can be heard beside the windows. Empty: as Qt chooses. `display`, `chosen`: what the environment
/// says of DISPLAY and QT_QPA_PLATFORM.
QByteArray platformFor(const QByteArray& display, const QByteArray& chosen);

/// The emergency stop's way past the windows: tells the listener which windows there are and where the button stands.
class StopPath : public QObject {
    Q_OBJECT
    Q_PROPERTY(bool apart READ apart CONSTANT)  // a window that hangs does not delay an emergency stop

public:
    explicit StopPath(Desk& desk);

    bool apart() const { return apart_; }
    /// `windows`: all of them; `button`: the item that stops.
    void attach(const QList<QQuickWindow*>& windows, QQuickItem* button);
    /// Before the windows go: nothing on the screen means a stop any more.
    void detach();

protected:
    bool eventFilter(QObject* window, QEvent* event) override;

private:
    void publish();

    StopListener listener_;
    bool apart_;
    QList<QQuickWindow*> windows_;
    QPointer<QQuickItem> button_;
    StopTargets told_;
};

}  // namespace passung::window
