#include "tests/devices/fakes/serial_mouse.h"

#include <bit>
#include <stdexcept>
#include <utility>

#include "tests/devices/fakes/waiting.h"

namespace passung::fake {
namespace {

constexpr const char* kMagellanVersion = "vMAGELLAN  Version 6.60\r";
constexpr const char* kSpaceballBanner = "\r@1 Spaceball\r@2 Firmware version 2.43\r";

/// A nibble with a parity in the high half, so that the character has an even number of bits.
char nibble(unsigned value) {
    value &= 0xf;
    return static_cast<char>(value | (std::popcount(value) % 2 == 0 ? 0x30u : 0x40u));
}

/// What the serial line takes for control travels in two characters.
std::string escaped(const std::string& bytes) {
    std::string result;
    for (const char byte : bytes) {
        switch (byte) {
            case 0x11:
                result += "^Q";
                break;
            case 0x13:
                result += "^S";
                break;
            case '\r':
                result += "^M";
                break;
            case '^':
                result += "^^";
                break;
            default:
                result += byte;
        }
    }
    return result;
}

}  // namespace

SerialMouse::SerialMouse(Model model, std::filesystem::path link) : model_(model), line_(std::move(link)) {}

void SerialMouse::plug() {
    line_.plug();
    asked_.clear();
}

void SerialMouse::unplug() {
    line_.unplug();
    served_ = false;
    keys_ = 0;
}

bool SerialMouse::answer() {
    const std::string bytes = line_.take(kSliceMs);
    if (bytes.empty()) return false;
    asked_ += bytes;
    for (std::size_t end; (end = asked_.find('\r')) != std::string::npos; asked_.erase(0, end + 1)) {
        const std::string command = asked_.substr(0, end);
        if (model_ == Model::Spaceball && command == "@RESET") sendRaw(kSpaceballBanner);
        if (model_ == Model::Spaceball && command == "k") {
            sendRaw(keyFrame(keys_));
            served_ = true;
        }
        if (model_ == Model::Magellan && command == "vQ") sendRaw(kMagellanVersion);
        if (model_ == Model::Magellan && command == "m3") served_ = true;
    }
    return true;
}

std::string SerialMouse::motionFrame(const std::array<int, 6>& counts) const {
    if (model_ == Model::Magellan) {
        std::string frame = "d";
        for (const int count : counts) {
            const unsigned biased = static_cast<unsigned>(count + 32768);
            for (const unsigned shift : {12u, 8u, 4u, 0u}) frame += nibble(biased >> shift);
        }
        return frame + '\r';
    }
    std::string body{'\0', '\x10'};  // a millisecond since the last frame, in sixteenths
    for (const int count : counts) {
        body += static_cast<char>(static_cast<unsigned>(count) >> 8 & 0xff);
        body += static_cast<char>(static_cast<unsigned>(count) & 0xff);
    }
    return 'D' + escaped(body) + '\r';
}

std::string SerialMouse::keyFrame(unsigned keys) const {
    if (model_ == Model::Magellan) {
        return std::string("k") + nibble(keys) + nibble(keys >> 4) + nibble(keys >> 8) + '\r';
    }
    // Keys 7 to 11 and a bit that keeps the byte printable; keys 0 to 5 and 6.
    const unsigned high = 0x40u | (keys >> 7 & 0x1fu);
    const unsigned low = 0x40u | (keys & 0x3fu) | (keys & 0x40u) << 1;
    return '.' + escaped({static_cast<char>(high), static_cast<char>(low)}) + '\r';
}

void SerialMouse::move(const std::array<int, 6>& counts) {
    sendRaw(motionFrame(counts));
    ++frames_sent_;
}

void SerialMouse::press(int button) {
    keys_ |= 1u << button;
    sendRaw(keyFrame(keys_));
}

void SerialMouse::release(int button) {
    keys_ &= ~(1u << button);
    sendRaw(keyFrame(keys_));
}

void SerialMouse::sendRaw(const std::string& bytes) {
    if (!line_.give(bytes)) throw std::runtime_error("pseudo-terminal does not take a frame");
}

}  // namespace passung::fake
