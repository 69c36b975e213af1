#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/truth/accuracy_ticks.h"
#include "core/scene/build_store.h"
#include "study/plan/study_plan.h"
#include "study/run/machine/hand_path.h"

namespace passung::run {

/// What accuracy costs the tick of a condition, over methods, geometries and settings of fields.
struct TickFront {
    scene::ContactSpec own;  // of the condition: what a setting does not say is as there
    HandPath::Origin path = HandPath::Origin::SimulatedHand;
    std::size_t ticks = 0;
    truth::TickAccuracy measured;
    std::vector<std::string> left_out;  // what the parts cannot have, and why
};

/// Whoever waited did not want to any more.
struct MeasuringCancelled : std::runtime_error {
    MeasuringCancelled() : std::runtime_error("measuring was cancelled") {}
};

/// How far measuring is.
struct FrontProgress {
    const truth::TickSetting* setting = nullptr;  // that is measured; null: none yet, the hand's path is made
    double cell = 0.0;                            // of it, see cellOf() [m]
    double share = 0.0;                           // of the work that is done
};
using FrontWatch = std::function<bool(const FrontProgress&)>;  // false: it is to be given up

/// Measures along handPath(). Throws MeasuringCancelled soon after the watch wants it, at the latest when the part that
/// is being built is there. Errors: those of handPath(), and of parts that cannot be built.
Result<TickFront> measureFront(const plan::Condition& condition, const truth::TickEffort& effort,
                               const FrontWatch& watch, scene::BuildStore* builds);

/// The edge of a field's cell that goes with a setting [m]; 0: chosen from the tolerance.
double cellOf(const TickFront& front, const truth::TickSetting& setting);

/// Tells whether the scene's contact is computed by the setting; lengths may differ by 1e-12 of them, which units cost.
bool isRenderedBy(const scene::SceneSpec& scene, const TickFront& front, const truth::TickSetting& setting);

}  // namespace passung::run
