#include "core/tick/input_guard.h"

namespace passung::tick {

namespace {

bool isPose(const Pose& X_BD) noexcept { return isRigid(X_BD) && X_BD.p.cwiseAbs().maxCoeff() <= kFarthestReading; }

/// Can the handle have come from `before` to `after` in `ticks` ticks?
bool follows(const scene::OutputLimits& limits, const Pose& before, const Pose& after, std::int64_t ticks) noexcept {
    const double elapsed = kTickSeconds * static_cast<double>(ticks);
    return (after.p - before.p).norm() <= limits.max_speed * elapsed &&
           rotationVector(after.q * before.q.conjugate()).norm() <= limits.max_spin * elapsed;
}

/// Counts the samples that do not follow from the last good one but from each other; true when they are enough.
bool agreesWithOthers(const HandModel& model, InputGuard& guard, const Pose& X_BD) noexcept {
    const bool agrees = guard.other_samples > 0 && guard.periods_since_other <= kLongestSearchGap &&
                        follows(model.limits, guard.X_BD_other, X_BD, guard.periods_since_other);
    guard.other_samples = agrees ? guard.other_samples + 1 : 1;
    guard.X_BD_other = X_BD;
    guard.periods_since_other = 0;
    return guard.other_samples >= (guard.good_confirmed ? kAgreeingSamplesToMove : kAgreeingSamples);
}

/// The sample becomes the last good one.
void accept(InputGuard& guard, HandSample& hand, const Pose& X_BD, bool confirmed) noexcept {
    hand.sample_periods = guard.periods_since_good;
    hand.input_usable = true;
    guard.X_BD_good = X_BD;
    guard.X_BD_good.q.normalize();
    guard.has_good_pose = true;
    guard.good_confirmed = confirmed;
    guard.periods_since_good = 0;
    guard.other_samples = 0;
}

/// Takes the reading if it is good. Otherwise says what is wrong with it.
std::uint32_t takeReading(const HandModel& model, const DeviceReading& reading, InputGuard& guard, HandSample& hand,
                          Report& report) noexcept {
    const Pose& X_BD = reading.X_BD;
    if (!reading.fresh) return kDeviceStale;
    if (!isPose(X_BD)) return kInputNotAPose;
    if (!guard.has_good_pose) {
        accept(guard, hand, X_BD, false);
    } else if (follows(model.limits, guard.X_BD_good, X_BD, guard.periods_since_good)) {
        accept(guard, hand, X_BD, guard.periods_since_good <= 2);
    } else if (agreesWithOthers(model, guard, X_BD)) {
        accept(guard, hand, X_BD, true);
        hand.relocated = true;
        report.status |= kInputRelocated;
    } else {
        return kInputJump;
    }
    return kStatusOk;
}

}  // namespace

Pose registeredPose(const scene::Registration& registration, const Pose& X_BD, const Pose& X_DH) noexcept {
    const Pose scaled{X_BD.q, registration.scale * X_BD.p};
    return registration.X_WB * (scaled * X_DH);
}

void guardInput(const HandModel& model, const Reading& device, const Grip& grip, const Proxy& proxy, InputGuard& guard,
                HandSample& hand, Report& report) noexcept {
    guard.periods_since_good += device.reading.periods;
    guard.periods_since_other += device.reading.periods;
    const std::uint32_t fault = takeReading(model, device.reading, guard, hand, report);
    report.status |= fault;
    if (fault != kStatusOk) {
        // One tick of a wrong pose is bearable, two are not: a pose that nobody confirmed is not held when it is
        // denied.
        const bool denied = fault == kInputJump && !guard.good_confirmed;
        hand.input_usable = guard.has_good_pose && guard.periods_since_good == 1 && !denied;
        report.status |= hand.input_usable ? kInputHeld : kInputRejected;
    }
    hand.X_WH = guard.has_good_pose ? registeredPose(model.registration, guard.X_BD_good, grip.X_DG) : proxy.X_WG;
}

void waitForStartPose(const HandModel& model, const HandSample& hand, Engagement& gate) noexcept {
    if (gate.engaged) return;
    const double away = (hand.X_WH.p - model.X_WG_start.p).norm();
    const double turned = rotationVector(hand.X_WH.q * model.X_WG_start.q.conjugate()).norm();
    const bool there =
        hand.input_usable && away <= model.start_gate.position_tolerance && turned <= model.start_gate.angle_tolerance;
    gate.held_ticks = there ? gate.held_ticks + 1 : 0;
    gate.engaged = gate.held_ticks > model.start_gate.hold_ticks;
}

}  // namespace passung::tick
