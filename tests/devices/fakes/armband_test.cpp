#include "tests/devices/fakes/armband.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/devices/fakes/waiting.h"
#include "tests/support/temp_folder.h"

/// The armband's frame, written out by hand, over a real line of the system.
namespace passung {
namespace {

using fake::Armband;
using Segments = std::array<int, 6>;

/// The program's end of the line.
class Line {
public:
    explicit Line(const std::filesystem::path& path) : line_(open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)) {
        if (line_ < 0) throw std::runtime_error("no line");
    }
    ~Line() { close(line_); }
    Line(const Line&) = delete;
    Line& operator=(const Line&) = delete;

    bool give(const std::string& bytes) const {
        return write(line_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
    }
    std::string take(std::size_t count) const {
        std::string bytes;
        fake::waitFor(
            "an answer",
            [&] {
                if (!fake::readable(line_)) return false;
                std::string more(count - bytes.size(), '\0');
                const ssize_t got = read(line_, more.data(), more.size());
                bytes.append(more, 0, got > 0 ? static_cast<std::size_t>(got) : 0);
                return got > 0;
            },
            [&] { return bytes.size() == count; });
        return bytes;
    }
    bool hasMore() const { return fake::readable(line_); }

private:
    int line_;
};

struct ArmbandLine : testing::Test {
    test::TempFolder folder;
    Armband band{folder.path() / "band"};
    Line line{band.path()};

    void send(const std::string& bytes, int time_ms) {
        ASSERT_TRUE(line.give(bytes));
        band.attend(time_ms, fake::kSliceMs);
    }
};

TEST(ArmbandSum, IsTheOneOfTheCatalogues) {
    // Truth: the check value that catalogues of CRCs give for this one (CRC-16/CCITT-FALSE): 0x29b1.
    EXPECT_EQ(fake::crc16("123456789"), 0x29b1);
    EXPECT_EQ(fake::crc16(""), 0xffff);
}

TEST_F(ArmbandLine, TakesAFrameAndSaysSo) {
    // Truth: closed form: the documented frame; the sum of 07 00 80 ff 00 00 00 32 was computed by Python's
    // binascii.crc_hqx(bytes, 0xffff).
    const std::string frame("\x56\x54\x07\x00\x80\xff\x00\x00\x00\x32\x6e\xb8", 12);
    EXPECT_EQ(Armband::frameOf(7, {0, 128, 255, 0, 0, 0}, 50), frame);
    send(frame, 1000);
    ASSERT_EQ(band.frames().size(), 1u);
    EXPECT_EQ(band.frames()[0].intensities, (Segments{0, 128, 255, 0, 0, 0}));
    EXPECT_EQ(band.frames()[0].sequence, 7);
    EXPECT_EQ(line.take(6), std::string("\x41\x4b\x07\x00\x84\x98", 6));
    EXPECT_EQ(band.at(999), Segments{});
    EXPECT_EQ(band.at(1049), (Segments{0, 128, 255, 0, 0, 0}));
    EXPECT_EQ(band.at(1050), Segments{}) << "it holds 50 ms";
}

TEST_F(ArmbandLine, FindsFramesAmongNoiseInPiecesAndShifted) {
    // Truth: invariant: each whole frame is taken once, and nothing else.
    const std::string first = Armband::frameOf(1, {1, 2, 3, 4, 5, 6}, 50);
    const std::string second = Armband::frameOf(2, {6, 5, 4, 3, 2, 1}, 50);
    for (std::size_t shift = 1; shift <= 7; ++shift) send(first.substr(shift), 10);
    EXPECT_TRUE(band.frames().empty());
    std::string broken = first;
    broken[5] = static_cast<char>(broken[5] ^ 0x10);
    send(broken, 11);
    EXPECT_TRUE(band.frames().empty());
    for (const char byte : first) send(std::string(1, byte), 12);
    send(second + second.substr(0, 4), 13);
    send(second.substr(4), 14);
    ASSERT_EQ(band.frames().size(), 3u);
    EXPECT_EQ(band.frames()[0].sequence, 1);
    EXPECT_EQ(band.frames()[2].time_ms, 14);
    EXPECT_GT(band.skippedBytes(), 0);
}

TEST_F(ArmbandLine, TakesNoFrameWithoutAHold) {
    // Truth: the documented frame: a hold is above zero, or a lost program would vibrate for ever.
    send(Armband::frameOf(1, {9, 9, 9, 9, 9, 9}, 0), 1);
    EXPECT_TRUE(band.frames().empty());
}

TEST_F(ArmbandLine, AnswersLateNeverHalfOrWrong) {
    // Truth: invariant.
    int sequence = 0;
    const auto next = [&] {
        ++sequence;
        send(Armband::frameOf(sequence, {1, 0, 0, 0, 0, 0}, 10), sequence);
    };
    band.delayAnswers(2);
    next();
    next();
    EXPECT_FALSE(line.hasMore());
    next();
    EXPECT_EQ(line.take(6), Armband::answerOf(1, 0));
    EXPECT_FALSE(line.hasMore());
    band.delayAnswers(0);
    next();
    EXPECT_EQ(line.take(18), Armband::answerOf(2, 0) + Armband::answerOf(3, 0) + Armband::answerOf(4, 0));
    band.answer(Armband::Answer::Never);
    next();
    EXPECT_FALSE(line.hasMore());
    band.answer(Armband::Answer::Half);
    next();
    EXPECT_EQ(line.take(3), Armband::answerOf(6, 0).substr(0, 3));
    EXPECT_FALSE(line.hasMore());
    band.answer(Armband::Answer::WrongSum);
    next();
    EXPECT_NE(line.take(6), Armband::answerOf(7, 0));
    band.answer(Armband::Answer::WrongSequence);
    next();
    EXPECT_EQ(line.take(6), Armband::answerOf(9, 0));
    EXPECT_EQ(band.frames().size(), 8u);
    band.answer(Armband::Answer::Cannot);
    next();
    EXPECT_EQ(line.take(6), Armband::answerOf(9, 1));
    EXPECT_EQ(band.frames().size(), 8u) << "what it cannot give it has not given";
}

TEST_F(ArmbandLine, IsGoneWhenItIsPulledAndBackUnderItsName) {
    // Truth: invariant of pseudo-terminals: who has the line open cannot write to it any more.
    band.unplug();
    EXPECT_FALSE(line.give(Armband::frameOf(1, {}, 10)));
    band.plug();
    const Line again(band.path());
    ASSERT_TRUE(again.give(Armband::frameOf(2, {}, 10)));
    band.attend(1, fake::kSliceMs);
    EXPECT_EQ(again.take(6), Armband::answerOf(2, 0));
}

}  // namespace
}  // namespace passung
