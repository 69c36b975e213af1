#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>

#include "devices/backends/backends.h"
#include "devices/host/hosted_unit.h"
#include "tests/devices/dhd/host_processes.h"
#include "tests/devices/fakes/calls_until_zero.h"
#include "tests/devices/fakes/dhd_block.h"
#include "tests/devices/unit/scripted_link.h"
#include "tests/support/length.h"

/// The whole way: a unit, its device host as a program of its own, and the shim of the vendor's library in that.
namespace passung::host {
namespace {

using fake::DhdBlock;
using fake::DhdFault;
using fake::SharedBlock;
using loop::DeviceState;
using unit::reached;
using Steady = std::chrono::steady_clock;

const Wrench kPush{Vec3(2, -1, 0.5), Vec3(0, 0, 0.1)};
constexpr int kHeartbeat = 5, kWatchdog = 20;  // [ms]

/// The loop of a study: opens the unit and pushes, once a millisecond, with a hand that trembles at the shim.
class Study {
public:
    explicit Study(DhdBlock& block, const std::string& serial = {}) : block_(block), serial_(serial) {
        setenv("PASSUNG_DEVICE_HOST", PASSUNG_DEVICE_HOST_FILE, 1);
        auto opened = backends::open({"right", "sigma7", "dhd", serial, PASSUNG_DHD_SHIM_FILE, {}});
        if (!opened) throw std::runtime_error(opened.errors().front().message);
        unit = *std::move(opened);
    }

    bool becomes(DeviceState state) {
        return reached([&] { return unit->state() == state; });
    }
    fake::DhdDevice& device() { return block_.devices[serial_ == "4712" ? 1 : 0]; }
    void tremble() {
        fake::DhdHand hand;
        hand.position[0] = 1e-5 * static_cast<double>(++trembled_ % 7);
        device().hand.store(hand);
    }
    /// One cycle; waits for its servo call a while.
    DeviceReading tick(const Wrench& F = kPush) {
        tremble();
        const std::int64_t before = device().commands.count();
        DeviceReading reading = unit->read();
        unit->command(F);
        for (int i = 0; i < 200 && device().commands.count() == before; ++i) poll(nullptr, 0, i < 100 ? 0 : 1);
        return reading;
    }
    void begin(int ticks = 20) {
        ASSERT_TRUE(becomes(DeviceState::Present)) << unit->trouble();
        unit->arm();
        ASSERT_TRUE(becomes(DeviceState::Ready)) << unit->trouble();
        unit->lend({});
        unit->takeNews();
        for (int i = 0; i < ticks; ++i) tick();
    }
    bool pushes() {
        return reached([&] {
            tick();
            return device().commands.last().felt[1] == 2.0;  // the vendor's y is our x
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
    DhdBlock& block_;
    std::string serial_;
    int trembled_ = 0;
};

bool isNoForce(const std::array<double, 7>& felt) {
    return std::all_of(felt.begin(), felt.end(), [](double component) { return component == 0.0; });
}

TEST(Sigma7Unit, PushesWithTheWrenchThatIsCommandedAndNotAfterwards) {
    // Truth: the shim's own account.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    {
        Study study(*block);
        study.begin();
        EXPECT_TRUE(study.pushes());
        const DeviceUnit who = study.unit->identity().value();
        EXPECT_EQ(who.backend + " " + who.kind + " " + who.serial, "dhd sigma7 4711");
        EXPECT_EQ(who.versions, "SDK 3.17.6.0, firmware 2.00");
        EXPECT_EQ(who.calibration, "axes y -x z; watchdog 20 ms; heartbeat 5 ms");
        EXPECT_EQ(test::hostsOf(getpid()).size(), 1u);
        study.unit->giveBack();
        const auto from = study.device().commands.count();
        ASSERT_TRUE(reached([&] { return study.device().commands.count() > from + 5; }));
        EXPECT_LE(fake::callsUntilZero(study.device().commands, from).value_or(99), 2);
    }
    EXPECT_TRUE(test::hostsOf(getpid()).empty());
    EXPECT_FALSE(block->devices[0].opened);
    EXPECT_TRUE(isNoForce(fake::feltAfterSilence(block->devices[0], 0)));
}

TEST(Sigma7Unit, TwoOfThemAreServedByTwoHosts) {
    // Truth: the shim's own account: each feels its own wrench.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    block->present = 2;
    block->swapped = true;
    Study right(*block, "4711"), left(*block, "4712");
    right.begin();
    left.begin();
    EXPECT_TRUE(reached([&] {
        right.tick({Vec3(1, 0, 0), Vec3::Zero()});
        left.tick({Vec3(3, 0, 0), Vec3::Zero()});
        return right.device().commands.last().felt[1] == 1.0 && left.device().commands.last().felt[1] == 3.0;
    }));
    EXPECT_EQ(test::hostsOf(getpid()).size(), 2u);
}

struct DeviceFault {
    const char* name;
    DeviceState state;
    const char* why;
    std::function<void(Study&)> happens, ends;
    bool reaches = true;  // zero can be commanded; else the device's watchdog has to end the force
};

class Sigma7Fault : public testing::TestWithParam<DeviceFault> {};

TEST_P(Sigma7Fault, TakesTheForceIsToldOnceAndComesBackWhenItIsArmed) {
    // Truth: the shim's own account: servo calls from the first that came after the fault was visible; for what can be
    // told nothing any more the device's watchdog.
    const DeviceFault& fault = GetParam();
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    Study study(*block);
    study.begin();
    ASSERT_TRUE(study.pushes());
    fault.happens(study);
    for (int i = 0; i < 5000 && study.unit->state() == DeviceState::Ready; ++i) {
        study.unit->read();
        study.unit->command(kPush);
        poll(nullptr, 0, 1);
    }
    ASSERT_EQ(study.unit->state(), fault.state) << study.unit->trouble();
    const auto visible = study.device().commands.count();
    for (int i = 0; i < 30; ++i) {
        study.unit->read();
        study.unit->command(kPush);
        poll(nullptr, 0, 1);
    }
    const auto calls = fake::callsUntilZero(study.device().commands, visible);
    if (fault.reaches) {
        EXPECT_LE(calls.value_or(99), 2);
        std::printf("%s: zero at call %d after the fault was seen\n", fault.name, static_cast<int>(calls.value_or(99)));
    } else {
        EXPECT_TRUE(isNoForce(fake::feltAfterSilence(study.device(), kWatchdog))) << "the device's watchdog";
    }
    fault.ends(study);
    ASSERT_TRUE(reached([&] {
        study.tick();
        return study.unit->state() == DeviceState::Present || study.unit->state() == DeviceState::Fault;
    })) << study.unit->trouble();
    const auto unarmed = study.device().commands.count();
    for (int i = 0; i < 10; ++i) study.tick();
    EXPECT_LE(fake::callsUntilZero(study.device().commands, unarmed).value_or(99), 1) << "not armed";
    study.unit->arm();
    ASSERT_TRUE(reached([&] {
        study.tick();
        return study.unit->state() == DeviceState::Ready;
    })) << study.unit->trouble();
    EXPECT_TRUE(study.pushes());
    const auto losses = study.losses();
    ASSERT_EQ(losses.size(), 1u);
    EXPECT_NE(losses.front().find(fault.why), std::string::npos) << losses.front();
}

DeviceFault goingWrong(const char* name, DeviceState state, const char* why, DhdFault fault, bool reaches = true) {
    return {name,
            state,
            why,
            [fault](Study& s) { s.device().fault = fault; },
            [](Study& s) { s.device().fault = DhdFault::None; },
            reaches};
}

DeviceFault hostSignal(const char* name, DeviceState state, const char* why, int signal) {
    return {name,
            state,
            why,
            [signal](Study&) {
                for (const pid_t host : test::hostsOf(getpid())) kill(host, signal);
            },
            [](Study&) {},
            false};
}

INSTANTIATE_TEST_SUITE_P(
    Faults, Sigma7Fault,
    testing::Values(goingWrong("Unplugged", DeviceState::Lost, "communication error", DhdFault::Unplugged, false),
                    goingWrong("MinusOne", DeviceState::Lost, "timeout", DhdFault::Timeout, false),
                    goingWrong("NotANumber", DeviceState::Fault, "no finite number", DhdFault::NotANumber),
                    goingWrong("Frozen", DeviceState::Fault, "stand still", DhdFault::Frozen),
                    goingWrong("LibraryHangs", DeviceState::Stale, "for 50 ms", DhdFault::Hang, false),
                    goingWrong("LibraryCrashes", DeviceState::Lost, "signal 11", DhdFault::Crash, false),
                    hostSignal("HostKilled", DeviceState::Lost, "signal 9", SIGKILL),
                    hostSignal("HostStopped", DeviceState::Stale, "for 50 ms", SIGSTOP),
                    DeviceFault{"Jump", DeviceState::Fault, "jumped",
                                [](Study& s) {
                                    fake::DhdHand far;
                                    far.position[2] = 0.9;
                                    s.device().hand.store(far);
                                },
                                [](Study&) {}},
                    DeviceFault{"MotorsOff", DeviceState::Fault, "motors off",
                                [](Study& s) { s.device().brakes = true; }, [](Study&) {}}),
    [](const auto& one) { return one.param.name; });

TEST(Sigma7Unit, WhateverIsReadAndAskedTheWrenchStaysWithinLimitsAndIsZeroUnlessReady) {
    // Truth: invariant, by the shim's own account of every call. PASSUNG_LONG=1: a million ticks.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    Study study(*block);
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
        fake::DhdHand hand;
        for (double& x : hand.position) x = 1e-3 * any(random);
        if (random() % 20 == 0) hand.position[random() % 3] = number();
        if (random() % 20 == 0) hand.frame[random() % 9] = number();
        if (random() % 50 == 0) study.device().brakes = true;
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
            const fake::DhdCommand command = study.device().commands.row(seen);
            const Vec3 force(command.asked[0], command.asked[1], command.asked[2]);
            const Vec3 torque(command.asked[3], command.asked[4], command.asked[5]);
            ASSERT_TRUE(force.allFinite() && torque.allFinite()) << "tick " << i;
            ASSERT_LE(force.norm(), 12.0) << "tick " << i;
            ASSERT_LE(torque.norm(), 0.2) << "tick " << i;
            const bool zero = force.isZero(0.0) && torque.isZero(0.0);
            pushed += zero ? 0 : 1;
            // What was on its way when it became so may come yet, once.
            if (not_ready > 2) {
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
constexpr const char* kWatchedVariable = "PASSUNG_TEST_WATCHED";

TEST(DISABLED_Study, Runs) {
    DhdBlock* block = fake::findBlock<DhdBlock>(fake::kDhdVariable);
    Watched* watched = fake::findBlock<Watched>(kWatchedVariable);
    ASSERT_TRUE(block != nullptr && watched != nullptr);
    Study study(*block);
    study.begin();
    for (;;) {
        study.tick();
        watched->pushing = true;
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
            execl("/proc/self/exe", "sigma7_unit_test", "--gtest_also_run_disabled_tests",
                  "--gtest_filter=DISABLED_Study.Runs", "--gtest_brief=1", nullptr);
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
struct Stops {
    SharedBlock<DhdBlock> block{fake::kDhdVariable};
    SharedBlock<Watched> watched{kWatchedVariable};
    std::vector<double> wall_ms;

    fake::DhdDevice& device() { return block->devices[0]; }
    bool pushesFully() {
        return reached([&] { return watched->pushing && device().commands.last().felt[1] == 2.0; });
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
    std::int64_t most_calls = 0;
};

int times() { return test::atFullLength() ? 100 : 5; }

TEST(StudyThatEnds, KilledItLeavesNoForce) {
    // Truth: the shim's own account: servo calls from the first after the study's end.
    Stops stops;
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

TEST(StudyThatEnds, StoppedItLeavesNoForceAndComesBackByARampOrNotAtAll) {
    // Truth: the shim's own account, as above. A study that goes on within 50 ms gets its force back step by step; one
    // that was slower never, for nobody arms it.
    Stops stops;
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
            const double felt = stops.device().commands.row(row).felt[1];
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

TEST(StudyThatEnds, StoppedForLongItStaysWithoutForce) {
    // Truth: the shim's own account: beyond 50 ms the host's latch holds, and the unit is told stale.
    Stops stops;
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

TEST(StudyThatEnds, HungInItsLoopItLeavesNoForce) {
    // Truth: the shim's own account, as above: servo calls from the first after the loop's last.
    Stops stops;
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

TEST(StudyThatEnds, KilledWhileTheLibraryHangsItLeavesNoHost) {
    // Truth: invariant: whoever holds the device of a library that hangs ends by itself.
    Stops stops;
    pid_t host = 0;
    {
        const StudyProcess study;
        ASSERT_TRUE(stops.pushesFully());
        const auto hosts = test::hostsOf(study.id());
        ASSERT_EQ(hosts.size(), 1u);
        host = hosts.front();
        stops.device().fault = DhdFault::Hang;
        const auto readings = stops.device().readings.load();
        poll(nullptr, 0, 20);
        EXPECT_LE(stops.device().readings, readings + 1) << "it hangs";
    }
    EXPECT_TRUE(reached([&] { return !test::runs(host); }));
}

TEST(HostedLink, TellsOfAGapAndTakesTheForceBeyondUntilItIsKnown) {
    // Truth: the shim's own account. A starved machine makes other gaps than those that are made here: each is tried
    // until it comes.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    setenv("PASSUNG_DEVICE_HOST", PASSUNG_DEVICE_HOST_FILE, 1);
    HostedLink link({.backend = "dhd", .address = PASSUNG_DHD_SHIM_FILE}, {});
    ASSERT_TRUE(link.open());
    const auto felt = [&] { return block->devices[0].commands.last().felt[1]; };
    unit::Exchange said;
    const auto exchange = [&](const Wrench& F) { return said = link.exchange(F, std::chrono::milliseconds(100)); };
    const auto afterSilence = [&](int milliseconds, unit::Exchange::Kind kind, const char* why) {
        exchange({});
        exchange(kPush);
        poll(nullptr, 0, milliseconds);
        exchange(kPush);
        return said.kind == kind && said.why.find(why) != std::string::npos;
    };
    EXPECT_TRUE(reached([&] { return afterSilence(20, unit::Exchange::Kind::News, "ramped back"); })) << said.why;
    EXPECT_LT(felt(), 1.0);
    EXPECT_TRUE(reached([&] { return exchange(kPush), felt() == 2.0; }));
    EXPECT_TRUE(reached([&] { return afterSilence(100, unit::Exchange::Kind::Stale, "taken away"); })) << said.why;
    for (int i = 0; i < 5; ++i) {
        exchange(kPush);
        EXPECT_EQ(felt(), 0.0);
    }
    EXPECT_TRUE(reached([&] { return exchange({}), exchange(kPush), felt() > 0.0; }));
}

TEST(HostedLink, IsLimitedInTheHostWhateverTheStudySends) {
    // Truth: the shim's own account: what it was asked for.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    setenv("PASSUNG_DEVICE_HOST", PASSUNG_DEVICE_HOST_FILE, 1);
    HostedLink link({.backend = "dhd", .address = PASSUNG_DHD_SHIM_FILE}, {});
    ASSERT_TRUE(link.open());
    const auto asked = [&](const Wrench& F) {
        link.exchange(F, std::chrono::milliseconds(1000));
        const fake::DhdCommand last = block->devices[0].commands.last();
        return std::pair(Vec3(last.asked[0], last.asked[1], last.asked[2]).norm(),
                         Vec3(last.asked[3], last.asked[4], last.asked[5]).norm());
    };
    // A machine that is late sees the zero that follows.
    EXPECT_TRUE(reached([&] { return std::abs(asked({Vec3(100, 0, 0), Vec3::Zero()}).first - 12.0) < 1e-9; }));
    EXPECT_TRUE(reached([&] { return std::abs(asked({Vec3::Zero(), Vec3(0, 0, 7)}).second - 0.2) < 1e-9; }));
    EXPECT_EQ(asked({Vec3(std::numeric_limits<double>::quiet_NaN(), 1, 1), Vec3::Zero()}), std::pair(0.0, 0.0));
    EXPECT_EQ(block->devices[0].non_finite, 0);
    for (auto row = std::int64_t{0}; row < block->devices[0].commands.count(); ++row)
        EXPECT_LE(std::abs(block->devices[0].commands.row(row).asked[1]), 12.0);
}

TEST(HostedLink, GivesNoForceAfterAFaultThoughTheStudyOverlooksIt) {
    // Truth: the shim's own account.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    setenv("PASSUNG_DEVICE_HOST", PASSUNG_DEVICE_HOST_FILE, 1);
    HostedLink link({.backend = "dhd", .address = PASSUNG_DHD_SHIM_FILE}, {});
    ASSERT_TRUE(link.open());
    fake::DhdDevice& device = block->devices[0];
    const auto push = [&] {
        const auto said = link.exchange(kPush, std::chrono::milliseconds(1000));
        return std::pair(said.kind, device.commands.last().felt[1]);
    };
    ASSERT_TRUE(reached([&] { return push().second == 2.0; }));
    device.fault = DhdFault::NotANumber;
    EXPECT_TRUE(reached([&] { return push().first == unit::Exchange::Kind::Wrong; }));
    device.fault = DhdFault::None;
    for (int i = 0; i < 5; ++i) EXPECT_EQ(push().second, 0.0);
    EXPECT_TRUE(reached([&] {
        link.exchange({}, std::chrono::milliseconds(1000));
        return push().second > 0.0;
    }));
}

TEST(HostProgram, ThatEndsAtOnceIsNoDevice) {
    // Truth: invariant.
    setenv("PASSUNG_DEVICE_HOST", "/bin/true", 1);
    EXPECT_NE(backends::find("dhd")->look({}).why_not.find("the device host has ended while it loaded"),
              std::string::npos);
}

TEST(HostProgram, IsMissedInWordsAndStartedByNobodyElse) {
    // Truth: invariant.
    setenv("PASSUNG_DEVICE_HOST", "/nonexistent/host", 1);
    const auto* dhd = backends::find("dhd");
    EXPECT_NE(dhd->look({}).why_not.find("no program is at /nonexistent/host"), std::string::npos);
    unsetenv("PASSUNG_DEVICE_HOST");
    EXPECT_NE(dhd->look({}).why_not.find("/passung-device-host"), std::string::npos);
    EXPECT_EQ(WEXITSTATUS(std::system(PASSUNG_DEVICE_HOST_FILE " dhd 2> /dev/null")), 2) << "no memory to share";
    EXPECT_EQ(WEXITSTATUS(std::system(PASSUNG_DEVICE_HOST_FILE " none 2> /dev/null")), 2);
    EXPECT_EQ(WEXITSTATUS(std::system(PASSUNG_DEVICE_HOST_FILE " 2> /dev/null")), 2);
}

TEST(HostProgram, AnAxisThatMirrorsIsRefused) {
    // Truth: invariant.
    const auto unit = backends::open({"right", "sigma7", "dhd", {}, {}, "x y -z"});
    ASSERT_FALSE(unit);
    EXPECT_EQ(unit.errors().front().key, "axes");
}

}  // namespace
}  // namespace passung::host
