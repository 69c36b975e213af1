#include "ui/window/desk.h"

#include <array>

#include "ui/presenter/participant.h"

namespace passung::window {

namespace {

constexpr int kFrame = 16;  // [ms]

}  // namespace

Desk::Desk(std::string data) : data_(std::move(data)) {
    timer_.setTimerType(Qt::PreciseTimer);
    timer_.setInterval(kFrame);
    connect(&timer_, &QTimer::timeout, this, &Desk::refresh);
}

Desk::~Desk() { end(); }

void Desk::open(const plan::StudyPlan& plan, const std::string& language) {
    close();
    language_ = language;
    run_.open(plan);
    drawn_ = nullptr;
    emit opened();
    emit happened();
}

void Desk::start(const plan::StudyPlan& plan, window::LiveOptions options) {
    end();
    hand_ = options.hand;
    language_ = options.language;
    run_.open(plan);
    drawn_ = nullptr;
    options.frames = &frames_;
    options.sound = &sound_;
    live_ = std::make_unique<window::LiveSession>(plan, std::move(options));
    {
        const std::lock_guard lock(stop_mutex_);
        stoppable_ = live_.get();
    }
    timer_.start();
    emit opened();
    emit happened();
}

void Desk::tryOut(const plan::StudyPlan& plan, window::LiveHand hand, const std::string& language) {
    start(plan, {.database = data_ + "/" + plan.name + ".db", .hand = hand, .try_out = true, .language = language});
}

void Desk::handIn(const std::string& form, session::FilledForm filled) {
    if (live_) live_->interview().handIn(form, std::move(filled));
}

void Desk::pageRead(std::int64_t page, std::int64_t read_ms) {
    if (live_) live_->interview().pageRead(page, read_ms);
}

void Desk::goOn() {
    if (live_) live_->interview().goOn();
}

void Desk::command(session::Command command) {
    if (live_) live_->command(std::move(command));
}

void Desk::setDisplay(presenter::Display display) {
    if (run_.view().display == display) return;
    if (auto needed = run_.setDisplay(display)) command(std::move(*needed));
    emit happened();
}

void Desk::openDisplay() {
    if (run_.view().display == presenter::Display::Lost) setDisplay(presenter::Display::Closed);  // gets a new window
    if (run_.view().display != presenter::Display::Shown) emit displayWanted();
    setDisplay(presenter::Display::Shown);
}

/// What runs can be stopped until it has come to its end.
void Desk::end() {
    if (live_) live_->end();
    {
        const std::lock_guard lock(stop_mutex_);
        stoppable_ = nullptr;
    }
    live_.reset();
}

void Desk::stopNow() {
    const std::lock_guard lock(stop_mutex_);
    if (stoppable_ != nullptr) stoppable_->command({.kind = session::CommandKind::Stop});
}

void Desk::close() {
    end();
    timer_.stop();
}

void Desk::drawsWith(const presenter::QualityFound& found) {
    run_.drawsWith(found);
    if (live_) live_->drawsWith(found);
    emit happened();
}

/// The pictures that the participant's window has shown, and which attempt it waits to show.
void Desk::checkPictures() {
    std::array<run::Picture, 64> pictures;
    while (const std::size_t count = frames_.takeForScreen(pictures))
        for (std::size_t i = 0; i < count; ++i) run_.see(pictures[i].began_ns, pictures[i].presented_ns);
    run_.checkPictures(run::steadyNanoseconds());
    if (run_.checkFirstPicture(frames_.hasShown(awaited_))) emit happened();
}

mouse::Pointer* Desk::pointer() { return byMouse() ? &live_->pointer() : nullptr; }

void Desk::refresh() {
    // Ticks first: what is still to come of an attempt that is over was before the news of the next one.
    std::array<loop::ScreenTick, 256> ticks;
    std::optional<loop::ScreenTick> newest;
    while (const std::size_t count = live_->takeTicks(ticks)) {
        take(std::span(ticks).first(count));
        newest = ticks[count - 1];
    }
    show(live_->takeNews(), newest);
    if (!run_.view().isRunning()) timer_.stop();
}

void Desk::bring(const std::vector<presenter::News>& news, std::span<const loop::ScreenTick> ticks) {
    take(ticks);
    show(news, ticks.empty() ? std::nullopt : std::optional(ticks.back()));
}

void Desk::take(std::span<const loop::ScreenTick> ticks) {
    std::vector<TickRecord> records;
    records.reserve(ticks.size());
    for (const loop::ScreenTick& tick : ticks) {
        TickRecord& record = records.emplace_back(tick.record);
        if (!tick.engaged) record.status &= ~std::uint32_t{kEngaged};  // a trial begins with all hands
    }
    run_.take(records);
    run_.follow(ticks);
    if (ticks.empty() || !run_.scene()) return;
    const bool proxy = run_.scene()->shown == plan::ShownPose::Proxy;
    std::vector<Pose> X_WOthers;
    for (const loop::HeldPart& other : ticks.back().others) X_WOthers.push_back(proxy ? other.X_WG : other.X_WH);
    run_.place(std::move(X_WOthers));
}

/// `newest`: the tick that the windows stand in from now on, if there is one since the last call.
void Desk::show(const std::vector<presenter::News>& news, const std::optional<loop::ScreenTick>& newest) {
    bool prepares = false;
    for (const presenter::News& what : news) {
        run_.take(what);
        if (const auto* attempt = std::get_if<presenter::AttemptPrepared>(&what)) {
            awaited_ = attempt->shown_as;
            prepares = true;
        }
    }
    checkPictures();
    if (run_.view().brief.sound && !speaker_) speaker_ = openSpeaker(sound_);
    if (byMouse() && newest && run_.last()) {
        const Pose X_W = run_.scene() ? presenter::pointerPose(*run_.scene(), *run_.last())
                                      : presenter::pointerPose({}, *run_.last());
        live_->pointer().keepNear(X_W, 2.0 * live_->reach(), 2.0 * live_->swing());
    }
    if (run_.scene().get() != drawn_) {
        drawn_ = run_.scene().get();
        emit sceneChanged();
    }
    if (!news.empty()) emit happened();
    if (prepares) emit prepared(awaited_);
    if (!newest) return;
    emit frame();
    if (prepares) return;  // the tick is of the attempt before
    const presenter::ParticipantView view = presenter::participantView(run_, !byMouse());
    frames_.show(*newest, view.scene && view.cue > 0.0);
}

}  // namespace passung::window
