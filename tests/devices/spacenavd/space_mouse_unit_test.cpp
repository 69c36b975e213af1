#include "devices/spacenavd/space_mouse_unit.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>

#include "devices/backends/backends.h"
#include "devices/spacenavd/space_mouse_wire.h"
#include "tests/devices/fakes/space_mouse_daemon.h"
#include "tests/devices/unit/scripted_link.h"

/// The backend against Debian's own spacenavd 1.1-1, which serves a serial mouse on a pseudo-terminal.
namespace passung::spacenavd {
namespace {

using fake::SerialMouse;
using fake::SpaceMouseDaemon;
using loop::DeviceState;
using unit::reached;

std::unique_ptr<unit::Unit> opened(const std::string& socket, const std::string& serial = {}) {
    auto unit = backends::open({"right", "spacemouse", "spacenavd", serial, socket, {}});
    if (!unit) throw std::runtime_error(unit.errors().front().message);
    return *std::move(unit);
}

class SpaceMouseUnit : public testing::Test {
protected:
    void SetUp() override {
        if (!SpaceMouseDaemon::installed()) GTEST_SKIP() << "no spacenavd is installed";
    }
    static bool becomes(unit::Unit& unit, DeviceState state) {
        return reached([&] { return unit.state() == state; });
    }
    /// Ready and lent, with the handle at the middle.
    static void begin(unit::Unit& unit) {
        ASSERT_TRUE(becomes(unit, DeviceState::Present)) << unit.trouble();
        unit.arm();
        ASSERT_TRUE(becomes(unit, DeviceState::Ready));
        unit.lend({});
        unit.takeNews();
    }
    /// Ticks until the handle has left `from`; where it is then.
    static Vec3 moved(unit::Unit& unit, const Vec3& from) {
        Vec3 p = from;
        reached([&] {
            p = unit.read().X_BD.p;
            return p != from;
        });
        return p;
    }
};

TEST_F(SpaceMouseUnit, MovesTheHandleWhileTheCapIsDeflectedAndTellsButtons) {
    // Truth: independent program (spacenavd 1.1-1 of Debian): what it makes of the mouse's frames.
    SpaceMouseDaemon daemon(SerialMouse::Model::Spaceball);
    const auto unit = opened(daemon.socket());
    begin(*unit);
    EXPECT_EQ(unit->identity()->serial, "Spaceball 4000FLX");
    EXPECT_FALSE(unit->pushesHand());
    daemon.mouse().move({350, 0, 0, 0, 0, 0});
    const Vec3 p = moved(*unit, Vec3::Zero());
    EXPECT_GT(p.x(), 0.0);
    EXPECT_EQ(p.y(), 0.0);
    const double x = unit->read().X_BD.p.x();
    EXPECT_NEAR(unit->read().X_BD.p.x() - x, kTickSeconds * 0.1, 1e-12);
    daemon.mouse().press(0);
    EXPECT_TRUE(reached([&] { return unit->read().buttons == 1; }));
    daemon.mouse().move({0, 0, 0, 0, 0, 0});
    EXPECT_TRUE(reached([&] { return unit->read().X_BD.p == unit->read().X_BD.p; }));
}

TEST_F(SpaceMouseUnit, IsStaleAfterASecondWhenTheMouseIsPulledInMotion) {
    // Truth: invariant; the daemon says nothing of it (spacenavd_test.cpp), so that time alone tells.
    SpaceMouseDaemon daemon(SerialMouse::Model::Spaceball);
    const auto unit = opened(daemon.socket());
    begin(*unit);
    daemon.mouse().move({0, 200, 0, 0, 0, 0});
    moved(*unit, Vec3::Zero());
    daemon.mouse().unplug();
    ASSERT_TRUE(becomes(*unit, DeviceState::Stale));
    const Vec3 p = unit->read().X_BD.p;
    EXPECT_FALSE(unit->read().fresh);
    EXPECT_EQ(unit->read().X_BD.p, p);
    EXPECT_NE(unit->trouble().find("repeat-interval"), std::string::npos);
    EXPECT_EQ(unit->takeNews().size(), 1u);
    unit->arm();
    EXPECT_TRUE(becomes(*unit, DeviceState::Ready));
    EXPECT_EQ(unit->read().X_BD.p, p) << "the motion has ended";
}

TEST_F(SpaceMouseUnit, IsLostWhenTheDaemonIsKilledAndThereAgainWhenItIsStarted) {
    // Truth: independent program (spacenavd 1.1-1 of Debian).
    SpaceMouseDaemon daemon(SerialMouse::Model::Magellan);
    const auto unit = opened(daemon.socket());
    begin(*unit);
    daemon.mouse().move({0, 0, 0, 0, 0, 200});
    EXPECT_TRUE(reached([&] { return unit->read().X_BD.q.z() != 0.0 || unit->read().X_BD.q.y() != 0.0; }));
    daemon.kill();
    ASSERT_TRUE(becomes(*unit, DeviceState::Lost));
    const Pose X = unit->read().X_BD;
    EXPECT_EQ(unit->read().X_BD.q.coeffs(), X.q.coeffs());
    EXPECT_TRUE(reached([&] { return unit->trouble().find("does not run") != std::string::npos; }));
    daemon.start();
    ASSERT_TRUE(becomes(*unit, DeviceState::Present));
    unit->arm();
    ASSERT_TRUE(becomes(*unit, DeviceState::Ready));
    int losses = 0;
    for (const unit::UnitNews& news : unit->takeNews()) losses += news.isLoss() ? 1 : 0;
    EXPECT_EQ(losses, 1);
    const double x = unit->read().X_BD.p.x();
    daemon.mouse().move({100, 0, 0, 0, 0, 0});
    EXPECT_TRUE(reached([&] { return unit->read().X_BD.p.x() > x; }));
}

TEST_F(SpaceMouseUnit, ADaemonThatHangsMovesNothingAndGoesOnLater) {
    // Truth: invariant: what comes late is what the cap does then.
    SpaceMouseDaemon daemon(SerialMouse::Model::Spaceball);
    const auto unit = opened(daemon.socket());
    begin(*unit);
    daemon.hang();
    daemon.mouse().move({100, 0, 0, 0, 0, 0});
    for (int i = 0; i < 50; ++i) EXPECT_EQ(unit->read().X_BD.p, Vec3(Vec3::Zero()));
    EXPECT_EQ(unit->state(), DeviceState::Ready);
    daemon.goOn();
    EXPECT_GT(moved(*unit, Vec3::Zero()).x(), 0.0);
}

TEST_F(SpaceMouseUnit, IsNoOtherThanTheOneThatIsNamed) {
    // Truth: invariant.
    SpaceMouseDaemon daemon(SerialMouse::Model::Spaceball);
    const auto other = opened(daemon.socket(), "SpaceMouse Pro");
    EXPECT_TRUE(reached([&] { return other->trouble() == "spacenavd serves Spaceball 4000FLX, not SpaceMouse Pro"; }));
    EXPECT_EQ(other->state(), DeviceState::Absent);
    const auto same = opened(daemon.socket(), "Spaceball 4000FLX");
    EXPECT_TRUE(becomes(*same, DeviceState::Present));
}

TEST(SpaceMouseSocket, SaysWhatIsMissingWhereNobodyListens) {
    // Truth: invariant.
    const auto unit = opened("/nonexistent/spnav.sock");
    ASSERT_TRUE(reached([&] { return !unit->trouble().empty(); }));
    EXPECT_EQ(
        unit->trouble(),
        "spacenavd does not run: nobody listens at /nonexistent/spnav.sock; `sudo apt install spacenavd` and `sudo "
        "systemctl start spacenavd`");
    EXPECT_EQ(unit->state(), DeviceState::Absent);
}

/// A program that speaks like the daemon for as long as a test wants, and then otherwise.
class FalseDaemon {
public:
    FalseDaemon() {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path().copy(address.sun_path, sizeof address.sun_path - 1);
        listener_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
            listen(listener_, 4) != 0)
            throw std::runtime_error("no socket");
    }
    ~FalseDaemon() {
        hangUp();
        close(listener_);
    }
    std::string path() const { return (folder_.path() / "s").string(); }
    void accept() { client_ = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC); }
    void answerName() {
        const std::uint32_t reply = kProtocol1;
        std::array<std::int32_t, 8> name{kAskName};
        std::memcpy(&name[1], "False", 6);
        send({reinterpret_cast<const char*>(&reply), sizeof reply});
        send({reinterpret_cast<const char*>(name.data()), sizeof name});
    }
    void send(std::string_view bytes) {
        ASSERT_EQ(::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
    }
    void hangUp() {
        if (client_ >= 0) close(client_);
        client_ = -1;
    }

private:
    test::TempFolder folder_;
    int listener_ = -1, client_ = -1;
};

std::string frame(std::array<std::int32_t, 8> words) {
    std::string bytes(sizeof words, '\0');
    std::memcpy(bytes.data(), words.data(), bytes.size());
    return bytes;
}

TEST(SpaceMouseSocket, HalfAFrameMovesNothingAndAShiftedOneEndsTheConnection) {
    // Truth: invariant: of a frame that is not whole nothing is known; what is shifted is never taken for a motion.
    for (std::size_t shift = 1; shift < 8; ++shift) {
        FalseDaemon daemon;
        const auto unit = opened(daemon.path());
        daemon.accept();
        daemon.answerName();
        ASSERT_TRUE(reached([&] { return unit->state() == DeviceState::Present; }));
        unit->arm();
        ASSERT_TRUE(reached([&] { return unit->state() == DeviceState::Ready; }));
        unit->lend({});
        daemon.send(frame({0, 350, 0, 0, 0, 0, 0, 8}).substr(0, 20));
        for (int i = 0; i < 20; ++i) {
            poll(nullptr, 0, 1);
            EXPECT_EQ(unit->read().X_BD.p, Vec3(Vec3::Zero()));
        }
        daemon.send(frame({0, 350, 0, 0, 0, 0, 0, 8}).substr(20));
        ASSERT_TRUE(reached([&] { return unit->read().X_BD.p.x() > 0.0; }));
        daemon.send(std::string(shift, '\x7e'));
        daemon.send(frame({0, 350, 0, 0, 0, 0, 0, 8}));
        daemon.send(frame({0, 350, 0, 0, 0, 0, 0, 8}));
        ASSERT_TRUE(reached([&] { return unit->state() == DeviceState::Lost; })) << shift;
        const Pose X = unit->read().X_BD;
        EXPECT_EQ(unit->read().X_BD.p, X.p);
    }
}

}  // namespace
}  // namespace passung::spacenavd
