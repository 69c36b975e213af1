#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ui/presenter/quality_search.h"
#include "ui/presenter/run_state.h"
#include "ui/presenter/session_news.h"

namespace passung::presenter {

enum class RowState { Waiting, Next, Running, Success, Timeout, Failure, Aborted, Skipped, Invalid };

struct TrialRow {
    std::int64_t number = 0;  // from 1
    std::string block, phase, condition;
    RowState state = RowState::Waiting;
    int attempts = 0;  // that ended
    std::optional<double> time_s;
    std::string remark;  // why it does not count
};

/// Why a command cannot be given now.
using Why = session::WhyNot;

/// What the participant's window is able to show.
enum class Display {
    Shown,
    Closed,  // the window was
    Lost,    // the graphics system draws no picture any more
};

/// How the loop has kept its rate over the last second of an attempt.
struct LoopView {
    double rate_hz = 0.0;     // ticks that happened
    double typical_us = 0.0;  // computing time of a tick, median
    double longest_us = 0.0;
    std::int64_t missed = 0;  // cycles since the attempt began
    std::size_t ticks = 0;    // that this is about; at first they are few

    bool isWhole() const { return ticks == kTicksPerSecond; }
    static constexpr std::size_t kTicksPerSecond = 1000;
};

/// The pictures of the participant's window over the last second.
struct PicturesView {
    double per_s = 0.0;   // that showed a newer tick
    double age_ms = 0.0;  // of what is on the screen now
};

/// What came of a trial, for the participant.
struct TrialResult {
    bool success = false;
    std::optional<double> time_s;  // if that is told as well
};

/// What the participant is asked or reads. A pause hides it and leaves it open.
using FormOrPage = std::variant<std::monostate, FormDue, PageDue>;

/// All that windows show of a run, as one value: its state, and what is known in several of them.
struct RunView {
    RunState state;
    std::string study, participant;
    std::size_t planned = 0, finished = 0;
    std::int64_t number = 0;  // of the running or next trial, from 1; 0: none
    std::string condition;
    TrialBrief brief;  // of the prepared, running or last trial
    session::SessionView session = session::viewWithoutSession();
    double trial_s = 0.0;  // since the go
    std::vector<TrialRow> rows;
    std::int64_t rows_changed = 0;         // counts up whenever a row does
    std::optional<LoopView> loop;          // none: the attempt has no tick yet
    std::optional<PicturesView> pictures;  // none: no attempt runs, or none of a second yet
    std::optional<QualityFound> quality;   // with which the participant's window draws; none: not found yet
    double force_N = 0.0, depth_mm = 0.0;
    std::optional<CommandAnswered> answered;  // the last command
    std::vector<std::string> warnings;        // of this run, in sentences
    Display display = Display::Shown;
    FormOrPage asked;
    /// What the participant may know of the trial that ended last; nothing once the next one begins.
    std::optional<TrialResult> result;

    /// Is what goes on one of these states?
    template <typename... States>
    bool is() const {
        return (std::holds_alternative<States>(state) || ...);
    }
    bool isOver() const { return is<state::Complete, state::Incomplete, state::Failed>(); }
    bool isRunning() const { return !is<state::Idle>() && !isOver(); }
    /// Why the session failed; empty: it did not.
    std::string failure() const {
        const auto* failed = std::get_if<state::Failed>(&state);
        return failed == nullptr ? std::string() : failed->why;
    }
    /// Share of the scene's models that is done; none: nothing is built that takes long.
    std::optional<double> built() const {
        const auto* preparing = std::get_if<state::Preparing>(&state);
        return preparing == nullptr ? std::nullopt : preparing->built;
    }
    /// Null: the participant fills none.
    std::shared_ptr<const FormRequest> form() const {
        const auto* due = std::get_if<FormDue>(&asked);
        return due == nullptr ? nullptr : due->form;
    }
    /// Null: the participant reads none.
    const PageDue* page() const { return std::get_if<PageDue>(&asked); }
    Why why(session::CommandKind kind) const { return session.permission(kind).why; }
    bool may(session::CommandKind kind) const { return why(kind) == Why::Possible; }
};

}  // namespace passung::presenter
