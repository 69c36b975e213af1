#include "tests/devices/fakes/armband.h"

namespace passung::fake {
namespace {

constexpr std::size_t kFrame = 12;
constexpr const char* kBegin = "\x56\x54";

int byteAt(const std::string& bytes, std::size_t at) { return static_cast<unsigned char>(bytes[at]); }

/// Bytes with their sum behind them.
std::string summed(const std::string& begin, const std::string& body) {
    const std::uint16_t sum = crc16(body);
    return begin + body + static_cast<char>(sum >> 8) + static_cast<char>(sum & 0xff);
}

}  // namespace

std::uint16_t crc16(const std::string& bytes) {
    unsigned sum = 0xffff;
    for (const char byte : bytes) {
        sum ^= static_cast<unsigned>(static_cast<unsigned char>(byte)) << 8;
        for (int bit = 0; bit < 8; ++bit) sum = (sum & 0x8000) != 0 ? (sum << 1 ^ 0x1021) & 0xffff : sum << 1;
    }
    return static_cast<std::uint16_t>(sum);
}

std::string Armband::frameOf(int sequence, const std::array<int, 6>& intensities, int hold_ms) {
    std::string body(1, static_cast<char>(sequence));
    for (const int intensity : intensities) body += static_cast<char>(intensity);
    return summed(kBegin, body + static_cast<char>(hold_ms));
}

std::string Armband::answerOf(int sequence, int status) {
    return summed("\x41\x4b", {static_cast<char>(sequence), static_cast<char>(status)});
}

void Armband::attend(int time_ms, int wait_ms) {
    bytes_ += line_.take(wait_ms);
    while (bytes_.size() >= kFrame) {
        ArmbandFrame frame;
        frame.time_ms = time_ms;
        frame.sequence = byteAt(bytes_, 2);
        for (std::size_t i = 0; i < 6; ++i) frame.intensities[i] = byteAt(bytes_, 3 + i);
        frame.hold_ms = byteAt(bytes_, 9);
        if (bytes_.substr(0, kFrame) != frameOf(frame.sequence, frame.intensities, frame.hold_ms) ||
            frame.hold_ms == 0) {
            bytes_.erase(0, 1);
            ++skipped_;
            continue;
        }
        bytes_.erase(0, kFrame);
        if (how_ == Answer::Cannot) {
            answers_.push_back(answerOf(frame.sequence, 1));
        } else {
            frames_.push_back(frame);
            std::string reply = answerOf(frame.sequence + (how_ == Answer::WrongSequence ? 1 : 0), 0);
            if (how_ == Answer::Half) reply.resize(3);
            if (how_ == Answer::WrongSum) reply.back() = static_cast<char>(reply.back() ^ 1);
            if (how_ != Answer::Never) answers_.push_back(reply);
        }
        while (answers_.size() > static_cast<std::size_t>(late_)) {
            line_.give(answers_.front());
            answers_.pop_front();
        }
    }
}

std::array<int, 6> Armband::at(int time_ms) const {
    for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame) {
        if (frame->time_ms > time_ms) continue;
        return time_ms < frame->time_ms + frame->hold_ms ? frame->intensities : std::array<int, 6>{};
    }
    return {};
}

}  // namespace passung::fake
