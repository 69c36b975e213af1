#include "devices/hd/hd_link.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <random>
#include <thread>

#include "tests/devices/fakes/hd_block.h"

/// The backend against a shim of the vendor's library, which was written from what is public before it; all in one
/// process, so that each exchange is one frame.
namespace passung::hd {
namespace {

using fake::HdBlock;
using fake::HdHand;
using fake::SharedBlock;
using std::chrono::milliseconds;
using unit::Exchange;
using Kind = Exchange::Kind;

/// Ours from the vendor's, by hand: x (right) is its x, y (away from the operator) against its z, z (up) its y.
Vec3 ours(const double* v) { return {v[0], -v[2], v[1]}; }
Vec3 vendors(const Vec3& v) { return {v.x(), v.z(), -v.y()}; }

DeviceDescription touch() {
    DeviceDescription limits;
    limits.actuated_degrees = 3;
    limits.max_force_N = 3.3;
    limits.max_torque_Nm = 0.0;
    return limits;
}

struct Shim {
    SharedBlock<HdBlock> block{fake::kHdVariable};
    HdLink link;

    explicit Shim(DeviceChoice choice = {.backend = "hd"}) : link(at(std::move(choice)), touch()) {}
    static DeviceChoice at(DeviceChoice choice) {
        if (choice.address.empty()) choice.address = PASSUNG_HD_SHIM_FILE;
        return choice;
    }
    Exchange exchange(const Wrench& F = {}) { return link.exchange(F, milliseconds(1)); }
    fake::HdDevice& device(std::size_t number = 0) { return block->devices[number]; }
};

/// A pose of the handle in our base, put into the device as it would say it: each axis of the rotation by hand.
void put(fake::HdDevice& device, const Pose& X_BD) {
    HdHand hand;
    const Vec3 p = vendors(X_BD.p);
    for (int i = 0; i < 3; ++i) hand.position[i] = p[i];
    // Columns of the vendor's frame: where its handle's x, y and z point. Its y is our z, its z against our y.
    const Vec3 columns[3] = {vendors(X_BD.q * Vec3(1, 0, 0)), vendors(X_BD.q * Vec3(0, 0, 1)),
                             vendors(X_BD.q * Vec3(0, -1, 0))};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) hand.frame[3 * row + column] = columns[column][row];
    device.hand.store(hand);
}

TEST(HdLink, GivesPosesInMetresAndTakesForcesInOurFrameAndNoTorque) {
    // Truth: closed form: the vendor's frame (x to the right, y up, z to the operator), mm and columns turned by hand.
    // 1 nm, 1 nrad.
    std::mt19937 random{19};
    std::uniform_real_distribution<double> any{-1.0, 1.0};
    const auto vector = [&](double scale) { return Vec3(scale * Vec3(any(random), any(random), any(random))); };
    for (const bool takes_newtonmetres : {false, true}) {
        Shim shim;
        shim.block->newtonmetres = takes_newtonmetres;
        ASSERT_TRUE(shim.link.open());
        const auto errors = shim.block->errors.load();  // names that no device has
        for (int i = 0; i < 1000; ++i) {
            const Pose X_BD{Quat(any(random), any(random), any(random), any(random)).normalized(), vector(0.08)};
            const Wrench F{vector(1.5), vector(0.1)};
            put(shim.device(), X_BD);
            const Exchange said = shim.exchange(F);
            ASSERT_EQ(said.kind, Kind::News) << said.why;
            EXPECT_LT((said.said.X_BD.p - X_BD.p).norm(), 1e-9);
            EXPECT_LT(rotationVector(said.said.X_BD.q * X_BD.q.conjugate()).norm(), 1e-9);
            const fake::HdCommand command = shim.device().commands.last();
            EXPECT_EQ(ours(command.felt), F.force);
            EXPECT_EQ(ours(command.felt + 3), Vec3(Vec3::Zero()));
        }
        EXPECT_EQ(shim.device().commands.count(), 1000) << "a frame for each exchange";
        EXPECT_EQ(shim.block->errors, errors);
    }
}

TEST(HdLink, EachOfTheWrongAxesIsFound) {
    // Truth: closed form as above: of 48 ways to name the axes one gives the pose that was put.
    const Pose X_BD{rotationFromVector(Vec3(0.3, 0.5, -0.7)), Vec3(0.01, 0.02, 0.03)};
    int right = 0, ways = 0;
    for (const char* order : {"x y z", "x z y", "y x z", "y z x", "z x y", "z y x"}) {
        for (int signs = 0; signs < 8; ++signs) {
            std::string axes;
            for (std::size_t i = 0; i < 3; ++i)
                axes += std::string(i > 0 ? " " : "") + ((signs >> i & 1) != 0 ? "-" : "") + order[2 * i];
            Shim shim({.backend = "hd", .axes = axes});
            ASSERT_TRUE(shim.link.open()) << axes;
            put(shim.device(), X_BD);
            const Exchange said = shim.exchange();
            const bool same = (said.said.X_BD.p - X_BD.p).norm() < 1e-9 &&
                              rotationVector(said.said.X_BD.q * X_BD.q.conjugate()).norm() < 1e-9;
            EXPECT_EQ(same, axes == kDefaultAxes) << axes;
            right += same ? 1 : 0;
            ++ways;
        }
    }
    EXPECT_EQ(ways, 48);
    EXPECT_EQ(right, 1);
}

TEST(HdLink, TellsWhoItIsAndPreparesTheDevice) {
    // Truth: the shim's own account.
    Shim shim;
    const auto unit = shim.link.open();
    ASSERT_TRUE(unit) << unit.errors().front().message;
    EXPECT_EQ(unit->serial, "815");
    EXPECT_EQ(unit->model, "Premium 6DOF");
    EXPECT_EQ(unit->versions, "HD 3.4.0, driver 1.0");
    EXPECT_EQ(unit->calibration, "axes x -z y; 1000 Hz");
    EXPECT_TRUE(shim.device().force_output && shim.device().clamping && shim.device().ramping);
    EXPECT_EQ(shim.device().commands.count(), 0) << "no force";
    HdHand hand;
    hand.buttons = 3;
    shim.device().hand.store(hand);
    EXPECT_EQ(shim.exchange().said.buttons, 3u);
    shim.link.close();
    EXPECT_FALSE(shim.device().opened);
    EXPECT_FALSE(shim.device().force_output);
}

TEST(HdLink, AnotherRateIsToldAndNoFailure) {
    // Truth: the vendor's public reference: a rate may be refused.
    Shim shim;
    shim.block->granted_rate = 500;
    const auto unit = shim.link.open();
    ASSERT_TRUE(unit) << unit.errors().front().message;
    EXPECT_EQ(unit->calibration, "axes x -z y; 500 Hz");
    EXPECT_EQ(shim.exchange().kind, Kind::News);
}

TEST(HdLink, TwoUnitsAreToldApartBySerialWhateverTheirNames) {
    // Truth: the shim's own account: which of them is opened.
    for (const bool swapped : {false, true}) {
        Shim shim({.backend = "hd", .serial = "816"});
        shim.block->present = 2;
        shim.block->swapped = swapped;
        const auto unit = shim.link.open();
        ASSERT_TRUE(unit) << unit.errors().front().message;
        EXPECT_EQ(unit->serial, "816");
        EXPECT_TRUE(shim.device(1).opened);
        EXPECT_FALSE(shim.device(0).opened);
    }
    Shim named({.backend = "hd", .address = PASSUNG_HD_SHIM_FILE "#Left Device"});
    named.block->present = 2;
    EXPECT_EQ(named.link.open()->serial, "816");
}

/// What opening says where something is missing.
std::string refusal(const DeviceChoice& choice, const std::function<void(HdBlock&)>& around = nullptr) {
    Shim shim(choice);
    if (around) around(*shim.block);
    const auto opened = shim.link.open();
    return opened ? "opened" : opened.errors().front().message;
}

TEST(HdLink, SaysWhatIsMissingAndWhatToDo) {
    // Truth: invariant: the file, the name and the remedy stand in the sentence.
    const auto has = [](const std::string& text, std::initializer_list<const char*> parts) {
        for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
    };
    has(refusal({.address = "/nonexistent/libHD.so"}),
        {"does not load from /nonexistent/libHD.so", "No such file", "PASSUNG_HD_LIBRARY"});
    has(refusal({.address = PASSUNG_HD_SHIM_INCOMPLETE_FILE}),
        {"has no function hdScheduleAsynchronous", "libhd-shim-incomplete.so", "older than 3.4"});
    has(refusal({}, [](HdBlock& block) { block.present = 0; }), {"Default Device", "device fault", "hidraw"});
    has(refusal({.address = PASSUNG_HD_SHIM_FILE "#Touch of room 2"}), {"Touch of room 2", "0x0300"});
    has(refusal({}, [](HdBlock& block) { block.present = 2; }), {"has 2 devices", "name one as `serial`"});
    has(refusal({.serial = "9"}, [](HdBlock& block) { block.present = 2; }), {"has no device 9, but 815, 816"});
    has(refusal({}, [](HdBlock& block) { block.metres = true; }), {"reaches 0.16 mm", "count in m?"});
    has(refusal({}, [](HdBlock& block) { block.devices[0].max_force = 2.0; }), {"pushes with 2 N of 3.3 N"});
    has(refusal({}, [](HdBlock& block) { block.devices[0].output_degrees = 0; }), {"drives 0 of 3"});
    has(refusal({},
                [](HdBlock& block) {
                    block.devices[0].opened = true;
                    block.devices[0].owner = getppid();
                }),
        {"0x0301", "does another program use it"});
}

struct Saying {
    const char* name;
    Kind kind;
    const char* why;
    std::function<void(HdBlock&)> happens;
};

class HdSays : public testing::TestWithParam<Saying> {};

TEST_P(HdSays, WhatCannotBeIsNoReadingAndHasNoForce) {
    // Truth: invariant; the shim's own account of the force.
    Shim shim;
    ASSERT_TRUE(shim.link.open());
    ASSERT_EQ(shim.exchange().kind, Kind::News);
    GetParam().happens(*shim.block);
    const Exchange said = shim.exchange({Vec3(3, 2, 3), Vec3::Zero()});
    EXPECT_EQ(said.kind, GetParam().kind);
    EXPECT_NE(said.why.find(GetParam().why), std::string::npos) << said.why;
    for (const double felt : shim.device().commands.last().felt) EXPECT_EQ(felt, 0.0);
    EXPECT_TRUE(shim.device().force_output) << "for when it is armed again";
}

void shape(HdBlock& block, double x, double first) {
    HdHand hand;
    hand.position[0] = x;
    hand.frame[0] = first;
    block.devices[0].hand.store(hand);
}

INSTANTIATE_TEST_SUITE_P(
    Readings, HdSays,
    testing::Values(
        Saying{"Unplugged", Kind::Gone, "communication error", [](HdBlock& b) { b.devices[0].plugged = false; }},
        Saying{"Warm", Kind::Wrong, "too warm", [](HdBlock& b) { b.devices[0].fault = fake::HdFault::WarmMotors; }},
        Saying{"NotANumber", Kind::Wrong, "no finite number",
               [](HdBlock& b) { b.devices[0].fault = fake::HdFault::NotANumber; }},
        Saying{"FarAway", Kind::Wrong, "beyond any device's reach", [](HdBlock& b) { shape(b, 80.0, 1); }},
        Saying{"NoRotation", Kind::Wrong, "no rotation", [](HdBlock& b) { shape(b, 0, 1.1); }},
        Saying{"Mirrored", Kind::Wrong, "no rotation", [](HdBlock& b) { shape(b, 0, -1); }},
        Saying{"ForceOff", Kind::Wrong, "maximum force exceeded", [](HdBlock& b) { b.devices[0].clamping = false; }}),
    [](const auto& one) { return one.param.name; });

TEST(HdLink, IsStaleUntilItIsCalibrated) {
    // Truth: the vendor's public reference: some calibrate themselves, others in the inkwell.
    Shim shim;
    shim.device().calibration = kCalibrationNeedsUpdate;
    ASSERT_TRUE(shim.link.open());
    Exchange said = shim.exchange();
    EXPECT_EQ(said.kind, Kind::Stale);
    EXPECT_NE(said.why.find("calibrates itself"), std::string::npos);
    EXPECT_EQ(shim.exchange().kind, Kind::News);
    shim.device().calibration = 0x5002;
    said = shim.exchange();
    EXPECT_EQ(said.kind, Kind::Stale);
    EXPECT_NE(said.why.find("inkwell"), std::string::npos);
}

TEST(HdLink, TheLibrarysThreadMakesTheCyclesUntilOneIsTheLast) {
    // Truth: the shim's own account of its ticks and of the thread that calls.
    Shim shim;
    ASSERT_TRUE(shim.link.open());
    int cycles = 0;
    std::thread::id called_by;
    std::thread pacing([&] {
        EXPECT_TRUE(shim.link.pace([&] {
            called_by = std::this_thread::get_id();
            shim.exchange({Vec3(1, 0, 0), Vec3::Zero()});
            return ++cycles < 20;
        }));
    });
    const auto pacing_id = pacing.get_id();
    while (shim.block->calls < 20) fake::step(*shim.block);
    pacing.join();
    EXPECT_EQ(cycles, 20);
    EXPECT_NE(called_by, pacing_id);
    EXPECT_EQ(shim.device().frames, 20);
    fake::step(*shim.block, 3);
    EXPECT_EQ(shim.block->calls, 20) << "it is not called any more";
    shim.link.close();
}

TEST(HdLink, LookListsAllUnitsAndLeavesThemClosed) {
    // Truth: the shim's own account.
    Shim shim;
    shim.block->present = 2;
    const auto units = look(PASSUNG_HD_SHIM_FILE);
    ASSERT_TRUE(units);
    ASSERT_EQ(units->size(), 2u);
    EXPECT_EQ(units->front().serial + units->back().serial, "815816");
    EXPECT_FALSE(shim.device(0).opened || shim.device(1).opened);
    EXPECT_EQ(look(PASSUNG_HD_SHIM_FILE "#Left Device")->front().serial, "816");
}

}  // namespace
}  // namespace passung::hd
