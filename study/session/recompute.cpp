#include "study/session/recompute.h"

#include "study/session/rendered_scenes.h"
#include "study/session/trial_course.h"

namespace passung::session {

using measures::Outcome;

Result<Judgement> judgeAgain(const protocol::Condition& condition, std::span<const TickRecord> records, Outcome outcome,
                             std::int64_t end_time, std::uint64_t attempt_seed) {
    const auto X_WT = targetPose(condition);
    if (!X_WT) return X_WT.errors();
    TrialCourse course(condition.task, *X_WT, attempt_seed);
    measures::PeriodClock clock;
    std::vector<TrialEvent> events;
    std::vector<TickRecord> of_trial;
    for (const TickRecord& record : records) {
        TrialCourse next = course;
        next.follow(record, events);
        // Whoever aborts an attempt does it before the tick that would have followed.
        const bool from_outside =
            clock.at(record) >= end_time && outcome == Outcome::Aborted && next.state() != TrialState::Aborted;
        if (from_outside) break;
        course = std::move(next);
        if (course.started()) of_trial.push_back(record);
        if (course.ended()) break;
    }
    if (!course.ended()) {
        const std::int64_t seen = records.empty() ? 0 : records.back().tick + 1;
        course.abort(of_trial.empty() ? seen : of_trial.back().tick + 1, "", events);
    }
    const measures::TrialContext context = course.context();
    return Judgement{context.outcome, measures::computeMeasures(of_trial, context)};
}

}  // namespace passung::session
