#include "study/session/trial_course.h"

#include <cmath>
#include <utility>

#include "core/base/assert.h"
#include "study/measures/tick_facts.h"

namespace passung::session {

namespace {

const char* eventName(TrialState state) {
    switch (state) {
        case TrialState::Succeeded:
            return "success";
        case TrialState::Failed:
            return "failure";
        case TrialState::TimedOut:
            return "timeout";
        default:
            return "aborted";
    }
}

}  // namespace

using plan::TimedBy;

TrialCourse::TrialCourse(const plan::Condition& condition, const Pose& X_WT, std::uint64_t attempt_seed)
    : X_WT_(X_WT),
      leave_radius_(condition.task.leave_radius),
      motion_bandwidth_(condition.task.motion_bandwidth),
      rule_(condition.task, condition.scene, X_WT, attempt_seed),
      timeout_(std::llround(condition.task.timeout / kTickSeconds)),
      timed_by_(condition.timed_by) {}

bool TrialCourse::awaitsExperimenter() const {
    return timed_by_ == TimedBy::Experimenter && state_ == TrialState::AwaitingStart && !begin_asked_;
}

bool TrialCourse::endsByExperimenter() const {
    return timed_by_ == TimedBy::Experimenter && (state_ == TrialState::Running || begin_asked_) && !ended() &&
           !conclusion_;
}

void TrialCourse::follow(const TickRecord& record, std::span<const TickRecord* const> hands,
                         std::vector<TrialEvent>& events) {
    PASSUNG_ASSERT(!ended());
    clock_.at(record);
    if (record.status & kNonFiniteLatched) return abort(record.tick, "a computed wrench was not finite", events);
    if (state_ == TrialState::AwaitingStart) awaitStart(record, events);
    if (state_ == TrialState::AwaitingStart) rule_.await(hands, clock_.periods());
    if (state_ != TrialState::Running) return;

    const bool over = clock_.periods() - *start_time_ >= timeout_;
    if (timed_by_ == TimedBy::Program) return watch(record, hands, over, events);
    std::optional<TrialState> verdict;
    if (timed_by_ == TimedBy::Experimenter && *start_tick_ < record.tick) verdict = conclusion_;
    if (!verdict && over) verdict = timed_by_ == TimedBy::Clock ? TrialState::Succeeded : TrialState::TimedOut;
    if (verdict) end(*verdict, record.tick, eventName(*verdict), events);
}

void TrialCourse::watch(const TickRecord& record, std::span<const TickRecord* const> hands, bool over,
                        std::vector<TrialEvent>& events) {
    if (!touched_ && measures::isContact(record)) {
        touched_ = true;
        events.push_back({clock_.periods(), "first_contact"});
    }
    if (record.status & kInputRejected) ++rejected_ticks_;
    if (const auto verdict = rule_.follow(record, hands, clock_.periods(), events)) {
        if (*verdict == TrialState::Aborted) return abort(record.tick, "start pose not reached", events);
        return end(*verdict, record.tick, eventName(*verdict), events);
    }
    if (!rule_.timesItself() && over) end(TrialState::TimedOut, record.tick, eventName(TrialState::TimedOut), events);
}

void TrialCourse::abort(std::int64_t tick, std::string reason, std::vector<TrialEvent>& events) {
    PASSUNG_ASSERT(!ended());
    abort_reason_ = std::move(reason);
    end(TrialState::Aborted, tick, eventName(TrialState::Aborted), events);
}

measures::TrialContext TrialCourse::context() const {
    PASSUNG_ASSERT(ended());
    using measures::Outcome;
    measures::TrialContext context;
    context.start_tick = start_tick_.value_or(end_tick_ + 1);
    context.end_tick = end_tick_;
    context.outcome = state_ == TrialState::Succeeded  ? Outcome::Success
                      : state_ == TrialState::Failed   ? Outcome::Failure
                      : state_ == TrialState::TimedOut ? Outcome::Timeout
                                                       : Outcome::Aborted;
    context.X_WT = X_WT_;
    context.leave_radius = leave_radius_;
    context.motion_bandwidth = motion_bandwidth_;
    context.watched = timed_by_ == TimedBy::Program;
    rule_.describe(context);
    return context;
}

void TrialCourse::awaitStart(const TickRecord& record, std::vector<TrialEvent>& events) {
    if (timed_by_ != TimedBy::Program) {
        if (begin_asked_ || timed_by_ == TimedBy::Clock) start(record, events);
    } else if (record.status & kEngaged) {
        start(record, events);
    } else if (clock_.periods() >= kStartLimit) {
        abort(record.tick, "start pose not reached", events);
    }
}

void TrialCourse::start(const TickRecord& record, std::vector<TrialEvent>& events) {
    state_ = TrialState::Running;
    start_tick_ = record.tick;
    start_time_ = clock_.periods();
    missed_at_start_ = clock_.missed();
    events.push_back({clock_.periods(), "trial_started"});
}

void TrialCourse::end(TrialState state, std::int64_t tick, const char* event, std::vector<TrialEvent>& events) {
    state_ = state;
    end_tick_ = tick;
    end_time_ = clock_.until(tick);
    events.push_back({end_time_, event});
}

}  // namespace passung::session
