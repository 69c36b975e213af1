#include <gtest/gtest.h>

#include <limits>

#include "devices/host/hosted_unit.h"
#include "tests/devices/fakes/dhd_block.h"
#include "tests/devices/host/hosted_study.h"

/// The whole way: a unit, its device host as a program of its own, and the shim of the vendor's library in that.
namespace passung::host {
namespace {

using fake::DhdBlock;
using fake::DhdFault;
using fake::SharedBlock;

const Wrench kPush{Vec3(2, -1, 0.5), Vec3(0, 0, 0.1)};
constexpr int kWatchdog = 20;  // [ms]

struct DhdFake {
    using Block = DhdBlock;
    using Device = fake::DhdDevice;
    using Hand = fake::DhdHand;
    static constexpr const char* kVariable = fake::kDhdVariable;
    static constexpr const char* kHost = PASSUNG_DEVICE_HOST_FILE;
    static Wrench push() { return kPush; }
    static DeviceChoice choice(const std::string& serial) {
        return {"right", "sigma7", "dhd", serial, PASSUNG_DHD_SHIM_FILE, {}};
    }
    static Device& device(Block& block, const std::string& serial) { return block.devices[serial == "4712" ? 1 : 0]; }
    static void runByClock(Block&) {}
    static void shake(Device& device, double x) {
        fake::DhdHand hand;
        hand.position[0] = x;
        device.hand.store(hand);
    }
    static void disturb(Device& device) { device.brakes = true; }
    static double felt(const fake::DhdCommand& command) { return command.felt[1]; }  // the vendor's y is our x
};
using Study = host::Study<DhdFake>;
using Stops = host::Stops<DhdFake>;

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
    // Truth: invariant, by the shim's own account of every call. What was on its way when it became so may come yet,
    // once.
    expectLimitsWhateverComes<DhdFake>(12.0, 0.2, 2);
}

TEST(DISABLED_Study, Runs) { runForEver<DhdFake>(); }

// Truth of these: the shim's own account: servo calls from the first after the study's end, or the loop's last.
TEST(StudyThatEnds, KilledItLeavesNoForce) { expectNoForceOfAKilledStudy<DhdFake>(); }
TEST(StudyThatEnds, StoppedItLeavesNoForceAndComesBackByARampOrNotAtAll) { expectNoForceOfAStoppedStudy<DhdFake>(); }
TEST(StudyThatEnds, StoppedForLongItStaysWithoutForce) { expectNoForceAfterALongStop<DhdFake>(); }
TEST(StudyThatEnds, HungInItsLoopItLeavesNoForce) { expectNoForceOfAHungStudy<DhdFake>(); }

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

TEST(HostedLink, HoldsAWrenchFromWhenItWasMade) {
    // Truth: the shim's own account: what was late on its way to the host does not begin a heartbeat of its own.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    setenv("PASSUNG_DEVICE_HOST", PASSUNG_DEVICE_HOST_FILE, 1);
    HostedLink link({.backend = "dhd", .address = PASSUNG_DHD_SHIM_FILE}, {});
    ASSERT_TRUE(link.open());
    const auto exchange = [&](int late_ms) {
        const auto made = Steady::now() - std::chrono::milliseconds(late_ms);
        link.stamp(std::chrono::nanoseconds(made.time_since_epoch()).count());
        link.exchange(kPush, std::chrono::milliseconds(1000));
        return block->devices[0].commands.last().felt[1];
    };
    for (int i = 0; i < 20; ++i) EXPECT_EQ(exchange(kHeartbeat + 1), 0.0);
    EXPECT_TRUE(reached([&] {
        link.exchange({}, std::chrono::milliseconds(1000));
        return exchange(0) > 0.0;
    })) << "one that is young enough does";
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
