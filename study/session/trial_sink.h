#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/tick_record.h"
#include "study/measures/measures.h"
#include "study/session/agenda.h"
#include "study/session/apparatus.h"
#include "study/session/questionnaire_source.h"
#include "study/session/staircase_step.h"

namespace passung::session {

enum class AttemptId : std::int64_t {};

struct AttemptStart {
    std::int64_t trial_index = 0;  // in the session's plan
    int attempt_no = 1;
    std::int64_t start_ns = 0;  // monotonic, from the segment's zero
    std::string params_json;
    std::vector<StageNote> stages;
    std::uint64_t seed = 0;  // of the simulated device and hand
    std::optional<StaircaseStep> staircase = {};
};

/// Person or rule that says what becomes of a trial. Only attempts that the protocol decides on count for its
/// max_attempts.
enum class Decider { Protocol, Experimenter, Interruption };

/// What became of a step of an assembly.
struct StepEnd {
    std::string name, part;
    measures::StepResult result;
    friend bool operator==(const StepEnd&, const StepEnd&) = default;
};

struct AttemptEnd {
    std::int64_t end_ns = 0;
    measures::Outcome outcome = measures::Outcome::Aborted;
    bool valid = true;
    std::string invalid_reason;  // e.g. dropped records
    std::vector<measures::Value> measures;
    std::vector<measures::Detection> detections;  // of the secondary task, by time
    std::vector<measures::TickOverlap> overlaps;  // of the ticks that were judged
    std::vector<StepEnd> steps;                   // of an assembly, in the order of the protocol
    LoopHealth health;
    bool timing_measured = true;  // false in virtual time: timing cells are exported as NA
    std::optional<StaircaseAnswer> staircase = {};
    Then then = Then::Done;  // of its trial
    Decider decided_by = Decider::Protocol;
};

/// What becomes of a trial in the session's order.
struct OrderStep {
    std::int64_t trial_index = 0;  // in the session's plan
    Then then = Then::Done;
    Decider decided_by = Decider::Experimenter;
    std::optional<AttemptId> attempt = {};  // that has ended so; none: the order changes between ends
};

/// What changes the order between the ends of attempts: durable as a whole or not at all.
struct Reordering {
    std::vector<AttemptId> discounted = {};  // finished ones that no longer count; what was recorded of them stays
    std::string reason = {};                 // why not
    std::vector<OrderStep> steps = {};       // in time
};

struct Event {
    std::optional<AttemptId> attempt;
    std::int64_t t_ns = 0;  // monotonic, from the segment's zero
    std::string source;     // "session", "loop", "experimenter"
    std::string event;
    std::string payload_json = "{}";
};

/// Destination of a session's data. Calls return quickly; those that give a Result<Done> return when the
/// data is durable.
class TrialSink {
public:
    virtual ~TrialSink() = default;
    virtual Result<AttemptId> startAttempt(const AttemptStart& start) = 0;
    /// `hand`: of the condition's scene, whose records they are.
    virtual void appendRecords(AttemptId attempt, std::size_t hand, std::span<const TickRecord> records) = 0;
    virtual void appendEvent(const Event& event) = 0;
    virtual Result<Done> finishAttempt(AttemptId attempt, const AttemptEnd& end) = 0;
    virtual Result<Done> storeQuestionnaire(const QuestionnaireRun& run) = 0;
    virtual Result<Done> reorder(const Reordering& change) = 0;
    virtual Result<Done> addNote(const std::string& author, const std::string& text, std::int64_t t_ns) = 0;
    virtual Result<Done> finishSession(bool complete, std::int64_t end_ns) = 0;
};

}  // namespace passung::session
