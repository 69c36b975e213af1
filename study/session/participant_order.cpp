#include "study/session/participant_order.h"

#include <algorithm>
#include <utility>

#include "study/design/allocation.h"

namespace passung::session {
namespace {

/// The code that the program gives the i-th person, from 0.
std::string codeOf(std::size_t i, std::size_t stations) {
    const auto number = static_cast<std::int64_t>(i / stations) + 1;
    auto code = plan::participantCode(plan::ParticipantKind::Real, number);
    if (stations > 1) code.insert(1, 1, static_cast<char>('A' + i % stations));
    return code;
}

}  // namespace

Result<std::vector<design::PlannedTrial>> planTrials(const plan::StudyPlan& plan, const DesignPlace& place,
                                                     std::string_view participant, int session) {
    return design::planSession(plan::designOf(plan), {plan.name, plan.seed, plan::rehearsedCode(participant),
                                                      place.slot, place.group, session});
}

std::vector<DesignPlace> firstPlaces(const plan::StudyPlan& plan, std::size_t count, std::size_t stations) {
    const auto design = plan::designOf(plan);
    const design::Allocation allocation{design::groupsOf(design).size(), design::sequencesOf(design),
                                        static_cast<std::size_t>(plan.allocation_blocks), plan.name, plan.seed};
    std::vector<DesignPlace> places(count);
    for (std::size_t station = 0; station < stations; ++station) {
        const design::Share share{station, stations};
        const auto own = design::firstPlaces(allocation, plan::kAllocationStratum, count / stations + 1, share,
                                             design::firstRow(design::rowsOf(design), share));
        for (std::size_t i = 0; i * stations + station < count; ++i)
            places[i * stations + station] = {own[i].replicate * allocation.sequences + own[i].sequence, own[i].group};
    }
    return places;
}

Result<std::vector<PlannedSession>> plannedSessions(const plan::StudyPlan& plan, int participants, int stations) {
    const auto at = static_cast<std::size_t>(stations);
    const auto places = firstPlaces(plan, static_cast<std::size_t>(std::max(participants, 0)), at);
    std::vector<PlannedSession> sessions;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto code = codeOf(i, at);
        for (int session = 1; session <= plan::sessionsOf(plan); ++session) {
            auto trials = planTrials(plan, places[i], code, session);
            if (!trials) return trials.errors();
            sessions.push_back({code, places[i], session, std::move(*trials)});
        }
    }
    return sessions;
}

}  // namespace passung::session
