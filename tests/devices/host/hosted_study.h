#pragma once

#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "devices/backends/backends.h"
#include "tests/devices/fakes/calls_until_zero.h"
#include "tests/devices/fakes/shared_block.h"
#include "tests/devices/host/host_processes.h"
#include "tests/devices/unit/scripted_link.h"
#include "tests/support/length.h"

/// Studies on a unit whose library, a shim, lives in a device host. What differs between shims is their `Fake`: its
/// Block, Device and Hand, the block's variable, the host's file kHost, push(), the wrench of the loop, choice() of a
/// unit, device() of a block by serial number, runByClock() of the shim, shake() and disturb() of a device, and felt()
/// of a command, the force along our x.
namespace passung::host {

using loop::DeviceState;
using unit::reached;
using Steady = std::chrono::steady_clock;

inline constexpr int kHeartbeat = 5;  // [ms]

/// The loop of a study: opens the unit and pushes, once a millisecond, with a hand that trembles at the shim.
template <class Fake>
class Study {
public:
    explicit Study(typename Fake::Block& block, const std::string& serial = {}) : block_(block), serial_(serial) {
        setenv("PASSUNG_DEVICE_HOST", Fake::kHost, 1);
        Fake::runByClock(block);
        auto opened = backends::open(Fake::choice(serial));
        if (!opened) throw std::runtime_error(opened.errors().front().message);
        unit = *std::move(opened);
    }

    bool becomes(DeviceState state) {
        return reached([&] { return unit->state() == state; });
    }
    typename Fake::Device& device() { return Fake::device(block_, serial_); }
    void tremble() { Fake::shake(device(), 1e-5 * static_cast<double>(++trembled_ % 7)); }
    /// One cycle; waits for its servo call a while.
    DeviceReading tick(const Wrench& F = Fake::push()) {
        tremble();
        const std::int64_t before = device().commands.count();
        DeviceReading reading = unit->read();
        unit->command(F);
        for (int i = 0; i < 200 && device().commands.count() == before; ++i) poll(nullptr, 0, i < 100 ? 0 : 1);
        return reading;
    }
    void begin(int ticks = 20) {
        ASSERT_TRUE(becomes(DeviceState::Present)) << unit->trouble();
        // A machine that keeps it waiting for 50 ms is no fault here.
        ASSERT_TRUE(reached([&] {
            unit->arm();
            return unit->state() == DeviceState::Ready;
        })) << unit->trouble();
        unit->lend({});
        unit->takeNews();
        for (int i = 0; i < ticks; ++i) tick();
    }
    bool pushes() {
        return reached([&] {
            tick();
            return Fake::felt(device().commands.last()) == 2.0;
        });
    }
    std::vector<std::string> losses() {
        std::vector<std::string> all;
        for (const unit::UnitNews& news : unit->takeNews())
            if (news.isLoss()) all.push_back(news.why);
        return all;
    }

    std::unique_ptr<unit::Unit> unit;

private:
    typename Fake::Block& block_;
    std::string serial_;
    int trembled_ = 0;
};

/// Whatever is read and asked, the wrench stays within the limits and is zero unless the unit is ready, but for what is
/// on its way, `late` ticks at most. By the shim's own account of every call. PASSUNG_LONG=1: a million ticks.
template <class Fake>
void expectLimitsWhateverComes(double max_force, double max_torque, int late) {
    fake::SharedBlock<typename Fake::Block> block(Fake::kVariable);
    Study<Fake> study(*block);
    study.begin();
    std::mt19937 random(22);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const auto number = [&]() -> double {
        switch (random() % 24) {
            case 0:
                return std::numeric_limits<double>::quiet_NaN();
            case 1:
                return std::numeric_limits<double>::infinity();
            case 2:
                return 1e300 * any(random);
            case 3:
                return 100.0 * any(random);
            default:
                return any(random);
        }
    };
    std::int64_t seen = study.device().commands.count(), pushed = 0;
    int not_ready = 0;
    const int ticks = test::atFullLength() ? 1'000'000 : 4000;
    for (int i = 0; i < ticks; ++i) {
        typename Fake::Hand hand;
        for (double& x : hand.position) x = 1e-3 * any(random);
        if (random() % 20 == 0) hand.position[random() % 3] = number();
        if (random() % 20 == 0) hand.frame[random() % 9] = number();
        if (random() % 50 == 0) Fake::disturb(study.device());
        study.device().hand.store(hand);
        if (random() % 4 == 0) study.unit->arm();
        const bool ready = study.unit->state() == DeviceState::Ready;
        Wrench F;
        for (int k = 0; k < 3; ++k) {
            F.force[k] = 20.0 * number();
            F.torque[k] = 0.3 * number();
        }
        const auto before = study.device().commands.count();
        study.unit->read();
        study.unit->command(F);
        for (int k = 0; k < 3000 && study.device().commands.count() == before; ++k)
            k < 2000 ? static_cast<void>(sched_yield()) : static_cast<void>(poll(nullptr, 0, 1));
        bool was_ready = ready || study.unit->state() == DeviceState::Ready;
        for (const unit::UnitNews& news : study.unit->takeNews())
            was_ready = was_ready || news.state == DeviceState::Ready;
        not_ready = was_ready ? 0 : not_ready + 1;
        for (const auto count = study.device().commands.count(); seen < count; ++seen) {
            const auto command = study.device().commands.row(seen);
            const Vec3 force(command.asked[0], command.asked[1], command.asked[2]);
            const Vec3 torque(command.asked[3], command.asked[4], command.asked[5]);
            ASSERT_TRUE(force.allFinite() && torque.allFinite()) << "tick " << i;
            ASSERT_LE(force.norm(), max_force) << "tick " << i;
            ASSERT_LE(torque.norm(), max_torque) << "tick " << i;
            const bool zero = force.isZero(0.0) && torque.isZero(0.0);
            pushed += zero ? 0 : 1;
            if (not_ready > late) {
                ASSERT_TRUE(zero) << "tick " << i << ", not ready since " << not_ready;
            }
        }
    }
    EXPECT_EQ(study.device().non_finite, 0);
    EXPECT_GT(pushed, ticks / 50) << "it was ready at times";
    std::printf("%d ticks, %lld calls that push\n", ticks, static_cast<long long>(pushed));
}

/// A study in a process of its own, which can be stopped, killed and hung.
struct Watched {
    std::atomic<bool> pushing = false, hang = false, hung = false, go_on = false;
};
inline constexpr const char* kWatchedVariable = "PASSUNG_TEST_WATCHED";

/// What that process does. A disabled test, kRuns, calls it.
inline constexpr const char* kRuns = "DISABLED_Study.Runs";
template <class Fake>
void runForEver() {
    auto* block = fake::findBlock<typename Fake::Block>(Fake::kVariable);
    auto* watched = fake::findBlock<Watched>(kWatchedVariable);
    ASSERT_TRUE(block != nullptr && watched != nullptr);
    Study<Fake> study(*block);
    study.begin();
    for (;;) {
        study.tick();
        if (!watched->pushing) {
            study.unit->arm();
            watched->pushing = Fake::felt(study.device().commands.last()) == 2.0;
        }
        while (watched->hang && !watched->go_on) {
            watched->hung = true;
            poll(nullptr, 0, 1);
        }
    }
}

class StudyProcess {
public:
    StudyProcess() {
        child_ = fork();
        if (child_ == 0) {
            const std::string filter = std::string("--gtest_filter=") + kRuns;
            execl("/proc/self/exe", "study", "--gtest_also_run_disabled_tests", filter.c_str(), "--gtest_brief=1",
                  nullptr);
            _exit(127);
        }
    }
    ~StudyProcess() {
        kill(child_, SIGKILL);
        waitpid(child_, nullptr, 0);
    }
    StudyProcess(const StudyProcess&) = delete;
    StudyProcess& operator=(const StudyProcess&) = delete;

    /// Sends it, and waits until it has done what it does.
    void send(int signal) const {
        kill(child_, signal);
        siginfo_t info{};
        waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WSTOPPED | WNOWAIT);
    }
    void resume() const { kill(child_, SIGCONT); }
    pid_t id() const { return child_; }

private:
    pid_t child_;
};

/// How many servo calls until zero, and how long, after the study was killed, stopped or hung.
template <class Fake>
struct Stops {
    fake::SharedBlock<typename Fake::Block> block{Fake::kVariable};
    fake::SharedBlock<Watched> watched{kWatchedVariable};
    std::vector<double> wall_ms;
    std::int64_t most_calls = 0;

    typename Fake::Device& device() { return block->devices[0]; }
    bool pushesFully() {
        return reached([&] { return watched->pushing && Fake::felt(device().commands.last()) == 2.0; });
    }
    void expectZeroSoon(std::int64_t from, Steady::time_point since) {
        ASSERT_TRUE(reached([&] { return fake::callsUntilZero(device().commands, from).has_value(); }));
        wall_ms.push_back(std::chrono::duration<double, std::milli>(Steady::now() - since).count());
        poll(nullptr, 0, 10);
        const auto calls = fake::callsUntilZero(device().commands, from);
        ASSERT_TRUE(calls.has_value()) << "it stays zero";
        EXPECT_LE(*calls, kHeartbeat + 2);
        most_calls = std::max(most_calls, *calls);
    }
    ~Stops() {
        if (wall_ms.empty()) return;
        std::sort(wall_ms.begin(), wall_ms.end());
        std::printf("%zu times: zero after %lld calls at most; wall time median %.1f ms, worst %.1f ms\n",
                    wall_ms.size(), static_cast<long long>(most_calls), wall_ms[wall_ms.size() / 2], wall_ms.back());
    }
};

inline int times() { return test::atFullLength() ? 100 : 5; }

template <class Fake>
void expectNoForceOfAKilledStudy() {
    Stops<Fake> stops;
    for (int i = 0; i < times(); ++i) {
        stops.watched->pushing = false;
        const StudyProcess study;
        ASSERT_TRUE(stops.pushesFully());
        const auto since = Steady::now();
        study.send(SIGKILL);
        stops.expectZeroSoon(stops.device().commands.count(), since);
        ASSERT_TRUE(reached([&] { return !stops.device().opened; })) << "the host has gone too";
    }
}

/// One that goes on within 50 ms gets its force back step by step; one that was slower never, for nobody arms it.
template <class Fake>
void expectNoForceOfAStoppedStudy() {
    Stops<Fake> stops;
    int ramped = 0;
    for (int i = 0; i < times(); ++i) {
        stops.watched->pushing = false;
        const StudyProcess study;
        ASSERT_TRUE(stops.pushesFully());
        const auto since = Steady::now();
        study.send(SIGSTOP);
        stops.expectZeroSoon(stops.device().commands.count(), since);
        const auto zero_at = stops.device().commands.count();
        study.resume();
        poll(nullptr, 0, 80);
        double last = 0.0;
        int steps = 0;
        for (auto row = zero_at; row < stops.device().commands.count(); ++row) {
            const double felt = Fake::felt(stops.device().commands.row(row));
            EXPECT_LT(felt - last, 1.0) << "no step back to the 2 N";
            steps += felt > last ? 1 : 0;
            last = felt;
        }
        ramped += steps > 5 ? 1 : 0;
        if (steps == 0) {
            EXPECT_EQ(last, 0.0) << "latched";
        }
    }
    std::printf("%d of %d ramped back\n", ramped, times());
}

/// Beyond 50 ms the host's latch holds, and the unit is told stale.
template <class Fake>
void expectNoForceAfterALongStop() {
    Stops<Fake> stops;
    const StudyProcess study;
    ASSERT_TRUE(stops.pushesFully());
    const auto since = Steady::now();
    study.send(SIGSTOP);
    stops.expectZeroSoon(stops.device().commands.count(), since);
    poll(nullptr, 0, 100);
    const auto from = stops.device().commands.count();
    study.resume();
    ASSERT_TRUE(reached([&] { return stops.device().commands.count() > from + 50; }));
    EXPECT_LE(fake::callsUntilZero(stops.device().commands, from).value_or(99), 1);
}

/// Servo calls from the first after the loop's last.
template <class Fake>
void expectNoForceOfAHungStudy() {
    Stops<Fake> stops;
    for (int i = 0; i < times(); ++i) {
        stops.watched->pushing = stops.watched->hang = stops.watched->hung = false;
        const StudyProcess study;
        ASSERT_TRUE(stops.pushesFully());
        const auto since = Steady::now();
        stops.watched->hang = true;
        ASSERT_TRUE(reached([&] { return stops.watched->hung.load(); }));
        stops.expectZeroSoon(stops.device().commands.count(), since);
    }
}

}  // namespace passung::host
