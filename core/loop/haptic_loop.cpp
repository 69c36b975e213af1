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
    : HapticCycle(std::array{tick::SceneTurn{&model}}, device, ring, show_proxy, screens) {}

HapticCycle::HapticCycle(std::span<const tick::SceneTurn> turns, HapticDevice& device, RecordRing& ring,
                         bool show_proxy, std::span<ScreenRing* const> screens, TickListener* listener, bool timed)
    : scenes_(turns),
      device_(device),
      ring_(ring),
      show_proxy_(show_proxy),
      screens_(screens),
      listener_(listener),
      timed_(timed) {}

/// The clock of the processor is the slower to read: outside, where it does not count as the tick's wall time.
tick::TickOutput HapticCycle::compute(const DeviceReading& reading, Times& times) noexcept {
    if (!timed_) return scenes_.step(reading);
    const std::int64_t processor_begin = threadProcessorNanoseconds();
    times.begin = now();
    const tick::TickOutput output = scenes_.step(reading);
    times.wall = now() - times.begin;
    times.processor = threadProcessorNanoseconds() - processor_begin;
    timing_.add(times.wall);
    processor_timing_.add(times.processor);
    return output;
}

void HapticCycle::run(std::uint32_t missed) noexcept {
    const std::int64_t tick = scenes_.tick();
    DeviceReading reading = device_.read();
    reading.periods = 1 + missed;
    Times times;
    const tick::TickOutput output = compute(reading, times);
    device_.command(output.F_D_B);

    TickRecord record = tick::makeRecord(tick, reading, output);
    record.duration_ns = times.wall;
    record.processor_ns = times.processor;
    ring_.tryPush(record);
    for (ScreenRing* screen : screens_) screen->tryPush({record, times.begin});
    if (listener_ != nullptr) listener_->take(record);

    if (hasPicture(tick)) {
        const bool running = (output.frame.status & kEngaged) != 0;
        device_.show({tick, show_proxy_ ? output.X_WG : output.frame.X_WH, running});
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
