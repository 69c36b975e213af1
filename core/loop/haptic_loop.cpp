#include "core/loop/haptic_loop.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "core/base/processor_clock.h"
#include "core/loop/cadence.h"

namespace passung::loop {

namespace {

constexpr int kPriority = 80;
constexpr std::int64_t kSpinNanoseconds = 100'000;  // the timer wakes up this much early, the rest is spun

std::int64_t now() noexcept {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

void sleepUntil(std::int64_t nanoseconds) noexcept {
    const std::int64_t wake = nanoseconds - kSpinNanoseconds;
    const timespec t{wake / 1'000'000'000, wake % 1'000'000'000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) != 0) {
    }
    while (now() < nanoseconds) {
    }
}

}  // namespace

HapticCycle::HapticCycle(const tick::TickModel& model, HapticDevice& device, RecordRing& ring, bool show_proxy,
                         std::span<ScreenRing* const> screens)
    : HapticCycle(std::array{tick::SceneTurn{&model}}, std::array{HandPort{&device, &ring}}, show_proxy, screens) {}

HapticCycle::HapticCycle(std::span<const tick::SceneTurn> turns, std::span<const HandPort> hands, bool show_proxy,
                         std::span<ScreenRing* const> screens, TickListener* listener, bool timed)
    : scenes_(turns),
      hands_(hands.begin(), hands.end()),
      readings_(hands.size()),
      outputs_(hands.size()),
      show_proxy_(show_proxy),
      screens_(screens),
      listener_(listener),
      timed_(timed) {}

void HapticCycle::release() noexcept {
    for (const HandPort& hand : hands_) hand.device->command(Wrench{});
}

/// The clock of the processor is the slower to read: outside, where it does not count as the tick's wall time.
void HapticCycle::compute(Times& times) noexcept {
    if (!timed_) return scenes_.step(readings_, outputs_);
    const std::int64_t processor_begin = threadProcessorNanoseconds();
    times.begin = now();
    scenes_.step(readings_, outputs_);
    times.wall = now() - times.begin;
    times.processor = threadProcessorNanoseconds() - processor_begin;
    timing_.add(times.wall);
    processor_timing_.add(times.processor);
}

void HapticCycle::run(std::uint32_t missed) noexcept {
    const std::int64_t tick = scenes_.tick();
    for (std::size_t i = 0; i < hands_.size(); ++i) {
        readings_[i] = hands_[i].device->read();
        readings_[i].periods = 1 + missed;
    }
    Times times;
    compute(times);
    for (std::size_t i = 0; i < hands_.size(); ++i) hands_[i].device->command(outputs_[i].F_D_B);

    ScreenTick shown{.record = {}, .began_ns = times.begin};
    shown.engaged = std::all_of(outputs_.begin(), outputs_.end(),
                                [](const tick::TickOutput& output) { return (output.frame.status & kEngaged) != 0; });
    for (std::size_t i = hands_.size(); i-- > 0;) {  // whoever has the first hand's record finds the others'
        TickRecord record = tick::makeRecord(tick, readings_[i], outputs_[i]);
        record.duration_ns = times.wall;
        record.processor_ns = times.processor;
        hands_[i].ring->tryPush(record);
        if (i == 0)
            shown.record = record;
        else
            shown.others[i - 1] = {outputs_[i].frame.X_WH, outputs_[i].X_WG, outputs_[i].held};
    }
    shown.at_rest = scenes_.atRest(static_cast<std::uint64_t>(tick));
    for (ScreenRing* screen : screens_) screen->tryPush(shown);
    if (listener_ != nullptr) listener_->take(shown.record);
    if (hasPicture(tick)) show(tick, shown.engaged);
}

void HapticCycle::show(std::int64_t tick, bool running) noexcept {
    DisplayedImage image{.tick = tick, .X_WShown = {}, .running = running};
    image.steps_done = outputs_.front().steps_done;
    image.at_rest = scenes_.atRest(pictures_++);
    for (std::size_t i = 0; i < hands_.size(); ++i) {
        image.X_WHeld[i] = show_proxy_ ? outputs_[i].X_WG : outputs_[i].frame.X_WH;
        image.held[i] = outputs_[i].held;
    }
    for (std::size_t i = 0; i < hands_.size(); ++i) {
        image.X_WShown = image.X_WHeld[i];
        hands_[i].device->show(image);
    }
}

RealTimeThread::RealTimeThread(HapticCycle& cycle, bool lock_memory)
    : cycle_(cycle), lock_memory_(lock_memory), thread_([this] { main(); }) {}

RealTimeThread::~RealTimeThread() { stop(); }

void RealTimeThread::stop() {
    askToStop();
    if (thread_.joinable()) thread_.join();
}

void RealTimeThread::main() {
    sched_param priority{};
    priority.sched_priority = kPriority;
    fifo_.store(pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority) == 0);
    locked_.store(lock_memory_ && mlockall(MCL_CURRENT | MCL_FUTURE) == 0);
    Cadence cadence(now() + kTickNanoseconds);
    std::int64_t missed = 0;
    while (running_.load(std::memory_order_relaxed)) {
        sleepUntil(cadence.due());
        lateness_.add(now() - cadence.due());
        cycle_.run(static_cast<std::uint32_t>(missed));
        overruns_.fetch_add(missed, std::memory_order_relaxed);
        ticks_.store(cycle_.ticks(), std::memory_order_release);
        missed = cadence.finish(now());
    }
    cycle_.release();
    if (locked_.load()) munlockall();
}

}  // namespace passung::loop
