#include "ui/window/screen.h"

#include <algorithm>
#include <cmath>

namespace passung::window {

namespace {

presenter::DragPlane planeOf(int buttons, int modifiers) {
    if ((modifiers & Qt::ControlModifier) != 0 || (buttons & Qt::RightButton) != 0) return presenter::DragPlane::Turn;
    if ((modifiers & Qt::ShiftModifier) != 0 || (buttons & Qt::MiddleButton) != 0) return presenter::DragPlane::Ground;
    return presenter::DragPlane::Upright;
}

/// Arrow keys and page up, down move; W, A, S, D, Q, E turn. Null: another key.
double* axisOf(int key, presenter::HeldKeys& keys, double& sign) {
    sign = 1.0;
    switch (key) {
        case Qt::Key_Left:
            sign = -1.0;
            [[fallthrough]];
        case Qt::Key_Right:
            return &keys.move.x();
        case Qt::Key_Down:
            sign = -1.0;
            [[fallthrough]];
        case Qt::Key_Up:
            return &keys.move.y();
        case Qt::Key_PageDown:
            sign = -1.0;
            [[fallthrough]];
        case Qt::Key_PageUp:
            return &keys.move.z();
        case Qt::Key_W:
            sign = -1.0;
            [[fallthrough]];
        case Qt::Key_S:
            return &keys.turn.x();
        case Qt::Key_D:
            sign = -1.0;
            [[fallthrough]];
        case Qt::Key_A:
            return &keys.turn.y();
        case Qt::Key_Q:
            sign = -1.0;
            [[fallthrough]];
        case Qt::Key_E:
            return &keys.turn.z();
        default:
            return nullptr;
    }
}

}  // namespace

Screen::Screen(Desk& desk, int every) : desk_(desk), every_(every) {
    connect(&desk_, &Desk::sceneChanged, this, &Screen::takeScene);
    connect(&desk_, &Desk::frame, this, &Screen::takeFrame);
    connect(&desk_, &Desk::happened, this, [this] {
        show(presenter::participantView(desk_.run(), !desk_.byMouse()));
        emit stateChanged();
    });
    connect(&desk_, &Desk::opened, this, [this] {
        letGo();
        emit stateChanged();
    });
    since_frame_.start();
}

Screen::~Screen() = default;

void Screen::setFullScreen(bool full) {
    full_screen_ = full;
    emit stateChanged();
}

bool Screen::shown() const {
    const presenter::RunView& run = desk_.run().view();
    return !run.is<presenter::state::Idle>() && run.display != presenter::Display::Closed;
}

void Screen::takeScene() {
    const auto scene = desk_.run().scene();
    if (!scene) return;
    show(*scene);
    show(presenter::participantView(desk_.run(), !desk_.byMouse()));
}

void Screen::takeFrame() {
    if (keys_.any() && every_ == 0) steer();
    if (every_ > 0 && since_frame_.elapsed() < every_) return;
    since_frame_.restart();
    const auto before = view().screen;
    show(presenter::participantView(desk_.run(), !desk_.byMouse()));
    if (view().screen != before) emit stateChanged();
}

void Screen::move(const presenter::PartMotion& motion) {
    if (mouse::Pointer* pointer = desk_.pointer()) pointer->move(motion.way, motion.turn);
}

/// Says what keys are held now; the session's thread moves the part by its own clock.
void Screen::steer() {
    mouse::Pointer* pointer = desk_.pointer();
    const auto& scene = desk_.run().scene();
    if (pointer == nullptr || !scene) return;
    const presenter::PartMotion second = presenter::keyMotion(scene->camera, keys_, 1.0);
    pointer->drive(second.way, second.turn);
}

void Screen::drag(double right, double down, double height, int buttons, int modifiers) {
    if (const auto& scene = desk_.run().scene())
        move(presenter::dragMotion(scene->camera, height, planeOf(buttons, modifiers), right, down));
}

void Screen::wheel(double notches, int modifiers) {
    if (const auto& scene = desk_.run().scene())
        move(presenter::wheelMotion(scene->camera, planeOf(0, modifiers), notches));
}

/// The handle's button that a key stands for, as a bit; 0: none. The space bar says that something is there, or picks
/// it up.
std::uint32_t Screen::buttonOf(int key) const {
    const presenter::TrialBrief& brief = desk_.run().view().brief;
    const auto bit = [](int button) { return button > 0 ? 1u << (button - 1) : 0u; };
    switch (key) {
        case Qt::Key_Space:
            return bit(std::max(1, brief.pick_button));
        case Qt::Key_Backspace:
            return bit(brief.undo_button);
        case Qt::Key_1:
            return bit(1);
        case Qt::Key_2:
            return bit(2);
        default:
            return 0;
    }
}

bool Screen::key(int key, bool down) {
    if (const std::uint32_t button = buttonOf(key); button != 0) {
        buttons_ = down ? buttons_ | button : buttons_ & ~button;
        if (mouse::Pointer* pointer = desk_.pointer()) pointer->press(buttons_);
        return true;
    }
    if (key == Qt::Key_Shift) {
        keys_.fine = down;
        steer();
        return false;  // it means something else with a drag
    }
    double sign = 1.0;
    double* axis = axisOf(key, keys_, sign);
    if (axis == nullptr) return false;
    *axis = down ? sign : *axis == sign ? 0.0 : *axis;
    steer();
    return true;
}

void Screen::letGo() {
    keys_ = {};
    steer();
    buttons_ = 0;
    if (mouse::Pointer* pointer = desk_.pointer()) pointer->press(0u);
}

void Screen::closed() {
    letGo();
    desk_.setDisplay(presenter::Display::Closed);
}

void Screen::setDrawing(bool draws) {
    if (desk_.run().view().display == (draws ? presenter::Display::Lost : presenter::Display::Shown))
        desk_.setDisplay(draws ? presenter::Display::Shown : presenter::Display::Lost);
}

}  // namespace passung::window
