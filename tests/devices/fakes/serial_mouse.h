#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/devices/fakes/pseudo_terminal.h"

namespace passung::fake {

/// A serial mouse of six degrees on a pseudo-terminal, as spacenavd 1.1 finds it through `serial =` of its file.
///
/// Magellan (SpaceMouse): a line ends in CR. `vQ` asks for the version; `d` and 24 characters are a motion: six times
/// four nibbles, highest first, of count + 32768; `k` and three characters are the keys, four bits each, lowest first.
/// The high half of a nibble's character means nothing to the daemon; here the parity makes the count of bits even, as
/// on the device.
///
/// Spaceball (4000 FLX): `@RESET` is answered by lines that begin with @1 and @2; `D`, a time of two bytes and six big
/// endian numbers of 16 bits are a motion, where ^Q ^S ^M ^^ stand for XON, XOFF, CR and ^; `.` and two bytes are
/// twelve keys.
///
/// Nothing is sent by itself: a motion is one frame, when the test says so.
class SerialMouse {
public:
    enum class Model { Magellan, Spaceball };

    /// `link` is a name for the terminal, which stays when the mouse is plugged in anew.
    SerialMouse(Model model, std::filesystem::path link);
    SerialMouse(const SerialMouse&) = delete;
    SerialMouse& operator=(const SerialMouse&) = delete;

    /// Answers what the daemon has asked, within a slice. True if it has asked anything.
    bool answer();

    /// Has the daemon recognised the mouse and set its mode since the last `forget`?
    bool isServed() const noexcept { return served_; }
    void forgetService() noexcept { served_ = false; }

    /// One frame with the counts of the device's own axes: translation x, y, z, then rotation.
    void move(const std::array<int, 6>& counts);
    /// One frame with the state of all keys after one has changed.
    void press(int button);
    void release(int button);
    /// Bytes as they are: half a frame, a shifted one, noise.
    void sendRaw(const std::string& bytes);

    /// The frame of a motion, and of keys, as this model sends it.
    std::string motionFrame(const std::array<int, 6>& counts) const;
    std::string keyFrame(unsigned keys) const;

    /// The cable is pulled: the terminal is gone. `plug` makes a new one under the same name.
    void unplug();
    void plug();

    std::int64_t framesSent() const noexcept { return frames_sent_; }

private:
    Model model_;
    PseudoTerminal line_;
    std::string asked_;
    bool served_ = false;
    unsigned keys_ = 0;
    std::int64_t frames_sent_ = 0;
};

}  // namespace passung::fake
