#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <limits>
#include <thread>

#include "tests/devices/fakes/virtuose_block.h"

/// The archive with the names of Haption's API, linked as a device host links the vendor's. The declarations are
/// written here a second time, so that a name or a linkage that slips does not link.
extern "C" {
int virtAPIVersion(int* major, int* minor);
void* virtOpen(const char* name);
int virtClose(void* context);
int virtGetErrorCode(void* context);
char* virtGetErrorMessage(int code);
int virtGetDeviceID(void* context, int* device_type, int* serial_number);
int virtSetCommandType(void* context, int type);
int virtSetIndexingMode(void* context, int mode);
int virtSetForceFactor(void* context, float factor);
int virtSetSpeedFactor(void* context, float factor);
int virtSetTimeStep(void* context, float step);
int virtSetBaseFrame(void* context, float* base);
int virtSetObservationFrame(void* context, float* frame);
int virtSetPowerOn(void* context, int power);
int virtGetPowerOn(void* context, int* power);
int virtSetTimeoutValue(void* context, float time_value);
int virtSaturateTorque(void* context, float force, float moment);
int virtGetPosition(void* context, float* position);
int virtGetPhysicalPosition(void* context, float* position);
int virtGetAvatarPosition(void* context, float* position);
int virtGetSpeed(void* context, float* speed);
int virtGetPhysicalSpeed(void* context, float* speed);
int virtGetButton(void* context, int number, int* state);
int virtGetDeadMan(void* context, int* dead_man);
int virtGetEmergencyStop(void* context, int* stop);
int virtGetAlarm(void* context, unsigned* alarm);
int virtSetForce(void* context, float* force);
int virtSetPeriodicFunction(void* context, void (*function)(void*, void*), float* period, void* argument);
int virtStartLoop(void* context);
int virtStopLoop(void* context);
}

namespace passung {
namespace {

using fake::SharedBlock;
using fake::VirtuoseBlock;
using fake::VirtuoseFault;
using fake::VirtuoseHand;

constexpr int kImpedance = 3;

/// The block, and the device opened, in impedance and under power.
struct VirtuoseArchive : testing::Test {
    SharedBlock<VirtuoseBlock> block{fake::kVirtuoseVariable};
    void* context = virtOpen("127.0.0.1#53210");

    void SetUp() override {
        ASSERT_NE(context, nullptr);
        ASSERT_EQ(virtSetCommandType(context, kImpedance), 0);
        ASSERT_EQ(virtSetPowerOn(context, 1), 0);
    }
    std::array<double, 6> feel(std::array<float, 6> force) {
        EXPECT_EQ(virtSetForce(context, force.data()), 0);
        return feltNow(*block);
    }
    void put(const VirtuoseHand& hand) { block->hand.store(hand); }
};

TEST(VirtuoseOpening, FindsNothingWithoutABlockOrAPort) {
    // Truth: invariant: no device, an error, and nothing that crashes.
    EXPECT_EQ(virtOpen("127.0.0.1#53210"), nullptr);
    EXPECT_EQ(virtGetErrorCode(nullptr), 2);
    EXPECT_STREQ(virtGetErrorMessage(2), "error 2");
    float pose[7];
    EXPECT_EQ(virtGetPosition(nullptr, pose), -1);
    EXPECT_EQ(virtGetErrorCode(nullptr), 3);
    const SharedBlock<VirtuoseBlock> block(fake::kVirtuoseVariable);
    EXPECT_EQ(virtOpen("127.0.0.1"), nullptr);
    int major = 0, minor = 0;
    EXPECT_EQ(virtAPIVersion(&major, &minor), 0);
    EXPECT_EQ(major, 4);
    EXPECT_EQ(minor, 4);
}

TEST_F(VirtuoseArchive, GivesTheHandInSiWithAQuaternionThatEndsInItsRealPart) {
    // Truth: public headers and users' code: m, quaternion x, y, z, w, m/s, rad/s.
    VirtuoseHand hand;
    hand.position[2] = 0.25;
    hand.xyzw[0] = 0.6;
    hand.xyzw[3] = 0.8;
    hand.speed[5] = -1.5;
    hand.buttons = 2;
    put(hand);
    float pose[7], twist[6];
    int state = 0, serial = 0;
    for (const auto get : {virtGetPosition, virtGetPhysicalPosition, virtGetAvatarPosition}) {
        ASSERT_EQ(get(context, pose), 0);
        EXPECT_EQ(pose[2], 0.25f);
        EXPECT_EQ(pose[3], 0.6f);
        EXPECT_EQ(pose[6], 0.8f);
    }
    for (const auto get : {virtGetSpeed, virtGetPhysicalSpeed}) {
        ASSERT_EQ(get(context, twist), 0);
        EXPECT_EQ(twist[5], -1.5f);
    }
    ASSERT_EQ(virtGetButton(context, 1, &state), 0);
    EXPECT_EQ(state, 1);
    ASSERT_EQ(virtGetButton(context, 0, &state), 0);
    EXPECT_EQ(state, 0);
    ASSERT_EQ(virtGetDeviceID(context, &state, &serial), 0);
    EXPECT_EQ(serial, 3545);
}

TEST_F(VirtuoseArchive, FeelsForcesUnderPowerWithAHandOnItsSwitchOnly) {
    // Truth: closed form: a vector that is shortened keeps its direction.
    using Six = std::array<double, 6>;
    EXPECT_EQ(feel({1, 2, 3, 0.5f, 0.25f, 0.125f}), (Six{1, 2, 3, 0.5, 0.25, 0.125}));
    ASSERT_EQ(virtSaturateTorque(context, 2.5f, 1.0f), 0);
    EXPECT_EQ(feel({3, 0, 4, 0, 0, 2}), (Six{1.5, 0, 2, 0, 0, 1}));
    ASSERT_EQ(virtSetForceFactor(context, 0.5f), 0);
    EXPECT_EQ(feel({1, 0, 0, 0, 0, 0}), (Six{0.5, 0, 0, 0, 0, 0}));
    VirtuoseHand hand;
    hand.dead_man = 0;
    put(hand);
    int on = 1;
    ASSERT_EQ(virtGetDeadMan(context, &on), 0);
    EXPECT_EQ(on, 0);
    EXPECT_EQ(feltNow(*block), Six{}) << "at once, without another call";
    EXPECT_EQ(feel({1, 0, 0, 0, 0, 0}), Six{});
    put({});
    block->emergency_stop = true;
    ASSERT_EQ(virtGetEmergencyStop(context, &on), 0);
    EXPECT_EQ(on, 1);
    EXPECT_EQ(feel({1, 0, 0, 0, 0, 0}), Six{});
    block->emergency_stop = false;
    EXPECT_EQ(feel({1, 0, 0, 0, 0, 0}), (Six{0.5, 0, 0, 0, 0, 0}));
    ASSERT_EQ(virtSetPowerOn(context, 0), 0);
    ASSERT_EQ(virtGetPowerOn(context, &on), 0);
    EXPECT_EQ(on, 0);
    EXPECT_EQ(feltNow(*block), Six{});
    EXPECT_EQ(block->commands.count(), 6);
}

TEST_F(VirtuoseArchive, FailsWhereTheVendorsWould) {
    // Truth: public headers: -1, and a number for the reason.
    float force[6] = {1, 0, 0, 0, 0, 0};
    ASSERT_EQ(virtSetCommandType(context, 5), 0);
    EXPECT_EQ(virtSetForce(context, force), -1);
    EXPECT_EQ(virtGetErrorCode(context), 17);
    EXPECT_EQ(virtSetForceFactor(context, 0.0f), -1);
    EXPECT_EQ(virtGetErrorCode(context), 9);
    EXPECT_EQ(virtSetSpeedFactor(context, -1.0f), -1);
    EXPECT_EQ(virtSetTimeStep(context, 0.0f), -1);
    EXPECT_EQ(virtSetIndexingMode(context, 2), 0);
    float identity[7] = {0, 0, 0, 0, 0, 0, 1}, turned[7] = {0, 0, 0, 1, 0, 0, 0};
    EXPECT_EQ(virtSetBaseFrame(context, identity), 0);
    EXPECT_EQ(virtSetObservationFrame(context, identity), 0);
    EXPECT_FALSE(block->foreign_frame);
    EXPECT_EQ(virtSetBaseFrame(context, turned), 0);
    EXPECT_TRUE(block->foreign_frame);
    block->alarm = 0x4000;
    unsigned alarm = 0;
    EXPECT_EQ(virtGetAlarm(context, &alarm), 0);
    EXPECT_EQ(alarm, 0x4000u);
    block->plugged = false;
    EXPECT_EQ(virtGetAlarm(context, &alarm), -1);
    EXPECT_EQ(virtGetErrorCode(context), 2);
    EXPECT_EQ(virtClose(context), 0);
    block->plugged = true;
    EXPECT_EQ(virtGetAlarm(context, &alarm), -1);
    EXPECT_EQ(virtGetErrorCode(context), 3);
}

TEST_F(VirtuoseArchive, FreezesAndLiesAsItIsTold) {
    // Truth: invariant.
    float pose[7];
    VirtuoseHand hand;
    hand.position[0] = 0.5;
    put(hand);
    ASSERT_EQ(virtGetPosition(context, pose), 0);
    block->fault = VirtuoseFault::Frozen;
    hand.position[0] = 0.75;
    put(hand);
    ASSERT_EQ(virtGetPosition(context, pose), 0);
    EXPECT_EQ(pose[0], 0.5f);
    block->fault = VirtuoseFault::NotANumber;
    ASSERT_EQ(virtGetPosition(context, pose), 0);
    EXPECT_EQ(pose[0], 0.75f);
    EXPECT_TRUE(std::isnan(pose[1]));
    block->fault = VirtuoseFault::Unplugged;
    EXPECT_EQ(virtGetPosition(context, pose), -1);
    block->fault = VirtuoseFault::None;
    feel({std::numeric_limits<float>::quiet_NaN(), 0, 0, 0, 0, 0});
    EXPECT_EQ(block->non_finite, 1);
}

struct Caller {
    std::thread::id thread;
    int calls = 0;
};

TEST_F(VirtuoseArchive, CallsThePeriodicFunctionOncePerTickInAThreadOfItsOwn) {
    // Truth: invariant of virtual time: as many calls as steps, none between.
    Caller caller;
    float period = 0.001f;
    ASSERT_EQ(virtSetPeriodicFunction(
                  context,
                  [](void* in, void* data) {
                      Caller& self = *static_cast<Caller*>(data);
                      self.thread = std::this_thread::get_id();
                      float force[6] = {static_cast<float>(++self.calls), 0, 0, 0, 0, 0};
                      virtSetForce(in, force);
                  },
                  &period, &caller),
              0);
    ASSERT_EQ(virtStartLoop(context), 0);
    EXPECT_EQ(virtStartLoop(context), -1);
    fake::step(*block, 500);
    EXPECT_EQ(caller.calls, 500);
    EXPECT_NE(caller.thread, std::this_thread::get_id());
    EXPECT_EQ(block->commands.count(), 500);
    EXPECT_EQ(block->commands.row(249).tick, 250.0);
    EXPECT_EQ(block->commands.row(249).felt[0], 250.0);
    ASSERT_EQ(virtStopLoop(context), 0);
    EXPECT_FLOAT_EQ(static_cast<float>(block->period_s), 0.001f);
}

TEST_F(VirtuoseArchive, EndsTheForceOfADeadProgramByItsTimeout) {
    // Truth: invariant: memory that two processes share; the controller's timeout ends what was left on.
    const pid_t child = fork();
    if (child == 0) {
        void* const own = virtOpen("127.0.0.1#53210");
        virtSetTimeoutValue(own, 0.02f);
        float force[6] = {0, 0, 7, 0, 0, 0};
        virtSetForce(own, force);
        block->fault = VirtuoseFault::Crash;
        virtSetForce(own, force);
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(block->commands.count(), 1);
    EXPECT_EQ(feltNow(*block, 0.019)[2], 7.0);
    EXPECT_EQ(feltNow(*block, 0.021)[2], 0.0);
}

}  // namespace
}  // namespace passung
