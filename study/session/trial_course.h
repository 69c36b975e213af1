#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/measures/measures.h"
#include "study/measures/period_clock.h"
#include "study/session/trial_rule.h"

namespace passung::session {

/// One attempt, decided record by record: AwaitingStart → Running → Succeeded | Failed | TimedOut, and from the first
/// two → Aborted. The trial starts at the first tick with kEngaged. Its type's rule wins over a time-out in the same
/// tick. Time counts missed cycles as well as ticks. Aborted by itself if the start pose is not reached within
/// kStartLimit, or if a wrench was not finite (the
/// output is then zero, so whatever followed would not be the condition's contact).
/// A trial that the experimenter times starts, and succeeds or fails, at the next tick after they say so; however long
/// it waits for the start, and whatever the held part does. One that the clock times starts at its first tick and
/// succeeds with its time-out.
class TrialCourse {
public:
    static constexpr std::int64_t kStartLimit = 60'000;  // [periods]

    /// Of a trial in `condition`. `X_WT`, `attempt_seed`: as for TrialRule.
    TrialCourse(const plan::Condition& condition, const Pose& X_WT, std::uint64_t attempt_seed);

    /// The experimenter starts the clock. @pre awaitsExperimenter()
    void begin() { begin_asked_ = true; }
    /// The experimenter stops it. @pre endsByExperimenter()
    void conclude(bool success) { conclusion_ = success ? TrialState::Succeeded : TrialState::Failed; }
    bool awaitsExperimenter() const;
    bool endsByExperimenter() const;

    /// Takes the next record and appends what happened in it. `hands`: as for TrialRule. @pre not ended()
    void follow(const TickRecord& record, std::span<const TickRecord* const> hands, std::vector<TrialEvent>& events);
    /// The same of a scene with one hand.
    void follow(const TickRecord& record, std::vector<TrialEvent>& events) {
        const TickRecord* const alone = &record;
        follow(record, std::span(&alone, 1), events);
    }

    /// Ends the attempt from outside, at `tick`. @pre not ended()
    void abort(std::int64_t tick, std::string reason, std::vector<TrialEvent>& events);

    TrialState state() const { return state_; }
    bool ended() const { return state_ > TrialState::Running; }
    bool started() const { return start_tick_.has_value(); }

    /// @pre ended(); an empty trial (end before start) if it never started.
    measures::TrialContext context() const;
    const std::string& abortReason() const { return abort_reason_; }

    /// Time at which the trial started [periods since the attempt's tick 0]; none: it did not.
    std::optional<std::int64_t> startTime() const { return start_time_; }

    /// Time at which the attempt ended [periods since its tick 0]. @pre ended()
    std::int64_t endTime() const { return end_time_; }

    /// Number of periods between the trial's start and its end that had no tick.
    std::int64_t missedCycles() const { return clock_.missed() - missed_at_start_; }
    /// Length of the trial [periods]; 0 if it never started. @pre ended()
    std::int64_t length() const { return start_time_ ? end_time_ - *start_time_ : 0; }

    /// Ticks of the running trial without usable device input, hence without a wrench.
    std::int64_t rejectedTicks() const { return rejected_ticks_; }

private:
    void awaitStart(const TickRecord& record, std::vector<TrialEvent>& events);
    void start(const TickRecord& record, std::vector<TrialEvent>& events);
    void watch(const TickRecord& record, std::span<const TickRecord* const> hands, bool over,
               std::vector<TrialEvent>& events);
    void end(TrialState state, std::int64_t tick, const char* event, std::vector<TrialEvent>& events);

    Pose X_WT_;
    double leave_radius_;
    double motion_bandwidth_;
    TrialRule rule_;
    std::int64_t timeout_;  // [periods]
    plan::TimedBy timed_by_;
    bool begin_asked_ = false;
    std::optional<TrialState> conclusion_;
    measures::PeriodClock clock_;
    TrialState state_ = TrialState::AwaitingStart;
    std::optional<std::int64_t> start_tick_;
    std::optional<std::int64_t> start_time_;  // [periods]
    std::int64_t missed_at_start_ = 0;
    std::int64_t end_tick_ = 0;
    std::int64_t end_time_ = 0;
    std::string abort_reason_;
    std::int64_t rejected_ticks_ = 0;
    bool touched_ = false;
};

}  // namespace passung::session
