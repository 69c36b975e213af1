#include "study/session/participant_order.h"

#include "study/design/allocation.h"

namespace passung::session {

Result<std::vector<design::PlannedTrial>> planTrials(const protocol::StudyPlan& plan, const DesignPlace& place,
                                                     std::string_view participant, int session) {
    return design::planSession(protocol::designOf(plan),
                               {plan.name, plan.seed, participant, place.slot, place.group, session});
}

std::vector<DesignPlace> firstPlaces(const protocol::StudyPlan& plan, std::size_t count,
                                     protocol::ParticipantKind kind) {
    const auto design = protocol::designOf(plan);
    const design::Allocation allocation{design::groupsOf(design).size(), design::sequencesOf(design),
                                        static_cast<std::size_t>(plan.allocation_blocks), plan.name, plan.seed};
    std::vector<DesignPlace> places;
    for (const design::Place& place : design::firstPlaces(allocation, protocol::participantKindName(kind), count))
        places.push_back({place.replicate * allocation.sequences + place.sequence, place.group});
    return places;
}

}  // namespace passung::session
