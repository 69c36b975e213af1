#include "core/tick/output_stage.h"

#include <algorithm>
#include <utility>

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

/// From the held part's origin and world axes to the handle's origin and device base axes.
Wrench wrenchOnDevice(const HandModel& model, const HandSample& hand, const Grip& grip, const Wrench& F_H_W) noexcept {
    const Quat R_BW = model.registration.X_WB.q.conjugate();
    const Vec3 p_DH_W = leverOf(hand, grip);
    return {R_BW * F_H_W.force, R_BW * (F_H_W.torque + p_DH_W.cross(F_H_W.force))};
}

/// The pairs' shares of what was sent, of whose force and torque the limits left so much.
void splitSent(const HandModel& model, const HandSample& hand, const Grip& grip, const Pushes& pushes, SentWrench& sent,
               double force_left, double torque_left) noexcept {
    Wrench rest = sent.last_sent;
    sent.last_shares.clear();
    for (const std::uint32_t i : pushes.pushes.held()) {
        if (i + 1 == pushes.pushes.size()) continue;  // no obstacle's: what is left below
        const Wrench push = wrenchOnDevice(model, hand, grip, pushes.pushes[i].wrench);
        const Wrench share{force_left * push.force, torque_left * push.torque};
        sent.last_shares[model.obstacles[i].body] = share;
        rest.force -= share.force;
        rest.torque -= share.torque;
    }
    sent.last_shares.back() = rest;  // that no obstacle pushes: the weight, and what has no push of its own
}

}  // namespace

Vec3 leverOf(const HandSample& hand, const Grip& grip) noexcept {
    return hand.X_WH.q * (grip.X_DG.q.conjugate() * grip.X_DG.p);
}

Wrench wrenchOnHeldPart(const HandModel& model, const HandSample& hand, const Grip& grip,
                        const Wrench& F_D_B) noexcept {
    const Quat& R_WB = model.registration.X_WB.q;
    const Vec3 force = R_WB * F_D_B.force;
    return {force, R_WB * F_D_B.torque - leverOf(hand, grip).cross(force)};
}

void delayOutput(const HandModel& model, const HandSample& hand, DelayLine& line, Pushes& pushes,
                 HandWrench& wrench) noexcept {
    const auto length = static_cast<std::size_t>(model.limits.delay_ticks) + 1;
    const std::size_t in = line.place, out = (line.place + 1) % length;
    line.delay_line[in] = hand.input_usable ? wrench.F_H_W : Wrench{};
    wrench.F_H_W = line.delay_line[out];
    FewOfMany<Wrench>& kept = line.push_line[in];
    kept.clear();
    for (const std::uint32_t i : pushes.pushes.held()) {
        kept[i] = pushes.pushes[i].wrench;
        pushes.pushes[i].wrench = Wrench{};
    }
    for (const std::uint32_t i : line.push_line[out].held())
        pushes.pushes[i].wrench = std::as_const(line.push_line[out])[i];
    line.place = out;
}

void withholdWrench(const HandModel&, Pushes& pushes, HandWrench& wrench, Report& report) noexcept {
    report.status |= kWrenchWithheld;
    clearPushes(pushes);
    if (isFinite(wrench.F_H_W)) wrench.F_H_W = Wrench{};
}

void limitOutput(const HandModel& model, const HandSample& hand, const Grip& grip, const Pushes& pushes,
                 SentWrench& sent, HandWrench& felt, CommandedWrench& command, Report& report) noexcept {
    const scene::OutputLimits& limits = model.limits;
    Wrench wrench = wrenchOnDevice(model, hand, grip, felt.F_H_W);
    if (!isFinite(wrench)) sent.latched = true;
    if (sent.latched) report.status |= kNonFiniteLatched;
    if (!hand.input_usable || sent.latched) {
        command.F_D_B = Wrench{};
        felt.F_H_W = Wrench{};
        sent.last_sent = sent.sent_at_sample = Wrench{};
        sent.weighed = 0.0;
        sent.last_shares.clear();
        return;
    }
    const bool turns = limits.actuates_torque && limits.max_torque != 0.0;
    if (!turns) wrench.torque.setZero();
    const double within =
        std::min(factorWithin(wrench.force, limits.max_force), factorWithin(wrench.torque, limits.max_torque));
    if (within < 1.0) report.status |= kForceLimited;
    wrench = {within * wrench.force, within * wrench.torque};

    const double rise = limits.max_force_rate * kTickSeconds;
    const double torque_rise = rise * limits.max_torque / limits.max_force;
    const Wrench &last = sent.last_sent, &at_sample = sent.sent_at_sample;
    const double force_rising = factorRising(wrench.force, last.force, at_sample.force, rise);
    const double torque_rising = factorRising(wrench.torque, last.torque, at_sample.torque, torque_rise);
    if (force_rising < 1.0 || torque_rising < 1.0) report.status |= kRateLimited;
    wrench = {force_rising * wrench.force, torque_rising * wrench.torque};

    command.F_D_B = wrench;
    felt.F_H_W = wrenchOnHeldPart(model, hand, grip, wrench);
    sent.last_sent = wrench;
    sent.weighed = model.hasWeight() ? pushes.pushes.back().wrench.force.norm() / model.weight.norm() : 0.0;
    if (hand.sample_periods > 0) sent.sent_at_sample = wrench;
    splitSent(model, hand, grip, pushes, sent, within * force_rising, turns ? within * torque_rising : 0.0);
}

}  // namespace passung::tick
