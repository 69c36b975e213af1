#include "study/session/trial_course.h"

#include <cmath>
#include <utility>

#include "core/base/assert.h"
#include "study/measures/tick_facts.h"

namespace passung::session {

TrialCourse::TrialCourse(const protocol::PegInHoleTask& task, const Pose& X_WT)
    : task_(task), X_WT_(X_WT), success_rule_(task, X_WT), timeout_(std::llround(task.timeout / kTickSeconds)) {}

void TrialCourse::follow(const TickRecord& record, std::vector<TrialEvent>& events) {
    PASSUNG_ASSERT(!ended());
    clock_.at(record);
    if (record.status & kNonFiniteLatched) return abort(record.tick, "a computed wrench was not finite", events);
    if (state_ == TrialState::AwaitingStart) awaitStart(record, events);
    if (state_ != TrialState::Running) return;

    noteMilestones(record, events);
    if (record.status & kInputRejected) ++rejected_ticks_;
    if (success_rule_.fulfilledAt(record)) return end(TrialState::Succeeded, record.tick, "success", events);
    if (clock_.periods() - *start_time_ >= timeout_) end(TrialState::TimedOut, record.tick, "timeout", events);
}

void TrialCourse::abort(std::int64_t tick, std::string reason, std::vector<TrialEvent>& events) {
    PASSUNG_ASSERT(!ended());
    abort_reason_ = std::move(reason);
    end(TrialState::Aborted, tick, "aborted", events);
}

measures::TrialContext TrialCourse::context() const {
    PASSUNG_ASSERT(ended());
    using measures::Outcome;
    measures::TrialContext context;
    context.start_tick = start_tick_.value_or(end_tick_ + 1);
    context.end_tick = end_tick_;
    context.outcome = state_ == TrialState::Succeeded  ? Outcome::Success
                      : state_ == TrialState::TimedOut ? Outcome::Timeout
                                                       : Outcome::Aborted;
    context.X_WT = X_WT_;
    context.leave_radius = task_.leave_radius;
    context.engagement_depth = task_.engagement_depth;
    context.clearance = task_.clearance;
    return context;
}

void TrialCourse::awaitStart(const TickRecord& record, std::vector<TrialEvent>& events) {
    if (record.status & kEngaged) {
        state_ = TrialState::Running;
        start_tick_ = record.tick;
        start_time_ = clock_.periods();
        missed_at_start_ = clock_.missed();
        events.push_back({clock_.periods(), "trial_started"});
    } else if (clock_.periods() >= kStartLimit) {
        abort(record.tick, "start pose not reached", events);
    }
}

void TrialCourse::noteMilestones(const TickRecord& record, std::vector<TrialEvent>& events) {
    if (!touched_ && measures::isContact(record)) {
        touched_ = true;
        events.push_back({clock_.periods(), "first_contact"});
    }
    if (!engaged_ && measures::tipDepthInBore(record, X_WT_.inverse(), task_.clearance) >= task_.engagement_depth) {
        engaged_ = true;
        events.push_back({clock_.periods(), "engaged"});
    }
}

void TrialCourse::end(TrialState state, std::int64_t tick, const char* event, std::vector<TrialEvent>& events) {
    state_ = state;
    end_tick_ = tick;
    end_time_ = clock_.until(tick);
    events.push_back({end_time_, event});
}

}  // namespace passung::session
