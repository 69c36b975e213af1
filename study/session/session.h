#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/design/trial_order.h"
#include "study/protocol/study_plan.h"
#include "study/session/apparatus.h"
#include "study/session/questionnaire_desk.h"
#include "study/session/trial_course.h"
#include "study/session/trial_sink.h"

namespace passung::session {

struct SessionSetup {
    const protocol::StudyPlan& plan;           // outlives the session
    std::vector<design::PlannedTrial> trials;  // what is to be done, in this order
    std::string participant;                   // code
    std::uint64_t seed = 0;                    // of the study
    bool timing_measured = true;               // false in virtual time
    int ordinal = 1;                           // number of the participant's session
    QuestionnaireSource* answers = nullptr;    // who answers; may stay null if the plan has no questionnaire
};

/// A trial that is over and durable.
struct TrialProgress {
    const design::PlannedTrial& trial;
    const protocol::Condition& condition;
    measures::Outcome outcome;
    bool valid;
    const std::string& invalid_reason;
    std::optional<double> trial_time_s;
    std::size_t finished;  // trials of this session so far
    std::size_t planned;
    std::int64_t session_ns;  // session time after the trial
};

/// Whom the session tells; either may be empty.
struct SessionListener {
    /// An attempt is durable: whoever hears this may rely on finding it after a crash.
    std::function<void(AttemptId, measures::Outcome)> acknowledge;
    std::function<void(const TrialProgress&)> progress;
};

/// BetweenTrials → InTrial → BetweenTrials … → Complete, and from the first two → Failed or Interrupted.
enum class SessionState { BetweenTrials, InTrial, Complete, Failed, Interrupted };

/// Runs the planned trials one after another: prepares the apparatus, records every tick into the sink, lets
/// TrialCourse decide, computes the measures and finishes the attempt durably. It has no clock: session time is the
/// haptic periods that the apparatus' records tell of, ticks and missed cycles, laid end to end over the attempts. The
/// first error of apparatus or sink ends the session as incomplete; attempts finished before it stay as they are.
class Session {
public:
    static constexpr std::int64_t kTicksPerLook = 20;
    static constexpr std::int64_t kTicksPerRest = 100;  // of a rest at a time
    static constexpr int kSilentLooks = 50;             // looks without any record after which the loop counts as dead

    Session(SessionSetup setup, Apparatus& apparatus, TrialSink& sink, SessionListener listener);
    ~Session();  // stops the apparatus if a trial is running
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// One bounded piece of work: look whether a due questionnaire is filled, rest for kTicksPerRest before a block
    /// that asks for it (events rest_started, rest_ended), begin the next trial (event swap_device if it is on another
    /// device than the one before), watch the running one for kTicksPerLook, or close the session. Whatever is to be
    /// done to a session from outside is done between two calls.
    SessionState advance();

    /// Ends the session from outside, between two calls of advance(): a running trial is stored as aborted for
    /// `reason`, the session as not complete. A session without a trial left is complete all the
    /// same; nothing happens to one that is over.
    void interrupt(const std::string& reason);

    /// Advances until the session is Complete or Failed.
    Result<Done> run();

    SessionState state() const { return state_; }

    /// Why the session failed; empty unless state() is Failed.
    const Errors& errors() const { return errors_; }

private:
    struct Attempt {
        AttemptId id;
        const protocol::Condition& condition;
        TrialCourse course;
        std::vector<TickRecord> records;  // of the running trial, for its measures
        measures::PeriodClock clock;
        std::int64_t next_tick = 0;
        std::int64_t missing_ticks = 0;
        int silent_looks = 0;
    };

    const design::PlannedTrial& trial() const { return setup_.trials[finished_]; }
    bool rest();
    void beginTrial();
    void watchTrial();
    bool asksQuestionnaire();
    std::size_t takeRecords();
    void judge(std::span<const TickRecord> records);
    void finishTrial();
    AttemptEnd describeEnd(LoopHealth health) const;
    void appendEvents(const std::vector<TrialEvent>& events);
    void finish(SessionState state);
    void note(const char* name, const char* key, const std::string& text);  // an event with one text
    void fail(const char* stage, const Errors& errors);

    SessionSetup setup_;
    Apparatus& apparatus_;
    TrialSink& sink_;
    SessionListener listener_;
    QuestionnaireDesk desk_;
    SessionState state_ = SessionState::BetweenTrials;
    std::optional<Attempt> attempt_;
    std::size_t finished_ = 0;
    std::optional<std::size_t> rested_for_;  // number of finished trials when a rest was last looked for
    std::int64_t rest_left_ = 0;             // [periods] of the running rest
    std::string device_in_use_;              // of the last trial
    std::int64_t session_ns_ = 0;            // at tick 0 of the running or next attempt
    Errors errors_;
};

/// Seed of everything random in the simulated device and hand during one attempt: the study's stream "simulated" of
/// this participant, session, trial and attempt. Independent of how many trials ran before, so a resumed session draws
/// the same.
std::uint64_t attemptSeed(const SessionSetup& setup, const design::PlannedTrial& trial, int attempt_no);

}  // namespace passung::session
