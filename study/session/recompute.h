#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/base/tick_record.h"
#include "study/measures/measures.h"
#include "study/plan/study_plan.h"

namespace passung::session {

/// What a session makes of an attempt's ticks.
struct Judgement {
    measures::Outcome outcome = measures::Outcome::Aborted;
    std::vector<measures::Value> measures;
    std::vector<measures::Detection> detections;
};

/// What is stored of an attempt and in none of its records: what came from outside, and its seed.
struct StoredEnd {
    measures::Outcome outcome = measures::Outcome::Aborted;
    std::int64_t end_time = 0;                    // [periods after tick 0]
    std::optional<std::int64_t> start_time = {};  // likewise; of a trial that the experimenter timed
    std::uint64_t seed = 0;                       // of the attempt
    std::vector<measures::TickOverlap> overlaps = {};
};

/// Judges recorded ticks once more, as the session did while they came. `hands`: those of each hand of the condition's
/// scene.
Result<Judgement> judgeAgain(const plan::Condition& condition, std::span<const std::vector<TickRecord>> hands,
                             const StoredEnd& stored);

}  // namespace passung::session
