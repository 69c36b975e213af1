#include "ui/presenter/run.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace passung::presenter {

using session::CommandKind;
using session::SessionState;

namespace {

RowState rowStateOf(measures::Outcome outcome, bool valid) {
    if (outcome == measures::Outcome::Aborted) return RowState::Aborted;
    if (!valid) return RowState::Invalid;
    switch (outcome) {
        case measures::Outcome::Success:
            return RowState::Success;
        case measures::Outcome::Timeout:
            return RowState::Timeout;
        case measures::Outcome::Failure:
        case measures::Outcome::Aborted:
            break;
    }
    return RowState::Failure;
}

bool hasEnded(RowState state) { return state >= RowState::Success && state != RowState::Skipped; }

}  // namespace

void Run::open(const plan::StudyPlan& plan) {
    *this = Run();
    view_.state = state::Opening();
    appearance_ = plan.view;
    view_.study = plan.title.empty() ? plan.name : plan.title;
    for (const auto& condition : plan.conditions) conditions_.push_back(condition.name);
}

void Run::take(const News& news) {
    std::visit(
        [this](const auto& what) {
            using What = std::decay_t<decltype(what)>;
            if constexpr (std::is_same_v<What, SessionBegun>) begin(what);
            if constexpr (std::is_same_v<What, FormDue>) ask(what);
            if constexpr (std::is_same_v<What, PageDue>) ask(what);
            if constexpr (std::is_same_v<What, AskedDone>) ask({});
            if constexpr (std::is_same_v<What, AttemptPrepared>) prepare(what);
            if constexpr (std::is_same_v<What, BuildProgress>) view_.state = state::Preparing{what.share};
            if constexpr (std::is_same_v<What, session::SessionEvent>) hear(what);
            if constexpr (std::is_same_v<What, CommandAnswered>) answer(what);
            if constexpr (std::is_same_v<What, RunOver>) finish(what);
        },
        news);
}

void Run::hear(const session::SessionEvent& event) {
    if (const auto* view = std::get_if<session::SessionView>(&event)) show(*view);
    if (const auto* ended = std::get_if<session::AttemptEnded>(&event)) end(*ended);
    if (const auto* warned = std::get_if<session::Warned>(&event)) view_.warnings.push_back(warned->text);
}

void Run::begin(const SessionBegun& begun) {
    appearance_ = begun.appearance;
    view_.quality = begun.quality;
    view_.participant = begun.participant;
    view_.planned = begun.trials.size();
    view_.rows.clear();
    for (const auto& trial : begun.trials) {
        TrialRow row;
        row.number = trial.trial_index + 1;
        row.block = trial.block;
        row.phase = trial.phase;
        if (trial.condition < conditions_.size()) row.condition = conditions_[trial.condition];
        view_.rows.push_back(std::move(row));
    }
    for (const session::EarlierTrial& trial : begun.earlier) {
        if (trial.place >= view_.rows.size()) continue;
        TrialRow& row = view_.rows[trial.place];
        row.state = rowStateOf(trial.outcome, trial.valid);
        row.attempts = trial.attempts;
        row.time_s = trial.time_s;
        row.remark = trial.invalid_reason;
    }
    ++view_.rows_changed;
}

void Run::ask(FormOrPage asked) {
    view_.asked = std::move(asked);
    if (view_.session.state == SessionState::BetweenTrials) view_.state = between();
}

/// What goes on while no trial does.
RunState Run::between() const {
    if (const auto form = view_.form()) return form->consent ? RunState(state::Consenting()) : state::Answering();
    if (view_.page() != nullptr) return state::ReadingPage();
    if (view_.session.rest) return state::Resting{*view_.session.rest};
    return view_.planned > 0 ? RunState(state::Between()) : state::Opening();
}

void Run::prepare(const AttemptPrepared& prepared) {
    view_.asked = {};
    view_.brief = prepared.brief;
    pair_.reset();
    view_.state = state::Preparing();
    view_.number = prepared.trial_index + 1;
    view_.condition = prepared.condition;
    view_.trial_s = view_.force_N = view_.depth_mm = 0.0;
    if (prepared.scene) scene_ = prepared.scene;
    poses_ = scene_ ? PartPoses(*scene_) : PartPoses();
    last_.reset();
    time_ = 0.0;
    started_.reset();
    ticks_ = 0;
    missed_ = 0;
    view_.loop.reset();
    view_.pictures.reset();
    presented_ns_.clear();
    on_screen_ns_ = 0;
    force_.clear();
    depth_.clear();
}

void Run::show(const session::SessionView& session) {
    view_.session = session;
    if (view_.is<state::Preparing>()) view_.state = state::Preparing();  // its build has ended
    switch (session.state) {
        case SessionState::Ready:
            view_.state = state::Ready();
            break;
        case SessionState::Paused:
            view_.state = session.stopped ? RunState(state::Stopped()) : state::Paused();
            break;
        case SessionState::Preparing:
            if (!view_.is<state::AwaitingPicture>()) view_.state = state::Preparing();
            break;
        case SessionState::InTrial:
            view_.state = started_ ? RunState(state::Running()) : state::ToStart();
            break;
        case SessionState::BetweenTrials:
            view_.state = between();
            break;
        case SessionState::Complete:
        case SessionState::Failed:
        case SessionState::Interrupted:
            break;
    }
    view_.finished = static_cast<std::size_t>(std::count(session.over.begin(), session.over.end(), true));
    view_.number = session.next ? static_cast<std::int64_t>(*session.next) + 1 : 0;
    for (std::size_t place = 0; place < std::min(session.over.size(), view_.rows.size()); ++place) {
        TrialRow& row = view_.rows[place];
        const bool next = session.next == place;
        if (next)
            row.state = session.state == SessionState::InTrial ? RowState::Running : RowState::Next;
        else if (session.over[place])
            row.state = hasEnded(row.state) ? row.state : RowState::Skipped;
        else if (row.state != RowState::Invalid)
            row.state = RowState::Waiting;
    }
    ++view_.rows_changed;
}

void Run::end(const session::AttemptEnded& ended) {
    const auto place = static_cast<std::size_t>(ended.trial_index);
    if (place >= view_.rows.size()) return;
    view_.result.reset();
    const plan::ShownResult told = view_.brief.result;
    if (told != plan::ShownResult::None && ended.outcome != measures::Outcome::Aborted)
        view_.result = {ended.outcome == measures::Outcome::Success,
                        told == plan::ShownResult::Time ? ended.trial_time_s : std::nullopt};
    TrialRow& row = view_.rows[place];
    row.state = rowStateOf(ended.outcome, ended.valid);
    row.time_s = ended.trial_time_s;
    row.remark = ended.invalid_reason;
    ++row.attempts;
    ++view_.rows_changed;
}

void Run::answer(const CommandAnswered& answered) {
    view_.answered = answered;
    const bool starts = answered.answer.accepted && answered.command.kind == CommandKind::Start;
    if (starts && view_.session.state == SessionState::InTrial) startClock();
}

void Run::finish(const RunOver& over) {
    view_.asked = {};
    view_.session = session::viewWithoutSession();
    view_.state = over.complete ? RunState(state::Complete()) : state::Incomplete();
    view_.number = 0;
    if (!over.errors.empty()) view_.state = state::Failed{toString(over.errors.front())};
}

bool Run::checkFirstPicture(bool shown) {
    if (shown && view_.is<state::AwaitingPicture>())
        view_.state = state::Preparing();
    else if (!shown && view_.is<state::Preparing>() && !view_.built())
        view_.state = state::AwaitingPicture();
    else
        return false;
    return true;
}

std::optional<session::Command> Run::setDisplay(Display display) {
    const bool was_shown = view_.display == Display::Shown;
    view_.display = display;
    if (!was_shown || display == Display::Shown || !view_.isRunning()) return std::nullopt;
    return session::Command{.kind = CommandKind::Pause,
                            .text = display == Display::Closed ? "the participant's window was closed"
                                                               : "the participant's picture was lost",
                            .source = "window",
                            .now = true};
}

void Run::take(std::span<const TickRecord> records) {
    for (const TickRecord& record : records) watch(record);
    if (!records.empty()) judgeLoop();
}

void Run::follow(std::span<const loop::ScreenTick> ticks) {
    for (const loop::ScreenTick& tick : ticks) poses_.follow(tick);
}

void Run::startClock() {
    started_ = time_;
    view_.result.reset();
    if (view_.is<state::ToStart, state::Preparing, state::AwaitingPicture>()) view_.state = state::Running();
}

void Run::watch(const TickRecord& record) {
    if (record.tick == 0 || (last_ && record.tick <= last_->tick)) {  // another attempt
        time_ = 0.0;
        started_.reset();
        pair_.reset();
        ticks_ = 0;
        missed_ = 0;
    }
    time_ += record.periods * kTickSeconds;
    const bool by_hand = view_.brief.timed_by == plan::TimedBy::Experimenter;
    if ((record.status & kEngaged) != 0 && !started_ && !by_hand) startClock();
    if (started_ && view_.brief.kind == TrialBrief::Kind::Pair) {
        if (!pair_) pair_.emplace();
        pair_->follow(record, std::llround(time_ / kTickSeconds));
    }
    view_.trial_s = started_ ? time_ - *started_ : 0.0;
    view_.force_N =
        static_cast<double>(Eigen::Vector3f(record.force_N[0], record.force_N[1], record.force_N[2]).norm());
    view_.depth_mm = 1e3 * static_cast<double>(record.hand_depth_m);
    force_.add(time_, view_.force_N);
    depth_.add(time_, view_.depth_mm);
    const std::size_t slot = ticks_ % durations_us_.size();
    durations_us_[slot] = static_cast<float>(record.duration_ns) * 1e-3f;
    periods_[slot] = record.periods;
    ++ticks_;
    missed_ += record.periods - 1;
    last_ = record;
}

void Run::see(std::int64_t began_ns, std::int64_t presented_ns) {
    presented_ns_.push_back(presented_ns);
    on_screen_ns_ = began_ns;
}

void Run::checkPictures(std::int64_t now_ns) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    while (!presented_ns_.empty() && presented_ns_.front() <= now_ns - kSecond) presented_ns_.pop_front();
    view_.pictures.reset();
    if (!view_.is<state::ToStart, state::Running>() || !last_ || time_ < 1.0) return;
    view_.pictures = {static_cast<double>(presented_ns_.size()),
                      on_screen_ns_ == 0 ? 0.0 : 1e-6 * static_cast<double>(now_ns - on_screen_ns_)};
}

void Run::judgeLoop() {
    const std::size_t count = std::min(ticks_, durations_us_.size());
    std::vector<float> sorted(durations_us_.begin(), durations_us_.begin() + static_cast<std::ptrdiff_t>(count));
    std::sort(sorted.begin(), sorted.end());
    std::uint64_t periods = 0;
    for (std::size_t i = 0; i < count; ++i) periods += periods_[i];
    view_.loop = {.rate_hz = static_cast<double>(count) / (static_cast<double>(periods) * kTickSeconds),
                  .typical_us = sorted[count / 2],
                  .longest_us = sorted.back(),
                  .missed = missed_,
                  .ticks = count};
}

}  // namespace passung::presenter
