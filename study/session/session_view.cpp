#include "study/session/session_view.h"

#include <cmath>

#include "study/session/session.h"

// What Session shows of itself.

namespace passung::session {

SessionView viewWithoutSession() {
    SessionView view;
    view.commands.fill({WhyNot::NoSession, "no session runs"});
    return view;
}

SessionView viewBeforeSession() {
    SessionView view;
    view.commands.fill({WhyNot::NotBegun, "the session has not begun"});
    view.commands[static_cast<std::size_t>(CommandKind::Abort)] = {};
    return view;
}

SessionView Session::view() const {
    SessionView view{.state = state()};
    if (!agenda_.empty()) view.next = agenda_.next();
    for (std::size_t place = 0; place < agenda_.planned(); ++place) view.over.push_back(agenda_.isOver(place));
    view.pauses_after = running() != nullptr && running()->pauses_after;
    const auto* between = std::get_if<BetweenTrials>(&state_);
    if (const auto* paused = std::get_if<Paused>(&state_)) {
        view.stopped = paused->stopped;
        between = &paused->then;
        if (between->swaps) view.awaited_device = device_in_use_;
    }
    if (between != nullptr && between->rest && view.next) {
        const double seconds = std::ceil(static_cast<double>(between->rest->left) * kTickSeconds);
        view.rest = RestView{static_cast<std::int64_t>(seconds), blockOf(*view.next).rest_ends};
    }
    for (std::size_t kind = 0; kind < view.commands.size(); ++kind)
        view.commands[kind] = permission({.kind = static_cast<CommandKind>(kind), .text = "a text"});
    return view;
}

}  // namespace passung::session
