#include "study/session/recompute.h"

#include <fmt/format.h>

#include "study/protocol/scene_parts.h"
#include "study/session/trial_course.h"

namespace passung::session {

using measures::Outcome;

Result<Pose> targetPose(const protocol::Condition& condition) {
    if (const auto* part = protocol::partNamed(condition.scene, condition.task.target)) return part->X_WP;
    Error error;
    error.message = fmt::format("condition {} has no part of this name", condition.name);
    error.key = "target";
    error.value = condition.task.target;
    return error;
}

Result<Judgement> judgeAgain(const protocol::Condition& condition, std::span<const TickRecord> records, Outcome outcome,
                             std::int64_t end_time) {
    const auto X_WT = targetPose(condition);
    if (!X_WT) return X_WT.errors();
    TrialCourse course(condition.task, *X_WT);
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
