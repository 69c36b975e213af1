#include "devices/spacenavd/space_mouse_unit.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "devices/spacenavd/space_mouse_wire.h"

namespace passung::spacenavd {
namespace {

using Steady = std::chrono::steady_clock;
using std::chrono::milliseconds;
using unit::Exchange;

constexpr const char* kSettings = "/etc/spnavrc";
constexpr const char* kUsualSocket = "/run/spnav.sock";
constexpr int kClutch = 2;  // of its buttons, from 1

/// The value of `socket = PATH`; empty: there is none.
std::string socketOf(const char* settings) {
    std::ifstream file(settings);
    for (std::string line; std::getline(file, line);) {
        const auto first = line.find_first_not_of(" \t");
        if (first == std::string::npos || line.compare(first, 6, "socket") != 0) continue;
        const auto equals = line.find('=', first + 6);
        if (equals == std::string::npos) continue;
        const auto begin = line.find_first_not_of(" \t\"", equals + 1);
        const auto end = line.find_last_not_of(" \t\"\r");
        if (begin != std::string::npos && end >= begin) return line.substr(begin, end - begin + 1);
    }
    return {};
}

bool isDeflected(const Twist& V) { return !V.v.isZero(0.0) || !V.w.isZero(0.0); }

milliseconds left(Steady::time_point until) {
    return std::max(milliseconds(0), std::chrono::duration_cast<milliseconds>(until - Steady::now()));
}

}  // namespace

std::string socketPath(const std::string& address) {
    if (!address.empty()) return address;
    if (const char* path = std::getenv("SPNAV_SOCKET"); path != nullptr && *path != '\0') return path;
    if (std::string path = socketOf(kSettings); !path.empty()) return path;
    return kUsualSocket;
}

struct SpaceMouseLink::Connection {
    explicit Connection(int descriptor) : socket(descriptor) {}
    ~Connection() { ::close(socket); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Waits for bytes; false: the daemon has hung up.
    bool take(milliseconds longest) {
        pollfd entry{socket, POLLIN, 0};
        if (poll(&entry, 1, static_cast<int>(longest.count())) <= 0) return true;
        char bytes[4096];
        const ssize_t count = recv(socket, bytes, sizeof bytes, MSG_DONTWAIT);
        if (count > 0) cutter.add({bytes, static_cast<std::size_t>(count)});
        return count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
    }

    bool give(const void* bytes, std::size_t count) const {
        return send(socket, bytes, count, MSG_NOSIGNAL | MSG_DONTWAIT) == static_cast<ssize_t>(count);
    }

    int socket;
    FrameCutter cutter;
    unit::Said said;
    bool untold = true;  // what is said now was not given to anybody; at first that is rest
    Steady::time_point heard = Steady::now();
};

SpaceMouseLink::SpaceMouseLink(DeviceChoice choice, unit::Axes axes) : choice_(std::move(choice)), axes_(axes) {}
SpaceMouseLink::~SpaceMouseLink() = default;

void SpaceMouseLink::close() noexcept { connection_.reset(); }

Result<DeviceUnit> SpaceMouseLink::open() {
    path_ = socketPath(choice_.address);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path_.size() >= sizeof address.sun_path)
        return Error{.message = "the path of its socket is too long: " + path_};
    path_.copy(address.sun_path, path_.size());
    const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (descriptor < 0) return Error{.message = std::string("no socket: ") + std::strerror(errno)};
    connection_ = std::make_unique<Connection>(descriptor);
    if (connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        const bool absent = errno == ENOENT || errno == ECONNREFUSED;
        return Error{.message = absent ? "spacenavd does not run: nobody listens at " + path_ +
                                             "; `sudo apt install spacenavd` and `sudo systemctl start spacenavd`"
                                       : "the socket " + path_ + " of spacenavd: " + std::strerror(errno)};
    }
    const auto name = askName();
    if (!name) return name.errors();
    if (!choice_.serial.empty() && choice_.serial != *name)
        return Error{.message = "spacenavd serves " + *name + ", not " + choice_.serial};
    return DeviceUnit{.hand = choice_.hand,
                      .kind = choice_.kind,
                      .backend = "spacenavd",
                      .serial = *name,
                      .model = *name,
                      .versions = "protocol 1 of spacenavd",
                      .calibration = "axes " + axes_.text()};
}

Result<std::string> SpaceMouseLink::askName() {
    const std::array<std::int32_t, 8> ask{kAskName};
    const Error silent{.message = "the program at " + path_ +
                                  " does not say which mouse it serves, as spacenavd 1.0 and later do: is a SpaceMouse "
                                  "plugged in? `journalctl -u spacenavd` says what it found"};
    if (!connection_->give(&kProtocol1, sizeof kProtocol1) || !connection_->give(&ask, sizeof ask)) return silent;
    std::string name;
    for (const auto until = Steady::now() + kAnswerTime; Steady::now() < until;) {
        if (!connection_->take(left(until))) return silent;
        while (const auto frame = connection_->cutter.next()) {
            if (std::holds_alternative<Broken>(*frame)) return silent;
            const auto* piece = std::get_if<Name>(&*frame);
            if (piece == nullptr) continue;
            if (!piece->known || (name + piece->piece).empty()) return silent;
            name += piece->piece;
            if (piece->ends) return name;
        }
    }
    return silent;
}

Exchange SpaceMouseLink::exchange(const Wrench&, milliseconds longest) {
    Connection& c = *connection_;
    if (!c.take(c.untold ? milliseconds(0) : longest))
        return {Exchange::Kind::Gone, {}, "spacenavd has gone: nobody is at " + path_ + " any more"};
    while (const auto frame = c.cutter.next()) {
        if (std::holds_alternative<Broken>(*frame))
            return {Exchange::Kind::Gone, {}, "what came from " + path_ + " is no frame of spacenavd"};
        if (std::holds_alternative<MouseRemoved>(*frame))
            return {Exchange::Kind::Gone, {}, "the SpaceMouse was unplugged"};
        if (const auto* motion = std::get_if<Deflection>(&*frame)) {
            c.said.V_D_B = twistOf(*motion, axes_);
            c.untold = true;
        } else if (const auto* button = std::get_if<Button>(&*frame); button != nullptr && button->number < 24) {
            const std::uint32_t bit = 1u << button->number;
            c.said.buttons = button->pressed ? c.said.buttons | bit : c.said.buttons & ~bit;
            c.untold = true;
        }
        c.heard = Steady::now();
    }
    if (std::exchange(c.untold, false)) return {Exchange::Kind::News, c.said, {}};
    if (isDeflected(c.said.V_D_B) && Steady::now() - c.heard > kHeld) {
        c.said.V_D_B = {};
        c.untold = true;
        return {Exchange::Kind::Stale,
                {},
                "the SpaceMouse was deflected and has not said a word for a second: it was unplugged, or held quite "
                "still, where a line `repeat-interval = 100` in /etc/spnavrc makes it speak"};
    }
    return {};
}

Result<std::unique_ptr<unit::Unit>> openSpaceMouse(const DeviceChoice& choice, const DeviceDescription& description) {
    const auto axes = unit::Axes::parse(choice.axes.empty() ? kDefaultAxes : choice.axes);
    if (!axes) return axes.errors();
    unit::LinkedParams params;
    params.description = description;
    params.gives_speeds = true;
    params.pushes = false;
    params.clutch = kClutch;
    return std::unique_ptr<unit::Unit>(
        std::make_unique<unit::LinkedUnit>(std::make_unique<SpaceMouseLink>(choice, *axes), std::move(params)));
}

}  // namespace passung::spacenavd
