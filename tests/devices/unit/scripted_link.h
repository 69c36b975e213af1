#pragma once

#include <poll.h>
#include <sched.h>

#include <functional>
#include <mutex>
#include <vector>

#include "devices/unit/link.h"
#include "devices/unit/linked_unit.h"

namespace passung::unit {

/// The other side of a link that a test writes: what each exchange gives, and what wrench it got. It outlives the link.
struct Script {
    std::mutex mutex;
    bool there = true;  // open() finds it
    std::function<Exchange(std::int64_t)>
        answers;  // by the number of the exchange, from 0 since the last say() or open
    std::vector<Wrench> got;
    std::vector<std::int64_t> stamps;           // of each
    std::vector<loop::DeviceState> state_then;  // of the unit, before each exchange
    std::function<loop::DeviceState()> state;
    int opened = 0;
    std::int64_t since = 0;

    std::size_t count() {
        const std::lock_guard lock(mutex);
        return got.size();
    }
    void say(std::function<Exchange(std::int64_t)> what) {
        const std::lock_guard lock(mutex);
        answers = std::move(what);
        since = 0;
    }
    void plug(bool in) {
        const std::lock_guard lock(mutex);
        there = in;
    }
};

class ScriptedLink final : public Link {
public:
    explicit ScriptedLink(Script& script) : script_(script) {}
    Result<DeviceUnit> open() override {
        const std::lock_guard lock(script_.mutex);
        if (!script_.there) return Error{.message = "nothing is plugged in: plug it in"};
        script_.since = 0;
        ++script_.opened;
        return DeviceUnit{.hand = "right", .kind = "sigma7", .backend = "scripted", .serial = "7"};
    }
    Exchange exchange(const Wrench& F_D_B, std::chrono::milliseconds) override {
        const std::lock_guard lock(script_.mutex);
        script_.got.push_back(F_D_B);
        script_.state_then.push_back(script_.state ? script_.state() : loop::DeviceState::Absent);
        if (!script_.there) return {Exchange::Kind::Gone, {}, "unplugged"};
        return script_.answers ? script_.answers(script_.since++) : Exchange{};
    }
    void stamp(std::int64_t made_at) noexcept override {
        const std::lock_guard lock(script_.mutex);
        script_.stamps.push_back(made_at);
    }
    void close() noexcept override {}

private:
    Script& script_;
};

/// A unit that says where it is; it moves a little with each message, as a hand does.
inline Exchange pose(const Vec3& p) {
    Exchange exchange{Exchange::Kind::News, {}, {}};
    exchange.said.X_BD.p = p;
    return exchange;
}
inline Exchange trembling(std::int64_t n) { return pose(Vec3(1e-6 * static_cast<double>(n % 2), 0, 0)); }

/// Waits for the unit's own thread, up to a minute, which only what hangs reaches.
constexpr int kSpins = 200;  // what comes within microseconds is not slept for
template <class Done>
bool reached(Done done) {
    for (int i = 0; i < 60000; ++i) {
        if (done()) return true;
        i < kSpins ? static_cast<void>(sched_yield()) : static_cast<void>(poll(nullptr, 0, 1));
    }
    return false;
}

}  // namespace passung::unit
