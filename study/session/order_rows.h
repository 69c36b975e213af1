#pragma once

#include <vector>

#include "study/design/trial_order.h"
#include "study/plan/study_plan.h"

namespace passung::session {

struct OrderedTrial {
    std::size_t condition = 0;
    bool catch_trial = false;
    friend bool operator==(const OrderedTrial&, const OrderedTrial&) = default;
};

/// A pass through a block's conditions, and how often the same pass comes in a row.
struct OrderedPass {
    std::vector<OrderedTrial> trials;
    int times = 1;
};

struct OrderedBlock {
    std::size_t block = 0;  // in the plan
    std::vector<OrderedPass> passes;
};

/// The trials of one participant's session as an experimenter reads them.
std::vector<OrderedBlock> orderOf(const plan::StudyPlan& plan, const std::vector<design::PlannedTrial>& trials);

}  // namespace passung::session
