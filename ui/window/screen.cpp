#include "ui/window/screen.h"

#include <QtQml/QQmlEngine>
#include <cmath>

#include "ui/participant/part_geometry.h"
#include "ui/window/words.h"

namespace passung::window {

namespace {

constexpr std::size_t kHeavy = 20'000;  // triangles; a part that software draws casts no shadow with more
constexpr double kDegrees = 57.29577951308232;

QVector3D millimetres(const Vec3& v) {
    return {static_cast<float>(1e3 * v.x()), static_cast<float>(1e3 * v.y()), static_cast<float>(1e3 * v.z())};
}

QQuaternion rotation(const Quat& q) {
    return {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z())};
}

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
        view_ = presenter::participantView(desk_.run(), !desk_.byMouse());
        emit stateChanged();
        emit frame();
    });
    connect(&desk_, &Desk::opened, this, [this] {
        letGo();
        emit stateChanged();
    });
    since_frame_.start();
    since_keys_.start();
}

Screen::~Screen() = default;

void Screen::setSoftware(bool software) {
    software_ = software;
    emit sceneChanged();
}

void Screen::setFullScreen(bool full) {
    full_screen_ = full;
    emit stateChanged();
}

bool Screen::shown() const {
    const presenter::RunView& run = desk_.run().view();
    return run.state != presenter::RunState::Idle && run.display != presenter::Display::Closed;
}

QString Screen::line() const { return participantLine(view_.screen); }
QString Screen::hint() const { return participantHint(view_.screen, desk_.byMouse()); }

QQuick3DGeometry* Screen::geometryOf(const std::shared_ptr<const presenter::ShadedMesh>& mesh) {
    auto& geometry = geometries_[mesh];
    if (!geometry) {
        geometry = std::make_unique<participant::PartGeometry>(*mesh);
        QQmlEngine::setObjectOwnership(geometry.get(), QQmlEngine::CppOwnership);
    }
    return geometry.get();
}

void Screen::takeScene() {
    const auto scene = desk_.run().scene();
    if (!scene) return;
    parts_.clear();
    std::size_t corners = 0;
    for (const presenter::DrawnPart& part : scene->parts) {
        QQuick3DGeometry* geometry = geometryOf(part.mesh);
        parts_.append(QVariantMap{{"geometry", QVariant::fromValue(geometry)},
                                  {"position", millimetres(part.X_W.p)},
                                  {"rotation", rotation(part.X_W.q)},
                                  {"held", part.held},
                                  {"casts", !(software_ && part.mesh->indices.size() / 3 > kHeavy)}});
        if (part.held) held_geometry_ = geometry;
        corners += part.mesh->indices.size();
    }
    heavy_ = software_ && corners / 3 > kHeavy;
    marks_.clear();
    for (const presenter::Mark& mark : scene->marks)
        marks_.append(QVariantMap{{"geometry", QVariant::fromValue(geometryOf(mark.mesh))},
                                  {"position", millimetres(mark.X_W.p)},
                                  {"rotation", rotation(mark.X_W.q)},
                                  {"pale", mark.pale}});
    radius_ = 1e3 * scene->radius;
    const presenter::Camera& camera = scene->camera;
    ground_position_ = millimetres({camera.centre.x(), camera.centre.y(), scene->floor});
    camera_position_ = millimetres(camera.X_WC.p);
    camera_rotation_ = rotation(camera.X_WC.q);
    const Vec3 from = (camera.X_WC.q * Vec3(-0.55, 0.5, 0.35) + 1.3 * Vec3::UnitZ()).normalized();
    light_rotation_ = rotation(Quat::FromTwoVectors(Vec3::UnitZ(), from));
    camera_opening_ = kDegrees * camera.opening;
    camera_near_ = 1e3 * camera.near;
    camera_far_ = 1e3 * camera.far;
    view_ = presenter::participantView(desk_.run(), !desk_.byMouse());
    emit sceneChanged();
    emit frame();
}

void Screen::takeFrame() {
    const double seconds = 1e-3 * static_cast<double>(since_keys_.restart());
    if (const auto& scene = desk_.run().scene(); scene && keys_.any() && every_ == 0)
        move(presenter::keyMotion(scene->camera, keys_, std::min(seconds, 0.1)));
    if (every_ > 0 && since_frame_.elapsed() < every_) return;
    since_frame_.restart();
    const auto before = view_.screen;
    view_ = presenter::participantView(desk_.run(), !desk_.byMouse());
    if (view_.screen != before) emit stateChanged();
    emit frame();
}

QVector3D Screen::heldPosition() const { return millimetres(view_.X_WHeld.p); }
QQuaternion Screen::heldRotation() const { return rotation(view_.X_WHeld.q); }
QVector3D Screen::startPosition() const { return millimetres(view_.X_WStart.p); }
QQuaternion Screen::startRotation() const { return rotation(view_.X_WStart.q); }
QVector3D Screen::arrowPosition() const { return millimetres(view_.arrow_from); }
double Screen::arrowLength() const { return 1e3 * view_.arrow_way.norm(); }

QQuaternion Screen::arrowRotation() const {
    if (!view_.arrow) return {};
    return rotation(Quat::FromTwoVectors(Vec3::UnitY(), view_.arrow_way));
}

QColor Screen::heldColor(const QColor& plain) const {
    const auto mixed = [this](float from, float to) { return from + static_cast<float>(view_.cue) * (to - from); };
    const QColor hit(0xd5, 0x2e, 0x00);
    return QColor::fromRgbF(mixed(plain.redF(), hit.redF()), mixed(plain.greenF(), hit.greenF()),
                            mixed(plain.blueF(), hit.blueF()));
}

void Screen::move(const presenter::PartMotion& motion) {
    if (mouse::Pointer* pointer = desk_.pointer()) pointer->move(motion.way, motion.turn);
}

void Screen::drag(double right, double down, double height, int buttons, int modifiers) {
    if (const auto& scene = desk_.run().scene())
        move(presenter::dragMotion(scene->camera, height, planeOf(buttons, modifiers), right, down));
}

void Screen::wheel(double notches, int modifiers) {
    if (const auto& scene = desk_.run().scene())
        move(presenter::wheelMotion(scene->camera, planeOf(0, modifiers), notches));
}

bool Screen::key(int key, bool down) {
    const std::uint32_t button = key == Qt::Key_Space || key == Qt::Key_1 ? 1u : key == Qt::Key_2 ? 2u : 0u;
    if (button != 0) {
        buttons_ = down ? buttons_ | button : buttons_ & ~button;
        if (mouse::Pointer* pointer = desk_.pointer()) pointer->press(buttons_);
        return true;
    }
    double sign = 1.0;
    double* axis = axisOf(key, keys_, sign);
    if (axis == nullptr) return false;
    *axis = down ? sign : *axis == sign ? 0.0 : *axis;
    return true;
}

void Screen::letGo() {
    keys_ = {};
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
