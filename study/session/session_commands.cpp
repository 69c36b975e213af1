#include <fmt/format.h>

#include <algorithm>

#include "core/base/assert.h"
#include "core/base/json.h"
#include "study/session/session.h"

// What Session does for an experimenter: may the command be obeyed now, the log, and the deed.

namespace passung::session {
namespace {

std::string withReason(std::string what, const std::string& reason) {
    return reason.empty() ? what : what + ": " + reason;
}

Reply accepted(std::string text) { return {true, std::move(text)}; }

Reply notKept(const Error& error) { return {false, toString(error), WhyNot::CannotBeKept}; }

}  // namespace

Reply Session::command(const Command& command) {
    const Permission permission = this->permission(command);
    logCommand(command, permission);
    if (!permission.given()) return {false, permission.text, permission.why};
    Reply answer = execute(command);
    if (!errors().empty()) return notKept(errors().front());
    return answer;
}

Permission Session::permission(const Command& command) const {
    if (isOver()) return {WhyNot::NoSession, "the session is over"};
    if (needsText(command.kind) && command.text.empty())
        return {WhyNot::NeedsText,
                command.kind == CommandKind::Note ? "a note needs a text" : "to invalidate an attempt needs a reason"};
    return permissionByState(command);
}

Permission Session::permissionByState(const Command& command) const {
    switch (command.kind) {
        case CommandKind::Start:
            if (running() && running()->course.awaitsExperimenter()) break;
            if (!is<Ready>()) return {WhyNot::BegunAlready, "the session has begun already"};
            break;
        case CommandKind::Done:
        case CommandKind::Failed:
            if (running() && running()->course.endsByExperimenter()) break;
            if (running() && running()->course.awaitsExperimenter())
                return {WhyNot::ClockNotStarted, "the trial's clock has not been started"};
            return {WhyNot::NoTrial, "no trial runs that the experimenter times"};
        case CommandKind::Continue:
            if (!is<Paused>()) return {WhyNot::NotPaused, "the session is not paused"};
            if (const std::string away = apparatus_.deviceNotReady(true); !away.empty())
                return {WhyNot::DeviceAway, away};
            break;
        case CommandKind::Pause:
            if (is<Ready>()) return {WhyNot::NotBegun, "the session has not begun"};
            if (is<Paused>()) return {WhyNot::PausedAlready, "the session is paused already"};
            if (running() && running()->pauses_after && !command.now)
                return {WhyNot::PausesAlready, "the session pauses after this trial already"};
            break;
        case CommandKind::Repeat:
            return permissionToRepeat();
        case CommandKind::Skip:
            if (agenda_.empty()) return {WhyNot::NothingLeft, "no trial is left"};
            break;
        case CommandKind::Back:
            return permissionToGoBack();
        case CommandKind::Invalidate:
            return permissionToInvalidate(command);
        case CommandKind::Note:
        case CommandKind::Abort:
        case CommandKind::Stop:
            break;
    }
    return {};
}

Permission Session::permissionToRepeat() const {
    if (running()) return {.attempt = running()->id};
    if (hasTrial()) return {};
    if (!last_) return {WhyNot::NothingEnded, "no trial has ended yet"};
    if (!agenda_.canGoBack() || agenda_.last() != *last_)
        return {WhyNot::RepeatedAlready, nameOf(*last_) + " is to be repeated already"};
    return {.attempt = past_[*last_].last};
}

Permission Session::permissionToGoBack() const {
    if (!agenda_.canGoBack()) return {WhyNot::NothingEnded, "there is no earlier trial"};
    return {.attempt = past_[agenda_.last()].last};
}

/// Of an attempt that is named, or else of the running one, or else of the last.
Permission Session::permissionToInvalidate(const Command& command) const {
    if (running() && command.attempt.value_or(running()->id) == running()->id) return {.attempt = running()->id};
    if (hasTrial() && !command.attempt) return {};
    if (!command.attempt && !last_) return {WhyNot::NothingEnded, "no attempt has ended yet"};
    const auto place = command.attempt ? placeOf(*command.attempt) : last_;
    if (!place)
        return {WhyNot::UnknownAttempt, fmt::format("attempt {} is not the newest one of a trial of this session",
                                                    static_cast<std::int64_t>(*command.attempt))};
    if (!past_[*place].counting)
        return {WhyNot::CountsNot, "the attempt of " + nameOf(*place) + " is not valid anyway"};
    return {.attempt = past_[*place].counting};
}

void Session::logCommand(const Command& command, const Permission& permission) {
    if (isOver()) return;  // its part of the data is closed
    Event event;
    if (running()) event.attempt = running()->id;
    event.t_ns = now();
    event.source = command.source;
    event.event = fmt::format("command_{}", commandName(command.kind));
    JsonObject payload;
    payload.boolean("accepted", permission.given());
    if (!permission.given()) payload.text("refusal", permission.text);
    if (command.now) payload.boolean("now", true);
    if (!command.text.empty()) payload.text("text", command.text);
    if (command.attempt) payload.integer("attempt_id", static_cast<std::int64_t>(*command.attempt));
    event.payload_json = payload.str();
    sink_.appendEvent(event);
}

void Session::drawsWith(const QualityFound& found) {
    if (isOver()) return;
    Event event{.attempt = {}, .t_ns = now(), .source = "window", .event = kQualityEvent};
    if (running()) event.attempt = running()->id;
    event.payload_json = qualityJson(found);
    sink_.appendEvent(event);
}

Reply Session::execute(const Command& command) {
    switch (command.kind) {
        case CommandKind::Start:
            if (running()) return time(command);
            state_ = BetweenTrials{};
            return accepted("the session begins");
        case CommandKind::Done:
        case CommandKind::Failed:
            return time(command);
        case CommandKind::Continue:
            apparatus_.rearm();
            state_ = BetweenTrials(std::get<Paused>(state_).then);
            return accepted(agenda_.empty() ? "the session ends" : "goes on with " + nameOf(agenda_.next()));
        case CommandKind::Pause:
            return pause(command);
        case CommandKind::Repeat:
            return repeat(command);
        case CommandKind::Skip:
            return skip(command);
        case CommandKind::Invalidate:
            return invalidate(command);
        case CommandKind::Back:
            return goBack(command);
        case CommandKind::Note:
            if (const auto kept = sink_.addNote(command.source, command.text, now()); !kept)
                return notKept(kept.errors().front());
            return accepted("noted");
        case CommandKind::Abort:
            interrupt(withReason("aborted by the experimenter", command.text));
            return accepted("the session is aborted");
        case CommandKind::Stop:
            return halt(command);
    }
    return {};
}

Reply Session::pause(const Command& command) {
    if (is<InTrial>() && !command.now) {
        attempt().pauses_after = true;
        return {true, "pauses after " + nameOf(agenda_.next()), WhyNot::Possible, true};
    }
    if (is<InTrial>()) abortRunning(withReason("paused", command.text), Then::RepeatNow);
    pauseHere();
    return accepted("paused");
}

Reply Session::repeat(const Command& command) {
    const std::string reason = withReason("repeated by the experimenter", command.text);
    if (is<InTrial>()) {
        abortRunning(reason, Then::RepeatNow);
        return accepted(nameOf(*last_) + " begins anew");
    }
    return goBack(command);
}

Reply Session::skip(const Command& command) {
    const std::size_t place = agenda_.next();
    if (is<InTrial>())
        abortRunning(withReason("skipped by the experimenter", command.text), Then::Done);
    else if (const auto done = sink_.reorder({.steps = {{.trial_index = trial().trial_index}}}); !done)
        return notKept(done.errors().front());
    else
        agenda_.end(Then::Done);
    return accepted(nameOf(place) + " is left out");
}

Reply Session::invalidate(const Command& command) {
    const std::string reason = withReason("invalidated by the experimenter", command.text);
    if (running() && (!command.attempt || *command.attempt == running()->id)) {
        const std::size_t place = agenda_.next();
        attempt().invalidated = reason;
        return accepted("the running attempt of " + nameOf(place) + " will not count");
    }
    const std::size_t place = command.attempt ? *placeOf(*command.attempt) : *last_;
    const Then then = agenda_.isOver(place) ? thenAfterInvalid(blockOf(place), past_[place].judged) : Then::Done;
    const auto goes_on = running() ? std::optional(agenda_.next()) : std::nullopt;
    if (const auto done = reorder(place, reason, then); !done) return notKept(done.errors().front());
    if (goes_on)
        agenda_.bring(*goes_on);  // it goes on; what is repeated comes after it
    else
        leaveOutNeedless();
    return accepted("the attempt of " + nameOf(place) + " no longer counts" +
                    (agenda_.isOver(place) ? "" : ", it is repeated"));
}

Reply Session::goBack(const Command& command) {
    if (is<InTrial>()) abortRunning(withReason("went back by the experimenter", command.text), Then::RepeatNow);
    if (isOver()) return {};
    const std::size_t place = agenda_.last();
    const std::string reason = withReason("repeated by the experimenter", command.text);
    if (const auto done = reorder(place, reason, Then::RepeatNow); !done) return notKept(done.errors().front());
    leaveOutNeedless();
    return accepted(nameOf(place) + " is next");
}

/// Unless the session is paused already, or over.
void Session::pauseHere() {
    if (isOver() || is<Paused>()) return;
    const auto* between = std::get_if<BetweenTrials>(&state_);
    state_ = Paused{between != nullptr ? *between : BetweenTrials{}};
}

/// Starts or stops the clock of a trial that the experimenter times, at the next tick.
Reply Session::time(const Command& command) {
    const std::string name = nameOf(agenda_.next());
    if (command.kind == CommandKind::Start) {
        attempt().course.begin();
        return accepted("the clock of " + name + " runs");
    }
    attempt().course.conclude(command.kind == CommandKind::Done);
    return accepted(name + (command.kind == CommandKind::Done ? " has succeeded" : " has failed"));
}

Reply Session::halt(const Command& command) {
    apparatus_.halt();
    if (is<InTrial>()) abortRunning(withReason("emergency stop", command.text), Then::RepeatNow);
    pauseHere();
    if (auto* paused = std::get_if<Paused>(&state_)) paused->stopped = true;
    return accepted("motors are off, the session is paused");
}

/// What counts of the trial at `place` no longer does, and it is to do again unless that is Done.
Result<Done> Session::reorder(std::size_t place, const std::string& reason, Then then) {
    Reordering change{.reason = reason};
    if (past_[place].counting) change.discounted.push_back(*past_[place].counting);
    if (then != Then::Done) change.steps.push_back({.trial_index = agenda_.trial(place).trial_index, .then = then});
    const auto done = sink_.reorder(change);
    if (!done) return done;
    if (past_[place].counting) staircases_.forget(*past_[place].counting);
    past_[place].counting.reset();
    if (then != Then::Done) questionnaires_.forget(agenda_.trial(place));
    agenda_.redo(place, then);
    return done;
}

void Session::abortRunning(const std::string& reason, Then then, Decider by) {
    PASSUNG_ASSERT(is<InTrial>());
    std::vector<TrialEvent> events;
    if (!attempt().course.ended()) attempt().course.abort(attempt().next_tick, reason, events);
    appendEvents(events);
    finishTrial(Verdict{then, by});
}

std::optional<std::size_t> Session::placeOf(AttemptId attempt) const {
    const auto found = std::find_if(past_.begin(), past_.end(), [&](const Past& past) { return past.last == attempt; });
    if (found == past_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - past_.begin());
}

std::string Session::nameOf(std::size_t place) const {
    return fmt::format("trial {}", agenda_.trial(place).trial_index + 1);
}

std::int64_t Session::now() const {
    return session_ns_ + (running() ? running()->clock.periods() * kTickNanoseconds : 0);
}

}  // namespace passung::session
