#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "study/person/perception.h"
#include "study/protocol/study_plan.h"

namespace passung::app {

/// What a simulated participant notices of the levels that staircases present (person::Perception).
class SimulatedPerception {
public:
    /// The plan outlives this.
    SimulatedPerception(const protocol::StudyPlan& plan, std::string participant);

    /// The person of this staircase, on its axis.
    person::Perception of(std::size_t staircase) const;

    /// Is the answer positive where chance alone is with the probability `guess`? Nothing for a condition without a
    /// stimulus. The same for every attempt at the trial: whoever does a trial again has not become another.
    std::optional<bool> notices(const protocol::Condition& condition, std::int64_t trial_index, double guess) const;

private:
    const protocol::StudyPlan& plan_;
    std::string participant_;
};

}  // namespace passung::app
