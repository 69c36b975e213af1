#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "study/design/trial_order.h"
#include "study/plan/participant.h"
#include "study/plan/study_plan.h"

namespace passung::session {

/// Slot of a participant in the design.
struct DesignPlace {
    std::size_t slot = 0;   // running number in the group, from 0: decides the rows of the squares
    std::size_t group = 0;  // index into plan::groupNames()
};

/// The trials of one participant's session, from 1, in order: design::planSession for a protocol.
Result<std::vector<design::PlannedTrial>> planTrials(const plan::StudyPlan& plan, const DesignPlace& place,
                                                     std::string_view participant, int session = 1);

/// The places of the first `count` participants of any kind, as the store allots them; with several `stations` each
/// takes the next one in turn.
std::vector<DesignPlace> firstPlaces(const plan::StudyPlan& plan, std::size_t count, std::size_t stations = 1);

/// A session as it is planned for one of the participants to come.
struct PlannedSession {
    std::string participant;  // code
    DesignPlace place;
    int session = 1;
    std::vector<design::PlannedTrial> trials;
};

/// All sessions of the people who take part first.
Result<std::vector<PlannedSession>> plannedSessions(const plan::StudyPlan& plan, int participants, int stations);

}  // namespace passung::session
