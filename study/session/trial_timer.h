#pragma once

#include <cstdint>
#include <optional>

#include "study/plan/study_plan.h"
#include "study/session/command.h"

namespace passung::session {

/// Source of begin and end of the trials that the experimenter would time (plan::TimedBy::Experimenter), where nobody
/// is there to send commands: in virtual time.
class TrialTimer {
public:
    virtual ~TrialTimer() = default;
    /// An attempt at a trial of this condition begins; `seed` and `trials_before` as for Apparatus::prepare().
    virtual void begin(const plan::Condition& condition, std::uint64_t seed, std::int64_t trials_before) = 0;
    /// What to command so many periods after the attempt's tick 0: Start, then Done or Failed; nothing: not yet.
    virtual std::optional<Command> commandAt(std::int64_t periods) = 0;
};

}  // namespace passung::session
