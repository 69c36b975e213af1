#include "ui/window/desk.h"

#include <algorithm>
#include <array>

namespace passung::window {

namespace {

constexpr int kFrame = 16;  // [ms]

}  // namespace

Desk::Desk(std::string data) : data_(std::move(data)) {
    timer_.setTimerType(Qt::PreciseTimer);
    timer_.setInterval(kFrame);
    connect(&timer_, &QTimer::timeout, this, &Desk::look);
}

Desk::~Desk() = default;

void Desk::start(const protocol::StudyPlan& plan, app::LiveOptions options) {
    live_.reset();
    hand_ = options.hand;
    language_ = options.language;
    run_.open(plan);
    drawn_ = nullptr;
    options.frames = &frames_;
    options.sound = &sound_;
    live_ = std::make_unique<app::LiveSession>(plan, std::move(options));
    timer_.start();
    emit opened();
    emit happened();
}

void Desk::tryOut(const protocol::StudyPlan& plan, app::LiveHand hand, const std::string& language) {
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
    setDisplay(presenter::Display::Shown);
}

void Desk::close() {
    live_.reset();
    timer_.stop();
}

mouse::Pointer* Desk::pointer() { return byMouse() ? &live_->pointer() : nullptr; }

void Desk::look() {
    // Ticks first: what is still to come of an attempt that is over was before the news of the next one.
    std::array<loop::ScreenTick, 256> ticks;
    std::array<TickRecord, 256> records;
    bool fresh = false;
    while (const std::size_t count = live_->takeTicks(ticks)) {
        std::transform(ticks.begin(), ticks.begin() + count, records.begin(),
                       [](const loop::ScreenTick& tick) { return tick.record; });
        run_.take(std::span(records).first(count));
        frames_.show(ticks[count - 1]);
        fresh = true;
    }
    const auto news = live_->takeNews();
    for (const presenter::News& what : news) run_.take(what);
    if (run_.view().sound && !speaker_) speaker_ = openSpeaker(sound_);
    if (byMouse() && fresh && run_.last()) {
        const auto& p = run_.last()->hand_position_m;
        const auto& q = run_.last()->hand_quaternion;
        live_->pointer().keepNear(
            {Eigen::Quaternionf(q[0], q[1], q[2], q[3]).cast<double>().normalized(), Vec3(p[0], p[1], p[2])},
            2.0 * live_->reach(), 2.0 * live_->swing());
    }
    if (run_.scene().get() != drawn_) {
        drawn_ = run_.scene().get();
        emit sceneChanged();
    }
    if (!news.empty()) emit happened();
    if (fresh) emit frame();
    if (!run_.view().isRunning()) timer_.stop();
}

}  // namespace passung::window
