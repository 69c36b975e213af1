#pragma once

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/devices/fakes/serial_mouse.h"
#include "tests/support/temp_folder.h"

namespace passung::fake {

/// Debian's spacenavd 1.1 with a serial mouse of our own, in a temporary folder: as a user, beside whatever runs on the
/// machine. With -d the daemon stays in its folder, where Debian's binary makes its socket as `run/spnav.sock`.
class SpaceMouseDaemon {
public:
    static bool installed();

    /// `settings` are lines of its configuration besides that of the mouse, such as "repeat-interval = 50\n".
    explicit SpaceMouseDaemon(SerialMouse::Model model, const std::string& settings = {});
    ~SpaceMouseDaemon();
    SpaceMouseDaemon(const SpaceMouseDaemon&) = delete;
    SpaceMouseDaemon& operator=(const SpaceMouseDaemon&) = delete;

    /// Starts it, or starts it anew; returns when the mouse is served and the socket takes clients.
    void start();
    void kill();  // at once, as a crash does
    void stop();  // as a service manager does
    void hang();  // stopped in its tracks
    void goOn();  // after `hang`

    SerialMouse& mouse() { return mouse_; }
    std::filesystem::path socket() const { return folder_.path() / "run/spnav.sock"; }
    /// What it has printed.
    std::string log() const;

private:
    void end(int signal);

    test::TempFolder folder_;
    SerialMouse mouse_;
    pid_t child_ = -1;
};

/// A client that keeps every byte as it came over the socket, and knows nothing of its meaning but the length of a
/// frame.
class SpaceMouseTap {
public:
    using Words = std::array<std::int32_t, 8>;

    explicit SpaceMouseTap(const std::filesystem::path& socket);
    ~SpaceMouseTap();
    SpaceMouseTap(const SpaceMouseTap&) = delete;
    SpaceMouseTap& operator=(const SpaceMouseTap&) = delete;

    void send(const void* bytes, std::size_t count);
    /// Exactly so many bytes; fewer if the daemon hangs up.
    std::string take(std::size_t count);
    /// Comes anything within a slice?
    bool hasMore() const;
    /// One frame of 32 bytes; empty if the daemon has hung up.
    std::optional<Words> frame();
    /// Asks for protocol 1 and returns what comes back in the next four bytes.
    std::uint32_t askProtocol1();
    /// A request of protocol 1 and the next frame.
    std::optional<Words> ask(std::int32_t request);

private:
    int socket_ = -1;
};

}  // namespace passung::fake
