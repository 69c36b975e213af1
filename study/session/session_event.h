#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "study/measures/measures.h"
#include "study/session/resume.h"
#include "study/session/session_view.h"
#include "study/session/trial_sink.h"

namespace passung::session {

// What happens to a session and to the run that it is part of, in time.

/// An earlier run was cut off; what it left is marked as crashed: texts that name it.
struct RecoveredCrash {
    std::vector<std::string> attempts, sessions;
};

/// For accuracy = "auto" this share of a step is done.
struct MeasuringAccuracy {
    std::string step;
    double share = 0.0;
};

struct PickedAccuracy {
    std::string text;  // what was picked and why
};

struct Warned {
    std::string text;
};

struct ParticipantBegins {
    std::string participant;      // code
    int number = 1, planned = 1;  // of this run's participants
};

/// The session begins to wait for a command.
struct SessionWaits {
    SessionView view;
    std::string advice;  // on the calibration of the device that it awaits; empty: none
};

/// An attempt is durable: whoever hears this may rely on finding it after a crash.
struct AttemptEnded {
    std::int64_t trial_index = 0;  // in the session's plan
    measures::Outcome outcome = measures::Outcome::Aborted;
    bool valid = false;
    std::string invalid_reason = {};
    std::optional<double> trial_time_s = {};
    AttemptId id = {};
    std::size_t finished = 0;  // trials of this session that are over; one that is to be repeated is not
    std::size_t planned = 0;   // without those that staircases do not need any more
};

/// A session that was not interrupted is over.
struct SessionOver {
    std::string participant;
    bool whole = false;
};

/// A view comes where a scene is about to be built, which may take long: how the session stands until its first look at
/// it. A resumption: what an earlier process did of the session.
using SessionEvent = std::variant<RecoveredCrash, MeasuringAccuracy, PickedAccuracy, Warned, ParticipantBegins,
                                  Resumption, SessionView, SessionWaits, AttemptEnded, SessionOver>;

/// Hears all of them on the thread that runs the session; may be empty.
using SessionListener = std::function<void(const SessionEvent&)>;

}  // namespace passung::session
