#include "ui/presenter/study_details.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "study/plan/duration.h"
#include "study/plan/participant.h"

namespace passung::presenter {

Result<StudyDetails> detailsOf(const plan::StudyPlan& plan, int participants) {
    StudyDetails details;
    for (std::size_t i = 0; i < plan::plannedConditions(plan); ++i)
        details.conditions.push_back(plan.conditions[i].name);
    for (const plan::Block& block : plan.blocks)
        details.blocks.push_back(
            {block.name, block.phase, block.order, block.adaptive, block.repetitions, block.session, block.rest});
    const auto groups = plan::groupNames(plan);
    const auto places = session::firstPlaces(plan, static_cast<std::size_t>(std::max(participants, 0)));
    details.minutes.resize(static_cast<std::size_t>(plan::sessionsOf(plan)));
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto code = plan::participantCode(plan::ParticipantKind::Real, static_cast<std::int64_t>(i) + 1);
        for (int session = 1; session <= plan::sessionsOf(plan); ++session) {
            const auto trials = session::planTrials(plan, places[i], code, session);
            if (!trials) return trials.errors();
            details.orders.push_back({code, groups.size() > 1 ? groups[places[i].group] : std::string(), session,
                                      trials->size(), session::orderOf(plan, *trials)});
            double& most = details.minutes[static_cast<std::size_t>(session - 1)];
            most = std::max(most, plan::longestDuration(plan, *trials) / 60.0);
        }
    }
    details.balance = designBalance(plan, places);
    return details;
}

std::vector<AccuracyPoint> accuracyPoints(const std::vector<store::AccuracyRow>& rows,
                                          const std::string& protocol_sha256) {
    std::vector<AccuracyPoint> points;
    for (const store::AccuracyRow& row : rows) {
        if (row.protocol_sha256 != protocol_sha256 || !(row.time_p99_us > 0.0) || !std::isfinite(row.error_p99_um))
            continue;
        points.push_back({row.time_p99_us, row.error_p99_um, row.mode, row.tolerance_um, row.spacing_mm,
                          row.budget_nodes, row.picked_for_us});
    }
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
        return std::pair(a.time_us, a.error_um) < std::pair(b.time_us, b.error_um);
    });
    double best = std::numeric_limits<double>::infinity();
    for (AccuracyPoint& point : points) {
        point.front = point.error_um < best;
        best = std::min(best, point.error_um);
    }
    return points;
}

}  // namespace passung::presenter
