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

Answer accepted(std::string text) { return {true, std::move(text)}; }

Answer notKept(const Error& error) { return {false, toString(error), WhyNot::CannotBeKept}; }

}  // namespace

Answer Session::command(const Command& command) {
    const Permission permission = this->permission(command);
    logCommand(command, permission);
    if (!permission.given()) return {false, permission.text, permission.why};
    Answer answer = execute(command);
    if (state_ == SessionState::Failed && !errors_.empty()) return notKept(errors_.front());
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
            if (attempt_ && attempt_->course.awaitsExperimenter()) break;
            if (state_ != SessionState::Ready) return {WhyNot::BegunAlready, "the session has begun already"};
            break;
        case CommandKind::Done:
        case CommandKind::Failed:
            if (attempt_ && attempt_->course.endsByExperimenter()) break;
            if (attempt_ && attempt_->course.awaitsExperimenter())
                return {WhyNot::ClockNotStarted, "the trial's clock has not been started"};
            return {WhyNot::NoTrial, "no trial runs that the experimenter times"};
        case CommandKind::Continue:
            if (state_ != SessionState::Paused) return {WhyNot::NotPaused, "the session is not paused"};
            break;
        case CommandKind::Pause:
            if (state_ == SessionState::Ready) return {WhyNot::NotBegun, "the session has not begun"};
            if (state_ == SessionState::Paused) return {WhyNot::PausedAlready, "the session is paused already"};
            if (pause_asked_ && !command.now)
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
    if (attempt_) return {.attempt = attempt_->id};
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
    if (attempt_ && command.attempt.value_or(attempt_->id) == attempt_->id) return {.attempt = attempt_->id};
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
    if (attempt_) event.attempt = attempt_->id;
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
    if (attempt_) event.attempt = attempt_->id;
    event.payload_json = qualityJson(found);
    sink_.appendEvent(event);
}

Answer Session::execute(const Command& command) {
    switch (command.kind) {
        case CommandKind::Start:
            if (attempt_) return time(command);
            state_ = SessionState::BetweenTrials;
            return accepted("the session begins");
        case CommandKind::Done:
        case CommandKind::Failed:
            return time(command);
        case CommandKind::Continue:
            apparatus_.rearm();
            state_ = SessionState::BetweenTrials;
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

Answer Session::pause(const Command& command) {
    const bool in_trial = state_ == SessionState::InTrial;
    if (in_trial && !command.now) {
        pause_asked_ = true;
        return {true, "pauses after " + nameOf(agenda_.next()), WhyNot::Possible, true};
    }
    if (in_trial) abortRunning(withReason("paused", command.text), Then::RepeatNow);
    if (!isOver()) state_ = SessionState::Paused;
    return accepted("paused");
}

Answer Session::repeat(const Command& command) {
    const std::string reason = withReason("repeated by the experimenter", command.text);
    if (state_ == SessionState::InTrial) {
        abortRunning(reason, Then::RepeatNow);
        return accepted(nameOf(*last_) + " begins anew");
    }
    return goBack(command);
}

Answer Session::skip(const Command& command) {
    const std::size_t place = agenda_.next();
    if (state_ == SessionState::InTrial)
        abortRunning(withReason("skipped by the experimenter", command.text), Then::Done);
    else if (const auto done = sink_.reorder({.steps = {{.trial_index = trial().trial_index}}}); !done)
        return notKept(done.errors().front());
    else
        agenda_.end(Then::Done);
    return accepted(nameOf(place) + " is left out");
}

Answer Session::invalidate(const Command& command) {
    const std::string reason = withReason("invalidated by the experimenter", command.text);
    if (attempt_ && (!command.attempt || *command.attempt == attempt_->id)) {
        const std::size_t place = agenda_.next();
        attempt_->invalidated = reason;
        return accepted("the running attempt of " + nameOf(place) + " will not count");
    }
    const std::size_t place = command.attempt ? *placeOf(*command.attempt) : *last_;
    const Then then = agenda_.isOver(place) ? thenAfterInvalid(blockOf(place), past_[place].judged) : Then::Done;
    const auto running = attempt_ ? std::optional(agenda_.next()) : std::nullopt;
    if (const auto done = reorder(place, reason, then); !done) return notKept(done.errors().front());
    if (running)
        agenda_.bring(*running);  // it goes on; what is repeated comes after it
    else
        leaveOutNeedless();
    return accepted("the attempt of " + nameOf(place) + " no longer counts" +
                    (agenda_.isOver(place) ? "" : ", it is repeated"));
}

Answer Session::goBack(const Command& command) {
    if (state_ == SessionState::InTrial)
        abortRunning(withReason("went back by the experimenter", command.text), Then::RepeatNow);
    if (isOver()) return {};
    const std::size_t place = agenda_.last();
    const std::string reason = withReason("repeated by the experimenter", command.text);
    if (const auto done = reorder(place, reason, Then::RepeatNow); !done) return notKept(done.errors().front());
    leaveOutNeedless();
    return accepted(nameOf(place) + " is next");
}

/// Starts or stops the clock of a trial that the experimenter times, at the next tick.
Answer Session::time(const Command& command) {
    const std::string name = nameOf(agenda_.next());
    if (command.kind == CommandKind::Start) {
        attempt_->course.begin();
        return accepted("the clock of " + name + " runs");
    }
    attempt_->course.conclude(command.kind == CommandKind::Done);
    return accepted(name + (command.kind == CommandKind::Done ? " has succeeded" : " has failed"));
}

Answer Session::halt(const Command& command) {
    apparatus_.halt();
    if (state_ == SessionState::InTrial) abortRunning(withReason("emergency stop", command.text), Then::RepeatNow);
    if (!isOver()) state_ = SessionState::Paused;
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
    if (then != Then::Done) desk_.forget(agenda_.trial(place));
    agenda_.redo(place, then);
    return done;
}

void Session::abortRunning(const std::string& reason, Then then, Decider by) {
    PASSUNG_ASSERT(state_ == SessionState::InTrial);
    std::vector<TrialEvent> events;
    if (!attempt_->course.ended()) attempt_->course.abort(attempt_->next_tick, reason, events);
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
    return session_ns_ + (attempt_ ? attempt_->clock.periods() * kTickNanoseconds : 0);
}

}  // namespace passung::session
