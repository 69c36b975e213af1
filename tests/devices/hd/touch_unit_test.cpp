#include <gtest/gtest.h>

#include "tests/devices/fakes/hd_block.h"
#include "tests/devices/host/hosted_study.h"

/// The whole way: a unit, its device host as a program of its own, and the shim of OpenHaptics in that, whose own servo
/// thread calls the host once a millisecond.
namespace passung::host {
namespace {

using fake::HdBlock;
using fake::HdFault;
using fake::SharedBlock;

struct HdFake {
    using Block = HdBlock;
    using Device = fake::HdDevice;
    using Hand = fake::HdHand;
    static constexpr const char* kVariable = fake::kHdVariable;
    static constexpr const char* kHost = PASSUNG_DEVICE_HOST_FILE;
    static Wrench push() { return {Vec3(2, -1, 0.5), Vec3(0, 0, 0.1)}; }
    static DeviceChoice choice(const std::string& serial) {
        return {"right", "touch", "hd", serial, PASSUNG_HD_SHIM_FILE, {}};
    }
    static Device& device(Block& block, const std::string& serial) { return block.devices[serial == "816" ? 1 : 0]; }
    static void runByClock(Block& block) { block.stepped = false; }
    static void shake(Device& device, double x) {
        fake::HdHand hand;
        hand.position[0] = x;
        device.hand.store(hand);
    }
    static void disturb(Device& device) { device.clamping = !device.clamping; }
    static double felt(const fake::HdCommand& command) { return command.felt[0]; }  // the vendor's x is ours
};
using Study = host::Study<HdFake>;

bool isNoForce(const fake::HdCommand& command) {
    return std::all_of(std::begin(command.felt), std::end(command.felt), [](double x) { return x == 0.0; });
}

TEST(TouchUnit, PushesWithTheForceThatIsCommandedAndNotAfterwards) {
    // Truth: the shim's own account.
    SharedBlock<HdBlock> block(fake::kHdVariable);
    {
        Study study(*block);
        study.begin();
        EXPECT_TRUE(study.pushes());
        const fake::HdCommand command = study.device().commands.last();
        EXPECT_EQ(Vec3(command.felt[3], command.felt[4], command.felt[5]), Vec3(Vec3::Zero())) << "no torque";
        const DeviceUnit who = study.unit->identity().value();
        EXPECT_EQ(who.backend + " " + who.kind + " " + who.serial, "hd touch 815");
        EXPECT_EQ(who.calibration, "axes x -z y; 1000 Hz; heartbeat 5 ms");
        EXPECT_EQ(study.unit->description().actuated_degrees, 3);
        study.unit->giveBack();
        const auto from = study.device().commands.count();
        ASSERT_TRUE(reached([&] { return study.device().commands.count() > from + 5; }));
        EXPECT_LE(fake::callsUntilZero(study.device().commands, from).value_or(99), kHeartbeat + 2);
    }
    EXPECT_TRUE(test::hostsOf(getpid()).empty());
    EXPECT_FALSE(block->devices[0].opened);
    EXPECT_TRUE(isNoForce(block->devices[0].commands.last()));
}

TEST(TouchUnit, TwoOfThemAreServedByTwoHosts) {
    // Truth: the shim's own account: each feels its own force.
    SharedBlock<HdBlock> block(fake::kHdVariable);
    block->present = 2;
    block->swapped = true;
    Study right(*block, "815"), left(*block, "816");
    right.begin();
    left.begin();
    EXPECT_TRUE(reached([&] {
        right.tick({Vec3(1, 0, 0), Vec3::Zero()});
        left.tick({Vec3(3, 0, 0), Vec3::Zero()});
        return HdFake::felt(right.device().commands.last()) == 1.0 &&
               HdFake::felt(left.device().commands.last()) == 3.0;
    }));
    EXPECT_EQ(test::hostsOf(getpid()).size(), 2u);
}

struct DeviceFault {
    const char* name;
    DeviceState state;
    const char* why;
    std::function<void(Study&)> happens, ends;
    bool reaches = true;  // zero can be commanded; else the device has to end the force by itself, which no shim shows
};

class TouchFault : public testing::TestWithParam<DeviceFault> {};

TEST_P(TouchFault, TakesTheForceIsToldOnceAndComesBackWhenItIsArmed) {
    // Truth: the shim's own account: servo calls from the first that came after the fault was visible.
    const DeviceFault& fault = GetParam();
    SharedBlock<HdBlock> block(fake::kHdVariable);
    Study study(*block);
    study.begin();
    ASSERT_TRUE(study.pushes());
    fault.happens(study);
    for (int i = 0; i < 5000 && study.unit->state() == DeviceState::Ready; ++i) {
        study.unit->read();
        study.unit->command(HdFake::push());
        poll(nullptr, 0, 1);
    }
    ASSERT_EQ(study.unit->state(), fault.state) << study.unit->trouble();
    const auto visible = study.device().commands.count();
    for (int i = 0; i < 30; ++i) {
        study.unit->read();
        study.unit->command(HdFake::push());
        poll(nullptr, 0, 1);
    }
    if (fault.reaches) {
        const auto calls = fake::callsUntilZero(study.device().commands, visible).value_or(99);
        EXPECT_LE(calls, 2);
        std::printf("%s: zero at call %d after the fault was seen\n", fault.name, static_cast<int>(calls));
    }
    fault.ends(study);
    ASSERT_TRUE(reached([&] {
        study.tick();
        return study.unit->state() == DeviceState::Present || study.unit->state() == DeviceState::Fault;
    })) << study.unit->trouble();
    const auto unarmed = study.device().commands.count();
    for (int i = 0; i < 10; ++i) study.tick();
    EXPECT_LE(fake::callsUntilZero(study.device().commands, unarmed).value_or(99), 1) << "not armed";
    const auto losses = study.losses();
    ASSERT_EQ(losses.size(), 1u);
    EXPECT_NE(losses.front().find(fault.why), std::string::npos) << losses.front();
    ASSERT_TRUE(reached([&] {
        study.unit->arm();
        study.tick();
        return study.unit->state() == DeviceState::Ready;
    })) << study.unit->trouble();
    EXPECT_TRUE(study.pushes());
}

DeviceFault goingWrong(const char* name, DeviceState state, const char* why, HdFault fault, bool reaches = true) {
    return {name,
            state,
            why,
            [fault](Study& s) { s.device().fault = fault; },
            [](Study& s) { s.device().fault = HdFault::None; },
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
    Faults, TouchFault,
    testing::Values(goingWrong("Unplugged", DeviceState::Lost, "communication error", HdFault::Unplugged, false),
                    goingWrong("NotANumber", DeviceState::Fault, "no finite number", HdFault::NotANumber),
                    goingWrong("Frozen", DeviceState::Fault, "stand still", HdFault::Frozen),
                    goingWrong("WarmMotors", DeviceState::Fault, "too warm", HdFault::WarmMotors),
                    goingWrong("LibraryCrashes", DeviceState::Lost, "signal 11", HdFault::Crash, false),
                    hostSignal("HostKilled", DeviceState::Lost, "signal 9", SIGKILL),
                    hostSignal("HostStopped", DeviceState::Stale, "for 50 ms", SIGSTOP),
                    DeviceFault{"Jump", DeviceState::Fault, "jumped",
                                [](Study& s) {
                                    fake::HdHand far;
                                    far.position[2] = 0.9;
                                    s.device().hand.store(far);
                                },
                                [](Study&) {}}),
    [](const auto& one) { return one.param.name; });

TEST(TouchUnit, ASchedulerThatCallsNobodyLosesTheDeviceAndItsHostEnds) {
    // Truth: the shim's own account. The last force stands in a library that calls nobody, until it is let go.
    SharedBlock<HdBlock> block(fake::kHdVariable);
    Study study(*block);
    study.begin();
    ASSERT_TRUE(study.pushes());
    const auto hosts = test::hostsOf(getpid());
    ASSERT_EQ(hosts.size(), 1u);
    block->stalled = true;
    ASSERT_TRUE(reached([&] {
        study.unit->read();
        study.unit->command(HdFake::push());
        return study.unit->state() != DeviceState::Ready;
    }));
    EXPECT_TRUE(reached([&] { return study.unit->trouble().find("has not called for 200 ms") != std::string::npos; }));
    EXPECT_TRUE(reached([&] { return !test::runs(hosts.front()); }));
    block->stalled = false;
    ASSERT_TRUE(reached([&] {
        study.unit->arm();
        study.tick();
        return study.unit->state() == DeviceState::Ready;
    })) << study.unit->trouble();
    EXPECT_TRUE(study.pushes());
}

TEST(TouchUnit, WhateverIsReadAndAskedTheForceStaysWithinLimitsAndIsZeroUnlessReady) {
    // Truth: invariant, by the shim's own account of every call. The servo thread goes on by its own clock; a command
    // stands for a heartbeat where the next one is late.
    expectLimitsWhateverComes<HdFake>(3.3, 0.0, kHeartbeat + 2);
}

TEST(DISABLED_Study, Runs) { runForEver<HdFake>(); }

// Truth of these: the shim's own account: servo calls from the first after the study's end, or the loop's last.
TEST(StudyThatEnds, KilledItLeavesNoForceOfATouch) { expectNoForceOfAKilledStudy<HdFake>(); }
TEST(StudyThatEnds, StoppedItLeavesNoForceOfATouch) { expectNoForceOfAStoppedStudy<HdFake>(); }
TEST(StudyThatEnds, StoppedForLongItStaysWithoutForceOfATouch) { expectNoForceAfterALongStop<HdFake>(); }
TEST(StudyThatEnds, HungInItsLoopItLeavesNoForceOfATouch) { expectNoForceOfAHungStudy<HdFake>(); }

}  // namespace
}  // namespace passung::host
