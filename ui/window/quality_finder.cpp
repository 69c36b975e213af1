#include "ui/window/quality_finder.h"

#include "study/run/machine/frame_clock.h"

namespace passung::window {

QualityFinder::QualityFinder(Desk& desk, std::optional<presenter::PictureQuality> fixed) : desk_(desk), fixed_(fixed) {
    if (fixed_) quality_ = *fixed_;
    connect(&desk_, &Desk::opened, this, [this] {
        search_.reset();
        found_ = false;
    });
    connect(&desk_, &Desk::prepared, this, &QualityFinder::prepare);
}

void QualityFinder::attach(QQuickWindow* window, QQuickItem* scene) {
    window_ = window;
    scene_ = scene;
    connect(  // stamped by the thread that draws, looked at in this one
        window, &QQuickWindow::frameSwapped, this,
        [this] {
            const std::int64_t now_ns = run::steadyNanoseconds();
            QMetaObject::invokeMethod(
                this, [this, now_ns] { took(now_ns); }, Qt::QueuedConnection);
        },
        Qt::DirectConnection);
}

/// The windows show the attempt's scene; its first picture counts from now on, or once the quality is found.
void QualityFinder::prepare(std::int64_t attempt) {
    attempt_ = attempt;
    const bool drawn = scene_ != nullptr && scene_->isVisible() && desk_.run().scene() != nullptr;
    if (!drawn) search_.reset();  // an earlier attempt's: its scene is gone
    if (const auto& kept = desk_.run().view().quality; kept && !fixed_ && !found_) {  // of a session that goes on
        quality_ = kept->quality;
        found_ = true;
        emit changed();
    }
    if (!fixed_ && !found_ && drawn)
        begin();
    else
        finish();
}

void QualityFinder::begin() {
    search_.emplace(desk_.run().appearance().shadow > 0.0);
    quality_ = search_->candidate();
    last_ns_ = 0;
    emit changed();
    draw();
}

void QualityFinder::took(std::int64_t now_ns) {
    if (!search_) return;
    const std::int64_t before_ns = std::exchange(last_ns_, now_ns);
    if (before_ns > 0) search_->take(1e-9 * static_cast<double>(now_ns - before_ns));
    if (quality_ != search_->candidate()) {
        quality_ = search_->candidate();
        emit changed();
    }
    if (!search_->done()) return draw();
    presenter::QualityFound found;
    found.quality = quality_;
    const double pixels = window_->devicePixelRatio();
    found.width_px = static_cast<int>(window_->width() * pixels);
    found.height_px = static_cast<int>(window_->height() * pixels);
    for (const presenter::DrawnPart& part : desk_.run().scene()->parts)
        found.triangles += static_cast<std::int64_t>(part.mesh->indices.size() / 3);
    found.pictures_per_s = search_->picturesPerSecond();
    search_.reset();
    found_ = true;
    desk_.drawsWith(found);
    finish();
}

/// Another picture, of the scene as well, although nothing in it has moved.
void QualityFinder::draw() {
    if (scene_ != nullptr) scene_->update();
    if (window_ != nullptr) window_->update();
}

void QualityFinder::finish() {
    desk_.frames().prepared(attempt_);
    draw();
}

}  // namespace passung::window
