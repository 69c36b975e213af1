#include "core/tick/input_guard.h"

namespace passung::tick {

namespace {

bool isPose(const Pose& X_BD) noexcept { return isRigid(X_BD) && X_BD.p.cwiseAbs().maxCoeff() <= kFarthestReading; }

/// Can the handle have come from `before` to `after` in `ticks` ticks?
bool follows(const model::OutputLimits& limits, const Pose& before, const Pose& after, std::int64_t ticks) noexcept {
    const double elapsed = kTickSeconds * static_cast<double>(ticks);
    return (after.p - before.p).norm() <= limits.max_speed * elapsed &&
           rotationVector(after.q * before.q.conjugate()).norm() <= limits.max_spin * elapsed;
}

/// Counts the samples that do not follow from the last good one but from each other; true when they are enough.
bool agreesWithOthers(const TickModel& model, TickState& state, const Pose& X_BD) noexcept {
    const bool agrees = state.other_samples > 0 && state.periods_since_other <= kLongestSearchGap &&
                        follows(model.limits, state.X_BD_other, X_BD, state.periods_since_other);
    state.other_samples = agrees ? state.other_samples + 1 : 1;
    state.X_BD_other = X_BD;
    state.periods_since_other = 0;
    return state.other_samples >= (state.good_confirmed ? kAgreeingSamplesToMove : kAgreeingSamples);
}

/// The sample becomes the last good one.
void accept(TickState& state, TickFrame& frame, bool confirmed) noexcept {
    frame.sample_periods = state.periods_since_good;
    frame.input_usable = true;
    state.X_BD_good = frame.reading.X_BD;
    state.X_BD_good.q.normalize();
    state.has_good_pose = true;
    state.good_confirmed = confirmed;
    state.periods_since_good = 0;
    state.other_samples = 0;
}

/// Takes the reading if it is good. Otherwise says what is wrong with it.
std::uint32_t takeReading(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    const Pose& X_BD = frame.reading.X_BD;
    if (!frame.reading.fresh) return kDeviceStale;
    if (!isPose(X_BD)) return kInputNotAPose;
    if (!state.has_good_pose) {
        accept(state, frame, false);
    } else if (follows(model.limits, state.X_BD_good, X_BD, state.periods_since_good)) {
        accept(state, frame, state.periods_since_good <= 2);
    } else if (agreesWithOthers(model, state, X_BD)) {
        accept(state, frame, true);
        frame.relocated = true;
        frame.status |= kInputRelocated;
    } else {
        return kInputJump;
    }
    return kStatusOk;
}

}  // namespace

Pose registeredPose(const model::Registration& registration, const Pose& X_BD) noexcept {
    const Pose scaled{X_BD.q, registration.scale * X_BD.p};
    return registration.X_WB * (scaled * registration.X_DH);
}

void guardInput(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    state.periods_since_good += frame.reading.periods;
    state.periods_since_other += frame.reading.periods;
    const std::uint32_t fault = takeReading(model, state, frame);
    frame.status |= fault;
    if (fault != kStatusOk) {
        // One tick of a wrong pose is bearable, two are not: a pose that nobody confirmed is not held when it is
        // denied.
        const bool denied = fault == kInputJump && !state.good_confirmed;
        frame.input_usable = state.has_good_pose && state.periods_since_good == 1 && !denied;
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
