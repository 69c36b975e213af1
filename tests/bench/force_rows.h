#pragma once

#include <string>

#include "core/base/tick_record.h"
#include "study/plan/study_plan.h"
#include "tests/bench/contact_rows.h"

namespace passung::bench {

inline constexpr const char* kForceGroup = "forces, peg in hole";
inline constexpr const char* kQpMethod = "god_object, one warm QP of at most 200 contacts";
inline constexpr const char* kForceMethod = "god_object, tick without field samples";
inline constexpr const char* kTickMethod = "god_object, whole tick";
inline constexpr const char* kOverlapMethod = "god_object, deepest overlap over the penalty's";

/// What the god object costs and leaves of overlap in the scenes of the study `protocol`, a peg_in_hole: its simulated
/// participant inserts the peg in each pair of clearance and stiffness, with the god object and with the penalty; the
/// recorded device paths are replayed. Times are of the thread, of each tick the fastest of the repetitions:
///   QP: the motion of each tick in contact under the 200 nearest of the contacts within half a cell of the proxy,
///   begun with what holds the motion that the tick before wanted;
///   without field samples: the whole tick less its queries;
///   whole: with the query at the hand that the record asks for.
/// Overlap, of both methods on the same device path and at the same stiffness: the deepest of the part that is shown
/// and the plate, at and between all ticks, by dense geometry that neither method uses (tests/hard/figures.h); with the
/// fields and points that the study asks for, and with finer ones.
/// Errors: the study cannot be read, a scene cannot be built.
Result<std::vector<Row>> forceRows(const std::string& protocol, const Extent& extent);

/// The device's readings while the study's simulated participant does a trial of so many ticks.
/// Errors: the device is not known, the scene cannot be built.
Result<std::vector<TickRecord>> recordTrial(const plan::StudyPlan& plan, const plan::Condition& condition,
                                            std::int64_t ticks);

}  // namespace passung::bench
