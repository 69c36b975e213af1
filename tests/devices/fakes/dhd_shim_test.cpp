#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <thread>

#include "tests/devices/fakes/dhd_block.h"
#include "tests/devices/fakes/shim_library.h"
#include "tests/devices/fakes/waiting.h"

/// The shim of Force Dimension's library, called through its names as a backend calls the vendor's. The signatures are
/// written here a second time, so that a slip in the shim is no slip here.
namespace passung {
namespace {

using fake::DhdBlock;
using fake::DhdCommand;
using fake::DhdDevice;
using fake::DhdFault;
using fake::DhdHand;
using fake::SharedBlock;
using fake::ShimLibrary;

struct Dhd {
    explicit Dhd(const char* path = PASSUNG_DHD_SHIM_FILE) : library(path) {}
    ShimLibrary library;
    int (*count)() = library.get<int()>("dhdGetDeviceCount");
    int (*openId)(char) = library.get<int(char)>("dhdOpenID");
    int (*openSerial)(int) = library.get<int(int)>("dhdOpenSerial");
    int (*close)(char) = library.get<int(char)>("dhdClose");
    int (*lastError)() = library.get<int()>("dhdErrorGetLast");
    int (*enableForce)(unsigned char, char) = library.get<int(unsigned char, char)>("dhdEnableForce");
    int (*pose)(double*, double*, double*, double (*)[3], char) =
        library.get<int(double*, double*, double*, double (*)[3], char)>("dhdGetPositionAndOrientationFrame");
    int (*set)(double, double, double, double, double, double, double, char) =
        library.get<int(double, double, double, double, double, double, double, char)>(
            "dhdSetForceAndTorqueAndGripperForce");

    /// The position as read; the result of the call as `result`.
    std::array<double, 3> position(int& result, char id = 0) const {
        std::array<double, 3> p{-7, -7, -7};
        double frame[3][3];
        result = pose(&p[0], &p[1], &p[2], frame, id);
        return p;
    }
};

TEST(DhdShim, HasTheNamesOfTheVendorsLibrary) {
    // Truth: the vendor's public documentation and the headers that others publish, by name.
    const ShimLibrary library(PASSUNG_DHD_SHIM_FILE);
    for (const char* name : {"dhdGetDeviceCount",
                             "dhdGetAvailableCount",
                             "dhdOpen",
                             "dhdOpenID",
                             "dhdOpenSerial",
                             "dhdClose",
                             "dhdGetSerialNumber",
                             "dhdGetSystemType",
                             "dhdGetSystemName",
                             "dhdGetSDKVersion",
                             "dhdGetVersion",
                             "dhdGetPositionAndOrientationFrame",
                             "dhdGetLinearVelocity",
                             "dhdGetAngularVelocityRad",
                             "dhdSetForceAndTorqueAndGripperForce",
                             "dhdGetButtonMask",
                             "dhdGetGripperAngleRad",
                             "dhdGetGripperGap",
                             "dhdEnableForce",
                             "dhdSetMaxForce",
                             "dhdSetMaxTorque",
                             "dhdSetWatchdog",
                             "dhdSetVelocityThreshold",
                             "dhdEnableExpertMode",
                             "dhdSetVibration",
                             "dhdGetComFreq",
                             "dhdErrorGetLast",
                             "dhdErrorGetLastStr",
                             "dhdEnableSimulator",
                             "dhdGetStatus",
                             "dhdSetBrakes",
                             "drdOpenID",
                             "drdClose",
                             "drdIsInitialized",
                             "drdAutoInit",
                             "drdStop"}) {
        EXPECT_TRUE(library.has(name)) << name;
    }
    EXPECT_FALSE(library.has("passung"));
}

TEST(DhdShim, LacksInItsVariantsWhatTheyAreFor) {
    // Truth: invariant: each variant is the same source with names hidden.
    const ShimLibrary incomplete(PASSUNG_DHD_SHIM_INCOMPLETE_FILE);
    EXPECT_FALSE(incomplete.has("dhdSetForceAndTorqueAndGripperForce"));
    EXPECT_TRUE(incomplete.has("dhdGetPositionAndOrientationFrame"));
    const ShimLibrary old(PASSUNG_DHD_SHIM_OLD_FILE);
    for (const char* name : {"dhdSetVibration", "dhdSetWatchdog", "dhdOpenSerial"}) EXPECT_FALSE(old.has(name)) << name;
    EXPECT_TRUE(old.has("dhdSetForceAndTorqueAndGripperForce"));
}

TEST(DhdShim, FindsNothingWithoutABlock) {
    // Truth: invariant: no device, an error, and nothing that crashes.
    const Dhd dhd;
    EXPECT_EQ(dhd.count(), 0);
    EXPECT_EQ(dhd.openId(0), -1);
    EXPECT_EQ(dhd.lastError(), 5);
    int result = 0;
    dhd.position(result);
    EXPECT_EQ(result, -1);
    EXPECT_EQ(dhd.set(1, 2, 3, 0, 0, 0, 0, 0), -1);
}

TEST(DhdShim, GivesTheHandInSiAndKeepsWhatIsAskedInSi) {
    // Truth: the vendor's public documentation: m, m/s, rad/s, N, N·m; frame[row][column].
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    const Dhd dhd;
    DhdHand hand;
    for (int i = 0; i < 3; ++i) {
        hand.position[i] = 0.01 * (i + 1);
        hand.velocity[i] = 0.1 * (i + 1);
        hand.spin[i] = 1.0 * (i + 1);
    }
    for (int i = 0; i < 9; ++i) hand.frame[i] = i;
    hand.grip_angle = 0.4;
    hand.buttons = 5;
    block->devices[0].hand.store(hand);
    ASSERT_EQ(dhd.count(), 1);
    ASSERT_EQ(dhd.openId(0), 0);
    double p[3], frame[3][3], v[3], w[3], angle;
    ASSERT_EQ(dhd.pose(&p[0], &p[1], &p[2], frame, 0), 0);
    ASSERT_EQ(dhd.library.get<int(double*, double*, double*, char)>("dhdGetLinearVelocity")(&v[0], &v[1], &v[2], 0), 0);
    ASSERT_EQ(dhd.library.get<int(double*, double*, double*, char)>("dhdGetAngularVelocityRad")(&w[0], &w[1], &w[2], 0),
              0);
    ASSERT_EQ(dhd.library.get<int(double*, char)>("dhdGetGripperAngleRad")(&angle, 0), 0);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(p[i], 0.01 * (i + 1));
        EXPECT_EQ(v[i], 0.1 * (i + 1));
        EXPECT_EQ(w[i], 1.0 * (i + 1));
        for (int j = 0; j < 3; ++j) EXPECT_EQ(frame[i][j], 3 * i + j);
    }
    EXPECT_EQ(angle, 0.4);
    EXPECT_EQ(dhd.library.get<unsigned(char)>("dhdGetButtonMask")(0), 5u);
    EXPECT_EQ(block->devices[0].readings, 1);

    dhd.enableForce(1, 0);
    EXPECT_EQ(dhd.set(1, 2, 3, 0.1, 0.2, 0.3, 0.5, 0), 0);
    const DhdCommand command = block->devices[0].commands.last();
    EXPECT_EQ(command.call, 1);
    const double expected[7] = {1, 2, 3, 0.1, 0.2, 0.3, 0.5};
    for (int i = 0; i < 7; ++i) EXPECT_EQ(command.felt[i], expected[i]);
}

TEST(DhdShim, FeelsNothingWithoutForcesOrWithBrakesAndStaysBelowItsLimit) {
    // Truth: closed form: a vector that is shortened keeps its direction.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    const Dhd dhd;
    ASSERT_EQ(dhd.openId(0), 0);
    DhdDevice& device = block->devices[0];
    dhd.set(3, 0, 4, 0, 0, 0, 0, 0);
    EXPECT_EQ(device.commands.last().felt[2], 0.0);
    EXPECT_EQ(device.commands.last().asked[2], 4.0);
    dhd.enableForce(1, 0);
    ASSERT_EQ(dhd.library.get<int(double, char)>("dhdSetMaxForce")(2.5, 0), 0);
    EXPECT_EQ(dhd.set(3, 0, 4, 0, 0, 0, 0, 0), 2);  // saturated: a note, no error
    EXPECT_DOUBLE_EQ(device.commands.last().felt[0], 1.5);
    EXPECT_DOUBLE_EQ(device.commands.last().felt[2], 2.0);
    device.brakes = true;
    dhd.set(3, 0, 4, 0, 0, 0, 0, 0);
    EXPECT_EQ(device.commands.last().felt[0], 0.0);
    EXPECT_EQ(device.commands.count(), 3);
    EXPECT_EQ(device.non_finite, 0);
    dhd.set(std::numeric_limits<double>::quiet_NaN(), 0, 0, 0, 0, 0, 0, 0);
    EXPECT_EQ(device.non_finite, 1);
}

TEST(DhdShim, ReturnsPositiveNotesThatAreNoErrors) {
    // Truth: the vendor's public documentation: 1 is the time guard, 2 a saturated motor.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    const Dhd dhd;
    ASSERT_EQ(dhd.openId(0), 0);
    block->call_result = 1;
    double x, y, z, frame[3][3];
    EXPECT_EQ(dhd.pose(&x, &y, &z, frame, 0), 1);
    EXPECT_EQ(x, 0.0);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) EXPECT_EQ(frame[i][j], i == j ? 1.0 : 0.0) << "a hand at rest is not turned";
    }
}

TEST(DhdShim, TellsTwoDevicesApartBySerialHoweverTheyAreCounted) {
    // Truth: invariant.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    block->present = 2;
    const Dhd dhd;
    const auto serial = dhd.library.get<int(unsigned short*, char)>("dhdGetSerialNumber");
    for (const bool swapped : {false, true}) {
        block->swapped = swapped;
        ASSERT_EQ(dhd.count(), 2);
        EXPECT_EQ(dhd.openSerial(4712), swapped ? 0 : 1);
        unsigned short number = 0;
        ASSERT_EQ(serial(&number, swapped ? 0 : 1), 0);
        EXPECT_EQ(number, 4712);
        EXPECT_EQ(serial(&number, swapped ? 1 : 0), -1) << "the other one is not open";
        EXPECT_EQ(dhd.openSerial(1), -1);
        dhd.close(swapped ? 0 : 1);
    }
}

TEST(DhdShim, FailsAsItIsToldFromTheReadingOnThatItIsTold) {
    // Truth: invariant.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    DhdDevice& device = block->devices[0];
    const Dhd dhd;
    ASSERT_EQ(dhd.openId(0), 0);
    int result = 0;
    const auto move = [&](double x) {
        DhdHand hand;
        hand.position[0] = x;
        device.hand.store(hand);
    };
    move(0.5);
    device.fault_at_reading = 2;
    device.fault = DhdFault::Unplugged;
    dhd.position(result);
    EXPECT_EQ(result, 0);
    dhd.position(result);
    EXPECT_EQ(result, 0);
    EXPECT_EQ(dhd.position(result)[0], -7) << "nothing is written";
    EXPECT_EQ(result, -1);
    EXPECT_EQ(dhd.lastError(), 2);
    EXPECT_EQ(dhd.set(1, 0, 0, 0, 0, 0, 0, 0), -1);
    EXPECT_EQ(device.commands.count(), 0);
    device.fault = DhdFault::Timeout;
    dhd.position(result);
    EXPECT_EQ(dhd.lastError(), 7);
    device.fault = DhdFault::NotANumber;
    EXPECT_TRUE(std::isnan(dhd.position(result)[1]));
    EXPECT_EQ(result, 0);
    device.fault = DhdFault::Frozen;
    move(0.7);
    EXPECT_EQ(dhd.position(result)[0], 0.5);
    device.fault = DhdFault::None;
    EXPECT_EQ(dhd.position(result)[0], 0.7);
    device.plugged = false;
    dhd.position(result);
    EXPECT_EQ(result, -1);
}

TEST(DhdShim, HangsInACallUntilItIsReleased) {
    // Truth: invariant.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    const Dhd dhd;
    ASSERT_EQ(dhd.openId(0), 0);
    block->devices[0].fault = DhdFault::Hang;
    std::atomic<bool> done = false;
    std::thread caller([&] {
        int result = 0;
        dhd.position(result);
        done = true;
    });
    for (int i = 0; i < 20; ++i) {
        fake::readable(-1, 1);
        EXPECT_FALSE(done);
    }
    block->released = true;
    caller.join();
    EXPECT_TRUE(done);
}

TEST(DhdShim, SetsTrapsOfUnits) {
    // Truth: closed form: a thousand millimetres are a metre.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    const Dhd dhd;
    ASSERT_EQ(dhd.openId(0), 0);
    DhdHand hand;
    hand.position[2] = 0.05;
    block->devices[0].hand.store(hand);
    block->millimetres = true;
    int result = 0;
    EXPECT_DOUBLE_EQ(dhd.position(result)[2], 50.0);
    block->millinewtonmetres = true;
    dhd.enableForce(1, 0);
    dhd.set(1, 2, 3, 0.2, 0.4, 0.6, 5, 0);
    const DhdCommand command = block->devices[0].commands.last();
    const double expected[7] = {1, 2, 3, 0.0002, 0.0004, 0.0006, 5};
    for (int i = 0; i < 7; ++i) EXPECT_DOUBLE_EQ(command.felt[i], expected[i]);
}

TEST(DhdShim, AsksForTheExpertModeWhereTheVendorDoes) {
    // Truth: the vendor's public documentation: thresholds and guards are of the expert interface.
    SharedBlock<DhdBlock> block(fake::kDhdVariable);
    const Dhd dhd;
    ASSERT_EQ(dhd.openId(0), 0);
    const auto threshold = dhd.library.get<int(unsigned, char)>("dhdSetVelocityThreshold");
    EXPECT_EQ(threshold(1, 0), -1);
    EXPECT_EQ(dhd.lastError(), 9);
    EXPECT_EQ(dhd.library.get<int()>("dhdEnableExpertMode")(), 0);
    EXPECT_EQ(threshold(1, 0), 0);
    int version[4] = {};
    dhd.library.get<void(int*, int*, int*, int*)>("dhdGetSDKVersion")(&version[0], &version[1], &version[2],
                                                                      &version[3]);
    EXPECT_EQ(version[0], 3);
    EXPECT_EQ(version[1], 17);
    block->version[1] = 5;
    dhd.library.get<void(int*, int*, int*, int*)>("dhdGetSDKVersion")(&version[0], &version[1], nullptr, nullptr);
    EXPECT_EQ(version[1], 5);
}

/// Another process that drives the device until it ends.
pid_t driver(DhdFault fault, DhdBlock& block) {
    const pid_t child = fork();
    if (child != 0) return child;
    const Dhd dhd;
    dhd.openId(0);
    dhd.enableForce(1, 0);
    dhd.library.get<int(unsigned char, char)>("dhdSetWatchdog")(10, 0);
    int result = 0;
    for (int i = 0;; ++i) {
        if (i == 50) block.devices[0].fault = fault;
        dhd.position(result);
        dhd.set(0, 0, 5, 0, 0, 0, 0, 0);
    }
}

TEST(DhdShim, KeepsItsCountsWhenTheProcessThatDroveItDies) {
    // Truth: invariant: memory that two processes share. The device's own watchdog ends what a dead program left on.
    for (const DhdFault fault : {DhdFault::None, DhdFault::Crash}) {
        SharedBlock<DhdBlock> block(fake::kDhdVariable);
        const pid_t child = driver(fault, *block);
        DhdDevice& device = block->devices[0];
        if (fault == DhdFault::None) {
            fake::waitFor(
                "commands", [] { return fake::readable(-1, 1); }, [&] { return device.commands.count() >= 100; });
            kill(child, SIGKILL);
        }
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_EQ(WTERMSIG(status), fault == DhdFault::None ? SIGKILL : SIGSEGV);
        EXPECT_GE(device.commands.count(), 50);
        EXPECT_EQ(device.commands.last().call, static_cast<double>(device.commands.count()));
        EXPECT_EQ(feltAfterSilence(device, 9)[2], 5.0);
        EXPECT_EQ(feltAfterSilence(device, 10)[2], 0.0);
    }
}

}  // namespace
}  // namespace passung
