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
    view_.state = RunState::Opening;
    appearance_ = plan.view;
    view_.study = plan.title.empty() ? plan.name : plan.title;
    for (const auto& condition : plan.conditions) conditions_.push_back(condition.name);
}

void Run::take(const News& news) {
    std::visit(
        [this](const auto& what) {
            using What = std::decay_t<decltype(what)>;
            if constexpr (std::is_same_v<What, SessionBegun>) begin(what);
            if constexpr (std::is_same_v<What, FormDue>) ask(what.form, std::nullopt);
            if constexpr (std::is_same_v<What, PageDue>) ask(nullptr, what);
            if constexpr (std::is_same_v<What, AskedDone>) ask(nullptr, std::nullopt);
            if constexpr (std::is_same_v<What, AttemptPrepared>) prepare(what);
            if constexpr (std::is_same_v<What, BuildProgress>) view_.built = what.share;
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

void Run::ask(std::shared_ptr<const FormRequest> form, std::optional<PageDue> page) {
    form_ = std::move(form);
    page_ = std::move(page);
    if (view_.session.state == SessionState::BetweenTrials) view_.state = between();
}

/// What goes on while no trial does.
RunState Run::between() const {
    if (form_) return form_->consent ? RunState::Consenting : RunState::Answering;
    if (page_) return RunState::Reading;
    if (view_.session.rest) return RunState::Resting;
    return view_.planned > 0 ? RunState::Between : RunState::Opening;
}

void Run::prepare(const AttemptPrepared& prepared) {
    form_.reset();
    page_.reset();
    brief_ = prepared.brief;
    view_.by_hand = brief_.timed_by == plan::TimedBy::Experimenter;
    pair_.reset();
    view_.state = RunState::Preparing;
    view_.number = prepared.trial_index + 1;
    view_.condition = prepared.condition;
    view_.trial_s = view_.force_N = view_.depth_mm = 0.0;
    if (prepared.scene) scene_ = prepared.scene;
    view_.sound = prepared.sound;
    last_.reset();
    time_ = 0.0;
    started_ = -1.0;
    ticks_ = 0;
    view_.loop = {};
    view_.pictures = {};
    presented_ns_.clear();
    on_screen_ns_ = 0;
    force_.clear();
    depth_.clear();
}

void Run::show(const session::SessionView& session) {
    view_.built.reset();
    view_.session = session;
    switch (session.state) {
        case SessionState::Ready:
            view_.state = RunState::Ready;
            break;
        case SessionState::Paused:
            view_.state = session.stopped ? RunState::Stopped : RunState::Paused;
            break;
        case SessionState::Preparing:
            view_.state = RunState::Preparing;
            break;
        case SessionState::InTrial:
            view_.state = started_ >= 0.0 ? RunState::Running : RunState::ToStart;
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
    result_.reset();
    if (brief_.result != plan::ShownResult::None && ended.outcome != measures::Outcome::Aborted)
        result_ = {ended.outcome == measures::Outcome::Success,
                   brief_.result == plan::ShownResult::Time ? ended.trial_time_s : std::nullopt};
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
    view_.built.reset();
    form_.reset();
    page_.reset();
    view_.session = session::viewWithoutSession();
    view_.state = over.complete ? RunState::Complete : RunState::Incomplete;
    view_.number = 0;
    if (over.errors.empty()) return;
    view_.state = RunState::Failed;
    view_.failure = toString(over.errors.front());
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

void Run::startClock() {
    started_ = time_;
    result_.reset();
    if (view_.state == RunState::ToStart || view_.state == RunState::Preparing) view_.state = RunState::Running;
}

void Run::watch(const TickRecord& record) {
    if (record.tick == 0 || (last_ && record.tick <= last_->tick)) {  // another attempt
        time_ = 0.0;
        started_ = -1.0;
        pair_.reset();
        ticks_ = 0;
        view_.loop.missed = 0;
    }
    time_ += record.periods * kTickSeconds;
    if ((record.status & kEngaged) != 0 && started_ < 0.0 && !view_.by_hand) startClock();
    if (started_ >= 0.0 && brief_.kind == TrialBrief::Kind::Pair) {
        if (!pair_) pair_.emplace();
        pair_->follow(record, std::llround(time_ / kTickSeconds));
    }
    view_.trial_s = started_ < 0.0 ? 0.0 : time_ - started_;
    view_.force_N =
        static_cast<double>(Eigen::Vector3f(record.force_N[0], record.force_N[1], record.force_N[2]).norm());
    view_.depth_mm = 1e3 * static_cast<double>(record.hand_depth_m);
    force_.add(time_, view_.force_N);
    depth_.add(time_, view_.depth_mm);
    const std::size_t slot = ticks_ % durations_us_.size();
    durations_us_[slot] = static_cast<float>(record.duration_ns) * 1e-3f;
    periods_[slot] = record.periods;
    ++ticks_;
    view_.loop.missed += record.periods - 1;
    last_ = record;
}

void Run::see(std::int64_t began_ns, std::int64_t presented_ns) {
    presented_ns_.push_back(presented_ns);
    on_screen_ns_ = began_ns;
}

void Run::checkPictures(std::int64_t now_ns) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    while (!presented_ns_.empty() && presented_ns_.front() <= now_ns - kSecond) presented_ns_.pop_front();
    const bool runs = view_.state == RunState::ToStart || view_.state == RunState::Running;
    view_.pictures.known = runs && last_ && time_ >= 1.0;
    view_.pictures.per_s = static_cast<double>(presented_ns_.size());
    view_.pictures.age_ms = on_screen_ns_ == 0 ? 0.0 : 1e-6 * static_cast<double>(now_ns - on_screen_ns_);
}

void Run::judgeLoop() {
    const std::size_t count = std::min(ticks_, durations_us_.size());
    std::vector<float> sorted(durations_us_.begin(), durations_us_.begin() + static_cast<std::ptrdiff_t>(count));
    std::sort(sorted.begin(), sorted.end());
    std::uint64_t periods = 0;
    for (std::size_t i = 0; i < count; ++i) periods += periods_[i];
    view_.loop.known = count == durations_us_.size();
    view_.loop.rate_hz = static_cast<double>(count) / (static_cast<double>(periods) * kTickSeconds);
    view_.loop.typical_us = sorted[count / 2];
    view_.loop.longest_us = sorted.back();
}

}  // namespace passung::presenter
