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
#include "study/session/session_event.h"
#include "ui/presenter/drawn_scene.h"
#include "ui/presenter/form.h"
#include "ui/presenter/quality_search.h"

namespace passung::presenter {

// What the thread that runs a session tells the windows, in this order.

/// A participant's session begins.
struct SessionBegun {
    std::string participant;
    std::vector<design::PlannedTrial> trials;
    std::vector<session::EarlierTrial> earlier = {};  // of a session that is resumed
    plan::View appearance = {};
    std::optional<QualityFound> quality = {};  // with which a session that is resumed was drawn
};

/// Clauses of consent, instructions and questionnaires, each until the participant has answered or read it.
struct FormDue {
    std::shared_ptr<const FormRequest> form;  // shared_ptr: windows keep it as long as they like
};
struct PageDue {
    std::int64_t number = 0;  // tells it from every other page of the run
    std::string text;
    std::string picture;  // file; empty: none
};
struct AskedDone {};

/// What a participant has to know of a trial beside its scene.
struct TrialBrief {
    enum class Kind { Insertion, Passage, Contour, Placement, Pair, Assembly };  // as in plan::Task::form
    Kind kind = Kind::Insertion;
    std::string question = {};  // of a pair
    plan::TimedBy timed_by = plan::TimedBy::Program;
    plan::ShownResult result = plan::ShownResult::None;
    bool sound = false;                    // there is something to be heard
    int pick_button = 0, undo_button = 0;  // of a hand that picks parts up, from 1; 0: none does
    bool pick_on_press = false;            // each press closes or opens the hand
};

/// An attempt is about to begin; its scene is built now.
struct AttemptPrepared {
    std::int64_t trial_index = 0;
    std::string condition;
    std::shared_ptr<const DrawnScene> scene;  // shared_ptr: windows draw it as long as they like
    TrialBrief brief = {};
    std::int64_t shown_as = 0;  // number of its first picture, which it waits for
};

/// Models of that scene's parts are built, which takes long the first time: this share of them is done.
struct BuildProgress {
    double share = 0.0;
};

struct CommandAnswered {
    session::Command command;
    session::Reply answer;
};

/// The run is over, and why.
struct RunOver {
    bool complete = false;
    Errors errors;
};

/// The session's view is told whenever something of it has changed.
using News = std::variant<SessionBegun, FormDue, PageDue, AskedDone, AttemptPrepared, BuildProgress,
                          session::SessionEvent, CommandAnswered, RunOver>;

}  // namespace passung::presenter
