#include "devices/vrpn/tracker_unit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "core/base/random.h"
#include "devices/backends/backends.h"
#include "devices/unit/linked_unit.h"
#include "tests/devices/fakes/vrpn_server.h"
#include "tests/devices/unit/scripted_link.h"
#include "tests/support/length.h"

/// The backend against a fake of a VRPN 07.38 server, which was written from the published format before it.
namespace passung::vrpn {
namespace {

using fake::VrpnServer;
using loop::DeviceState;
using std::chrono::milliseconds;
using unit::Exchange;
using unit::reached;

constexpr double kReach = 1e-3;  // [m] of a hand that trembles

std::string at(const VrpnServer& server, const std::string& name = "Phantom0@", const std::string& sensor = "#0") {
    return name + "127.0.0.1:" + std::to_string(server.port()) + sensor;
}

std::unique_ptr<unit::Unit> opened(const std::string& address, const std::string& serial = {}) {
    auto unit = backends::open({"right", "tracker", "vrpn", serial, address, {}});
    if (!unit) throw std::runtime_error(unit.errors().front().message);
    return *std::move(unit);
}

/// A tracker's own clock: tells where a trembling hand is, or what else it is told to, every `period`.
class Feed {
public:
    enum class Kind { Trembles, IsSilent, StandsStill, NotANumber, Infinite, IsFar, IsNoRotation };

    explicit Feed(VrpnServer& server, milliseconds period = milliseconds(1))
        : server_(server), period_(period), thread_([this] { main(); }) {}
    ~Feed() {
        over_ = true;
        thread_.join();
    }
    void does(Kind kind) { kind_ = kind; }

private:
    void main() {
        std::array<double, 3> p{};
        for (std::int64_t n = 0; !over_; ++n) {
            const Kind kind = kind_;
            if (kind != Kind::StandsStill) p[0] = 1e-5 * static_cast<double>(n % 7);
            std::array<double, 3> said = p;
            if (kind == Kind::NotANumber) said[1] = std::numeric_limits<double>::quiet_NaN();
            if (kind == Kind::Infinite) said[2] = std::numeric_limits<double>::infinity();
            if (kind == Kind::IsFar) said[1] = 900.0;
            const double w = kind == Kind::IsNoRotation ? 0.9 : 1.0;
            server_.setTime(1'700'000'000, static_cast<std::int32_t>(n % 1'000'000));
            if (kind != Kind::IsSilent) server_.sendPose(0, said, {0.0, 0.0, 0.0, w});
            server_.sendPose(1, {0.5, 0.5, 0.5}, {0.0, 0.0, 0.0, 1.0});
            std::this_thread::sleep_for(period_);
        }
    }

    VrpnServer& server_;
    const milliseconds period_;
    std::atomic<Kind> kind_ = Kind::Trembles;
    std::atomic<bool> over_ = false;
    std::thread thread_;
};

/// Ready and lent. A machine that keeps the feed waiting is no fault here: it is armed again.
void begin(unit::Unit& unit) {
    ASSERT_TRUE(reached([&] { return unit.state() != DeviceState::Absent; })) << unit.trouble();
    ASSERT_TRUE(reached([&] {
        unit.arm();
        return unit.state() == DeviceState::Ready;
    })) << unit.trouble();
    unit.lend({});
    unit.takeNews();
}

std::vector<std::string> losses(unit::Unit& unit) {
    std::vector<std::string> all;
    for (const unit::UnitNews& news : unit.takeNews())
        if (news.isLoss()) all.push_back(news.why);
    return all;
}

/// Nothing but a cookie ever goes to the server: no force is asked of anybody.
void expectNoForceAsked(const VrpnServer& server) {
    EXPECT_EQ(server.received(), 0);
    EXPECT_EQ(server.malformed(), 0);
    for (const auto& field : server.fields()) EXPECT_TRUE(field.is_end);
    EXPECT_EQ(server.felt(), (std::array<double, 3>{}));
}

TEST(TrackerUnit, GivesPoseButtonsAndGripOfTheSensorThatIsNamed) {
    // Truth: closed form: what the fake was told to send; the quaternion is x, y, z, w.
    VrpnServer server;
    const auto unit = opened(at(server, "Phantom0@", "#3"));
    ASSERT_TRUE(reached([&] {
        server.sendPose(3, {0.25, -0.5, 1.0}, {0.0, 0.6, 0.0, 0.8});
        server.sendPose(2, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0});
        return unit->state() == DeviceState::Present;
    })) << unit->trouble();
    server.sendButton(0, true);
    server.sendButton(31, true);
    server.sendButton(32, true);
    server.sendButton(-1, true);
    server.sendButton(0, false);
    // Button 5 is pressed at the other sender, VRPN Control, which has the number 0; the type of a button has 7.
    server.sendRaw(std::string("\0\0\0\x20\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x07\0\0\0\0\0\0\0\x05\0\0\0\x01", 32));
    server.sendAnalog({0.4, 7.0});
    server.sendMessage("a type of tomorrow", "12345");
    DeviceReading reading;
    ASSERT_TRUE(reached([&] {
        server.sendPose(3, {0.25, -0.5, 1.0}, {0.0, 0.6, 0.0, 0.8});
        server.sendPose(2, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0});
        reading = unit->read();
        return reading.buttons != 0 && unit->status().grip_rad == 0.4;
    }));
    EXPECT_EQ(reading.buttons, 0x8000'0000u);
    EXPECT_EQ(reading.X_BD.p, Vec3(0.25, -0.5, 1.0));
    EXPECT_NEAR(reading.X_BD.q.y(), 0.6, 1e-15);
    EXPECT_NEAR(reading.X_BD.q.w(), 0.8, 1e-15);
    EXPECT_FALSE(unit->pushesHand());
    const DeviceUnit who = unit->identity().value();
    EXPECT_EQ(who.backend + " " + who.kind + " " + who.serial + " " + who.model, "vrpn tracker Phantom0#3 tracker");
    EXPECT_EQ(who.versions, "VRPN 07.38");
    EXPECT_EQ(who.calibration, "axes x y z");
}

TEST(TrackerUnit, NeverAsksAForceOfTheServersDeviceAndTellsOfOneThatOthersAsk) {
    // Truth: the fake's own account: a force field of VRPN stays where its client hangs, so that none is sent.
    VrpnServer server;
    const Feed feed(server);
    const auto unit = opened(at(server));
    begin(*unit);
    for (int i = 0; i < 50; ++i) {
        unit->read();
        unit->command({Vec3(2, -1, 0.5), Vec3(0, 0, 0.1)});
        if (i == 20) server.sendForce({0.0, 0.0, 0.0});
        if (i > 30) server.sendForce({0.0, 0.0, -2.0});
        poll(nullptr, 0, 1);
    }
    int told = 0;
    ASSERT_TRUE(reached([&] {
        for (const unit::UnitNews& news : unit->takeNews())
            told += news.why.find("with 2 N") != std::string::npos ? 1 : 0;
        return told > 0;
    }));
    EXPECT_EQ(told, 1);
    unit->giveBack();
    expectNoForceAsked(server);
}

struct TrackerFault {
    const char* name;
    DeviceState state;
    const char* why;
    std::function<void(VrpnServer&, Feed&)> happens;
};

class TrackerFaults : public testing::TestWithParam<TrackerFault> {};

TEST_P(TrackerFaults, AreToldOnceGiveNoWrongPoseAndEndWhenItIsArmed) {
    // Truth: invariant; the hand never is farther from the origin than kReach.
    const TrackerFault& fault = GetParam();
    VrpnServer server;
    Feed feed(server);
    const auto unit = opened(at(server));
    begin(*unit);
    const auto tick = [&] {
        const DeviceReading reading = unit->read();
        if (reading.fresh) {
            EXPECT_LT(reading.X_BD.p.norm(), kReach);
            EXPECT_EQ(reading.X_BD.q.coeffs(), Quat::Identity().coeffs());
        }
        unit->command({Vec3(2, -1, 0.5), Vec3::Zero()});
        poll(nullptr, 0, 1);
    };
    std::vector<std::string> told;
    // A machine that keeps the feed waiting for 100 ms is no fault of the server's: once more then.
    for (int tries = 0; tries < 50 && (told.empty() || told.front().find(fault.why) == std::string::npos); ++tries) {
        feed.does(Feed::Kind::Trembles);
        ASSERT_TRUE(reached([&] {
            unit->arm();
            tick();
            return unit->read().fresh;
        })) << unit->trouble();
        unit->takeNews();
        fault.happens(server, feed);
        for (int i = 0; i < 5000 && unit->state() == DeviceState::Ready; ++i) tick();
        ASSERT_TRUE(reached([&] {
            told = losses(*unit);
            return !told.empty();
        }));
        ASSERT_EQ(told.size(), 1u);
        ASSERT_TRUE(told.front().find(fault.why) != std::string::npos ||
                    told.front().find("for 100 ms") != std::string::npos)
            << told.front();
    }
    EXPECT_NE(told.front().find(fault.why), std::string::npos) << told.front();
    for (int i = 0; i < 20; ++i) {
        EXPECT_FALSE(unit->read().fresh) << "not armed";
        tick();
    }
    server.numberTypesFrom(70);
    feed.does(Feed::Kind::Trembles);
    ASSERT_TRUE(reached([&] {
        tick();
        return unit->state() == DeviceState::Present || unit->state() == fault.state;
    })) << unit->trouble();
    EXPECT_TRUE(losses(*unit).empty()) << "what follows is no news";
    ASSERT_TRUE(reached([&] {
        unit->arm();
        tick();
        return unit->read().fresh;
    })) << unit->trouble();
    expectNoForceAsked(server);
}

TrackerFault doing(const char* name, DeviceState state, const char* why, Feed::Kind kind) {
    return {name, state, why, [kind](VrpnServer&, Feed& feed) { feed.does(kind); }};
}
TrackerFault saying(const char* name, const std::string& bytes) {
    return {name, DeviceState::Lost, "no message of VRPN",
            [bytes](VrpnServer& server, Feed&) { server.sendRaw(bytes); }};
}
/// Of a pose, whose message has 88 bytes.
TrackerFault missing(const char* name, std::size_t bytes) {
    return {name, DeviceState::Lost, "", [bytes](VrpnServer& server, Feed& feed) {
                feed.does(Feed::Kind::IsSilent);
                server.cutNext(88 - bytes);
                server.sendPose(0, {1e-5, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0});
                feed.does(Feed::Kind::Trembles);
            }};
}

INSTANTIATE_TEST_SUITE_P(
    Faults, TrackerFaults,
    testing::Values(TrackerFault{"Killed", DeviceState::Lost, "hung up",
                                 [](VrpnServer& server, Feed&) { server.dropConnections(); }},
                    doing("Silent", DeviceState::Stale, "for 100 ms", Feed::Kind::IsSilent),
                    doing("Frozen", DeviceState::Fault, "stand still", Feed::Kind::StandsStill),
                    doing("NotANumber", DeviceState::Fault, "no finite number", Feed::Kind::NotANumber),
                    doing("Infinite", DeviceState::Fault, "no finite number", Feed::Kind::Infinite),
                    doing("Jump", DeviceState::Fault, "jumped", Feed::Kind::IsFar),
                    doing("NoRotation", DeviceState::Fault, "no rotation", Feed::Kind::IsNoRotation),
                    saying("ShiftedBy1", std::string(1, '\x5a')), saying("ShiftedBy2", std::string(2, '\x5a')),
                    saying("ShiftedBy3", std::string(3, '\x5a')), saying("ShiftedBy4", std::string(4, '\x5a')),
                    saying("ShiftedBy5", std::string(5, '\x5a')), saying("ShiftedBy6", std::string(6, '\x5a')),
                    saying("ShiftedBy7", std::string(7, '\x5a')),
                    saying("TooLong", std::string("\0\1\0\1", 4) + std::string(20, '\0')), missing("Lacks1", 1),
                    missing("Lacks4", 4), missing("Lacks7", 7), missing("HalfAMessage", 44)),
    [](const testing::TestParamInfo<TrackerFault>& fault) { return std::string(fault.param.name); });

TEST(TrackerUnit, MayLieStillWhileNobodyUsesIt) {
    // Truth: invariant: between attempts the same pose to the last bit is a tracker on a table.
    VrpnServer server;
    Feed feed(server);
    const auto unit = opened(at(server));
    begin(*unit);
    unit->giveBack();
    feed.does(Feed::Kind::StandsStill);
    for (int i = 0; i < 15; ++i) {
        poll(nullptr, 0, 100);
        EXPECT_NE(unit->state(), DeviceState::Fault) << unit->trouble();
    }
}

TEST(TrackerUnit, IsConnectedAnewAfterASecondWithoutAPose) {
    // Truth: the fake's own account of connections that ended. A cable that was pulled ends none by itself.
    VrpnServer server;
    Feed feed(server);
    const auto unit = opened(at(server));
    begin(*unit);
    feed.does(Feed::Kind::IsSilent);
    ASSERT_TRUE(reached([&] { return !server.fields().empty(); }));
    EXPECT_EQ(losses(*unit).size(), 1u) << "stale, before";
    feed.does(Feed::Kind::Trembles);
    ASSERT_TRUE(reached([&] { return unit->state() == DeviceState::Present; })) << unit->trouble();
}

TEST(TrackerUnit, ASampleOf50HzStandsUntilTheNext) {
    // Truth: invariant: of two readings in a row that are not fresh the newest sample is older than 25 ms, whatever the
    // machine does; that of a tracker of 1 kHz is never so old on purpose.
    VrpnServer server;
    const Feed feed(server, milliseconds(20));
    const auto unit = opened(at(server));
    begin(*unit);
    int fresh = 0, missing = 0;
    for (int i = 0; i < 300; ++i) {
        const bool is_fresh = unit->read().fresh;
        const double age = unit->status().age_s;
        missing = is_fresh ? 0 : missing + 1;
        fresh += is_fresh ? 1 : 0;
        EXPECT_TRUE(missing <= 1 || age > 25e-3 || unit->state() != DeviceState::Ready) << missing << ", " << age;
        if (unit->state() != DeviceState::Ready) unit->arm();
        poll(nullptr, 0, 1);
    }
    EXPECT_GT(fresh, 10) << "of 300, at 15 poses";
}

TEST(TrackerUnit, OfABurstTheNewestCounts) {
    // Truth: invariant: what comes late and at once is no jump, nor read one after the other.
    VrpnServer server;
    const auto unit = opened(at(server));
    double x = 0.0;
    const auto send = [&] { server.sendPose(0, {x += 1e-6, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}); };
    ASSERT_TRUE(reached([&] {
        send();
        return unit->state() == DeviceState::Present;
    }));
    for (int i = 0; i < 3000; ++i) send();
    EXPECT_TRUE(reached([&] { return unit->read().X_BD.p.x() == x; }));
    EXPECT_EQ(unit->state(), DeviceState::Present) << unit->trouble();
}

/// A link by itself, on a server that its test feeds.
struct Linked {
    VrpnServer server;
    TrackerLink link;

    explicit Linked(const std::string& axes) : link({}, *trackerAddress(at(server)), *unit::Axes::parse(axes)) {
        const Feed feed(server);
        const auto opened = link.open();
        if (!opened) throw std::runtime_error(opened.errors().front().message);
    }
    /// Sends a pose in the server's frame; the one that is said then.
    Pose said(const Vec3& p, const Quat& q) {
        while (link.exchange({}, milliseconds(0)).kind == Exchange::Kind::News) {
        }
        server.sendPose(0, {p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()});
        const Exchange exchange = link.exchange({}, milliseconds(1000));
        EXPECT_EQ(exchange.kind, Exchange::Kind::News) << exchange.why;
        return exchange.said.X_BD;
    }
};

Vec3 anyVector(Random& random) { return {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)}; }

Quat anyTurn(Random& random) {
    return Quat(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
}

TEST(TrackerLink, AThousandPosesComeThroughWireAndFrameToTheirLastPlace) {
    // Truth: closed form: x right, y up, z to the user, as many servers have it, turned by hand: our y is against its
    // z, our z its y. Numbers have 64 bits on the wire; what rounds is the quaternion, made a unit's.
    Linked linked("x -z y");
    Random random(12);
    for (int i = 0; i < 1000; ++i) {
        const Pose X_BD{anyTurn(random), anyVector(random)};
        const auto theirs = [](const Vec3& ours) { return Vec3(ours.x(), ours.z(), -ours.y()); };
        const Vec3 n = theirs(X_BD.q.vec());
        const Pose said = linked.said(theirs(X_BD.p), Quat(X_BD.q.w(), n.x(), n.y(), n.z()));
        ASSERT_EQ(said.p, X_BD.p);
        ASSERT_LE((said.q.coeffs() - X_BD.q.coeffs()).cwiseAbs().maxCoeff(), 0x1p-52);
    }
}

TEST(TrackerLink, HalfAMessageGivesNoPoseOfTwoHalves) {
    // Truth: invariant: with the next message's bytes in the place of those that are missing a pose is no rotation, or
    // what follows it is no message.
    const Vec3 p(0.125, -0.25, 0.5);
    const Quat q(0.02, 0.6, 0.0, std::sqrt(1.0 - 0.36 - 0.0004));
    for (std::size_t half = 0; half < 88; ++half) {
        Linked linked("x y z");
        linked.said(p, q);
        for (int i = 0; i < 6; ++i) {
            if (i == 3 && half > 0) linked.server.cutNext(half);
            linked.server.setTime(1'700'000'000, 250'000);
            linked.server.sendPose(0, {p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()});
        }
        Exchange exchange;
        do {
            exchange = linked.link.exchange({}, milliseconds(0));
            if (exchange.kind != Exchange::Kind::News || !isRigid(exchange.said.X_BD)) continue;
            EXPECT_EQ(exchange.said.X_BD.p, p) << half;
            EXPECT_LT((exchange.said.X_BD.q.coeffs() - q.coeffs()).norm(), 1e-12) << half;
        } while (exchange.kind == Exchange::Kind::News);
        EXPECT_TRUE(exchange.kind == Exchange::Kind::Gone || half <= 24) << half;
        EXPECT_TRUE(exchange.kind == Exchange::Kind::Silence || half > 0) << "nothing is missing";
    }
}

TEST(TrackerLink, EachOfTheWrongAxesIsFound) {
    // Truth: closed form as above, for rotations by where the handle's own axes point: of 48 ways to name the axes one
    // gives the pose that was sent.
    const Pose X_BD{rotationFromVector(Vec3(0.3, 0.5, -0.7)), Vec3(0.1, 0.2, 0.3)};
    const auto theirs = [](const Vec3& ours) { return Vec3(-ours.y(), -ours.x(), ours.z()); };  // a mirror
    Mat3 R;
    R << theirs(X_BD.q * Vec3(0, -1, 0)), theirs(X_BD.q * Vec3(-1, 0, 0)), theirs(X_BD.q * Vec3(0, 0, 1));
    const Quat sent(R);
    int right = 0, ways = 0;
    for (const char* order : {"x y z", "x z y", "y x z", "y z x", "z x y", "z y x"}) {
        for (int signs = 0; signs < 8; ++signs) {
            std::string axes;
            for (std::size_t i = 0; i < 3; ++i)
                axes += std::string(i > 0 ? " " : "") + ((signs >> i & 1) != 0 ? "-" : "") + order[2 * i];
            Linked linked(axes);
            const Pose said = linked.said(theirs(X_BD.p), sent);
            const bool same =
                (said.p - X_BD.p).norm() < 1e-12 && rotationVector(said.q * X_BD.q.conjugate()).norm() < 1e-12;
            EXPECT_EQ(same, axes == "-y -x z") << axes;
            right += same ? 1 : 0;
            ++ways;
        }
    }
    EXPECT_EQ(ways, 48);
    EXPECT_EQ(right, 1);
}

/// A program that takes connections, and no more.
struct Silent final : fake::LoopbackHandler {
    void connected(int) override {}
    void heard(int, const std::string&) override {}
    void gone(int) override {}
};

/// What a unit says of why it is not there.
std::string troubleOf(const std::string& address, const std::string& serial = {}) {
    const auto unit = opened(address, serial);
    EXPECT_TRUE(reached([&] { return !unit->trouble().empty() || unit->state() == DeviceState::Present; }));
    return unit->trouble();
}

TEST(TrackerUnit, SaysWhatIsMissing) {
    // Truth: invariant: sentences that somebody in a lab can act on.
    const std::string nobody = troubleOf("Phantom0@127.0.0.1:9");
    EXPECT_NE(nobody.find("no VRPN server runs: nobody listens at 127.0.0.1:9"), std::string::npos) << nobody;
    VrpnServer server;
    const std::string here = "127.0.0.1:" + std::to_string(server.port());
    EXPECT_EQ(troubleOf(at(server)), "the VRPN server at " + here + " gives no pose of any tracker: is one in view?");
    {
        const Feed feed(server);
        EXPECT_EQ(troubleOf(at(server, "Wand@")),
                  "the VRPN server at " + here +
                      " gives no pose of Wand#0, but of Phantom0#0, Phantom0#1: is it in "
                      "view, and is this its name?");
        EXPECT_EQ(troubleOf(here), "the VRPN server at " + here +
                                       " has several trackers, Phantom0#0, Phantom0#1: name one as `serial` in the "
                                       "station file");
        EXPECT_EQ(troubleOf(here, "Phantom0#1"), "");
        EXPECT_EQ(troubleOf(here, "Phantom0"), "");
        const auto found = backends::find("vrpn")->look(here);
        ASSERT_EQ(found.units.size(), 2u);
        EXPECT_EQ(found.units.back().serial, "Phantom0#1");
        EXPECT_EQ(backends::find("vrpn")->look(at(server)).units.size(), 1u);
    }
    server.stayMute(true);
    EXPECT_EQ(troubleOf(at(server)), "what listens at " + here + " is another program than a VRPN server")
        << "messages, and no cookie before";
    Silent silent;
    fake::LoopbackServer other(silent);
    EXPECT_NE(troubleOf("127.0.0.1:" + std::to_string(other.port())).find("does not introduce itself"),
              std::string::npos);
    VrpnServer old("Phantom0", "06.04"), later("Phantom0", "07.99");
    EXPECT_NE(troubleOf(at(old)).find("is of version 06.04, and not 7"), std::string::npos);
    const Feed feed(later);
    EXPECT_EQ(troubleOf(at(later)), "");
}

TEST(TrackerUnit, RefusesAStationFileThatNamesNoTracker) {
    // Truth: invariant.
    const auto keyOf = [](const std::string& serial, const std::string& address, const std::string& axes) {
        const auto unit = backends::open({"right", "tracker", "vrpn", serial, address, axes});
        return unit ? "opened" : unit.errors().front().key;
    };
    for (const char* wrong : {"@host:3883", "host:", "host:port", "host:123456", "a@host#", "a@host#x", "a@:3883",
                              "host#2", "::1", "a@host:1:2"})
        EXPECT_EQ(keyOf({}, wrong, {}), "address") << wrong;
    for (const char* right : {"", "127.0.0.1", "127.0.0.1:9", "a@127.0.0.1", "a b@127.0.0.1:9#17"})
        EXPECT_EQ(keyOf({}, right, {}), "opened") << right;
    EXPECT_EQ(keyOf({}, {}, "x y y"), "axes");
    EXPECT_EQ(keyOf("b#0", "a@127.0.0.1:9", {}), "serial");
    EXPECT_EQ(keyOf("a", "a@127.0.0.1:9", "-x y z"), "opened");
    EXPECT_EQ(trackerAddress("a b@host#17")->serial, "a b#17");
    EXPECT_EQ(trackerAddress("a b@host#17")->port, "3883");
}

TEST(TrackerUnit, WhateverComesAPoseIsOneThatWasSentAndNoForceIsAsked) {
    // Truth: invariant: fresh readings are within the hand's reach and turned by nothing. PASSUNG_LONG=1: a million
    // ticks.
    VrpnServer server;
    const auto unit = opened(at(server));
    Random random(23);
    const int ticks = test::atFullLength() ? 1'000'000 : 4'000, kinds = test::atFullLength() ? 8'000 : 400;
    int fresh = 0, connections = 0;
    bool sound = true;
    const auto sendSound = [&] { server.sendPose(0, {random.uniform(-kReach, kReach), 0, 0}, {0.0, 0.0, 0.0, 1.0}); };
    const auto isThere = [&] { return unit->state() != DeviceState::Absent && unit->state() != DeviceState::Lost; };
    const auto noise = [&](std::size_t length) {
        std::string bytes(length, '\0');
        for (char& byte : bytes) byte = static_cast<char>(random.below(256));
        return bytes;
    };
    for (int i = 0; i < ticks; ++i) {
        if (!isThere()) {
            ASSERT_TRUE(reached([&] {  // which takes a moment
                sendSound();
                return isThere();
            }));
            ++connections;
        }
        unit->arm();
        switch (random.below(static_cast<std::uint64_t>(kinds))) {
            case 0:
                server.sendRaw(noise(1 + random.below(40)));
                ASSERT_TRUE(reached([&] {
                    sendSound();
                    return !isThere();
                }));
                continue;
            case 1:
                server.cutNext(random.below(80));
                break;
            case 2:
                server.dropConnections();
                ASSERT_TRUE(reached([&] { return !isThere(); }));
                continue;
            case 3:
                server.sendMessage("vrpn_Tracker Pos_Quat", noise(64));
                break;
            case 4:
                server.sendMessage("vrpn_Button Change", noise(8));
                break;
            case 5:
                server.sendMessage("vrpn_Analog Channel", noise(random.below(40)));
                break;
            case 6:
                server.sendMessage("vrpn_ForceDevice Force", noise(24));
                break;
            case 7:
                server.sendMessage(noise(3) + "x", noise(random.below(70)));
                break;
            case 8:
                server.sendPose(0, {0.0, std::numeric_limits<double>::quiet_NaN(), 0.0}, {0.0, 0.0, 0.0, 1.0});
                break;
            case 9:
                server.sendPose(0, {0.0, 1e300, 0.0}, {0.0, 0.0, 0.0, 1.0});
                break;
            default:
                break;
        }
        sendSound();
        const DeviceReading reading = unit->read();
        if (reading.fresh) {
            ++fresh;
            sound = sound && reading.X_BD.p.cwiseAbs().maxCoeff() <= kReach &&
                    reading.X_BD.q.coeffs() == Quat::Identity().coeffs();
        }
        unit->command({anyVector(random), anyVector(random)});
        if (i % 4 == 0) sched_yield();
    }
    EXPECT_TRUE(sound);
    EXPECT_GT(fresh, ticks / 50);
    EXPECT_GT(connections, ticks / kinds);
    expectNoForceAsked(server);
    std::printf("%d ticks, %d fresh, connected %d times\n", ticks, fresh, connections);
}

}  // namespace
}  // namespace passung::vrpn
