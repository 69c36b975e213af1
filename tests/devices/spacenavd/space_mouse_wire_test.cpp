#include "devices/spacenavd/space_mouse_wire.h"

#include <gtest/gtest.h>
#include <spnav.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <map>

#include "core/base/random.h"

namespace passung::spacenavd {
namespace {

/// The bytes that Debian's spacenavd 1.1-1 sent, by what was done; the period of a motion, a measured time, is zero.
std::map<std::string, std::string> keptWire() {
    std::ifstream file(PASSUNG_SOURCE_DIR "/tests/data/wire/spacenavd.csv");
    std::map<std::string, std::string> rows;
    std::string line;
    std::getline(file, line);  // the header
    while (std::getline(file, line)) {
        const auto comma = line.find(',');
        std::string bytes;
        for (std::size_t i = comma + 1; i + 1 < line.size(); i += 2) {
            const std::string digits = line.substr(i, 2);
            bytes += digits == ".." ? '\0' : static_cast<char>(std::stoi(digits, nullptr, 16));
        }
        rows[line.substr(0, comma)] = bytes;
    }
    return rows;
}

std::array<std::int32_t, 6> countsOf(const std::optional<Frame>& frame) {
    const auto* deflection = frame ? std::get_if<Deflection>(&*frame) : nullptr;
    return deflection != nullptr ? deflection->counts : std::array<std::int32_t, 6>{-1, -1, -1, -1, -1, -1};
}

TEST(SpaceMouseWire, ReadsWhatTheDaemonSends) {
    // Truth: independent program (spacenavd 1.1-1 of Debian), its bytes as they are kept; it has a dead zone of two.
    const auto wire = keptWire();
    for (const char* protocol : {"1", "0"}) {
        FrameCutter cutter;
        const std::string p = protocol;
        for (const char* step :
             {" move 1 2 3 4 5 6", " move -350 0 0 0 0 350", " move 0 0 0 0 0 0", " press 2", " release 2"})
            cutter.add(wire.at(p + step));
        EXPECT_EQ(countsOf(cutter.next()), (std::array<std::int32_t, 6>{0, 2, 3, 4, 5, 6}));
        EXPECT_EQ(countsOf(cutter.next()), (std::array<std::int32_t, 6>{-350, 0, 0, 0, 0, 350}));
        EXPECT_EQ(countsOf(cutter.next()), (std::array<std::int32_t, 6>{}));
        for (const bool pressed : {true, false}) {
            const auto frame = cutter.next();
            const auto& button = std::get<Button>(frame.value());
            EXPECT_EQ(button.number, 2);
            EXPECT_EQ(button.pressed, pressed);
        }
        EXPECT_FALSE(cutter.next());
    }
    FrameCutter cutter;
    cutter.add(wire.at("1 name asked"));
    const auto frame = cutter.next();
    const auto& name = std::get<Name>(frame.value());
    EXPECT_EQ(name.piece, "Spaceball 4000FLX");
    EXPECT_TRUE(name.known);
    EXPECT_TRUE(name.ends);
}

TEST(SpaceMouseWire, TheReplyMayStandBetweenAnyTwoFramesAndBytesMayComeOneByOne) {
    // Truth: independent program (spacenavd 1.1-1, kept bytes): a frame that was on its way comes before the reply.
    const auto wire = keptWire();
    const std::string a = wire.at("1 move 1 2 3 4 5 6"), b = wire.at("1 press 2");
    const std::string reply = wire.at("protocol 1 asked with 01 55 aa 7f");
    for (const std::string& stream : {reply + a + b, a + reply + b, a + b + reply}) {
        FrameCutter cutter;
        std::vector<Frame> frames;
        for (const char byte : stream) {
            cutter.add({&byte, 1});
            while (const auto frame = cutter.next()) frames.push_back(*frame);
        }
        ASSERT_EQ(frames.size(), 2u);
        EXPECT_TRUE(std::holds_alternative<Deflection>(frames[0]));
        EXPECT_TRUE(std::holds_alternative<Button>(frames[1]));
    }
}

TEST(SpaceMouseWire, TellsAStreamThatIsShifted) {
    // Truth: invariant: bytes that were lost or came too much are seen within three frames, of a hand that moves.
    const auto wire = keptWire();
    std::string stream;
    for (int i = 0; i < 4; ++i) stream += wire.at("1 move -350 0 0 0 0 350") + wire.at("1 move 1 2 3 4 5 6");
    for (std::size_t shift = 1; shift < 8; ++shift) {
        for (const std::string& shifted : {stream.substr(shift), std::string(shift, '\x5a') + stream}) {
            FrameCutter cutter;
            cutter.add(shifted);
            bool told = false;
            for (int i = 0; i < 3 && !told; ++i) told = std::holds_alternative<Broken>(cutter.next().value());
            EXPECT_TRUE(told) << shift;
        }
    }
}

TEST(SpaceMouseWire, WhateverComesEveryFrameIsSoundOrBroken) {
    // Truth: invariant: random bytes give no count beyond 16 bits and no button beyond 256.
    Random random(5);
    FrameCutter cutter;
    int broken = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string bytes;
        for (int k = 0; k < 32; ++k) bytes += static_cast<char>(k > 0 && k < 4 ? 0 : random.below(k == 0 ? 8 : 256));
        cutter.add(bytes);
        while (const auto frame = cutter.next()) {
            if (std::holds_alternative<Broken>(*frame)) ++broken;
            for (const std::int32_t count : countsOf(frame)) ASSERT_LE(std::abs(count), 32768);
            const auto* button = std::get_if<Button>(&*frame);
            ASSERT_TRUE(button == nullptr || button->number < 256);
        }
    }
    EXPECT_GT(broken, 10000);
}

TEST(SpaceMouseWire, TurnsTheHandleAsTheDaemonsOwnLibraryTurnsAnObject) {
    // Truth: independent program (spnav_posrot_moveobj of Debian's libspnav 1.0-1), whose scene has x right, y up and z
    // towards the user; ours has y away from the user and z up.
    const auto axes = unit::Axes::parse(kDefaultAxes);
    ASSERT_TRUE(axes);
    for (std::size_t axis = 0; axis < 6; ++axis) {
        Deflection deflection;
        deflection.counts[axis] = 100;
        spnav_posrot moved{};
        spnav_posrot_init(&moved);
        spnav_event_motion event{};
        const std::array<int*, 6> fields{&event.x, &event.y, &event.z, &event.rx, &event.ry, &event.rz};
        *fields[axis] = 100;
        spnav_posrot_moveobj(&moved, &event);
        const auto ours = [](double x, double y, double z) { return Vec3(x, -z, y); };
        const Vec3 way = ours(moved.pos[0], moved.pos[1], moved.pos[2]);
        const Vec3 turn = ours(moved.rot[0], moved.rot[1], moved.rot[2]);
        const Twist V = twistOf(deflection, *axes);
        EXPECT_EQ(V.v.norm() > 0.0, axis < 3);
        EXPECT_NEAR(V.v.dot(way), V.v.norm() * way.norm(), 1e-9) << axis;
        EXPECT_NEAR(V.w.dot(turn), V.w.norm() * turn.norm(), 1e-9) << axis;
    }
}

TEST(SpaceMouseWire, AThousandSpeedsReturnWithinACountAndEveryOtherOrderOfAxesIsTold) {
    // Truth: invariant: half a count of rounding. Of the 48 orders of axes one gives the counts back, 47 do not.
    const auto axes = unit::Axes::parse(kDefaultAxes);
    Random random(11);
    const auto axis = [&random](double full) {
        return Vec3(random.uniform(-full, full), random.uniform(-full, full), random.uniform(-full, full));
    };
    for (int i = 0; i < 1000; ++i) {
        const Twist V{axis(kFullSpeed), axis(kFullSpin)};
        const Twist back = twistOf(deflectionFor(V, *axes), *axes);
        EXPECT_LE((back.v - V.v).cwiseAbs().maxCoeff(), 0.5000001 * kFullSpeed / kFullCounts);
        EXPECT_LE((back.w - V.w).cwiseAbs().maxCoeff(), 0.5000001 * kFullSpin / kFullCounts);
    }
    const Deflection known{{11, -52, 173, 204, -35, 96}};
    int wrong = 0;
    for (const char* order : {"x y z", "x z y", "y x z", "y z x", "z x y", "z y x"}) {
        for (int signs = 0; signs < 8; ++signs) {
            std::string text;
            for (std::size_t i = 0; i < 3; ++i) {
                if (i > 0) text += ' ';
                if ((signs >> i & 1) != 0) text += '-';
                text += order[2 * i];
            }
            const auto other = unit::Axes::parse(text);
            if (deflectionFor(twistOf(known, *axes), *other).counts != known.counts) ++wrong;
        }
    }
    EXPECT_EQ(wrong, 47);
    EXPECT_EQ(twistOf(Deflection{{30000, 0, 0, 0, 0, 0}}, *axes).v.x(), kFullSpeed) << "beyond the stop";
}

}  // namespace
}  // namespace passung::spacenavd
