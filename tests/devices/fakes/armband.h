#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/devices/fakes/pseudo_terminal.h"

namespace passung::fake {

/// CRC-16 with the polynomial 0x1021, begun with 0xffff, nothing reflected.
std::uint16_t crc16(const std::string& bytes);

/// One frame that an armband has taken.
struct ArmbandFrame {
    int time_ms = 0;                   // virtual time at which it was taken
    int sequence = 0;                  // 0 to 255
    std::array<int, 6> intensities{};  // 0 to 255, by segment, the first one above, then to the right
    int hold_ms = 0;                   // the segments stop so long after the last frame
};

/// A vibrotactile armband of six segments on a serial line. No maker's protocol is public; this is the frame that is
/// documented here:
///
///     to it    56 54  sequence  six intensities  hold  crc(high, low)     12 bytes, hold in ms, > 0
///     from it  41 4b  sequence  status  crc(high, low)                     6 bytes, status 0: given, 1: cannot
///
/// The sum is crc16 of all that stands between the first two bytes and it. What does not begin with 56 54, or has
/// another sum, is skipped byte by byte and is not acknowledged. Time is virtual: the test says it.
class Armband {
public:
    enum class Answer { Prompt, Never, Half, WrongSum, WrongSequence, Cannot };

    explicit Armband(std::filesystem::path link) : line_(std::move(link)) {}

    const std::filesystem::path& path() const noexcept { return line_.path(); }
    /// Takes what has come by that time and answers it. Waits for bytes, at most so long by the clock.
    void attend(int time_ms, int wait_ms = 0);
    void answer(Answer how) { how_ = how; }
    /// Each answer comes so many frames late.
    void delayAnswers(int frames) { late_ = frames; }
    void unplug() { line_.unplug(); }
    void plug() { line_.plug(); }

    const std::vector<ArmbandFrame>& frames() const noexcept { return frames_; }
    std::int64_t skippedBytes() const noexcept { return skipped_; }
    /// What the segments do at that time: the last frame that was taken by then, silence after its hold.
    std::array<int, 6> at(int time_ms) const;

    static std::string frameOf(int sequence, const std::array<int, 6>& intensities, int hold_ms);
    static std::string answerOf(int sequence, int status);

private:
    PseudoTerminal line_;
    std::string bytes_;
    std::vector<ArmbandFrame> frames_;
    std::deque<std::string> answers_;
    Answer how_ = Answer::Prompt;
    int late_ = 0;
    std::int64_t skipped_ = 0;
};

}  // namespace passung::fake
