#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/plan/study_plan.h"
#include "study/session/agenda.h"
#include "study/session/picture_quality.h"
#include "study/session/staircases.h"
#include "study/session/trial_sink.h"

namespace passung::session {

/// What a trial of the plan has had so far.
struct Past {
    int attempts = 0;                   // begun
    int judged = 0;                     // of them the protocol decided on: these count for its max_attempts
    std::optional<AttemptId> last;      // the newest attempt that ended
    std::optional<AttemptId> counting;  // the one that is valid and ended by its own rules
};

/// What a staircase was told by an attempt, as it is stored.
struct StoredStep {
    std::string staircase, track;
    double level = 0.0;
    bool positive = false;
};

/// An attempt of an earlier part of the session, as it is stored.
struct StoredAttempt {
    AttemptId id;
    std::size_t place;  // of its trial in the plan
    int attempt_no;
    std::optional<measures::Outcome> outcome;  // none: it crashed
    bool valid;
    std::int64_t start_ns = 0;  // session time
    std::vector<measures::Value> measures = {};
    std::optional<StoredStep> step = {};  // none: no track was told anything
    std::string invalid_reason = {};
};

/// What an earlier part of the session made of a trial.
struct EarlierTrial {
    std::size_t place;          // in the plan
    int attempts;               // that ended
    measures::Outcome outcome;  // of the newest of them
    bool valid;
    std::string invalid_reason;
    std::optional<double> time_s;
    bool over;  // and it stays so
    bool succeeded() const { return over && valid && outcome == measures::Outcome::Success; }
};

/// Point at which an interrupted session goes on.
struct Resumption {
    Agenda agenda;
    std::vector<Past> past;                    // by place in the plan
    Reordering change = {};                    // to be stored before it goes on
    std::optional<std::size_t> last = {};      // place of the newest attempt that ended
    std::int64_t start_ns = 0;                 // session time that the earlier parts took
    std::vector<FinishedTrial> finished = {};  // trials that are over and stay so, in time
    std::vector<StoredForm> forms = {};        // that were stored
    std::vector<ToldStep> steps = {};          // what staircases were told by attempts that count
    std::vector<EarlierTrial> earlier = {};    // by place: trials of which an attempt had ended
    std::optional<QualityFound> quality = {};  // with which the windows drew
};

/// What the protocol says of a trial whose newest attempt ended so; it is number `judged` of those that did.
Then thenAfter(const plan::Block& block, measures::Outcome outcome, bool valid, int judged);
/// The same of a trial whose finished attempt was made invalid.
Then thenAfterInvalid(const plan::Block& block, int judged);

/// Tells whether a whole session needs another attempt at this trial.
bool lacks(const Staircases& staircases, const design::PlannedTrial& trial, const Past& past);

/// The session's state after `attempts`, ascending by time, and the `steps` that its order took: trials come as in the
/// uninterrupted session, the interrupted one again, and then the protocol's [resume] adds what is to be done anew.
/// Where nothing is left but the session is not whole, what it lacks is offered again. Attempts of which no step tells
/// are of older programs, or crashed; of those the protocol decides. `crashed`: the program was killed; else the
/// session was ended by somebody, in the middle of the newest attempt if that is aborted.
Resumption resumption(const plan::StudyPlan& plan, std::vector<design::PlannedTrial> trials,
                      const std::vector<StoredAttempt>& attempts, bool crashed, std::vector<StoredForm> forms = {},
                      const std::vector<OrderStep>& steps = {});

/// Why a session that was interrupted so long ago must not go on; nothing if it may.
std::optional<std::string> tooOld(const plan::ResumePolicy& policy, double age_s);

}  // namespace passung::session
