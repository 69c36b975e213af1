#include "devices/dhd/dhd_link.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <random>

#include "tests/devices/fakes/dhd_block.h"

/// The backend against a shim of the vendor's library, which was written from what is public before it; all in one
/// process, so that each exchange is one servo call.
namespace passung::dhd {
namespace {

using fake::DhdBlock;
using fake::DhdHand;
using fake::SharedBlock;
using std::chrono::milliseconds;
using unit::Exchange;
using Kind = Exchange::Kind;

/// Ours from the vendor's, by hand: x (right) is its y, y (away from the operator) against its x, z (up) its z.
Vec3 ours(const double* v) { return {v[1], -v[0], v[2]}; }
Vec3 vendors(const Vec3& v) { return {-v.y(), v.x(), v.z()}; }

struct Shim {
    SharedBlock<DhdBlock> block{fake::kDhdVariable};
    DeviceDescription limits;
    DhdLink link;

    explicit Shim(DeviceChoice choice = {.backend = "dhd"}) : link(at(std::move(choice)), limits) {}
    static DeviceChoice at(DeviceChoice choice) {
        if (choice.address.empty()) choice.address = PASSUNG_DHD_SHIM_FILE;
        return choice;
    }
    Exchange exchange(const Wrench& F = {}) { return link.exchange(F, milliseconds(1)); }
    fake::DhdDevice& device(std::size_t number = 0) { return block->devices[number]; }
};

/// A pose of the handle in our base, put into the device as it would say it: each axis of the rotation by hand.
void put(fake::DhdDevice& device, const Pose& X_BD) {
    DhdHand hand;
    const Vec3 p = vendors(X_BD.p);
    for (int i = 0; i < 3; ++i) hand.position[i] = p[i];
    // Columns of the vendor's frame: where its handle's x, y and z point. Its x is our -y, its y our x.
    const Vec3 columns[3] = {vendors(X_BD.q * Vec3(0, -1, 0)), vendors(X_BD.q * Vec3(1, 0, 0)),
                             vendors(X_BD.q * Vec3(0, 0, 1))};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) hand.frame[3 * row + column] = columns[column][row];
    device.hand.store(hand);
}

struct Poses {
    std::mt19937 random{17};
    std::uniform_real_distribution<double> any{-1.0, 1.0};
    Vec3 vector(double scale) { return scale * Vec3(any(random), any(random), any(random)); }
    Pose pose() { return {Quat(any(random), any(random), any(random), any(random)).normalized(), vector(0.08)}; }
};

TEST(DhdLink, GivesPosesAndTakesWrenchesInOurFrame) {
    // Truth: closed form: the vendor's frame (x to the operator, y to the right, z up) turned by hand. 1 nm, 1 nrad.
    Shim shim;
    ASSERT_TRUE(shim.link.open());
    Poses poses;
    for (int i = 0; i < 1000; ++i) {
        const Pose X_BD = poses.pose();
        const Wrench F{poses.vector(5.0), poses.vector(0.1)};
        put(shim.device(), X_BD);
        const Exchange said = shim.exchange(F);
        ASSERT_EQ(said.kind, Kind::News) << said.why;
        EXPECT_LT((said.said.X_BD.p - X_BD.p).norm(), 1e-9);
        EXPECT_LT(rotationVector(said.said.X_BD.q * X_BD.q.conjugate()).norm(), 1e-9);
        const fake::DhdCommand command = shim.device().commands.last();
        EXPECT_EQ(ours(command.felt), F.force);
        EXPECT_EQ(ours(command.felt + 3), F.torque);
        EXPECT_EQ(command.felt[6], 0.0);
    }
    EXPECT_EQ(shim.device().commands.count(), 1001) << "one when it is opened, one each exchange";
}

TEST(DhdLink, EachOfTheWrongAxesIsFound) {
    // Truth: closed form as above: of 48 ways to name the axes one gives the pose that was put.
    const Pose X_BD{rotationFromVector(Vec3(0.3, 0.5, -0.7)), Vec3(0.01, 0.02, 0.03)};
    const char* names[] = {"x", "y", "z"};
    int right = 0, ways = 0;
    for (int order = 0; order < 27; ++order) {
        const int place[] = {order % 3, order / 3 % 3, order / 9};
        if (place[0] == place[1] || place[1] == place[2] || place[0] == place[2]) continue;
        for (int signs = 0; signs < 8; ++signs) {
            std::string axes;
            for (int i = 0; i < 3; ++i)
                axes += std::string(i > 0 ? " " : "") + ((signs >> i & 1) != 0 ? "-" : "") + names[place[i]];
            Shim shim({.backend = "dhd", .axes = axes});
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

TEST(DhdLink, TellsWhoItIsAndPreparesTheDevice) {
    // Truth: the shim's own account: watchdog, limits, no force before the first command.
    Shim shim;
    shim.device().brakes = true;
    const auto unit = shim.link.open();
    ASSERT_TRUE(unit);
    EXPECT_EQ(unit->serial, "4711");
    EXPECT_EQ(unit->model, "sigma.7");
    EXPECT_EQ(unit->versions, "SDK 3.17.6.0, firmware 2.00");
    EXPECT_EQ(unit->calibration, "axes y -x z; watchdog 20 ms");
    EXPECT_EQ(shim.device().watchdog_ms, DhdLink::kWatchdog);
    EXPECT_EQ(shim.device().max_force, 12.0);
    EXPECT_EQ(shim.device().max_torque, 0.2);
    EXPECT_TRUE(shim.device().forces_enabled);
    EXPECT_FALSE(shim.device().brakes);
    EXPECT_EQ(shim.device().commands.count(), 1);
    DhdHand hand;
    hand.buttons = 5;
    hand.grip_angle = 0.4;
    shim.device().hand.store(hand);
    const Exchange said = shim.exchange();
    EXPECT_EQ(said.said.buttons, 5u);
    EXPECT_EQ(said.said.grip_rad, 0.4);
    shim.link.close();
    EXPECT_FALSE(shim.device().opened);
}

TEST(DhdLink, NotesOfTheLibraryAreNoFailures) {
    // Truth: the vendor's public documentation: 1 (time guard) and 2 (saturated) are successes.
    for (const int note : {1, 2}) {
        Shim shim;
        ASSERT_TRUE(shim.link.open());
        shim.block->call_result = note;
        EXPECT_EQ(shim.exchange().kind, Kind::News) << note;
    }
}

TEST(DhdLink, TwoUnitsAreToldApartBySerialWhateverTheOrderOfPlugging) {
    // Truth: the shim's own account: which of them is opened.
    for (const char* library : {PASSUNG_DHD_SHIM_FILE, PASSUNG_DHD_SHIM_WITHOUT_SERIAL_FILE}) {
        for (const bool swapped : {false, true}) {
            Shim shim({.backend = "dhd", .serial = "4712", .address = library});
            shim.block->present = 2;
            shim.block->swapped = swapped;
            const auto unit = shim.link.open();
            ASSERT_TRUE(unit) << unit.errors().front().message;
            EXPECT_EQ(unit->serial, "4712");
            EXPECT_TRUE(shim.device(1).opened);
            EXPECT_FALSE(shim.device(0).opened);
        }
    }
    Shim shim;
    shim.block->present = 2;
    EXPECT_NE(shim.link.open().errors().front().message.find("name one as `serial`"), std::string::npos);
    Shim none({.backend = "dhd", .serial = "9"});
    EXPECT_NE(none.link.open().errors().front().message.find("finds no device 9"), std::string::npos);
}

/// What opening says where something is missing.
std::string refusal(const DeviceChoice& choice, const std::function<void(DhdBlock&)>& around = nullptr) {
    Shim shim(choice);
    if (around) around(*shim.block);
    const auto opened = shim.link.open();
    return opened ? "opened" : opened.errors().front().message;
}

TEST(DhdLink, SaysWhatIsMissingAndWhatToDo) {
    // Truth: invariant: the file, the name and the remedy stand in the sentence.
    const auto has = [](const std::string& text, std::initializer_list<const char*> parts) {
        for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
    };
    has(refusal({.address = "/nonexistent/libdhd.so"}),
        {"does not load from /nonexistent/libdhd.so", "No such file", "PASSUNG_DHD_LIBRARY"});
    has(refusal({.address = PASSUNG_DHD_SHIM_INCOMPLETE_FILE}),
        {"has no function dhdSetForceAndTorqueAndGripperForce", "libdhd-shim-incomplete.so"});
    has(refusal({.address = PASSUNG_DHD_SHIM_OLD_FILE}), {"has no function dhdSetWatchdog", "older than 3.17"});
    has(refusal({}, [](DhdBlock& block) { block.version[0] = 2; }), {"is of version 2.17, and not 3"});
    has(refusal({}, [](DhdBlock& block) { block.present = 0; }), {"sees no device", "lsusb -d 1451:", "udev"});
    has(refusal({}, [](DhdBlock& block) { block.devices[0].plugged = false; }), {"dhdOpenID", "no device found"});
    has(refusal({}, [](DhdBlock& block) { block.devices[0].type = 34; }), {"4711 is no sigma.7 but omega.6"});

    const Shim shim;
    setenv(DhdLibrary::kFileVariable, "/elsewhere/libdhd.so", 1);
    EXPECT_NE(DhdLibrary::load({}).errors().front().message.find("/elsewhere/libdhd.so"), std::string::npos);
    setenv(DhdLibrary::kFileVariable, PASSUNG_DHD_SHIM_FILE, 1);
    EXPECT_TRUE(DhdLibrary::load({}));
    unsetenv(DhdLibrary::kFileVariable);
    const auto usual = DhdLibrary::load({});
    if (!usual)
        has(usual.errors().front().message,
            {"libdhd.so.3, libdhd.so, libdrd.so.3", "ld.so.conf", "path of its libdhd.so"});
}

struct Saying {
    const char* name;
    Kind kind;
    const char* why;
    std::function<void(DhdBlock&)> happens;
};

class DhdSays : public testing::TestWithParam<Saying> {};

TEST_P(DhdSays, WhatCannotBeIsNoReading) {
    // Truth: invariant.
    Shim shim;
    ASSERT_TRUE(shim.link.open());
    ASSERT_EQ(shim.exchange().kind, Kind::News);
    GetParam().happens(*shim.block);
    const Exchange said = shim.exchange({Vec3(1, 2, 3), Vec3::Zero()});
    EXPECT_EQ(said.kind, GetParam().kind);
    EXPECT_NE(said.why.find(GetParam().why), std::string::npos) << said.why;
}

void shape(DhdBlock& block, double x, double first) {
    DhdHand hand;
    hand.position[0] = x;
    hand.frame[0] = first;
    block.devices[0].hand.store(hand);
}

INSTANTIATE_TEST_SUITE_P(
    Readings, DhdSays,
    testing::Values(
        Saying{"MinusOne", Kind::Gone, "communication error", [](DhdBlock& b) { b.devices[0].plugged = false; }},
        Saying{"SetReturnsMinusOne", Kind::Gone, "dhdSetForceAndTorqueAndGripperForce",
               [](DhdBlock& b) { b.call_result = -1; }},
        Saying{"Timeout", Kind::Gone, "timeout", [](DhdBlock& b) { b.devices[0].fault = fake::DhdFault::Timeout; }},
        Saying{"NotANumber", Kind::Wrong, "no finite number",
               [](DhdBlock& b) { b.devices[0].fault = fake::DhdFault::NotANumber; }},
        Saying{"Infinite", Kind::Wrong, "no finite number",
               [](DhdBlock& b) { shape(b, std::numeric_limits<double>::infinity(), 1); }},
        Saying{"Millimetres", Kind::Wrong, "in mm", [](DhdBlock& b) { shape(b, 0.03, 1), b.millimetres = true; }},
        Saying{"NoRotation", Kind::Wrong, "no rotation", [](DhdBlock& b) { shape(b, 0, 1.1); }},
        Saying{"Mirrored", Kind::Wrong, "no rotation", [](DhdBlock& b) { shape(b, 0, -1); }},
        Saying{"Brakes", Kind::Wrong, "motors off", [](DhdBlock& b) { b.devices[0].brakes = true; }},
        Saying{"ForceButton", Kind::Wrong, "cause 3",
               [](DhdBlock& b) {
                   b.devices[0].forces_enabled = false;
                   b.devices[0].force_off_cause = 3;
               }}),
    [](const auto& one) { return one.param.name; });

TEST(DhdLink, LookListsAllUnitsAndLeavesThemClosed) {
    // Truth: the shim's own account.
    Shim shim;
    shim.block->present = 2;
    const auto units = look(PASSUNG_DHD_SHIM_FILE);
    ASSERT_TRUE(units);
    ASSERT_EQ(units->size(), 2u);
    EXPECT_EQ(units->front().serial + units->back().serial, "47114712");
    EXPECT_FALSE(shim.device(0).opened || shim.device(1).opened);
    shim.device(0).type = 34;
    EXPECT_EQ(look(PASSUNG_DHD_SHIM_FILE)->size(), 1u) << "what cannot be used is none";
    shim.device(1).type = 63;
    EXPECT_NE(look(PASSUNG_DHD_SHIM_FILE).errors().front().message.find("4712 is no sigma.7 but delta.3"),
              std::string::npos);
    shim.device(0).plugged = shim.device(1).plugged = false;
    EXPECT_NE(look(PASSUNG_DHD_SHIM_FILE).errors().front().message.find("opens none"), std::string::npos);
}

}  // namespace
}  // namespace passung::dhd
