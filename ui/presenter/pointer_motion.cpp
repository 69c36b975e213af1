#include "ui/presenter/pointer_motion.h"

namespace passung::presenter {

namespace {

constexpr double kTurnPerPixel = 0.006;  // [rad]
constexpr double kNotch = 2.0e-3;        // [m]
constexpr double kTurnPerNotch = 0.05;   // [rad]
constexpr double kKeySpeed = 0.04;       // [m/s]
constexpr double kKeyTurn = 0.6;         // [rad/s]
constexpr double kFine = 0.1;            // share of both

/// Right, up and away as a person sees them, but level with the ground.
struct ViewAxes {
    Vec3 right, up = Vec3::UnitZ(), away;
    explicit ViewAxes(const Camera& camera) : right(camera.X_WC.q * Vec3::UnitX()), away(up.cross(right)) {}
    Vec3 at(const Vec3& v) const { return v.x() * right + v.y() * up + v.z() * away; }
};

}  // namespace

PartMotion dragMotion(const Camera& camera, double height_px, DragPlane plane, double right_px, double down_px) {
    const ViewAxes view(camera);
    const double scale = camera.metresPerPixel(height_px);
    switch (plane) {
        case DragPlane::Upright:
            return {scale * view.at({right_px, -down_px, 0.0}), Vec3::Zero()};
        case DragPlane::Ground:
            return {scale * view.at({right_px, 0.0, -down_px}), Vec3::Zero()};
        case DragPlane::Turn:
            return {Vec3::Zero(), kTurnPerPixel * (right_px * view.up + down_px * view.right)};
    }
    return {};
}

PartMotion wheelMotion(const Camera& camera, DragPlane plane, double notches) {
    const ViewAxes view(camera);
    if (plane == DragPlane::Turn) return {Vec3::Zero(), kTurnPerNotch * notches * view.away};
    return {kNotch * notches * view.away, Vec3::Zero()};
}

PartMotion keyMotion(const Camera& camera, const HeldKeys& keys, double seconds) {
    const ViewAxes view(camera);
    if (keys.fine) seconds *= kFine;
    return {kKeySpeed * seconds * view.at(keys.move), kKeyTurn * seconds * view.at(keys.turn)};
}

}  // namespace passung::presenter
