#include "study/session/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/assert.h"
#include "core/base/json.h"
#include "core/base/random.h"
#include "study/measures/overlap.h"
#include "study/plan/participant.h"
#include "study/session/rendered_scenes.h"
#include "study/session/secondary.h"

namespace passung::session {
namespace {

constexpr std::size_t kTakeAtOnce = 256;  // records

/// Why a trial of this length [s] that the participant saw so does not count; empty: nothing against it.
std::string pictureFault(const Presentation& given, const plan::View& view, double seconds) {
    const double age_s = 1e-6 * given.frame_age_max_us;
    if (age_s > view.max_picture_age)
        return fmt::format("picture: up to {:.0f} ms old, at most {:.0f} ms count", 1e3 * age_s,
                           1e3 * view.max_picture_age);
    // Of a short trial one picture more or less says nothing.
    if (static_cast<double>(given.frames + 1) < view.min_pictures_per_s * seconds)
        return fmt::format("pictures: {:.1f} a second, at least {:.1f} count",
                           static_cast<double>(given.frames) / seconds, view.min_pictures_per_s);
    return {};
}

/// Why a trial in which at most this share of the cycles may be without usable input does not count; empty: nothing
/// against it. A cycle that was missed had none.
std::string loopFault(const TrialCourse& course, double most) {
    const double lacking = static_cast<double>(course.rejectedTicks() + course.missedCycles());
    if (!(lacking > most * static_cast<double>(course.length()))) return {};
    if (course.rejectedTicks() == 0)
        return fmt::format("loop: {} of {} cycles missed", course.missedCycles(), course.length());
    return fmt::format("no usable device input in {} ticks, and {} of {} cycles missed", course.rejectedTicks(),
                       course.missedCycles(), course.length());
}

/// @pre the condition's trial is an assembly
std::string stepJson(const plan::Condition& condition, const measures::StepChange& change) {
    const auto& steps = std::get<plan::AssemblyTask>(condition.task.form).steps;
    JsonObject json;
    json.text("step", steps[change.step].name);
    if (change.what == measures::StepChange::What::State) json.text("state", measures::stepStateName(change.state));
    if (change.hand > 0) json.text("hand", condition.scene.hand(change.hand).name);
    return json.str();
}

std::vector<StepEnd> stepEnds(const plan::Condition& condition, const std::vector<measures::StepResult>& results) {
    const auto& named = std::get<plan::AssemblyTask>(condition.task.form).steps;
    std::vector<StepEnd> ends;
    for (std::size_t i = 0; i < results.size(); ++i) {
        const std::size_t part = condition.scene.effects.pick.steps[i].part;
        ends.push_back({named[i].name, condition.scene.parts[part].name, results[i]});
    }
    return ends;
}

}  // namespace

std::uint64_t attemptSeed(const SessionSetup& setup, const design::PlannedTrial& trial, int attempt_no) {
    const std::string purpose = fmt::format("simulated|{}|{}|{}", setup.ordinal, trial.trial_index, attempt_no);
    return streamSeed(setup.plan->name, plan::rehearsedCode(setup.participant), trial.phase, purpose, setup.seed);
}

Session::Session(SessionSetup setup, Apparatus& apparatus, TrialSink& sink, SessionListener listener)
    : setup_(std::move(setup)),
      apparatus_(apparatus),
      sink_(sink),
      listener_(std::move(listener)),
      questionnaires_(*setup_.plan,
                      {plan::rehearsedCode(setup_.participant), setup_.seed, setup_.ordinal, setup_.timing_measured},
                      setup_.answers, sink),
      instructions_(*setup_.plan, setup_.language, setup_.timing_measured, setup_.reader, sink),
      state_(setup_.waits ? State(Ready{}) : State(BetweenTrials{})),
      agenda_(setup_.resumed ? setup_.resumed->agenda : Agenda(setup_.trials)),
      staircases_(*setup_.plan, plan::rehearsedCode(setup_.participant), setup_.seed, setup_.ordinal),
      past_(setup_.resumed ? setup_.resumed->past : std::vector<Past>(setup_.trials.size())),
      last_(setup_.resumed ? setup_.resumed->last : std::nullopt),
      session_ns_(setup_.resumed ? setup_.resumed->start_ns : 0) {
    if (setup_.resumed) questionnaires_.resume(setup_.resumed->finished, agenda_.remaining(), setup_.resumed->forms);
    if (setup_.resumed)
        for (ToldStep& told : setup_.resumed->steps) staircases_.restore(std::move(told));
    leaveOutNeedless();
}

Session::~Session() {
    if (is<InTrial>()) apparatus_.stop();
}

Result<Done> Session::run() {
    while (is<BetweenTrials>() || is<InTrial>()) advance();
    if (is<Failed>()) return errors();
    return Done{};
}

const Errors& Session::errors() const {
    static const Errors none;
    const auto* failed = std::get_if<Failed>(&state_);
    return failed != nullptr ? failed->errors : none;
}

void Session::interrupt(const std::string& reason) {
    const bool complete = !is<InTrial>() && agenda_.empty() && !questionnaires_.isDue({});
    if (is<InTrial>()) abortRunning(reason, Then::RepeatNow, Decider::Interruption);
    if (isOver()) return;
    if (complete) return finish(Complete{});
    note("session_interrupted", "reason", reason);
    finish(Interrupted{});
}

SessionState Session::advance() {
    switch (state()) {
        case SessionState::BetweenTrials:
            if (losesDevice() || asksQuestionnaire()) break;
            if (agenda_.empty()) {
                if (!instructions_.show(nullptr, session_ns_)) finish(Complete{});
            } else if (!rest() && !swapsDevice() && !instructions_.show(&trial(), session_ns_)) {
                beginTrial();
            }
            break;
        case SessionState::InTrial:
            watchTrial();
            break;
        case SessionState::Ready:
        case SessionState::Paused:
            keepDeviceNews();
            break;
        case SessionState::Preparing:
        case SessionState::Complete:
        case SessionState::Failed:
        case SessionState::Interrupted:
            break;
    }
    return state();
}

/// What a staircase chooses for the next trial; nothing if none governs it.
std::optional<StaircaseStep> Session::nextStep() const {
    if (!staircases_.governs(trial())) return std::nullopt;
    return staircases_.next(trial());
}

/// What the next trial presents.
const plan::Condition& Session::conditionOf(const std::optional<StaircaseStep>& step) const {
    const std::size_t shown = step ? step->condition : trial().condition;
    PASSUNG_ASSERT(shown < setup_.plan->conditions.size());
    return setup_.plan->conditions[shown];
}

/// Trials of a staircase whose tracks are all finished.
void Session::leaveOutNeedless() {
    if (setup_.plan->staircases.empty()) return;
    agenda_.leaveOut([&](const design::PlannedTrial& planned) { return !staircases_.needs(planned); });
}

void Session::beginTrial() {
    AttemptStart start;
    start.staircase = nextStep();
    const plan::Condition& condition = conditionOf(start.staircase);
    const auto X_WT = targetPose(condition);
    if (!X_WT) return fail("prepare", X_WT.errors());

    start.trial_index = trial().trial_index;
    start.attempt_no = past_[agenda_.next()].attempts + 1;
    start.start_ns = session_ns_;
    start.params_json = condition.params_json;
    start.seed = attemptSeed(setup_, trial(), start.attempt_no);
    if (setup_.shown && !std::exchange(view_noted_, true)) note("view_shown", plan::viewJson(setup_.plan->view));
    state_ = Preparing{};
    if (listener_) listener_(view());
    auto stages = apparatus_.prepare(condition, start.seed, start.trial_index);
    if (!stages) return fail("prepare", stages.errors());
    start.stages = *std::move(stages);

    const auto id = sink_.startAttempt(start);
    if (!id) return fail("start attempt", id.errors());
    ++past_[agenda_.next()].attempts;
    InTrial attempt{*id, &condition, TrialCourse(condition, *X_WT, start.seed), HandsView(condition)};
    attempt.others.resize(attempt.view.otherHands());
    if (condition.secondary.any()) attempt.secondary.emplace(detectionSettings(condition.secondary), start.seed);
    if (setup_.timer != nullptr && condition.timed_by == plan::TimedBy::Experimenter)
        setup_.timer->begin(condition, start.seed, start.trial_index);
    attempt.step = start.staircase;
    apparatus_.start();
    state_ = std::move(attempt);
}

void Session::watchTrial() {
    if (setup_.timer != nullptr && attempt().condition->timed_by == plan::TimedBy::Experimenter)
        if (const auto said = setup_.timer->commandAt(attempt().clock.periods())) static_cast<void>(command(*said));
    apparatus_.advance(kTicksPerPoll);
    attempt().silent_polls = takeRecords() > 0 ? 0 : attempt().silent_polls + 1;
    if (losesDevice()) return;
    const bool silent = attempt().silent_polls >= kSilentPolls && !attempt().course.ended();
    if (silent) {
        std::vector<TrialEvent> events;
        attempt().course.abort(attempt().next_tick, "the loop delivers no records", events);
        appendEvents(events);
    }
    if (!attempt().course.ended()) return;
    finishTrial(silent ? std::optional(Verdict{Then::RepeatNow, Decider::Interruption}) : std::nullopt);
    if (silent && !is<Failed>()) {
        Error error;
        error.message = "the haptic loop delivers no records";
        fail("loop", {error});
    }
}

/// Keeps what happened to the devices; why the first of them that was lost was; empty: none was.
std::string Session::keepDeviceNews() {
    std::string loss;
    for (const DeviceNews& news : apparatus_.takeDeviceNews()) {
        Event event{.attempt = {}, .t_ns = now(), .source = "device", .event = news.event};
        if (running()) event.attempt = running()->id;
        event.payload_json = news.payload_json;
        sink_.appendEvent(event);
        if (loss.empty()) loss = news.loss;
    }
    return loss;
}

/// True: a device is not ready, so that the session is paused.
bool Session::losesDevice() {
    std::string loss = keepDeviceNews();
    if (!running()) loss = apparatus_.deviceNotReady(false);  // what was armed again meanwhile is no loss any more
    if (loss.empty()) return false;
    if (running()) abortRunning("device " + loss, Then::RepeatNow, Decider::Interruption);
    pauseHere();
    return true;
}

/// Takes all that the apparatus holds; how many records there were.
std::size_t Session::takeRecords() {
    std::array<TickRecord, kTakeAtOnce> buffer;
    std::size_t total = 0;
    while (const std::size_t count = apparatus_.takeRecords(buffer)) {
        const std::span<const TickRecord> records = std::span(buffer).first(count);
        sink_.appendRecords(attempt().id, 0, records);
        takeOtherHands();
        judge(records);
        total += count;
    }
    return total;
}

/// They are there when the first hand's are.
void Session::takeOtherHands() {
    std::array<TickRecord, kTakeAtOnce> buffer;
    for (std::size_t i = 0; i < attempt().others.size(); ++i) {
        while (const std::size_t count = apparatus_.takeRecordsOf(i + 1, buffer)) {
            const std::span<const TickRecord> records = std::span(buffer).first(count);
            sink_.appendRecords(attempt().id, i + 1, records);
            attempt().others[i].insert(attempt().others[i].end(), records.begin(), records.end());
        }
    }
}

void Session::judge(std::span<const TickRecord> records) {
    std::vector<TrialEvent> events;
    for (const TickRecord& record : records) {
        attempt().missing_ticks += record.tick - attempt().next_tick;
        attempt().clock.at(record);
        attempt().next_tick = record.tick + 1;
        if (attempt().secondary) attempt().secondary->follow(record);
        if (attempt().course.ended()) continue;
        attempt().course.follow(attempt().view.of(record, attempt().others),
                                attempt().view.all(record, attempt().others), events);
        // What is laid down before the start is then where it was left.
        if (attempt().course.started() || attempt().condition->scene.effects.picks())
            attempt().records.push_back(record);
    }
    appendEvents(events);
}

void Session::finishTrial(std::optional<Verdict> verdict) {
    LoopHealth health = apparatus_.stop();
    takeRecords();
    // From tick 0 to where a next tick would be.
    const std::int64_t periods = attempt().clock.until(std::max(attempt().next_tick, health.ticks));
    AttemptEnd end = describeEnd(std::move(health));
    if (!verdict) verdict = judgeByProtocol(end);
    end.then = verdict->then;
    end.decided_by = verdict->by;
    // Of two attempts at one trial at most one counts.
    if (end.valid && end.then != Then::Done) {
        end.valid = false;
        end.invalid_reason = fmt::format("{}: the trial is repeated", measures::outcomeName(end.outcome));
    }
    if (attempt().step)
        end.staircase = staircases_.take(attempt().id, trial(), *attempt().step, end.measures, end.valid);
    const auto finished = sink_.finishAttempt(attempt().id, end);
    session_ns_ += periods * kTickNanoseconds;
    if (!finished) return fail("finish attempt", finished.errors());
    takeEnd(attempt().id, end);
}

Session::Verdict Session::judgeByProtocol(const AttemptEnd& end) {
    const plan::Block& block = blockOf(agenda_.next());
    const int judged = ++past_[agenda_.next()].judged;
    const Then then = thenAfter(block, end.outcome, end.valid, judged);
    // A track that lacks an answer never finishes.
    const bool lacks = attempt().step && !attempt().step->track.empty() &&
                       !(end.valid && staircases_.answerTo(trial(), end.measures).has_value());
    if (then == Then::Done && lacks && judged < block.max_attempts) return {Then::RepeatAtBlockEnd, Decider::Protocol};
    return {then, Decider::Protocol};
}

/// The attempt is durable: the agenda moves on, and who waits for it is told.
void Session::takeEnd(AttemptId attempt, const AttemptEnd& end) {
    state_ = this->attempt().pauses_after ? State(Paused{}) : State(BetweenTrials{});
    last_ = agenda_.next();
    past_[*last_].last = attempt;
    if (end.valid) past_[*last_].counting = attempt;
    if (end.then == Then::Done) questionnaires_.remember({agenda_.trial(*last_), end.measures});
    agenda_.end(end.then);
    leaveOutNeedless();
    if (!listener_) return;
    AttemptEnded ended{agenda_.trial(*last_).trial_index,
                       end.outcome,
                       end.valid,
                       end.invalid_reason,
                       {},
                       attempt,
                       agenda_.finished(),
                       agenda_.planned() - agenda_.leftOut()};
    for (const measures::Value& value : end.measures)
        if (value.name == "trial_time_s") ended.trial_time_s = value.value;
    listener_(ended);
}

const plan::Block& Session::blockOf(std::size_t place) const {
    return setup_.plan->blocks.at(static_cast<std::size_t>(agenda_.trial(place).block_index));
}

bool Session::isWhole() const {
    for (std::size_t place = 0; place < past_.size(); ++place)
        if (lacks(staircases_, agenda_.trial(place), past_[place])) return false;
    return true;
}

AttemptEnd Session::describeEnd(LoopHealth health) {
    const TrialCourse& course = attempt().course;
    measures::TrialContext context = course.context();
    AttemptEnd end;
    if (attempt().secondary) {
        context.detections = attempt().secondary->detections(course.startTime(), course.endTime());
        end.detections = *context.detections;
    }
    end.end_ns = session_ns_ + course.endTime() * kTickNanoseconds;
    end.outcome = context.outcome;
    const auto hands = attempt().view.recordsOfAll(attempt().records, attempt().others);
    if (context.watched) {
        std::vector<measures::TickOverlap> overlaps = measures::ticksToJudge(attempt().records, context, hands);
        if (!overlaps.empty() && apparatus_.measureOverlaps(attempt().records, attempt().others, overlaps))
            context.overlaps = overlaps;
    }
    end.overlaps = context.overlaps;
    if (const auto* assembly = std::get_if<measures::AssemblyFacts>(&context.form))
        end.steps = stepEnds(*attempt().condition, assembly->steps);
    std::vector<TickRecord> judged;
    for (const TickRecord& record : attempt().records) judged.push_back(attempt().view.of(record, attempt().others));
    end.measures = measures::computeMeasures(judged, context, hands);
    end.timing_measured = setup_.timing_measured;

    health.dropped_records = std::max(health.dropped_records, attempt().missing_ticks);
    if (course.state() == TrialState::Aborted)
        end.invalid_reason = course.abortReason();
    else if (health.dropped_records > 0)
        end.invalid_reason = fmt::format("{} tick records lost", health.dropped_records);
    else
        end.invalid_reason = loopFault(course, setup_.plan->max_missed_share);
    // Nobody looks at the pictures of a simulated participant, and where the program does not time a trial nothing
    // moves.
    const bool seen = health.presentation && course.started() &&
                      plan::kindOfCode(setup_.participant) != plan::ParticipantKind::Simulated &&
                      attempt().condition->timed_by == plan::TimedBy::Program;
    if (end.invalid_reason.empty() && seen)
        end.invalid_reason =
            pictureFault(*health.presentation, setup_.plan->view, static_cast<double>(course.length()) * kTickSeconds);
    if (end.invalid_reason.empty()) end.invalid_reason = attempt().invalidated;
    end.valid = end.invalid_reason.empty();
    end.health = std::move(health);
    return end;
}

void Session::appendEvents(const std::vector<TrialEvent>& events) {
    for (const TrialEvent& happened : events) {
        Event event;
        event.attempt = attempt().id;
        event.t_ns = session_ns_ + happened.time * kTickNanoseconds;
        event.source = "session";
        event.event = happened.name;
        if (event.event == "aborted")
            event.payload_json = JsonObject().text("reason", attempt().course.abortReason()).str();
        if (happened.step) event.payload_json = stepJson(*attempt().condition, *happened.step);
        sink_.appendEvent(event);
    }
}

void Session::finish(State over) {
    state_ = std::move(over);
    const auto finished = sink_.finishSession(is<Complete>() && isWhole(), session_ns_);
    // Of a session that has failed already most likely the same once more.
    if (!finished && !is<Failed>()) state_ = Failed{finished.errors()};
}

void Session::note(const char* name, const std::string& payload_json) {
    Event event;
    event.t_ns = session_ns_;
    event.source = "session";
    event.event = name;
    event.payload_json = payload_json;
    sink_.appendEvent(event);
}

void Session::note(const char* name, const char* key, const std::string& text) {
    note(name, JsonObject().text(key, text).str());
}

void Session::fail(const char* stage, const Errors& errors) {
    note("session_failed", "stage", stage);
    finish(Failed{errors});
}

}  // namespace passung::session
