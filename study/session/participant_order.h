#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "study/design/trial_order.h"
#include "study/protocol/study_plan.h"

namespace passung::session {

/// The trials of one participant in order: design::planSession for a protocol. `slot` is the participant's running
/// number in the study, from 0; it decides the row of the Williams square.
std::vector<design::PlannedTrial> planTrials(const protocol::StudyPlan& plan, std::size_t slot,
                                             std::string_view participant);

}  // namespace passung::session
