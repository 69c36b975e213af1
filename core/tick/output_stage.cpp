#include "core/tick/output_stage.h"

#include <algorithm>

#include "core/tick/contact_energy.h"

namespace passung::tick {

namespace {

/// The factor in (0, 1] that keeps `v` within `limit`; a zero vector needs none. Taken apart into largest component and
/// ratio, so that no finite vector is too long; the last factor covers the rounding of both and of who checks.
double factorWithin(const Vec3& v, double limit) noexcept {
    const double largest = v.cwiseAbs().maxCoeff();
    if (!(largest > 0.0)) return 1.0;
    const double ratio = (v / largest).norm();
    return largest * ratio > limit ? limit / largest / ratio * (1.0 - 0x1p-48) : 1.0;
}

/// The factor that keeps `v` from rising by more than `rise` above the share along `v` of `last` or of `at_sample`.
double factorRising(const Vec3& v, const Vec3& last, const Vec3& at_sample, double rise) noexcept {
    const double largest = v.cwiseAbs().maxCoeff();
    if (!(largest > 0.0)) return 1.0;
    const Vec3 direction = (v / largest).normalized();
    return factorWithin(v, std::max({0.0, last.dot(direction), at_sample.dot(direction)}) + rise);
}

/// From the handle's origin to the held part's, world axes.
Vec3 lever(const TickModel& model, const TickFrame& frame) noexcept {
    return frame.X_WH.q * (model.registration.X_DH.q.conjugate() * model.registration.X_DH.p);
}

/// From the held part's origin and world axes to the handle's origin and device base axes.
Wrench wrenchOnDevice(const TickModel& model, const TickFrame& frame, const Wrench& F_H_W) noexcept {
    const Quat R_BW = model.registration.X_WB.q.conjugate();
    const Vec3 p_DH_W = lever(model, frame);
    return {R_BW * F_H_W.force, R_BW * (F_H_W.torque + p_DH_W.cross(F_H_W.force))};
}

/// The pairs' shares of what was sent, of whose force and torque the limits left so much.
void splitSent(const TickModel& model, TickState& state, const TickFrame& frame, double force_left,
               double torque_left) noexcept {
    Wrench rest = state.last_sent;
    for (PairAccount& pair : state.pairs) {
        const Wrench push = wrenchOnDevice(model, frame, pair.push);
        pair.last_sent = {force_left * push.force, torque_left * push.torque};
        rest.force -= pair.last_sent.force;
        rest.torque -= pair.last_sent.torque;
    }
    state.pairs.back().last_sent = rest;  // that has no push of its own
}

}  // namespace

Wrench wrenchOnHeldPart(const TickModel& model, const TickFrame& frame, const Wrench& F_D_B) noexcept {
    const Quat& R_WB = model.registration.X_WB.q;
    const Vec3 force = R_WB * F_D_B.force;
    return {force, R_WB * F_D_B.torque - lever(model, frame).cross(force)};
}

void delayOutput(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    const auto length = static_cast<std::int64_t>(model.limits.delay_ticks) + 1;
    state.delay_line[static_cast<std::size_t>(state.tick % length)] = frame.input_usable ? frame.F_H_W : Wrench{};
    frame.F_H_W = state.delay_line[static_cast<std::size_t>((state.tick + 1) % length)];
    delayPushes(model, state);
}

void withholdWrench(const TickModel&, TickState& state, TickFrame& frame) noexcept {
    frame.status |= kWrenchWithheld;
    clearPushes(state);
    if (isFinite(frame.F_H_W)) frame.F_H_W = Wrench{};
}

void limitOutput(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    const model::OutputLimits& limits = model.limits;
    Wrench wrench = wrenchOnDevice(model, frame, frame.F_H_W);
    if (!isFinite(wrench)) state.latched = true;
    if (state.latched) frame.status |= kNonFiniteLatched;
    if (!frame.input_usable || state.latched) {
        frame.F_D_B = Wrench{};
        frame.F_H_W = Wrench{};
        state.last_sent = state.sent_at_sample = Wrench{};
        for (PairAccount& pair : state.pairs) pair.last_sent = Wrench{};
        return;
    }
    const bool turns = limits.actuates_torque && limits.max_torque != 0.0;
    if (!turns) wrench.torque.setZero();
    const double within =
        std::min(factorWithin(wrench.force, limits.max_force), factorWithin(wrench.torque, limits.max_torque));
    if (within < 1.0) frame.status |= kForceLimited;
    wrench = {within * wrench.force, within * wrench.torque};

    const double rise = limits.max_force_rate * kTickSeconds;
    const double torque_rise = rise * limits.max_torque / limits.max_force;
    const Wrench &last = state.last_sent, &at_sample = state.sent_at_sample;
    const double force_rising = factorRising(wrench.force, last.force, at_sample.force, rise);
    const double torque_rising = factorRising(wrench.torque, last.torque, at_sample.torque, torque_rise);
    if (force_rising < 1.0 || torque_rising < 1.0) frame.status |= kRateLimited;
    wrench = {force_rising * wrench.force, torque_rising * wrench.torque};

    frame.F_D_B = wrench;
    frame.F_H_W = wrenchOnHeldPart(model, frame, wrench);
    state.last_sent = wrench;
    if (frame.sample_periods > 0) state.sent_at_sample = wrench;
    splitSent(model, state, frame, within * force_rising, turns ? within * torque_rising : 0.0);
}

}  // namespace passung::tick
