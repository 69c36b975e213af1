#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/base/tick_record.h"
#include "study/measures/measures.h"
#include "study/protocol/study_plan.h"

namespace passung::session {

/// What a session makes of an attempt's ticks.
struct Judgement {
    measures::Outcome outcome = measures::Outcome::Aborted;
    std::vector<measures::Value> measures;
};

/// Judges recorded ticks once more, as the session did while they came. `outcome` and `end_time` [periods after tick 0]
/// are what was stored: they say when somebody aborted the attempt, which is in no record. `attempt_seed`: likewise.
Result<Judgement> judgeAgain(const protocol::Condition& condition, std::span<const TickRecord> records,
                             measures::Outcome outcome, std::int64_t end_time, std::uint64_t attempt_seed);

}  // namespace passung::session
