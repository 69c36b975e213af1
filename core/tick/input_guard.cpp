#include "core/tick/input_guard.h"

#include <cmath>

namespace passung::tick {

namespace {

constexpr double kUnitTolerance = 1e-3;  // of a quaternion's length: drivers send rounded values

bool isGood(const TickModel& model, const TickState& state, const DeviceReading& reading) noexcept {
    if (!isFinite(reading.X_BD)) return false;
    if (!(std::abs(reading.X_BD.q.norm() - 1.0) < kUnitTolerance)) return false;
    if (!state.has_good_pose) return true;
    const double elapsed = kTickSeconds * static_cast<double>(state.ticks_since_good + 1);
    const Vec3 moved = reading.X_BD.p - state.X_BD_good.p;
    const Vec3 turned = rotationVector(reading.X_BD.q * state.X_BD_good.q.conjugate());
    return moved.norm() <= model.limits.max_speed * elapsed && turned.norm() <= model.limits.max_spin * elapsed;
}

}  // namespace

Pose registeredPose(const model::Registration& registration, const Pose& X_BD) noexcept {
    const Pose scaled{X_BD.q, registration.scale * X_BD.p};
    return registration.X_WB * (scaled * registration.X_DH);
}

void guardInput(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    if (!frame.reading.fresh) frame.status |= kDeviceStale;
    if (frame.reading.fresh && isGood(model, state, frame.reading)) {
        state.X_BD_good = frame.reading.X_BD;
        state.X_BD_good.q.normalize();
        state.has_good_pose = true;
        state.ticks_since_good = 0;
        frame.input_usable = true;
    } else {
        ++state.ticks_since_good;
        frame.input_usable = state.has_good_pose && state.ticks_since_good <= 1;
        frame.status |= frame.input_usable ? kInputHeld : kInputRejected;
    }
    frame.X_WH = state.has_good_pose ? registeredPose(model.registration, state.X_BD_good) : state.X_WG;
}

void waitForStartPose(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    if (state.engaged) return;
    const double away = (frame.X_WH.p - model.X_WG_start.p).norm();
    const double turned = rotationVector(frame.X_WH.q * model.X_WG_start.q.conjugate()).norm();
    const bool there =
        frame.input_usable && away <= model.start_gate.position_tolerance && turned <= model.start_gate.angle_tolerance;
    state.held_ticks = there ? state.held_ticks + 1 : 0;
    state.engaged = state.held_ticks > model.start_gate.hold_ticks;
}

}  // namespace passung::tick
