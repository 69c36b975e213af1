#include "study/session/participant_order.h"

#include "study/design/allocation.h"

namespace passung::session {

Result<std::vector<design::PlannedTrial>> planTrials(const protocol::StudyPlan& plan, const DesignPlace& place,
                                                     std::string_view participant, int session) {
    return design::planSession(protocol::designOf(plan),
                               {plan.name, plan.seed, participant, place.slot, place.group, session});
}

std::vector<DesignPlace> firstPlaces(const protocol::StudyPlan& plan, std::size_t count, protocol::ParticipantKind kind,
                                     std::size_t stations) {
    const auto design = protocol::designOf(plan);
    const design::Allocation allocation{design::groupsOf(design).size(), design::sequencesOf(design),
                                        static_cast<std::size_t>(plan.allocation_blocks), plan.name, plan.seed};
    std::vector<DesignPlace> places(count);
    for (std::size_t station = 0; station < stations; ++station) {
        const design::Share share{station, stations};
        const auto own = design::firstPlaces(allocation, protocol::participantKindName(kind), count / stations + 1,
                                             share, design::firstRow(design::rowsOf(design), share));
        for (std::size_t i = 0; i * stations + station < count; ++i)
            places[i * stations + station] = {own[i].replicate * allocation.sequences + own[i].sequence, own[i].group};
    }
    return places;
}

}  // namespace passung::session
