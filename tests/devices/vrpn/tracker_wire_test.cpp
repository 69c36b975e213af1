#include "devices/vrpn/tracker_wire.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <vector>

#include "core/base/random.h"
#include "tests/support/length.h"

namespace passung::vrpn {
namespace {

/// A server's stream, message by message: written by Python 3.11 (struct.pack) from the published format, not by a
/// server, of which there is none here. Its types come before its senders, in no order and with gaps; it has 43
/// senders.
std::vector<std::string> keptStream() {
    std::ifstream file(PASSUNG_SOURCE_DIR "/tests/data/wire/vrpn.csv");
    std::vector<std::string> messages;
    std::string line;
    std::getline(file, line);  // the header
    while (std::getline(file, line)) {
        std::string bytes;
        for (std::size_t i = line.find(',') + 1; i + 1 < line.size(); i += 2)
            bytes += static_cast<char>(std::stoi(line.substr(i, 2), nullptr, 16));
        messages.push_back(bytes);
    }
    return messages;
}

std::string joined(const std::vector<std::string>& messages) {
    std::string stream;
    for (const std::string& message : messages) stream += message;
    return stream;
}

/// What a message says, in one line.
std::string textOf(const Heard& heard) {
    const auto numbers = [](std::initializer_list<double> all) {
        std::string text;
        char number[32];
        for (const double x : all) {
            std::snprintf(number, sizeof number, " %.17g", x);
            text += number;
        }
        return text;
    };
    const std::string& who = heard.sender;
    if (const auto* greeting = std::get_if<Greeting>(&heard.message)) return "version " + greeting->version;
    if (const auto* pose = std::get_if<PoseReport>(&heard.message)) {
        const Vec3& p = pose->X.p;
        const Quat& q = pose->X.q;
        return who + "#" + std::to_string(pose->sensor) + numbers({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
    }
    if (const auto* button = std::get_if<ButtonChange>(&heard.message))
        return who + (button->pressed ? " presses " : " releases ") + std::to_string(button->number);
    if (const auto* analog = std::get_if<AnalogReport>(&heard.message))
        return who + " opens" + numbers({analog->first});
    if (const auto* force = std::get_if<ForceReport>(&heard.message))
        return who + " pushes" + numbers({force->force.x(), force->force.y(), force->force.z()});
    return std::holds_alternative<Broken>(heard.message) ? "broken" : "nothing";
}

/// All that is of use in a stream that comes in such pieces, up to the first that is broken.
template <class Cut>
std::vector<std::string> read(std::string_view stream, Cut next_piece) {
    MessageCutter cutter;
    std::vector<std::string> texts;
    while (!stream.empty()) {
        const std::size_t size = std::min<std::size_t>(next_piece(), stream.size());
        cutter.add(stream.substr(0, size));
        stream.remove_prefix(size);
        while (const auto heard = cutter.next()) {
            const std::string text = textOf(*heard);
            if (text != "nothing") texts.push_back(text);
            if (text == "broken") return texts;
        }
    }
    return texts;
}

std::vector<std::string> readWhole(std::string_view stream) {
    return read(stream, [&] { return stream.size(); });
}

/// What the stream says, typed in once more.
const std::string kFarPose = "body of the room 120#0 4.9406564584124654e-324 -0 1.0000000000000001e+300 0 0 0 1";
const std::string kWandPose =
    "Wand#2 1.1000000000000001 2.2000000000000002 -3.2999999999999998 0 0.59999999999999998 0 0.80000000000000004";
const std::vector<std::string> kSaid{"version 07.38",
                                     "Phantom0#0 0.125 -0.25 0.0078125 0.5 -0.5 0.5 0.5",
                                     kWandPose,
                                     "Phantom0 presses 1",
                                     "Phantom0 releases 1",
                                     "Phantom0 opens 0.75",
                                     "Phantom0 pushes 0.5 0 -2",
                                     kFarPose};

TEST(TrackerWire, ReadsAStreamWhateverItsNumbersAndTheirOrder) {
    // Truth: independent program (Python 3.11, struct): the kept stream.
    EXPECT_EQ(readWhole(joined(keptStream())), kSaid);
}

TEST(TrackerWire, SegmentsOfTcpKeepNoBorders) {
    // Truth: invariant: however the bytes come, the same is said.
    const std::string stream = joined(keptStream());
    for (std::size_t size = 1; size < 130; ++size) EXPECT_EQ(read(stream, [&] { return size; }), kSaid) << size;
    Random random(8);
    for (int i = 0; i < 200; ++i)
        EXPECT_EQ(read(stream, [&] { return 1 + static_cast<std::size_t>(random.below(i % 2 == 0 ? 40 : 300)); }),
                  kSaid);
}

TEST(TrackerWire, AShiftedStreamNeverGivesAPoseThatWasNotSent) {
    // Truth: invariant: where 1 to 7 bytes are lost, or come too much, before any message, nothing is read but what was
    // sent, and it is told: nearly always at the next message, and at most as much is waited for as a message may be
    // long.
    const std::vector<std::string> messages = keptStream();
    constexpr std::size_t kRepeated = MessageCutter::kLongest / 88 + 2;
    std::string stream = joined(messages);
    for (std::size_t i = 0; i < kRepeated; ++i) stream += messages.back();
    std::vector<std::string> said = kSaid;
    said.insert(said.end(), kRepeated, kSaid.back());
    const auto tell = [&](const std::string& shifted) {
        std::vector<std::string> texts = readWhole(shifted);
        ASSERT_FALSE(texts.empty());
        EXPECT_EQ(texts.back(), "broken");
        texts.pop_back();
        ASSERT_LE(texts.size(), said.size());
        EXPECT_TRUE(std::equal(texts.begin(), texts.end(), said.begin())) << texts.back();
    };
    std::size_t begins = 0;
    for (const std::string& message : messages) {
        for (std::size_t shift = 1; shift < 8; ++shift) {
            SCOPED_TRACE(std::to_string(shift) + " at " + std::to_string(begins));
            tell(std::string(stream).erase(begins, shift));
            for (const char filler : {'\0', '\x5a', '\x7f', '\xff'})
                tell(std::string(stream).insert(begins, shift, filler));
        }
        begins += message.size();
    }
}

TEST(TrackerWire, ALengthThatCannotBeIsToldBeforeAnyMoreIsWaitedFor) {
    // Truth: invariant: a length covers the head, and is no longer than a server's own buffer.
    const std::vector<std::string> messages = keptStream();
    const std::string& pose = messages.back();
    for (const std::uint32_t length : {0u, 1u, 23u, MessageCutter::kLongest + 1, 0x7fffffffu, 0xffffffffu}) {
        std::string head = pose.substr(0, 24);
        for (std::size_t i = 0; i < 4; ++i) head[i] = static_cast<char>(length >> (24 - 8 * i) & 0xff);
        EXPECT_EQ(readWhole(joined(messages) + head).back(), "broken") << length;
    }
    for (const std::uint32_t body : {0u, 8u, 63u, 65u, 72u}) {  // of a pose that has 64 bytes
        std::string other = pose.substr(0, 24) + std::string((body + 7) / 8 * 8, '\0');
        other[2] = 0;
        other[3] = static_cast<char>(24 + body);
        EXPECT_EQ(readWhole(joined(messages) + other).back(), "broken") << body;
    }
}

TEST(TrackerWire, ANumberThatWasNotNamedIsNoMessage) {
    // Truth: invariant: a server names each sender and type before it uses it.
    const std::vector<std::string> messages = keptStream();
    for (const std::size_t word : {12u, 16u}) {
        std::string pose = messages.back();
        pose[word + 2] = '\x33';
        EXPECT_EQ(readWhole(joined(messages) + pose).back(), "broken") << word;
        pose[word] = '\xff';  // a type of the system that there is not
        EXPECT_EQ(readWhole(joined(messages) + pose).back(), "broken") << word;
    }
}

TEST(TrackerWire, OtherProgramsAreToldByTheirFirstBytesAndOtherVersionsByTheirNumber) {
    // Truth: invariant.
    for (const char* other : {"H", "vrpn ", "SSH-2.0-OpenSSH", "vrpn: ver, 07.38  0....."})
        EXPECT_EQ(readWhole(other), std::vector<std::string>{"broken"}) << other;
    EXPECT_TRUE(readWhole("vrpn: ver. 07.38  0").empty()) << "more has to come";
    std::string old = "vrpn: ver. 06.04  0";
    old.resize(kCookieLength, '\0');
    EXPECT_EQ(readWhole(old), std::vector<std::string>{"version 06.04"});
    EXPECT_EQ(kCookie.substr(0, 19), "vrpn: ver. 07.38  0");
}

TEST(TrackerWire, WhateverBytesComeItEndsAndKeepsNoMoreThanIsNamed) {
    // Truth: invariant: streams with random bytes in random places, and random messages, are read to their end or told.
    const std::string stream = joined(keptStream());
    Random random(6);
    int broken = 0;
    const int rounds = test::atFullLength() ? 200'000 : 4'000;
    for (int i = 0; i < rounds; ++i) {
        std::string bytes = stream;
        const auto flips = 1 + random.below(6);
        for (std::uint64_t k = 0; k < flips; ++k)
            bytes[static_cast<std::size_t>(random.below(bytes.size()))] = static_cast<char>(random.below(256));
        const auto texts = read(bytes, [&] { return 1 + static_cast<std::size_t>(random.below(2000)); });
        ASSERT_LE(texts.size(), kSaid.size() + 20);
        broken += !texts.empty() && texts.back() == "broken" ? 1 : 0;
    }
    EXPECT_GT(broken, rounds / 10);
    EXPECT_LT(broken, rounds) << "a byte within a number is another number";
}

}  // namespace
}  // namespace passung::vrpn
