#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "study/design/trial_order.h"
#include "study/measures/measures.h"
#include "study/session/command.h"
#include "study/session/session.h"
#include "ui/presenter/drawn_scene.h"

namespace passung::presenter {

// What the thread that runs a session tells the windows, in this order.

/// A participant's session begins.
struct SessionBegun {
    std::string participant;
    std::vector<design::PlannedTrial> trials;
};

/// An attempt is about to begin; its scene is built now.
struct AttemptPrepared {
    std::int64_t trial_index = 0;
    std::string condition;
    std::shared_ptr<const DrawnScene> scene;  // shared_ptr: windows draw it as long as they like
    bool sound = false;                       // there is something to be heard
};

/// Models of that scene's parts are built, which takes long the first time: this share of them is done.
struct BuildProgress {
    double share = 0.0;
};

/// How things stand; told whenever something of it has changed.
struct SessionGlance {
    session::SessionState state = session::SessionState::BetweenTrials;
    std::optional<std::size_t> next;  // place in the plan of the running or next trial; none: nothing is left
    std::vector<bool> over;           // by place in the plan
    bool can_go_back = false;
    friend bool operator==(const SessionGlance&, const SessionGlance&) = default;
};

/// An attempt is durable.
struct AttemptEnded {
    std::int64_t trial_index = 0;
    measures::Outcome outcome = measures::Outcome::Aborted;
    bool valid = false;
    std::string invalid_reason;
    std::optional<double> trial_time_s;
};

struct CommandAnswered {
    session::Command command;
    session::Answer answer;
};

/// The run is over, and why.
struct RunOver {
    bool complete = false;
    Errors errors;
};

using News =
    std::variant<SessionBegun, AttemptPrepared, BuildProgress, SessionGlance, AttemptEnded, CommandAnswered, RunOver>;

}  // namespace passung::presenter
