#pragma once

#include <iterator>
#include <optional>
#include <string>
#include <string_view>

#include "study/session/trial_sink.h"

namespace passung::session {

/// What an experimenter may tell a session.
enum class CommandKind {
    Start,       // a session that waits for it begins; or the clock of a trial that the experimenter times
    Pause,       // after the running trial, or now: it is aborted and done again
    Continue,    // after a pause or an emergency stop
    Repeat,      // the running trial from its beginning, else the last one; its attempt no longer counts
    Skip,        // the running trial, else the next one, is left out
    Invalidate,  // an attempt does not count, for a reason; the protocol says whether its trial is repeated
    Back,        // one trial back; what it had no longer counts
    Note,        // a remark in the data
    Abort,       // ends the session
    Stop,        // emergency: motors off at once, the running attempt is aborted, the session pauses
    Done,        // a trial that the experimenter times has succeeded
    Failed,      // or not
};

inline constexpr std::string_view kCommandNames[] = {"start", "pause", "continue", "repeat", "skip", "invalidate",
                                                     "back",  "note",  "abort",    "stop",   "done", "failed"};
constexpr std::string_view commandName(CommandKind kind) { return kCommandNames[static_cast<std::size_t>(kind)]; }
constexpr std::optional<CommandKind> commandNamed(std::string_view name) {
    for (std::size_t i = 0; i < std::size(kCommandNames); ++i)
        if (kCommandNames[i] == name) return static_cast<CommandKind>(i);
    return std::nullopt;
}

/// Tells whether the command says nothing without a text.
constexpr bool needsText(CommandKind kind) { return kind == CommandKind::Note || kind == CommandKind::Invalidate; }

/// Why a command is refused.
enum class WhyNot {
    Possible,  // it is not
    NoSession,
    BegunAlready,
    NotBegun,
    NotPaused,
    PausedAlready,
    PausesAlready,  // after the running trial
    NothingEnded,
    RepeatedAlready,  // will be
    NothingLeft,
    NoTrial,          // that the experimenter times
    ClockNotStarted,  // of that trial
    NeedsText,
    UnknownAttempt,
    CountsNot,     // the attempt, anyway
    CannotBeKept,  // the data's fault
    DeviceAway,    // a device is not there
};

struct Command {
    CommandKind kind = CommandKind::Pause;
    std::string text = {};                  // the reason, or the note
    std::optional<AttemptId> attempt = {};  // of Invalidate; none: the running one, else the last
    std::string source = "experimenter";    // who says so, for the log
    bool now = false;                       // of Pause: what must not go on cannot wait for the trial's end
};

/// What came of a command; for people. What was accepted is in the data when the answer is given.
struct Reply {
    bool accepted = false;
    std::string text;  // what happens now, or why not
    WhyNot why = WhyNot::Possible;
    bool after_trial = false;  // it happens when the running trial is over
};

}  // namespace passung::session
