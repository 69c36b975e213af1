#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "tests/devices/fakes/hd_block.h"
#include "tests/devices/fakes/shim_library.h"

/// The shim of OpenHaptics' HD library, called through its names as a backend calls the vendor's. Signatures and
/// numbers of parameters are written here a second time, so that a slip in the shim is no slip here.
namespace passung {
namespace {

using fake::HdBlock;
using fake::HdCommand;
using fake::HdDevice;
using fake::HdFault;
using fake::HdHand;
using fake::SharedBlock;
using fake::ShimLibrary;

constexpr unsigned kPosition = 0x2050, kVelocity = 0x2051, kTransform = 0x2052, kMaxForce = 0x2603, kRate = 0x2601,
                   kForce = 0x2700, kTorque = 0x2701, kButtons = 0x2000, kOutput = 0x4000, kClamping = 0x4001;
constexpr unsigned kNoDevice = 0xFFFFFFFF, kContinue = 1, kDone = 0;

struct ErrorInfo {
    unsigned code;
    int internal_code;
    unsigned device;
};

struct Hd {
    explicit Hd(const char* path = PASSUNG_HD_SHIM_FILE) : library(path) {}
    ~Hd() {
        if (started) library.get<void()>("hdStopScheduler")();
    }
    void start(std::function<void()> each) {
        body = std::move(each);
        library.get<unsigned long(unsigned (*)(void*), void*, unsigned short)>("hdScheduleAsynchronous")(
            [](void* self) {
                static_cast<Hd*>(self)->body();
                return kContinue;
            },
            this, 0x7fff);
        library.get<void()>("hdStartScheduler")();
        started = true;
    }
    std::array<double, 16> numbers(unsigned name) const {
        std::array<double, 16> values;
        values.fill(-7);
        getDoublev(name, values.data());
        return values;
    }
    ShimLibrary library;
    unsigned (*init)(const char*) = library.get<unsigned(const char*)>("hdInitDevice");
    void (*enable)(unsigned) = library.get<void(unsigned)>("hdEnable");
    void (*begin)(unsigned) = library.get<void(unsigned)>("hdBeginFrame");
    void (*end)(unsigned) = library.get<void(unsigned)>("hdEndFrame");
    void (*getDoublev)(unsigned, double*) = library.get<void(unsigned, double*)>("hdGetDoublev");
    void (*setDoublev)(unsigned, const double*) = library.get<void(unsigned, const double*)>("hdSetDoublev");
    ErrorInfo (*error)() = library.get<ErrorInfo()>("hdGetError");
    std::function<void()> body;
    bool started = false;
};

TEST(HdShim, HasTheNamesOfTheVendorsLibraryAndItsVariantLacksOne) {
    // Truth: the vendor's public reference guide, by name.
    const ShimLibrary library(PASSUNG_HD_SHIM_FILE);
    const ShimLibrary incomplete(PASSUNG_HD_SHIM_INCOMPLETE_FILE);
    for (const char* name : {"hdInitDevice",
                             "hdDisableDevice",
                             "hdMakeCurrentDevice",
                             "hdGetCurrentDevice",
                             "hdEnable",
                             "hdDisable",
                             "hdIsEnabled",
                             "hdStartScheduler",
                             "hdStopScheduler",
                             "hdScheduleAsynchronous",
                             "hdScheduleSynchronous",
                             "hdUnschedule",
                             "hdSetSchedulerRate",
                             "hdGetSchedulerTimeStamp",
                             "hdBeginFrame",
                             "hdEndFrame",
                             "hdGetDoublev",
                             "hdGetFloatv",
                             "hdGetIntegerv",
                             "hdGetBooleanv",
                             "hdGetString",
                             "hdSetDoublev",
                             "hdSetFloatv",
                             "hdCheckCalibration",
                             "hdUpdateCalibration",
                             "hdGetError",
                             "hdGetErrorString"}) {
        EXPECT_TRUE(library.has(name)) << name;
        EXPECT_EQ(incomplete.has(name), std::string(name) != "hdScheduleAsynchronous") << name;
    }
}

TEST(HdShim, FindsNothingWithoutABlock) {
    // Truth: invariant: no device, an error, and nothing that crashes.
    const Hd hd;
    EXPECT_EQ(hd.init(nullptr), kNoDevice);
    EXPECT_EQ(hd.error().code, 0x300u);
    EXPECT_EQ(hd.error().code, 0u) << "the stack is empty";
    EXPECT_EQ(hd.numbers(kMaxForce)[0], -7);
    hd.begin(0);
    EXPECT_EQ(hd.error().code, 0x104u);
}

TEST(HdShim, GivesMillimetresAndATransformColumnByColumn) {
    // Truth: closed form: a rotation by 90° about z takes x to y, so that the first column is 0, 1, 0.
    SharedBlock<HdBlock> block(fake::kHdVariable);
    const Hd hd;
    HdHand hand;
    hand.position[0] = 0.01;
    hand.position[1] = 0.02;
    hand.position[2] = -0.03;
    hand.velocity[2] = 0.5;
    hand.buttons = 3;
    const double quarter[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
    std::copy(quarter, quarter + 9, hand.frame);
    block->devices[0].hand.store(hand);
    ASSERT_EQ(hd.init(nullptr), 0u);
    hd.begin(0);
    const auto transform = hd.numbers(kTransform);
    const std::array<double, 16> expected{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 10, 20, -30, 1};
    EXPECT_EQ(transform, expected);
    EXPECT_EQ(hd.numbers(kPosition)[2], -30.0);
    EXPECT_EQ(hd.numbers(kVelocity)[2], 500.0);
    int buttons = 0;
    hd.library.get<void(unsigned, int*)>("hdGetIntegerv")(kButtons, &buttons);
    EXPECT_EQ(buttons, 3);
    hand.position[0] = 0.09;
    block->devices[0].hand.store(hand);
    EXPECT_EQ(hd.numbers(kPosition)[0], 10.0) << "a frame keeps its hand";
    hd.end(0);
    EXPECT_EQ(hd.error().code, 0u);
    block->metres = true;
    hd.begin(0);
    EXPECT_EQ(hd.numbers(kPosition)[0], 0.09);
    hd.end(0);
}

TEST(HdShim, TakesMillinewtonmetresAndFeelsThemAtTheEndOfTheFrame) {
    // Truth: the vendor's public reference guide: N and mN·m; closed form for the limits.
    SharedBlock<HdBlock> block(fake::kHdVariable);
    HdDevice& device = block->devices[0];
    const Hd hd;
    ASSERT_EQ(hd.init("Default Device"), 0u);
    EXPECT_EQ(hd.numbers(kMaxForce)[0], 3.3);
    const auto frame = [&](std::array<double, 3> force, std::array<double, 3> torque) {
        hd.begin(0);
        hd.setDoublev(kForce, force.data());
        hd.setDoublev(kTorque, torque.data());
        hd.end(0);
        return device.commands.last();
    };
    EXPECT_EQ(frame({1, 2, 0}, {0, 0, 50}).felt[1], 0.0) << "no output yet";
    hd.enable(kOutput);
    HdCommand command = frame({1, 2, -0.5}, {10, 20, 50});
    const double expected[6] = {1, 2, -0.5, 0.010, 0.020, 0.050};
    for (int i = 0; i < 6; ++i) EXPECT_DOUBLE_EQ(command.felt[i], expected[i]);
    EXPECT_EQ(command.asked[5], 50.0);
    block->newtonmetres = true;
    EXPECT_DOUBLE_EQ(frame({0, 0, 0}, {0.01, 0, 0}).felt[3], 0.01);
    block->newtonmetres = false;
    hd.enable(kClamping);
    command = frame({0, 6, 8}, {0, 0, 0});
    EXPECT_NEAR(command.felt[1], 3.3 * 0.6, 1e-15);
    EXPECT_NEAR(command.felt[2], 3.3 * 0.8, 1e-15);
    hd.begin(0);
    hd.end(0);
    EXPECT_EQ(device.commands.last().felt[1], 0.0) << "a frame without a force commands none";
    device.clamping = false;
    EXPECT_EQ(frame({0, 6, 8}, {0, 0, 0}).felt[1], 0.0);
    EXPECT_EQ(hd.error().code, 0x201u);
    EXPECT_EQ(frame({0, 1, 0}, {0, 0, 0}).felt[1], 0.0) << "the output is off";
    device.force_output = true;
    device.output_degrees = 3;
    command = frame({0, 1, 0}, {10, 0, 0});
    EXPECT_EQ(command.felt[1], 1.0);
    EXPECT_EQ(command.felt[3], 0.0);
    frame({std::numeric_limits<double>::quiet_NaN(), 0, 0}, {0, 0, 0});
    EXPECT_EQ(device.non_finite, 1);
    EXPECT_EQ(device.frames, device.commands.count());
}

TEST(HdShim, KeepsItsErrorsOnAStackWithTheNewestFirst) {
    // Truth: the vendor's public reference guide.
    SharedBlock<HdBlock> block(fake::kHdVariable);
    const Hd hd;
    ASSERT_EQ(hd.init(nullptr), 0u);
    EXPECT_EQ(hd.numbers(kPosition)[0], -7) << "no frame, no state";
    hd.end(0);
    hd.begin(0);
    hd.begin(0);
    hd.end(0);
    hd.getDoublev(0x9999, nullptr);
    EXPECT_EQ(hd.error().code, 0x100u);
    EXPECT_EQ(hd.error().code, 0x400u);
    EXPECT_EQ(hd.error().code, 0x401u);
    const ErrorInfo oldest = hd.error();
    EXPECT_EQ(oldest.code, 0x402u);
    EXPECT_EQ(oldest.device, 0u);
    EXPECT_EQ(hd.error().code, 0u);
    EXPECT_EQ(block->errors, 4);
    EXPECT_EQ(hd.init(nullptr), kNoDevice);
    EXPECT_EQ(hd.error().code, 0x301u);
}

TEST(HdShim, CallsBackOncePerTickInAThreadOfItsOwn) {
    // Truth: invariant of virtual time: as many calls as steps, none between.
    SharedBlock<HdBlock> block(fake::kHdVariable);
    std::thread::id thread;
    int calls = 0;
    Hd hd;
    ASSERT_EQ(hd.init(nullptr), 0u);
    hd.enable(kOutput);
    hd.start([&] {
        thread = std::this_thread::get_id();
        ++calls;
        hd.begin(0);
        const double force[3] = {0, 0.001 * calls, 0};
        hd.setDoublev(kForce, force);
        hd.end(0);
    });
    EXPECT_EQ(calls, 0);
    fake::step(*block, 1000);
    EXPECT_EQ(calls, 1000);
    EXPECT_EQ(block->calls, 1000);
    EXPECT_NE(thread, std::this_thread::get_id());
    const auto& commands = block->devices[0].commands;
    ASSERT_EQ(commands.count(), 1000);
    for (int i = 0; i < 1000; ++i) {
        EXPECT_EQ(commands.row(i).tick, i + 1);
        EXPECT_DOUBLE_EQ(commands.row(i).felt[1], 0.001 * (i + 1));
    }
    block->stalled = true;
    fake::step(*block, 10);
    EXPECT_EQ(calls, 1000) << "the vendor's thread hangs";
    EXPECT_EQ(block->ticks, 1010);
}

TEST(HdShim, CallsBackByTheClockWhereItIsNotStepped) {
    // Truth: invariant: the thread runs by itself, however fast, and says the rate that it has.
    SharedBlock<HdBlock> block(fake::kHdVariable);
    block->stepped = false;
    block->granted_rate = 500;
    std::atomic<int> calls = 0;  // outlives the scheduler, which ends with hd
    Hd hd;
    ASSERT_EQ(hd.init(nullptr), 0u);
    const auto set_rate = hd.library.get<void(unsigned long)>("hdSetSchedulerRate");
    set_rate(1000);
    EXPECT_EQ(hd.error().code, 0x101u);
    set_rate(500);
    EXPECT_EQ(hd.error().code, 0u);
    EXPECT_EQ(hd.numbers(kRate)[0], 500.0);
    hd.start([&] { ++calls; });
    fake::waitFor(
        "calls", [] { return fake::readable(-1, 1); }, [&] { return calls >= 20; });
}

TEST(HdShim, RunsCallbacksByPriorityUntilTheyAreDone) {
    // Truth: the vendor's public reference guide: higher priorities first; a callback that is done is called no more.
    SharedBlock<HdBlock> block(fake::kHdVariable);
    Hd hd;
    ASSERT_EQ(hd.init(nullptr), 0u);
    static std::string order;
    order.clear();
    const auto schedule =
        hd.library.get<unsigned long(unsigned (*)(void*), void*, unsigned short)>("hdScheduleAsynchronous");
    const auto low = schedule(
        [](void*) {
            order += 'l';
            return kContinue;
        },
        nullptr, 1);
    schedule(
        [](void*) {
            order += 'h';
            return kDone;
        },
        nullptr, 9);
    hd.start([] { order += 'n'; });
    fake::step(*block, 2);
    EXPECT_EQ(order, "nhlnl");
    EXPECT_EQ(hd.library.get<unsigned char(unsigned long)>("hdUnschedule")(low), 1);
    fake::step(*block, 1);
    EXPECT_EQ(order, "nhlnln");
    hd.library.get<void(unsigned (*)(void*), void*, unsigned short)>("hdScheduleSynchronous")(
        [](void*) {
            order += 's';
            return kDone;
        },
        nullptr, 1);
    EXPECT_EQ(order, "nhlnlns");
}

TEST(HdShim, FailsAsItIsToldFromTheTickOnThatItIsTold) {
    // Truth: invariant.
    SharedBlock<HdBlock> block(fake::kHdVariable);
    HdDevice& device = block->devices[0];
    double x = 0, y = 0;
    unsigned error = 0;
    Hd hd;
    ASSERT_EQ(hd.init(nullptr), 0u);
    hd.start([&] {
        hd.begin(0);
        const auto position = hd.numbers(kPosition);
        x = position[0];
        y = position[1];
        hd.end(0);
        error = 0;
        for (ErrorInfo info = hd.error(); info.code != 0; info = hd.error()) error = info.code;  // the oldest
    });
    HdHand hand;
    const auto move = [&](double to) {
        hand.position[0] = to;
        device.hand.store(hand);
        fake::step(*block);
    };
    device.fault = HdFault::Frozen;
    device.fault_at_tick = 2;
    move(0.001);
    EXPECT_EQ(x, 1.0);
    move(0.002);
    EXPECT_EQ(x, 1.0);
    device.fault = HdFault::NotANumber;
    move(0.003);
    EXPECT_TRUE(std::isnan(y));
    EXPECT_EQ(error, 0u);
    device.fault = HdFault::WarmMotors;
    move(0.004);
    EXPECT_EQ(x, 4.0);
    EXPECT_EQ(error, 0x200u);
    device.fault = HdFault::None;
    device.plugged = false;
    const auto before = device.commands.count();
    move(0.005);
    EXPECT_EQ(x, -7);
    EXPECT_EQ(error, 0x302u);
    EXPECT_EQ(device.commands.count(), before) << "nothing reaches a device that is gone";
    device.plugged = true;
    move(0.006);
    EXPECT_EQ(x, 6.0);
    EXPECT_EQ(error, 0u);
}

TEST(HdShim, TellsTwoDevicesApartBySerialWhateverTheirNames) {
    // Truth: invariant.
    for (const bool swapped : {false, true}) {
        SharedBlock<HdBlock> block(fake::kHdVariable);
        block->present = 2;
        block->swapped = swapped;
        const Hd hd;
        const unsigned handle = hd.init("Left Device");
        ASSERT_EQ(handle, swapped ? 0u : 1u);
        EXPECT_STREQ(hd.library.get<const char*(unsigned)>("hdGetString")(0x2504), swapped ? "815" : "816");
        EXPECT_EQ(hd.init("Third Device"), kNoDevice);
        EXPECT_NE(hd.init("Default Device"), kNoDevice);
    }
}

TEST(HdShim, KeepsItsCountsWhenTheProcessThatDroveItIsKilled) {
    // Truth: invariant: memory that two processes share, stepped from outside.
    SharedBlock<HdBlock> block(fake::kHdVariable);
    const pid_t child = fork();
    if (child == 0) {
        Hd hd;
        hd.init(nullptr);
        hd.enable(kOutput);
        hd.start([&] {
            hd.begin(0);
            const double force[3] = {0, 0, 2};
            hd.setDoublev(kForce, force);
            hd.end(0);
        });
        for (;;) pause();
    }
    fake::step(*block, 25);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_EQ(block->ticks, 25);
    EXPECT_EQ(block->devices[0].commands.count(), 25);
    EXPECT_EQ(block->devices[0].commands.last().felt[2], 2.0) << "it stands until somebody ends it";
    const Hd next;
    EXPECT_EQ(next.init(nullptr), 0u) << "a dead process lets the device go";
}

}  // namespace
}  // namespace passung
