#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <variant>

#include "study/session/session_view.h"

namespace passung::presenter {

/// States of a run, as the largest lines on the experimenter's screen say them; a state holds what only it has.
namespace state {

struct Idle {};     // no session
struct Opening {};  // database and study
/// The next trial's scene is built.
struct Preparing {
    std::optional<double> built = {};  // share of its models that is done; none: nothing takes long
};
struct AwaitingPicture {};  // the prepared trial begins with its first one
struct ToStart {};          // the hand is on its way to the start pose
struct Running {};          // the trial
struct Between {};          // trials
struct Consenting {};       // the participant decides on a clause of consent
struct ReadingPage {};      // the participant reads instructions
struct Answering {};        // the participant fills a questionnaire
struct Resting {
    session::RestView rest;
};
struct Ready {};  // waits for Start
struct Paused {};
struct Stopped {};  // paused by an emergency stop: motors are off
struct Complete {};
struct Incomplete {};  // ended before the last trial
struct Failed {
    std::string why;
};

}  // namespace state

using RunState =
    std::variant<state::Idle, state::Opening, state::Preparing, state::AwaitingPicture, state::ToStart, state::Running,
                 state::Between, state::Consenting, state::ReadingPage, state::Answering, state::Resting, state::Ready,
                 state::Paused, state::Stopped, state::Complete, state::Incomplete, state::Failed>;

/// For visitors that treat several states alike.
template <typename State, typename... States>
concept OneOf = (std::same_as<State, States> || ...);

}  // namespace passung::presenter
