#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/json.h"
#include "core/base/result.h"
#include "study/measures/detection.h"
#include "study/session/apparatus.h"
#include "study/session/command.h"
#include "study/session/hands_view.h"
#include "study/session/instruction_course.h"
#include "study/session/questionnaire_course.h"
#include "study/session/session_event.h"
#include "study/session/session_setup.h"
#include "study/session/session_view.h"
#include "study/session/staircases.h"
#include "study/session/trial_course.h"
#include "study/session/trial_sink.h"

namespace passung::session {

/// Runs the planned trials one after another: prepares the apparatus, records every tick into the sink, lets
/// TrialCourse decide, computes the measures and finishes the attempt durably; between, it does what an experimenter
/// commands. It has no clock: session time is the haptic periods that the apparatus' records tell of, ticks and missed
/// cycles, laid end to end over the attempts. The first error of apparatus or sink ends the session as incomplete;
/// attempts finished before it stay as they are.
class Session {
public:
    static constexpr std::int64_t kTicksPerPoll = 20;
    static constexpr std::int64_t kTicksPerRest = 100;  // of a rest at a time
    // Looks without any record after which the loop counts as dead: three seconds. A virtual machine was seen to stop
    // one processor for one.
    static constexpr int kSilentPolls = 150;

    Session(SessionSetup setup, Apparatus& apparatus, TrialSink& sink, SessionListener listener);
    ~Session();  // stops the apparatus if a trial is running
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// One bounded piece of work: look whether a due questionnaire is filled, rest for kTicksPerRest before a block
    /// that asks for it (events rest_started, rest_ended; a session whose setup waits for commands is Paused where the
    /// experimenter ends the rest), have another device than the last trial's put in place
    /// (events swap_device and device_swapped; between them a session whose setup waits for commands is Paused until
    /// the experimenter says Continue), look whether the instructions before the next trial are read, begin it, watch
    /// the running one for kTicksPerPoll, or close the session; nothing in Ready and Paused but to keep what happens to
    /// devices. Whatever is to be done to a session from outside is done between two calls. A device that is lost ends
    /// the running attempt, which does not count and whose trial is done again, and the session is Paused until
    /// Continue, which arms it anew.
    SessionState advance();

    /// What an experimenter wants, between two calls of advance(). Every command is logged as an event "command_…",
    /// accepted or not; whoever wants motors off at once calls the apparatus' halt() first.
    Reply command(const Command& command);

    /// Whether command() would obey now: the only place that decides it. What it cannot foresee is that the data cannot
    /// be kept.
    Permission permission(const Command& command) const;

    /// The session as it stands; also while the apparatus prepares a trial.
    SessionView view() const;

    /// Keeps in the data how the participant's window draws from now on, between two calls of advance().
    void drawsWith(const QualityFound& found);

    /// Ends the session from outside, between two calls of advance(): a running trial is stored as aborted for
    /// `reason`, the session as not complete. A session without a trial or questionnaire left is complete all the
    /// same; nothing happens to one that is over.
    void interrupt(const std::string& reason);

    /// Advances until the session waits or is over.
    Result<Done> run();

    SessionState state() const { return static_cast<SessionState>(state_.index()); }
    bool isOver() const { return state() >= SessionState::Complete; }

    /// What is done and what is to come.
    const Agenda& agenda() const { return agenda_; }

    /// Tells whether every main trial has an attempt that counts and every track of a staircase has come to its end.
    bool isWhole() const;

    /// Why the session failed; empty unless state() is Failed.
    const Errors& errors() const;

private:
    /// A rest that runs before a block.
    struct Rest {
        std::int64_t left = 0;  // [periods]
        bool told = false;      // the experimenter was asked to end it
    };

    // The session's states in the order of SessionState, each with what is valid in it alone.
    struct Ready {};
    struct BetweenTrials {
        std::optional<Rest> rest = {};
        bool swaps = false;  // device_in_use_ is being put in place
    };
    struct Preparing {};
    struct InTrial {
        AttemptId id;
        const plan::Condition* condition;
        TrialCourse course;
        HandsView view;
        std::vector<TickRecord> records = {};  // of the first hand from the start on; where it picks up from tick 0
        std::vector<std::vector<TickRecord>> others = {};  // of the other hands, since the attempt began
        measures::PeriodClock clock = {};
        std::int64_t next_tick = 0;
        std::int64_t missing_ticks = 0;
        int silent_polls = 0;
        std::optional<StaircaseStep> step = {};
        std::string invalidated = {};  // why the experimenter does not want it to count; empty: nothing against it
        std::optional<measures::DetectionTask> secondary = {};
        bool pauses_after = false;  // the experimenter asked for it
    };
    struct Paused {
        BetweenTrials then = {};  // what Continue goes on with
        bool stopped = false;     // by an emergency stop
    };
    struct Complete {};
    struct Failed {
        Errors errors;
    };
    struct Interrupted {};
    using State = std::variant<Ready, BetweenTrials, Preparing, InTrial, Paused, Complete, Failed, Interrupted>;
    static_assert(std::variant_size_v<State> == static_cast<std::size_t>(SessionState::Interrupted) + 1);

    struct Verdict {
        Then then;
        Decider by;
    };

    const design::PlannedTrial& trial() const { return agenda_.trial(agenda_.next()); }
    template <class S>
    bool is() const {
        return std::holds_alternative<S>(state_);
    }
    InTrial& attempt() { return std::get<InTrial>(state_); }
    const InTrial& attempt() const { return std::get<InTrial>(state_); }
    const InTrial* running() const { return std::get_if<InTrial>(&state_); }
    BetweenTrials& between() { return std::get<BetweenTrials>(state_); }

    bool rest();
    bool isResting(Rest& rest, const plan::Block& block);
    bool swapsDevice();
    JsonObject stableStiffnessOf(const char* key, const std::string& device) const;
    std::optional<StaircaseStep> nextStep() const;
    const plan::Condition& conditionOf(const std::optional<StaircaseStep>& step) const;
    void leaveOutNeedless();
    void beginTrial();
    void watchTrial();
    std::string keepDeviceNews();
    bool losesDevice();
    bool asksQuestionnaire();
    std::size_t takeRecords();
    void takeOtherHands();
    void judge(std::span<const TickRecord> records);
    void finishTrial(std::optional<Verdict> verdict = {});  // none: as the protocol says
    Verdict judgeByProtocol(const AttemptEnd& end);
    void takeEnd(AttemptId attempt, const AttemptEnd& end);
    AttemptEnd describeEnd(LoopHealth health);
    const plan::Block& blockOf(std::size_t place) const;
    void appendEvents(const std::vector<TrialEvent>& events);
    void finish(State over);
    void note(const char* name, const char* key, const std::string& text);  // an event with one text
    void note(const char* name, const std::string& payload_json);
    void fail(const char* stage, const Errors& errors);

    // session_commands.cpp
    Permission permissionByState(const Command& command) const;
    Permission permissionToRepeat() const;
    Permission permissionToGoBack() const;
    Permission permissionToInvalidate(const Command& command) const;
    bool hasTrial() const { return is<Preparing>() || is<InTrial>(); }
    void logCommand(const Command& command, const Permission& permission);
    Reply execute(const Command& command);
    Reply pause(const Command& command);
    void pauseHere();
    Reply repeat(const Command& command);
    Reply skip(const Command& command);
    Reply invalidate(const Command& command);
    Reply goBack(const Command& command);
    Reply halt(const Command& command);
    Reply time(const Command& command);
    Result<Done> reorder(std::size_t place, const std::string& reason, Then then);
    void abortRunning(const std::string& reason, Then then, Decider by = Decider::Experimenter);
    std::optional<std::size_t> placeOf(AttemptId attempt) const;
    std::string nameOf(std::size_t place) const;
    std::int64_t now() const;  // session time [ns]

    SessionSetup setup_;
    Apparatus& apparatus_;
    TrialSink& sink_;
    SessionListener listener_;
    QuestionnaireCourse questionnaires_;
    InstructionCourse instructions_;
    State state_ = BetweenTrials{};
    Agenda agenda_;
    Staircases staircases_;
    std::vector<Past> past_;                 // by place in the plan
    std::optional<std::size_t> last_;        // place of the newest attempt that ended
    std::optional<std::size_t> rested_for_;  // place of the trial that a rest was last looked for
    std::string device_in_use_;              // of the last trial, or being swapped to
    std::int64_t session_ns_;                // at tick 0 of the running or next attempt
    bool view_noted_ = false;
};

/// Seed of everything random in the simulated device and hand during one attempt: the study's stream "simulated" of
/// this participant, session, trial and attempt. Independent of how many trials ran before, so a resumed session draws
/// the same.
std::uint64_t attemptSeed(const SessionSetup& setup, const design::PlannedTrial& trial, int attempt_no);

}  // namespace passung::session
