#include "study/session/recompute.h"

#include "study/session/hands_view.h"
#include "study/session/rendered_scenes.h"
#include "study/session/secondary.h"
#include "study/session/trial_course.h"

namespace passung::session {

using measures::Outcome;

namespace {

/// What the experimenter said before this record, at `time`.
void sayAgain(TrialCourse& course, const StoredEnd& stored, std::int64_t time) {
    if (course.awaitsExperimenter() && stored.start_time && time >= *stored.start_time) course.begin();
    const bool said = stored.outcome == Outcome::Success || stored.outcome == Outcome::Failure;
    if (course.endsByExperimenter() && said && time >= stored.end_time)
        course.conclude(stored.outcome == Outcome::Success);
}

}  // namespace

Result<Judgement> judgeAgain(const plan::Condition& condition, std::span<const std::vector<TickRecord>> hands,
                             const StoredEnd& stored) {
    const HandsView view(condition);
    const std::vector<TickRecord>& records = hands.front();
    const auto others = hands.subspan(1);
    const auto X_WT = targetPose(condition);
    if (!X_WT) return X_WT.errors();
    TrialCourse course(condition, *X_WT, stored.seed);
    std::optional<measures::DetectionTask> secondary;
    if (condition.secondary.any()) secondary.emplace(detectionSettings(condition.secondary), stored.seed);
    measures::PeriodClock clock;
    std::vector<TrialEvent> events;
    std::vector<TickRecord> of_trial;
    for (const TickRecord& record : records) {
        const std::int64_t time = clock.at(record);
        if (secondary) secondary->follow(record);
        TrialCourse next = course;
        sayAgain(next, stored, time);
        const TickRecord judged = view.of(record, others);
        next.follow(judged, view.all(record, others), events);
        // Whoever aborts an attempt does it before the tick that would have followed.
        const bool from_outside =
            time >= stored.end_time && stored.outcome == Outcome::Aborted && next.state() != TrialState::Aborted;
        if (from_outside) break;
        course = std::move(next);
        if (course.started()) of_trial.push_back(judged);
        if (course.ended()) break;
    }
    if (!course.ended()) {
        const std::int64_t seen = records.empty() ? 0 : records.back().tick + 1;
        course.abort(of_trial.empty() ? seen : of_trial.back().tick + 1, "", events);
    }
    measures::TrialContext context = course.context();
    context.overlaps = stored.overlaps;
    if (secondary) context.detections = secondary->detections(course.startTime(), course.endTime());
    return Judgement{context.outcome, measures::computeMeasures(of_trial, context, view.recordsOfAll(records, others)),
                     context.detections.value_or(std::vector<measures::Detection>{})};
}

}  // namespace passung::session
