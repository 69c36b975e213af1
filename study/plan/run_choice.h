#pragma once

#include <cstdint>
#include <optional>

#include "study/plan/study_plan.h"

namespace passung::plan {

/// What a run decides beside the protocol's text. A draft stays as its text says; run::freeze() takes both.
struct RunChoice {
    std::optional<std::uint64_t> seed = {};  // in place of the draft's
    bool trials_only = false;                // a try-out: no consent, instructions or questionnaires

    std::uint64_t seedOf(const StudyPlan& draft) const { return seed.value_or(draft.seed); }
};

}  // namespace passung::plan
