#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "study/plan/block.h"
#include "study/session/command.h"

namespace passung::session {

/// Ready → BetweenTrials → Preparing → InTrial → BetweenTrials … → Complete; Paused in place of BetweenTrials when that
/// was asked; and from all of them → Failed or Interrupted. Only Paused and Ready wait for a command.
enum class SessionState { Ready, BetweenTrials, Preparing, InTrial, Paused, Complete, Failed, Interrupted };

/// Whether a command is obeyed now.
struct Permission {
    WhyNot why = WhyNot::Possible;
    std::string text = {};                  // why not, for people
    std::optional<AttemptId> attempt = {};  // that Repeat, Back or Invalidate is about; none: no attempt
    bool given() const { return why == WhyNot::Possible; }
    friend bool operator==(const Permission&, const Permission&) = default;
};

/// A rest that runs.
struct RestView {
    std::int64_t seconds = 0;  // that it has to last yet, rounded up
    plan::RestEnds ends = plan::RestEnds::ByTime;
    friend bool operator==(const RestView&, const RestView&) = default;
};

/// All that front ends show of a session, as one value: how it stands and what an experimenter may command. In
/// Preparing a scene is built: what is commanded meanwhile is answered when its trial runs.
struct SessionView {
    SessionState state = SessionState::BetweenTrials;
    std::optional<std::size_t> next = {};  // place in the plan of the running or next trial; none: nothing is left
    std::vector<bool> over = {};           // by place in the plan
    bool pauses_after = false;             // the running trial
    bool stopped = false;                  // an emergency stop is why the session is paused: motors are off
    std::string awaited_device = {};       // to be put in place while the session is Paused; empty: it waits for none
    std::optional<RestView> rest = {};
    /// Permission of every command, by its kind, with the text that it needs and without the number of an attempt.
    std::array<Permission, std::size(kCommandNames)> commands = {};

    const Permission& permission(CommandKind kind) const { return commands[static_cast<std::size_t>(kind)]; }
    bool waits() const { return state == SessionState::Ready || state == SessionState::Paused; }
    friend bool operator==(const SessionView&, const SessionView&) = default;
};

/// View where there is no session: nothing is obeyed.
SessionView viewWithoutSession();
/// View before a session begins, while consent is asked for: only Abort is obeyed.
SessionView viewBeforeSession();

}  // namespace passung::session
