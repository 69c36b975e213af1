#include <gtest/gtest.h>
#include <spnav.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "tests/devices/fakes/space_mouse_daemon.h"
#include "tests/devices/fakes/waiting.h"

/// What spacenavd 1.1-1 and libspnav 1.0-1 of Debian 12 make of a serial mouse's frames. Each motion waits for its
/// event before the next is sent, so that nothing depends on how fast the machine is.
namespace passung {
namespace {

using fake::SerialMouse;
using fake::SpaceMouseDaemon;
using fake::SpaceMouseTap;
using Counts = std::array<int, 6>;

constexpr std::int32_t kMotion = 0, kPress = 1, kRelease = 2;
constexpr std::int32_t kAskName = 0x7faa2000, kAskType = 0x7faa2005;

/// The vendor's own library as a client of that daemon; one in a process at a time.
class Library {
public:
    explicit Library(const SpaceMouseDaemon& daemon) {
        setenv("SPNAV_SOCKET", daemon.socket().c_str(), 1);
        if (spnav_open() != 0) throw std::runtime_error("libspnav finds no daemon");
    }
    ~Library() { spnav_close(); }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;

    /// The next event; its type is 0 if the library has lost its daemon.
    spnav_event next() {
        spnav_event event{};
        bool over = false;
        fake::waitFor(
            "an event of libspnav", [&] { return over = fake::readable(spnav_fd()); }, [&] { return over; });
        if (spnav_poll_event(&event) == 0) event.type = 0;
        return event;
    }
};

class Spacenavd : public testing::TestWithParam<SerialMouse::Model> {
protected:
    void SetUp() override {
        if (!SpaceMouseDaemon::installed()) GTEST_SKIP() << "no spacenavd is installed";
    }
};

/// What arrives for the counts of the device: its own order; the daemon turns the third axis of a Magellan round, so
/// that both models say the same of the same hand, and takes what is below its dead zone of two for nothing.
Counts arriving(SerialMouse::Model model, Counts counts) {
    if (model == SerialMouse::Model::Magellan) {
        counts[2] = -counts[2];
        counts[5] = -counts[5];
    }
    for (int& count : counts) count = std::abs(count) < 2 ? 0 : count;
    return counts;
}

Counts countsOf(const SpaceMouseTap::Words& words) {
    return {words[1], words[2], words[3], words[4], words[5], words[6]};
}

TEST_P(Spacenavd, BringsEachAxisToTheLibraryInItsPlaceAndSign) {
    // Truth: independent program (spacenavd 1.1-1 and libspnav 1.0-1 of Debian).
    SpaceMouseDaemon daemon(GetParam());
    Library library(daemon);
    std::vector<Counts> ways;
    for (std::size_t axis = 0; axis < 6; ++axis) {
        for (const int count : {350, -350, 17, 13, 94, -3, 2, 1}) {  // 13, 17, 19, 94: what a serial line escapes
            ways.emplace_back();
            ways.back()[axis] = count;
        }
    }
    ways.push_back({19, 0x1113, -0x0d0d, 0x5e5e, -32768, 32767});  // all that 16 bits hold
    ways.push_back({});
    for (const Counts& sent : ways) {
        daemon.mouse().move(sent);
        const spnav_event event = library.next();
        ASSERT_EQ(event.type, SPNAV_EVENT_MOTION);
        const Counts expected = arriving(GetParam(), sent);
        const Counts got{event.motion.x,  event.motion.y,  event.motion.z,
                         event.motion.rx, event.motion.ry, event.motion.rz};
        EXPECT_EQ(got, expected) << testing::PrintToString(sent);
    }
}

TEST_P(Spacenavd, BringsButtonsAsPressAndReleaseInTheirOrder) {
    // Truth: independent program (spacenavd 1.1-1 and libspnav 1.0-1 of Debian).
    SpaceMouseDaemon daemon(GetParam());
    Library library(daemon);
    for (const int button : {0, 1, 5, 6, 7, 8}) {
        for (const bool pressed : {true, false}) {
            pressed ? daemon.mouse().press(button) : daemon.mouse().release(button);
            const spnav_event event = library.next();
            ASSERT_EQ(event.type, SPNAV_EVENT_BUTTON);
            EXPECT_EQ(event.button.bnum, button);
            EXPECT_EQ(event.button.press, pressed ? 1 : 0);
        }
    }
}

TEST_P(Spacenavd, SendsTheSameEventsToTheLibraryAndToTheTap) {
    // Truth: independent program (libspnav 1.0-1 of Debian), for what the bytes of a frame mean.
    SpaceMouseDaemon daemon(GetParam());
    Library library(daemon);
    SpaceMouseTap tap(daemon.socket());
    ASSERT_EQ(tap.askProtocol1(), 0x7faa5501u);
    for (const Counts& sent : {Counts{12, -34, 56, -78, 90, -123}, Counts{}}) {
        daemon.mouse().move(sent);
        const spnav_event event = library.next();
        const auto words = tap.frame();
        ASSERT_TRUE(words.has_value());
        EXPECT_EQ(words->at(0), kMotion);
        EXPECT_EQ(countsOf(*words), (Counts{event.motion.x, event.motion.y, event.motion.z, event.motion.rx,
                                            event.motion.ry, event.motion.rz}));
        EXPECT_EQ(static_cast<unsigned>(words->at(7)), event.motion.period);
    }
    daemon.mouse().press(3);
    EXPECT_EQ(library.next().button.bnum, 3);
    EXPECT_EQ(tap.frame(), (SpaceMouseTap::Words{kPress, 3, 1}));
    daemon.mouse().release(3);
    EXPECT_EQ(library.next().button.bnum, 3);
    EXPECT_EQ(tap.frame(), (SpaceMouseTap::Words{kRelease, 3}));
}

INSTANTIATE_TEST_SUITE_P(Models, Spacenavd,
                         testing::Values(SerialMouse::Model::Magellan, SerialMouse::Model::Spaceball),
                         [](const testing::TestParamInfo<SerialMouse::Model>& model) {
                             return model.param == SerialMouse::Model::Magellan ? "Magellan" : "Spaceball";
                         });

class SpacenavdSocket : public Spacenavd {};

/// The row of a kept stream: what was done, and the bytes that came of it, in hexadecimal digits.
std::string row(const std::string& what, const std::string& bytes, std::size_t without_last = 0) {
    constexpr const char* digits = "0123456789abcdef";
    std::string text = what + ',';
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const auto byte = static_cast<unsigned char>(bytes[i]);
        if (i + without_last >= bytes.size()) {
            text += "..";
        } else {
            text += digits[byte >> 4];
            text += digits[byte & 15];
        }
    }
    return text + '\n';
}

TEST_F(SpacenavdSocket, SendsTheBytesThatAreKept) {
    // Truth: independent program (spacenavd 1.1-1 of Debian), recorded on x86-64; the period of a motion is a measured
    // time and stands as dots. The file serves clients where no daemon is installed.
    SpaceMouseDaemon daemon(SerialMouse::Model::Spaceball);
    std::string stream = "step,bytes\n";
    const auto frames = [&](SpaceMouseTap& tap, const std::string& protocol) {
        for (const Counts& counts : {Counts{1, 2, 3, 4, 5, 6}, Counts{-350, 0, 0, 0, 0, 350}, Counts{}}) {
            daemon.mouse().move(counts);
            std::string step = protocol + " move";
            for (const int count : counts) step += ' ' + std::to_string(count);
            stream += row(step, tap.take(32), 4);
        }
        daemon.mouse().press(2);
        stream += row(protocol + " press 2", tap.take(32));
        daemon.mouse().release(2);
        stream += row(protocol + " release 2", tap.take(32));
    };
    {
        SpaceMouseTap tap(daemon.socket());
        const std::uint32_t request = 0x7faa5501;
        tap.send(&request, sizeof request);
        stream += row("protocol 1 asked with 01 55 aa 7f", tap.take(4));
        frames(tap, "1");
        SpaceMouseTap::Words words{kAskName};
        tap.send(words.data(), sizeof words);
        stream += row("1 name asked", tap.take(32));
        words = {kAskType};
        tap.send(words.data(), sizeof words);
        stream += row("1 type asked", tap.take(32));
    }
    SpaceMouseTap silent(daemon.socket());
    frames(silent, "0");

    const std::string path = PASSUNG_SOURCE_DIR "/tests/data/wire/spacenavd.csv";
    if (std::getenv("PASSUNG_WRITE_WIRE") != nullptr) std::ofstream(path, std::ios::binary) << stream;
    std::stringstream kept;
    kept << std::ifstream(path, std::ios::binary).rdbuf();
    EXPECT_EQ(stream, kept.str());
}

TEST_F(SpacenavdSocket, PutsAFrameBeforeTheReplyToAClientThatAsksLate) {
    // Truth: independent program (spacenavd 1.1-1 of Debian). Who takes the first four bytes for the reply reads all
    // later frames shifted.
    SpaceMouseDaemon daemon(SerialMouse::Model::Spaceball);
    SpaceMouseTap late(daemon.socket());
    SpaceMouseTap witness(daemon.socket());
    ASSERT_EQ(witness.askProtocol1(), 0x7faa5501u);  // the daemon takes its clients in the order of their coming
    daemon.mouse().move({7, 0, 0, 0, 0, 0});
    ASSERT_TRUE(witness.frame().has_value());
    const std::uint32_t request = 0x7faa5501;
    late.send(&request, sizeof request);
    const auto first = late.frame();
    ASSERT_TRUE(first.has_value());
    EXPECT_EQ(countsOf(*first), (Counts{7, 0, 0, 0, 0, 0}));
    std::uint32_t reply = 0;
    std::memcpy(&reply, late.take(4).data(), 4);
    EXPECT_EQ(reply, request);
}

TEST_F(SpacenavdSocket, SendsNothingForAMotionThatIsHeld) {
    // Truth: independent program (spacenavd 1.1-1 of Debian): a serial mouse's frame with the counts of the last one
    // makes no event, so that a hand that holds still looks like a mouse that is gone.
    SpaceMouseDaemon daemon(SerialMouse::Model::Spaceball);
    SpaceMouseTap tap(daemon.socket());
    ASSERT_EQ(tap.askProtocol1(), 0x7faa5501u);
    for (int i = 0; i < 10; ++i) daemon.mouse().move({50, 0, 0, 0, 0, 0});
    daemon.mouse().move({51, 0, 0, 0, 0, 0});
    EXPECT_EQ(countsOf(tap.frame().value()), (Counts{50, 0, 0, 0, 0, 0}));
    EXPECT_EQ(countsOf(tap.frame().value()), (Counts{51, 0, 0, 0, 0, 0}));
}

TEST_F(SpacenavdSocket, RepeatsAHeldMotionWhereItsSettingsSaySo) {
    // Truth: independent program (spacenavd 1.1-1 of Debian).
    SpaceMouseDaemon daemon(SerialMouse::Model::Spaceball, "repeat-interval = 1\n");
    SpaceMouseTap tap(daemon.socket());
    ASSERT_EQ(tap.askProtocol1(), 0x7faa5501u);
    daemon.mouse().move({50, 0, 0, 0, 0, 0});
    for (int i = 0; i < 10; ++i) EXPECT_EQ(countsOf(tap.frame().value()), (Counts{50, 0, 0, 0, 0, 0}));
}

TEST_F(SpacenavdSocket, EndsInMotionWithoutAZeroWhenItIsKilled) {
    // Truth: independent program (spacenavd 1.1-1 and libspnav 1.0-1 of Debian): the last that a client hears is the
    // motion, then the end of the stream, which the library reports as no event at all.
    SpaceMouseDaemon daemon(SerialMouse::Model::Spaceball);
    Library library(daemon);
    SpaceMouseTap tap(daemon.socket());
    ASSERT_EQ(tap.askProtocol1(), 0x7faa5501u);
    daemon.mouse().move({0, 0, 0, 0, 0, 200});
    EXPECT_EQ(library.next().type, SPNAV_EVENT_MOTION);
    EXPECT_EQ(countsOf(tap.frame().value()), (Counts{0, 0, 0, 0, 0, 200}));
    daemon.kill();
    EXPECT_FALSE(tap.frame().has_value());
    EXPECT_EQ(library.next().type, 0);
    EXPECT_TRUE(std::filesystem::exists(daemon.socket())) << "a killed daemon leaves its socket's name behind";
    EXPECT_THROW(SpaceMouseTap{daemon.socket()}, std::runtime_error);
}

TEST_F(SpacenavdSocket, TakesItsNameAwayWhenItIsStoppedAndServesAgainWhenItIsStarted) {
    // Truth: independent program (spacenavd 1.1-1 of Debian).
    SpaceMouseDaemon daemon(SerialMouse::Model::Spaceball);
    daemon.stop();
    EXPECT_FALSE(std::filesystem::exists(daemon.socket()));
    for (int i = 0; i < 2; ++i) {
        daemon.start();
        SpaceMouseTap tap(daemon.socket());
        ASSERT_EQ(tap.askProtocol1(), 0x7faa5501u);
        daemon.mouse().move({i + 5, 0, 0, 0, 0, 0});
        EXPECT_EQ(countsOf(tap.frame().value()), (Counts{i + 5, 0, 0, 0, 0, 0}));
        daemon.kill();
    }
}

TEST_F(SpacenavdSocket, SaysNothingWhenTheMouseIsPulledInMotionAndStillNamesIt) {
    // Truth: independent program (spacenavd 1.1-1 of Debian): between the motion and the replies to later questions
    // there is no frame, neither a zero nor the removal of a device.
    SpaceMouseDaemon daemon(SerialMouse::Model::Spaceball);
    SpaceMouseTap tap(daemon.socket());
    ASSERT_EQ(tap.askProtocol1(), 0x7faa5501u);
    daemon.mouse().move({0, 100, 0, 0, 0, 0});
    EXPECT_EQ(countsOf(tap.frame().value()), (Counts{0, 100, 0, 0, 0, 0}));
    daemon.mouse().unplug();
    for (int i = 0; i < 100; ++i) {
        const auto reply = tap.ask(kAskType);
        ASSERT_TRUE(reply.has_value());
        EXPECT_EQ(reply->at(0), kAskType);
        EXPECT_EQ(reply->at(7), 0);  // no error: the daemon has not noticed
    }
}

TEST_F(SpacenavdSocket, BringsLateWhatCameWhileItHung) {
    // Truth: invariant: a stopped process sends nothing, and what the line kept comes when it goes on.
    SpaceMouseDaemon daemon(SerialMouse::Model::Spaceball);
    SpaceMouseTap tap(daemon.socket());
    ASSERT_EQ(tap.askProtocol1(), 0x7faa5501u);
    daemon.hang();
    daemon.mouse().move({30, 0, 0, 0, 0, 0});
    EXPECT_FALSE(tap.hasMore());
    daemon.goOn();
    EXPECT_EQ(countsOf(tap.frame().value()), (Counts{30, 0, 0, 0, 0, 0}));
}

TEST_F(SpacenavdSocket, FindsTheMouseAgainAfterARestart) {
    // Truth: independent program (spacenavd 1.1-1 of Debian).
    SpaceMouseDaemon daemon(SerialMouse::Model::Magellan);
    daemon.mouse().unplug();
    daemon.mouse().plug();
    daemon.start();
    SpaceMouseTap tap(daemon.socket());
    ASSERT_EQ(tap.askProtocol1(), 0x7faa5501u);
    daemon.mouse().move({9, 0, 0, 0, 0, 0});
    EXPECT_EQ(countsOf(tap.frame().value()), (Counts{9, 0, 0, 0, 0, 0}));
}

TEST_F(SpacenavdSocket, DropsAFrameThatIsCutOrShiftedAndGoesOn) {
    // Truth: independent program (spacenavd 1.1-1 of Debian): a line of the wrong length makes no event.
    SpaceMouseDaemon daemon(SerialMouse::Model::Magellan);
    SpaceMouseTap tap(daemon.socket());
    ASSERT_EQ(tap.askProtocol1(), 0x7faa5501u);
    const std::string frame = daemon.mouse().motionFrame({40, 0, 0, 0, 0, 0});
    daemon.mouse().sendRaw(frame.substr(0, 10) + '\r');
    daemon.mouse().sendRaw(frame.substr(3));
    daemon.mouse().move({41, 0, 0, 0, 0, 0});
    EXPECT_EQ(countsOf(tap.frame().value()), (Counts{41, 0, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace passung
