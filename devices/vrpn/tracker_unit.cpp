#include "devices/vrpn/tracker_unit.h"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/base/printable.h"
#include "devices/unit/linked_unit.h"
#include "devices/vrpn/tracker_wire.h"

namespace passung::vrpn {
namespace {

using Steady = std::chrono::steady_clock;
using std::chrono::milliseconds;
using unit::Exchange;

constexpr std::string_view kServed = "07.";  // whatever follows
constexpr int kMostButtons = 32;             // that a reading has room for
constexpr std::size_t kMostTrackers = 64;    // to be listed
constexpr milliseconds kReadingStands{25};   // the next one of a tracker of 50 Hz, and what a network adds
constexpr milliseconds kStaleAfter{100};
constexpr milliseconds kFrozenAfter{1000};

milliseconds left(Steady::time_point until) {
    return std::max(milliseconds(0), std::chrono::duration_cast<milliseconds>(until - Steady::now()));
}

std::string placeOf(const TrackerAddress& address) { return address.host + ":" + address.port; }

std::string serialOf(const std::string& name, std::int32_t sensor) {
    return printable(name) + "#" + std::to_string(sensor);
}

bool isNumber(std::string_view text, std::size_t most_digits) {
    return !text.empty() && text.size() <= most_digits &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::string listOf(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

Error noServer(const TrackerAddress& address, int reason) {
    if (reason != ECONNREFUSED)
        return {.message = fmt::format("no VRPN server answers at {}: {}; is it switched on, and does a firewall let "
                                       "TCP through?",
                                       placeOf(address), std::strerror(reason))};
    return {.message = fmt::format("no VRPN server runs: nobody listens at {}; start it there, or write where it runs "
                                   "as `address = \"NAME@HOST:PORT\"` into the station file",
                                   placeOf(address))};
}

/// Waits until it is connected, but not for ever; what came of it as in errno, 0: it is.
int connectWithin(int descriptor, const addrinfo& at, milliseconds longest) {
    if (connect(descriptor, at.ai_addr, at.ai_addrlen) == 0) return 0;
    if (errno != EINPROGRESS) return errno;
    pollfd entry{descriptor, POLLOUT, 0};
    if (poll(&entry, 1, static_cast<int>(longest.count())) <= 0) return ETIMEDOUT;
    int reason = 0;
    socklen_t size = sizeof reason;
    getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &reason, &size);
    return reason;
}

/// A socket to the server.
Result<int> connected(const TrackerAddress& address) {
    addrinfo hints{}, *all = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    if (getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &all) != 0)
        return Error{.message = "no such host of a VRPN server: " + address.host};
    int reason = ENOENT;
    for (const addrinfo* at = all; at != nullptr && reason != 0; at = at->ai_next) {
        const int descriptor = socket(at->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, at->ai_protocol);
        reason = descriptor < 0 ? errno : connectWithin(descriptor, *at, TrackerLink::kConnectTime);
        if (reason == 0) {
            freeaddrinfo(all);
            return descriptor;
        }
        if (descriptor >= 0) ::close(descriptor);
    }
    freeaddrinfo(all);
    return noServer(address, reason);
}

}  // namespace

Result<TrackerAddress> trackerAddress(const std::string& address) {
    TrackerAddress at;
    const Error wrong{.message = "must be NAME@HOST:PORT#SENSOR, of which NAME@, :PORT and #SENSOR may be left out",
                      .key = "address",
                      .value = address};
    if (address.empty()) return at;
    const auto name_ends = address.rfind('@');
    const std::string name = name_ends == std::string::npos ? std::string() : address.substr(0, name_ends);
    std::string rest = name_ends == std::string::npos ? address : address.substr(name_ends + 1);
    std::string sensor = "0";
    if (const auto mark = rest.find('#'); mark != std::string::npos) {
        sensor = rest.substr(mark + 1);
        rest.resize(mark);
        if (name.empty() || !isNumber(sensor, 6)) return wrong;
    }
    if (const auto colon = rest.find(':'); colon != std::string::npos) {
        at.port = rest.substr(colon + 1);
        rest.resize(colon);
    }
    if (rest.empty() || !isNumber(at.port, 5) || (name.empty() && name_ends != std::string::npos)) return wrong;
    at.host = rest;
    if (!name.empty()) at.serial = serialOf(name, std::stoi(sensor));
    return at;
}

/// A socket to a server, and what it has said since.
class TrackerLink::Connection {
public:
    static Result<std::unique_ptr<Connection>> open(const TrackerAddress& address) {
        const auto descriptor = connected(address);
        if (!descriptor) return descriptor.errors();
        return std::make_unique<Connection>(*descriptor, address);
    }
    Connection(int descriptor, TrackerAddress address) : socket_(descriptor), address_(std::move(address)) {}
    ~Connection() { ::close(socket_); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Greets, and listens until the tracker of the address has said where it is; where none is named, for a while to
    /// all of them.
    Result<Done> meet();
    /// The one that the address names, or the only one there is.
    Result<Done> choose();
    /// What has come. Waits for it unless something was not told yet.
    Exchange exchange(milliseconds longest, const unit::Axes& axes);

    const std::string& serial() const { return address_.serial; }
    const std::string& version() const { return version_; }
    const std::vector<std::string>& trackers() const { return trackers_; }

private:
    bool take(milliseconds longest);
    bool hear(const Heard& heard);
    /// An error with the server's place where "{}" stands.
    Error flaw(fmt::format_string<std::string> what) const { return {.message = fmt::format(what, placeOf(address_))}; }

    int socket_;
    TrackerAddress address_;
    MessageCutter cutter_;
    std::string version_;
    std::vector<std::string> trackers_;  // serials of those that have said where they are
    unit::Said said_;                    // in the server's frame
    std::string remark_;
    bool untold_ = false;
    bool told_of_force_ = false;
    Steady::time_point posed_ = Steady::now();
};

/// Waits for bytes; false: the server has hung up.
bool TrackerLink::Connection::take(milliseconds longest) {
    pollfd entry{socket_, POLLIN, 0};
    if (poll(&entry, 1, static_cast<int>(longest.count())) <= 0) return true;
    char bytes[65536];
    const ssize_t count = recv(socket_, bytes, sizeof bytes, MSG_DONTWAIT);
    if (count > 0) cutter_.add({bytes, static_cast<std::size_t>(count)});
    return count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
}

/// Takes a message; true: what follows is for later, for this one has to be judged by itself.
bool TrackerLink::Connection::hear(const Heard& heard) {
    if (const auto* greeting = std::get_if<Greeting>(&heard.message)) version_ = greeting->version;
    if (const auto* pose = std::get_if<PoseReport>(&heard.message)) {
        const std::string serial = serialOf(heard.sender, pose->sensor);
        if (trackers_.size() < kMostTrackers &&
            std::find(trackers_.begin(), trackers_.end(), serial) == trackers_.end())
            trackers_.push_back(serial);
        if (serial != address_.serial) return false;
        said_.X_BD = pose->X;
        untold_ = true;
        posed_ = Steady::now();
        return !isRigid(pose->X);
    }
    const auto mark = address_.serial.rfind('#');
    if (mark == std::string::npos || printable(heard.sender) != address_.serial.substr(0, mark)) return false;
    if (const auto* button = std::get_if<ButtonChange>(&heard.message);
        button != nullptr && button->number >= 0 && button->number < kMostButtons) {
        const std::uint32_t bit = 1u << button->number;
        said_.buttons = button->pressed ? said_.buttons | bit : said_.buttons & ~bit;
    } else if (const auto* analog = std::get_if<AnalogReport>(&heard.message)) {
        said_.grip_rad = analog->first;
    } else if (const auto* force = std::get_if<ForceReport>(&heard.message);
               force != nullptr && force->force.norm() > 0.0 && !std::exchange(told_of_force_, true)) {
        remark_ = fmt::format("the server's own device pushes, with {:.3g} N: another program commands it",
                              force->force.norm());
    }
    return false;
}

Result<Done> TrackerLink::Connection::meet() {
    if (send(socket_, kCookie.data(), kCookie.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(kCookie.size()))
        return flaw("the VRPN server at {} has hung up");
    const bool named = !address_.serial.empty();
    auto until = Steady::now() + kFirstPose;
    while (Steady::now() < until) {
        if (!take(left(until))) return flaw("the VRPN server at {} has hung up");
        while (const auto heard = cutter_.next()) {
            if (std::holds_alternative<Broken>(heard->message))
                return version_.empty() ? flaw("what listens at {} is another program than a VRPN server")
                                        : flaw("what came from {} is no message of VRPN");
            hear(*heard);
            if (!std::holds_alternative<Greeting>(heard->message)) continue;
            if (!version_.starts_with(kServed))
                return Error{.message = fmt::format("the VRPN server at {} is of version {}, and not 7",
                                                    placeOf(address_), printable(version_))};
            if (!named) until = Steady::now() + kCensus;
        }
        if (named && untold_) return Done{};
    }
    if (version_.empty()) return flaw("what listens at {} does not introduce itself, as a VRPN server does");
    if (trackers_.empty()) return flaw("the VRPN server at {} gives no pose of any tracker: is one in view?");
    if (!named) return Done{};
    return Error{.message = fmt::format("the VRPN server at {} gives no pose of {}, but of {}: is it in view, and is "
                                        "this its name?",
                                        placeOf(address_), address_.serial, listOf(trackers_))};
}

Result<Done> TrackerLink::Connection::choose() {
    if (!address_.serial.empty()) return Done{};
    if (trackers_.size() > 1)
        return Error{.message = fmt::format("the VRPN server at {} has several trackers, {}: name one as `serial` in "
                                            "the station file",
                                            placeOf(address_), listOf(trackers_))};
    address_.serial = trackers_.front();
    posed_ = Steady::now();
    return Done{};
}

Exchange TrackerLink::Connection::exchange(milliseconds longest, const unit::Axes& axes) {
    const std::string place = placeOf(address_);
    if (!take(untold_ ? milliseconds(0) : longest))
        return {Exchange::Kind::Gone, {}, "the VRPN server at " + place + " has gone: it has hung up"};
    while (const auto heard = cutter_.next()) {
        if (std::holds_alternative<Broken>(heard->message))
            return {Exchange::Kind::Gone, {}, "what came from " + place + " is no message of VRPN"};
        if (hear(*heard)) break;
    }
    if (std::exchange(untold_, false)) {
        Exchange exchange{Exchange::Kind::News, said_, std::exchange(remark_, {})};
        exchange.said.X_BD = axes.toBase(said_.X_BD);
        if (isRigid(said_.X_BD)) exchange.said.X_BD.q.normalize();
        return exchange;
    }
    if (Steady::now() - posed_ > kSilent)
        return {Exchange::Kind::Gone,
                {},
                fmt::format("no pose of {} has come from {} for a second: it is out of view, or its server hangs",
                            address_.serial, place)};
    return {};
}

TrackerLink::TrackerLink(DeviceChoice choice, TrackerAddress address, unit::Axes axes)
    : choice_(std::move(choice)), address_(std::move(address)), axes_(axes) {}
TrackerLink::~TrackerLink() = default;

void TrackerLink::close() noexcept { connection_.reset(); }

Result<DeviceUnit> TrackerLink::open() {
    auto connection = Connection::open(address_);
    if (!connection) return connection.errors();
    connection_ = *std::move(connection);
    if (const auto met = connection_->meet(); !met) return met.errors();
    if (const auto chosen = connection_->choose(); !chosen) return chosen.errors();
    return DeviceUnit{.hand = choice_.hand,
                      .kind = choice_.kind,
                      .backend = "vrpn",
                      .serial = connection_->serial(),
                      .model = "tracker",
                      .versions = "VRPN " + connection_->version(),
                      .calibration = "axes " + axes_.text()};
}

Exchange TrackerLink::exchange(const Wrench&, milliseconds longest) { return connection_->exchange(longest, axes_); }

Result<std::vector<DeviceUnit>> TrackerLink::look(const TrackerAddress& address) {
    const auto connection = Connection::open(address);
    if (!connection) return connection.errors();
    if (const auto met = (*connection)->meet(); !met) return met.errors();
    std::vector<DeviceUnit> units;
    for (const std::string& serial : (*connection)->trackers())
        if (address.serial.empty() || serial == address.serial)
            units.push_back({.serial = serial, .model = "tracker", .versions = "VRPN " + (*connection)->version()});
    return units;
}

Result<std::unique_ptr<unit::Unit>> openTracker(const DeviceChoice& choice, const DeviceDescription& description) {
    auto address = trackerAddress(choice.address);
    if (!address) return address.errors();
    const auto axes = unit::Axes::parse(choice.axes.empty() ? unit::Axes().text() : choice.axes);
    if (!axes) return axes.errors();
    if (!choice.serial.empty()) {
        const std::string serial = choice.serial.find('#') == std::string::npos ? choice.serial + "#0" : choice.serial;
        if (!address->serial.empty() && address->serial != serial)
            return Error{
                .message = "must be that of the address, " + address->serial, .key = "serial", .value = serial};
        address->serial = serial;
    }
    unit::LinkedParams params;
    params.description = description;
    params.pushes = false;
    params.reading_stands = kReadingStands;
    params.stale_after = kStaleAfter;
    params.frozen_after = kFrozenAfter;
    return std::unique_ptr<unit::Unit>(std::make_unique<unit::LinkedUnit>(
        std::make_unique<TrackerLink>(choice, *std::move(address), *axes), std::move(params)));
}

}  // namespace passung::vrpn
