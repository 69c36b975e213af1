#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/json.h"
#include "study/session/session.h"

// What Session does between two trials: questionnaires, rests, changes of the device.

namespace passung::session {

/// True while a questionnaire is open, or after it failed.
bool Session::asksQuestionnaire() {
    if (setup_.plan->questionnaires.empty()) return false;
    const auto open = questionnaires_.ask(agenda_.remaining(), session_ns_);
    if (!open) fail("questionnaire", open.errors());
    return !open || *open;
}

/// A piece of the rest before the next trial's block; false if there is nothing to rest any more.
bool Session::rest() {
    if (rested_for_ != agenda_.next()) {
        rested_for_ = agenda_.next();
        const auto block = static_cast<std::size_t>(trial().block_index);
        const bool first = trial().trial_in_block == 0 && block < setup_.plan->blocks.size();
        const std::int64_t length = first ? std::llround(setup_.plan->blocks[block].rest / kTickSeconds) : 0;
        between().rest.reset();
        if (length > 0) between().rest = Rest{length};
        if (between().rest) note("rest_started", "block", trial().block);
    }
    if (!between().rest) return false;
    Rest& rest = *between().rest;
    const std::int64_t step = std::min(rest.left, kTicksPerRest);
    if (step > 0) apparatus_.wait(step);
    session_ns_ += step * kTickNanoseconds;
    rest.left -= step;
    if (isResting(rest, blockOf(agenda_.next()))) return true;
    between().rest.reset();
    note("rest_ended", "block", trial().block);
    return true;
}

/// Has the rest before the block not lasted long enough, or has who ends it not done so?
bool Session::isResting(Rest& rest, const plan::Block& block) {
    if (rest.left > 0) return true;
    switch (block.rest_ends) {
        case plan::RestEnds::ByTime:
            break;
        case plan::RestEnds::ByParticipant:
            return setup_.reader != nullptr && !setup_.reader->goesOn();
        case plan::RestEnds::ByExperimenter:
            if (!setup_.waits || std::exchange(rest.told, true)) break;
            pauseHere();
            return true;
    }
    return false;
}

/// The device under `key`, with the stable stiffness that the study keeps for it.
JsonObject Session::stableStiffnessOf(const char* key, const std::string& device) const {
    JsonObject payload;
    payload.text(key, device);
    for (const plan::StableStiffness& stable : setup_.plan->stable_stiffness)
        if (stable.device == device)
            payload.number("stable_stiffness_N_per_m", stable.linear)
                .number("stable_rotational_stiffness_Nm_per_rad", stable.rotational)
                .text("origin", stable.origin);
    return payload;
}

/// Notes that another device comes into use, and what is known of its stability; true if that is waited for.
bool Session::swapsDevice() {
    const std::string& device = conditionOf(nextStep()).device;
    const bool first = device_in_use_.empty(), other = !first && device_in_use_ != device;
    device_in_use_ = device;
    if (other) {
        note("swap_device", stableStiffnessOf("to", device).str());
        between().swaps = true;
        if (setup_.waits) {
            pauseHere();
            return true;
        }
    }
    const bool swapped = std::exchange(between().swaps, false);
    if (swapped) note("device_swapped", JsonObject().text("to", device).str());
    if ((first || swapped) && setup_.calibrated_utc)
        note("device_calibration",
             stableStiffnessOf("device", device).text("calibrated_utc", setup_.calibrated_utc(device)).str());
    return false;
}

}  // namespace passung::session
