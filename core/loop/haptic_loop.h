#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <thread>
#include <vector>

#include "core/base/tick_record.h"
#include "core/loop/haptic_device.h"
#include "core/loop/record_ring.h"
#include "core/loop/timing.h"
#include "core/tick/scene_sequence.h"

namespace passung::loop {

inline constexpr std::int64_t kDisplayHz = 60;

/// Tells whether the display of a simulated person gets a picture with this tick.
constexpr bool hasPicture(std::int64_t tick) noexcept {
    return tick == 0 || tick * kDisplayHz / 1000 != (tick - 1) * kDisplayHz / 1000;
}

/// Gets every tick once its wrench is commanded, in the loop's thread.
class TickListener {
public:
    virtual ~TickListener() = default;
    virtual void take(const TickRecord& record) noexcept = 0;  // rt-safe
};

/// What a hand of the scene holds, and the ring that gets its records.
struct HandPort {
    HapticDevice* device = nullptr;
    RecordRing* ring = nullptr;
};

/// The haptic cycle, whatever clock drives it: read the devices, compute the tick, command the wrenches, record.
class HapticCycle {
public:
    /// Of a scene with one hand. `show_proxy`: the display draws the proxy, otherwise the device's pose. `screens` get
    /// every tick too; what they drop matters to nobody. Borrows everything.
    HapticCycle(const tick::TickModel& model, HapticDevice& device, RecordRing& ring, bool show_proxy,
                std::span<ScreenRing* const> screens = {});
    /// Of scenes that are rendered one after the other, each with `hands`, in their order. `listener`: to the first
    /// hand's records. Not `timed`: no clock is read, all times are 0.
    HapticCycle(std::span<const tick::SceneTurn> turns, std::span<const HandPort> hands, bool show_proxy,
                std::span<ScreenRing* const> screens = {}, TickListener* listener = nullptr, bool timed = true);

    /// One cycle. `missed`: cycles that were missed since the previous one, because it ended after its deadline; for
    /// the record, which else could not tell how much time lies between two ticks. rt-safe.
    void run(std::uint32_t missed = 0) noexcept;

    /// Commands zero wrenches. rt-safe.
    void release() noexcept;

    std::int64_t ticks() const { return scenes_.tick(); }
    std::uint64_t stateHash() const { return scenes_.hash(); }
    /// Energies as tick::SceneSequence gives them.
    std::vector<tick::PairAccount> pairs() const { return scenes_.pairs(); }
    /// Computing time of the ticks, by the wall clock.
    const TimingHistogram& timing() const { return timing_; }
    /// Of it what the calling thread spent on a processor.
    const TimingHistogram& processorTiming() const { return processor_timing_; }

private:
    struct Times {
        std::int64_t begin = 0, wall = 0, processor = 0;  // when it began, how long it took [ns]
    };
    void compute(Times& times) noexcept;
    void show(std::int64_t tick, bool running) noexcept;

    tick::SceneSequence scenes_;
    std::vector<HandPort> hands_;
    std::vector<DeviceReading> readings_;  // of the newest tick, as the others
    std::vector<tick::TickOutput> outputs_;
    bool show_proxy_;
    std::span<ScreenRing* const> screens_;
    TickListener* listener_;  // may be null
    bool timed_;
    std::uint64_t pictures_ = 0;
    TimingHistogram timing_, processor_timing_;
};

/// How the real-time thread runs on this machine.
struct Scheduling {
    bool fifo = false;           // SCHED_FIFO was granted
    bool memory_locked = false;  // mlockall was granted
};

/// Drives a cycle at 1 kHz in a thread of its own: absolute timer, then a short spin. The thread asks for SCHED_FIFO
/// and locked memory and goes on without them. Locked is all memory of the program, so one whose libraries give pages
/// back to the system and do not bear a refusal, such as a QML engine, must not ask for it.
class RealTimeThread {
public:
    explicit RealTimeThread(HapticCycle& cycle, bool lock_memory = true);
    ~RealTimeThread();  // stops
    RealTimeThread(const RealTimeThread&) = delete;
    RealTimeThread& operator=(const RealTimeThread&) = delete;

    /// Ends after the running cycle and releases the device.
    void stop();

    /// Stops as stop() does, without waiting for the end. From any thread.
    void askToStop() noexcept { running_.store(false); }

    std::int64_t ticks() const noexcept { return ticks_.load(std::memory_order_acquire); }
    /// Cycles missed between the first tick and the last: the records' periods less one each, summed up.
    std::int64_t overruns() const noexcept { return overruns_.load(std::memory_order_relaxed); }
    Scheduling scheduling() const noexcept { return {fifo_.load(), locked_.load()}; }
    /// How late the cycles began; read after stop().
    const TimingHistogram& lateness() const { return lateness_; }

private:
    void main();

    HapticCycle& cycle_;
    bool lock_memory_;
    std::atomic<bool> running_{true};
    std::atomic<bool> fifo_{false}, locked_{false};
    std::atomic<std::int64_t> ticks_{0}, overruns_{0};
    TimingHistogram lateness_;
    std::thread thread_;  // last: starts when everything else is there
};

}  // namespace passung::loop
