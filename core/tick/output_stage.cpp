#include "core/tick/output_stage.h"

#include <algorithm>

namespace passung::tick {

namespace {

/// The factor in (0, 1] that keeps `v` within `limit`, rounding included; a zero vector needs none.
double factorWithin(const Vec3& v, double limit) noexcept {
    const double length = v.norm();
    return length > limit ? limit / length * (1.0 - 0x1p-50) : 1.0;
}

/// The factor that keeps `v` from rising faster than `rise` above its predecessor's share along `v`.
double factorRising(const Vec3& v, const Vec3& last, double rise) noexcept {
    const double length = v.norm();
    if (!(length > 0.0)) return 1.0;
    return factorWithin(v, std::max(0.0, last.dot(v) / length) + rise);
}

/// From the held part's origin and world axes to the handle's origin and device base axes, or back.
Wrench toDevice(const Wrench& F_H_W, const Pose& X_WB, const Vec3& p_DH_W) noexcept {
    const Quat R_BW = X_WB.q.conjugate();
    return {R_BW * F_H_W.force, R_BW * (F_H_W.torque + p_DH_W.cross(F_H_W.force))};
}

Wrench toHeldPart(const Wrench& F_D_B, const Pose& X_WB, const Vec3& p_DH_W) noexcept {
    const Vec3 force = X_WB.q * F_D_B.force;
    return {force, X_WB.q * F_D_B.torque - p_DH_W.cross(force)};
}

}  // namespace

void delayOutput(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    const auto length = static_cast<std::int64_t>(model.limits.delay_ticks) + 1;
    state.delay_line[static_cast<std::size_t>(state.tick % length)] = frame.F_H_W;
    frame.F_H_W = state.delay_line[static_cast<std::size_t>((state.tick + 1) % length)];
}

void limitOutput(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    const model::OutputLimits& limits = model.limits;
    const Vec3 p_DH_W = frame.X_WH.q * (model.registration.X_DH.q.conjugate() * model.registration.X_DH.p);
    Wrench wrench = toDevice(frame.F_H_W, model.registration.X_WB, p_DH_W);
    if (!isFinite(wrench)) state.latched = true;
    if (state.latched) frame.status |= kNonFiniteLatched;
    if (!frame.input_usable || state.latched) {
        frame.F_D_B = Wrench{};
        frame.F_H_W = Wrench{};
        state.last_sent = Wrench{};
        return;
    }
    if (!limits.actuates_torque || limits.max_torque == 0.0) wrench.torque.setZero();
    const double within =
        std::min(factorWithin(wrench.force, limits.max_force), factorWithin(wrench.torque, limits.max_torque));
    if (within < 1.0) frame.status |= kForceLimited;
    wrench = {within * wrench.force, within * wrench.torque};

    const double rise = limits.max_force_rate * kTickSeconds;
    const double torque_rise = rise * limits.max_torque / limits.max_force;
    const double rising = std::min(factorRising(wrench.force, state.last_sent.force, rise),
                                   factorRising(wrench.torque, state.last_sent.torque, torque_rise));
    if (rising < 1.0) frame.status |= kRateLimited;
    wrench = {rising * wrench.force, rising * wrench.torque};

    frame.F_D_B = wrench;
    frame.F_H_W = toHeldPart(wrench, model.registration.X_WB, p_DH_W);
    state.last_sent = wrench;
}

}  // namespace passung::tick
