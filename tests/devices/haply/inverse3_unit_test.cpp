#include "devices/haply/inverse3_unit.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <thread>

#include "devices/backends/backends.h"
#include "tests/devices/fakes/calls_until_zero.h"
#include "tests/devices/fakes/haply_service.h"
#include "tests/devices/unit/scripted_link.h"

/// The backend against a fake of the Inverse Service 3.5, which was written from its public pages before it.
namespace passung::haply {
namespace {

using fake::HaplyService;
using loop::DeviceState;
using unit::reached;

const Wrench kPush{Vec3(2, -1, 0.5), Vec3::Zero()};

/// A unit on the service, and a loop of a millisecond that pushes it, with a hand that trembles at the fake.
class Inverse3Unit : public testing::Test {
protected:
    std::unique_ptr<unit::Unit> open(const HaplyService& service, const std::string& serial = {}) {
        const std::string at =
            "localhost:" + std::to_string(service.port()) + ":" + std::to_string(service.eventPort());
        auto unit = backends::open({"right", "inverse3", "haply", serial, at, {}});
        if (!unit) throw std::runtime_error(unit.errors().front().message);
        return *std::move(unit);
    }
    static bool becomes(unit::Unit& unit, DeviceState state) {
        return reached([&] { return unit.state() == state; });
    }
    void tremble(HaplyService& service, const std::string& device) {
        fake::HaplyDeviceState state;
        state.position[0] = 1e-5 * static_cast<double>(++trembled_ % 7);
        service.setState(device, state);
    }
    /// One cycle, and the message that it sends.
    DeviceReading tick(unit::Unit& unit, HaplyService& service, const std::string& device, const Wrench& F = kPush) {
        tremble(service, device);
        DeviceReading reading = unit.read();
        const std::int64_t before = service.messages();
        unit.command(F);
        for (int i = 0; i < 20 && service.messages() == before; ++i) poll(nullptr, 0, 1);
        return reading;
    }
    void begin(unit::Unit& unit, HaplyService& service, const std::string& device, int ticks = 30) {
        ASSERT_TRUE(becomes(unit, DeviceState::Present)) << unit.trouble();
        unit.arm();
        ASSERT_TRUE(becomes(unit, DeviceState::Ready));
        unit.lend({});
        unit.takeNews();
        for (int i = 0; i < ticks; ++i) tick(unit, service, device);
    }
    static std::int64_t rows(const HaplyService& service, const std::string& device) {
        return static_cast<std::int64_t>(service.record(device).size());
    }
    static std::optional<std::int64_t> untilZero(const HaplyService& service, const std::string& device,
                                                 std::int64_t from) {
        const auto record = service.record(device);
        return fake::callsUntilZero(static_cast<std::int64_t>(record.size()), from, [&](std::int64_t number) {
            const auto& felt = record[static_cast<std::size_t>(number)].felt;
            return felt[0] == 0.0 && felt[1] == 0.0 && felt[2] == 0.0;
        });
    }
    static int losses(unit::Unit& unit) {
        int count = 0;
        for (const unit::UnitNews& news : unit.takeNews()) count += news.isLoss() ? 1 : 0;
        return count;
    }

private:
    int trembled_ = 0;
};

TEST_F(Inverse3Unit, OpensTheGateReadsThePoseAndPushesWithTheForceThatIsCommanded) {
    // Truth: the fake's own account of what reaches the device.
    HaplyService service;
    const auto unit = open(service);
    begin(*unit, service, "049D");
    EXPECT_EQ(service.gateGain("049D"), 1.0);
    EXPECT_TRUE(reached([&] {
        tick(*unit, service, "049D");
        return service.felt("049D") == std::array{2.0, -1.0, 0.5};
    }));
    fake::HaplyDeviceState state;
    state.position = {0.01, -0.10, 0.16};
    state.grip = {std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0};
    state.buttons = {false, true, false};
    service.setState("049D", state);
    DeviceReading reading;
    EXPECT_TRUE(reached([&] {
        unit->command(kPush);
        reading = unit->read();
        return reading.buttons == 2;
    }));
    EXPECT_LT((reading.X_BD.p - Vec3(0.01, 0.02, 0.01)).norm(), 1e-15);
    EXPECT_NEAR(reading.X_BD.q.y(), std::sqrt(0.5), 1e-15);
    const DeviceUnit who = unit->identity().value();
    EXPECT_EQ(who.serial, "049D");
    EXPECT_EQ(who.backend, "haply");
    EXPECT_EQ(who.versions, "firmware 7.4.0");
    EXPECT_EQ(who.calibration, "force_gate gain 0.3, set to 1; damping 0, set to 0");
    EXPECT_EQ(service.violations(), 0);
    EXPECT_EQ(service.misunderstood(), 0);
}

TEST_F(Inverse3Unit, GetsNoForceBetweenAttemptsNorAfterTheProgram) {
    // Truth: the fake's own account.
    HaplyService service;
    auto unit = open(service);
    begin(*unit, service, "049D");
    unit->giveBack();
    const auto from = rows(service, "049D");
    ASSERT_TRUE(reached([&] { return rows(service, "049D") > from + 5; }));
    EXPECT_LE(untilZero(service, "049D", from).value_or(99), 2);
    unit.reset();
    EXPECT_EQ(service.felt("049D"), (std::array<double, 3>{}));
}

struct ServiceFault {
    const char* name;
    DeviceState state;
    std::function<void(HaplyService&)> happens, ends;
};

class Inverse3Fault : public Inverse3Unit, public testing::WithParamInterface<ServiceFault> {};

TEST_P(Inverse3Fault, TakesTheForceWithinTwoMessagesIsToldOnceAndComesBackWhenItIsArmed) {
    // Truth: the fake's own account: rows of messages, from the first that came after the fault was visible.
    const ServiceFault& fault = GetParam();
    HaplyService service({"049D", "04A1"});
    const auto unit = open(service, "049D");
    begin(*unit, service, "049D");
    fault.happens(service);
    for (int i = 0; i < 3000 && unit->state() == DeviceState::Ready; ++i) {
        unit->read();
        unit->command(kPush);
        poll(nullptr, 0, 1);
    }
    ASSERT_EQ(unit->state(), fault.state) << unit->trouble();
    const auto visible = rows(service, "049D");
    for (int i = 0; i < 30; ++i) {
        unit->read();
        unit->command(kPush);
        poll(nullptr, 0, 1);
    }
    const auto calls = untilZero(service, "049D", visible);
    ASSERT_TRUE(calls.has_value()) << "the last force stands";
    EXPECT_LE(*calls, 2);
    std::printf("%s: zero at call %d after the fault was seen\n", fault.name, static_cast<int>(*calls));
    fault.ends(service);
    ASSERT_TRUE(reached([&] { return unit->state() != DeviceState::Lost && unit->state() != DeviceState::Absent; }))
        << unit->trouble();
    const auto unarmed = rows(service, "049D");
    for (int i = 0; i < 10; ++i) tick(*unit, service, "049D");
    EXPECT_LE(untilZero(service, "049D", unarmed).value_or(99), 1) << "not armed";
    EXPECT_EQ(losses(*unit), 1);
    unit->arm();
    ASSERT_TRUE(becomes(*unit, DeviceState::Ready));
    EXPECT_TRUE(reached([&] {
        tick(*unit, service, "049D");
        return service.felt("049D")[0] == 2.0;
    }));
    EXPECT_EQ(service.violations(), 0);
    EXPECT_EQ(service.felt("04A1"), (std::array<double, 3>{})) << "the other device";
}

ServiceFault lying(const char* name, HaplyService::Lie lie) {
    return {name, DeviceState::Fault, [lie](HaplyService& s) { s.lie(lie); },
            [](HaplyService& s) { s.lie(HaplyService::Lie::None); }};
}

INSTANTIATE_TEST_SUITE_P(
    Faults, Inverse3Fault,
    testing::Values(ServiceFault{"Unplugged", DeviceState::Lost, [](HaplyService& s) { s.unplug("049D"); },
                                 [](HaplyService& s) { s.plug("049D"); }},
                    ServiceFault{"Frozen", DeviceState::Fault, [](HaplyService& s) { s.freeze(true); },
                                 [](HaplyService& s) { s.freeze(false); }},
                    lying("NotANumber", HaplyService::Lie::NotANumber), lying("Null", HaplyService::Lie::Null),
                    lying("Huge", HaplyService::Lie::Huge), lying("Text", HaplyService::Lie::Text),
                    lying("Missing", HaplyService::Lie::Missing), lying("HalfAState", HaplyService::Lie::Truncated),
                    ServiceFault{"Jump", DeviceState::Fault,
                                 [](HaplyService& s) {
                                     fake::HaplyDeviceState far;
                                     far.position = {400.0, 0.0, 0.0};
                                     s.setState("049D", far);
                                 },
                                 [](HaplyService&) {}},
                    ServiceFault{"HalfAFrame", DeviceState::Lost, [](HaplyService& s) { s.cutNextAnswer(40, false); },
                                 [](HaplyService&) {}},
                    ServiceFault{"HalfAFrameAndGone", DeviceState::Lost,
                                 [](HaplyService& s) { s.cutNextAnswer(40, true); }, [](HaplyService&) {}},
                    ServiceFault{"Silent", DeviceState::Stale, [](HaplyService& s) { s.hold(true); },
                                 [](HaplyService& s) { s.hold(false); }},
                    ServiceFault{"Restarted", DeviceState::Lost, [](HaplyService& s) { s.closeConnections(1001); },
                                 [](HaplyService&) {}},
                    ServiceFault{"Cut", DeviceState::Lost, [](HaplyService& s) { s.dropConnections(); },
                                 [](HaplyService&) {}},
                    ServiceFault{"Brake", DeviceState::Lost,
                                 [](HaplyService& s) {
                                     s.sendEvent("device-safety-triggered", "device", "error", "049D",
                                                 "ebrake_triggered");
                                 },
                                 [](HaplyService&) {}}),
    [](const testing::TestParamInfo<ServiceFault>& fault) { return std::string(fault.param.name); });

TEST_F(Inverse3Unit, StaysWithItsSerialWhenTheDevicesAreSwappedAndKeysComeInAnyOrder) {
    // Truth: invariant: a serial number is a device, the order of a list is none.
    HaplyService service({"049D", "04A1"});
    const auto unit = open(service, "04A1");
    begin(*unit, service, "04A1");
    service.reverseDevices();
    service.addUnknownKeys(true);
    for (unsigned seed = 1; seed < 20; ++seed) {
        service.shuffleKeys(seed);
        tick(*unit, service, "04A1");
    }
    EXPECT_EQ(unit->state(), DeviceState::Ready) << unit->trouble();
    EXPECT_TRUE(reached([&] {  // a command that a busy machine brings late gives none
        tick(*unit, service, "04A1");
        return service.felt("04A1")[0] == 2.0;
    }));
    EXPECT_EQ(service.felt("049D"), (std::array<double, 3>{}));
    EXPECT_EQ(unit->identity()->serial, "04A1");
}

TEST_F(Inverse3Unit, SaysWhatIsMissing) {
    // Truth: invariant: sentences that somebody in a lab can act on.
    HaplyService service({"049D", "04A1"});
    const auto none = open(service, "FFFF");
    EXPECT_TRUE(reached([&] { return none->trouble() == "the Inverse Service has no device FFFF, but 049D, 04A1"; }));
    const auto which = open(service);
    EXPECT_TRUE(reached([&] {
        return which->trouble() ==
               "the Inverse Service has several devices, 049D, 04A1: name one as `serial` in the station file";
    }));
    auto nobody = backends::open({"right", "inverse3", "haply", {}, "localhost:9", {}});
    EXPECT_TRUE(reached([&] { return (*nobody)->trouble().find("does not run: nobody speaks") != std::string::npos; }));
    EXPECT_FALSE(backends::open({"right", "inverse3", "haply", {}, "localhost:ten", {}}));
    EXPECT_FALSE(backends::open({"right", "inverse3", "haply", {}, {}, "x y z"}));
    EXPECT_FALSE(backends::open({"right", "inverse3", "happly", {}, {}, {}}));
}

}  // namespace
}  // namespace passung::haply
