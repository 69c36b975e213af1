#include "devices/simulated/hand_params.h"

#include <fmt/format.h>

#include <cmath>

namespace passung::simulated {

std::vector<Error> HandParams::validate() const {
    std::vector<Error> errors;
    const auto require = [&](bool ok, const char* key, double value, const char* requirement) {
        if (!ok) errors.push_back({.message = requirement, .key = key, .value = fmt::format("{}", value)});
    };
    const auto positive = [&](const char* key, double value) {
        require(std::isfinite(value) && value > 0, key, value, "must be finite and above 0");
    };
    const auto notNegative = [&](const char* key, double value) {
        require(std::isfinite(value) && value >= 0, key, value, "must be finite and at least 0");
    };
    const auto delay = [&](const char* key, double value) {
        require(value >= 0 && value <= kMaxSenseDelay, key, value, "must be 0 to 0.5 s");
    };
    notNegative("mass", mass);
    notNegative("inertia", inertia);
    positive("stiffness", stiffness);
    notNegative("damping", damping);
    positive("rotational_stiffness", rotational_stiffness);
    notNegative("rotational_damping", rotational_damping);
    notNegative("tremor", tremor);
    delay("visual_delay", visual_delay);
    delay("haptic_delay", haptic_delay);
    notNegative("lateral_error", lateral_error);
    notNegative("depth_error", depth_error);
    notNegative("tilt_error", tilt_error);
    positive("pace", pace);
    positive("approach_duration", approach_duration);
    positive("approach_height", approach_height);
    positive("descend_speed", descend_speed);
    notNegative("judgement", judgement);
    positive("press_force", press_force);
    positive("search_speed", search_speed);
    positive("search_pitch", search_pitch);
    positive("first_search_radius", first_search_radius);
    positive("last_search_radius", last_search_radius);
    require(last_search_radius >= first_search_radius, "last_search_radius", last_search_radius,
            "must be at least first_search_radius");
    notNegative("search_tilt", search_tilt);
    positive("insert_speed", insert_speed);
    positive("insert_force", insert_force);
    require(lapse_rate >= 0 && lapse_rate <= 1, "lapse_rate", lapse_rate, "must be 0 to 1");
    notNegative("lapse_duration", lapse_duration);
    notNegative("feeling_error", feeling_error);
    for (const CueSense& cue : {visual_cue, vibration_cue, sound_cue}) {
        positive("cue_threshold", cue.threshold);
        delay("cue_delay", cue.delay);
        notNegative("cue_noise", cue.noise);
    }
    require(insert_force >= press_force, "insert_force", insert_force, "must be at least press_force");
    return errors;
}

}  // namespace passung::simulated
