#pragma once

#include <QtCore/QObject>
#include <QtCore/QPointer>
#include <QtQuick/QQuickItem>
#include <QtQuick/QQuickWindow>
#include <optional>

#include "ui/presenter/quality_search.h"
#include "ui/window/desk.h"

namespace passung::window {

/// How the participant's window draws. Before a session's first trial that shows a scene it is found on that scene, in
/// the window as it stands; then it is frozen until the session is over, also where it is resumed. The trial waits for
/// it.
class QualityFinder : public QObject {
    Q_OBJECT
    Q_PROPERTY(bool shadows READ shadows NOTIFY changed)
    Q_PROPERTY(int samples READ samples NOTIFY changed)
    Q_PROPERTY(double scale READ scale NOTIFY changed)  // of the drawn picture's sides to the window's

public:
    /// `fixed`: is drawn with, nothing is tried.
    QualityFinder(Desk& desk, std::optional<presenter::PictureQuality> fixed);

    bool shadows() const { return quality_.shadows; }
    int samples() const { return quality_.samples; }
    double scale() const { return quality_.scale; }

    /// `scene`: the item of `window` that draws the scene.
    void attach(QQuickWindow* window, QQuickItem* scene);

signals:
    void changed();

private:
    void prepare(std::int64_t attempt);
    void begin();
    void took(std::int64_t now_ns);
    void draw();
    void finish();

    Desk& desk_;
    std::optional<presenter::PictureQuality> fixed_;
    presenter::PictureQuality quality_;
    bool found_ = false;  // for the running session
    QPointer<QQuickWindow> window_;
    QPointer<QQuickItem> scene_;
    std::optional<presenter::QualitySearch> search_;
    std::int64_t attempt_ = 0;  // that waits
    std::int64_t last_ns_ = 0;  // when the display got the picture before; 0: none
};

}  // namespace passung::window
