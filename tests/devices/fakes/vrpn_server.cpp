#include "tests/devices/fakes/vrpn_server.h"

#include <algorithm>
#include <bit>
#include <type_traits>
#include <utility>

namespace passung::fake {
namespace {

constexpr std::size_t kCookie = 24, kHead = 24, kAlign = 8;
constexpr std::uint32_t kLongest = 65536;  // no message of a client is longer
constexpr std::int32_t kSenderDescription = -1, kTypeDescription = -2, kUdpDescription = -3;
constexpr const char* kPing = "vrpn_Base ping_message";
constexpr const char* kPong = "vrpn_Base pong_message";
constexpr const char* kField = "vrpn_ForceDevice Force_Field";

const std::vector<std::string>& typesOfServer() {
    static const std::vector<std::string> names{"VRPN_Connection_Got_First_Connection",
                                                "VRPN_Connection_Got_Connection",
                                                "vrpn_Base text_message",
                                                kPing,
                                                kPong,
                                                "vrpn_Tracker Pos_Quat",
                                                "vrpn_Tracker Velocity",
                                                "vrpn_Button Change",
                                                "vrpn_Analog Channel",
                                                "vrpn_ForceDevice Force",
                                                kField};
    return names;
}

/// A number in big endian.
template <typename Number>
std::string big(Number number) {
    using Bits = std::conditional_t<sizeof(Number) == 8, std::uint64_t, std::uint32_t>;
    const auto bits = std::bit_cast<Bits>(number);
    std::string bytes;
    for (int shift = 8 * (static_cast<int>(sizeof(Number)) - 1); shift >= 0; shift -= 8) {
        bytes += static_cast<char>(bits >> shift & 0xff);
    }
    return bytes;
}

std::uint32_t wordAt(const std::string& bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i) word = word << 8 | static_cast<unsigned char>(bytes[at + i]);
    return word;
}

double floatAt(const std::string& bytes, std::size_t at) {
    return static_cast<double>(std::bit_cast<float>(wordAt(bytes, at)));
}

std::size_t padded(std::size_t size) { return (size + kAlign - 1) / kAlign * kAlign; }

/// A name with its length, the zero at its end counted.
std::string named(const std::string& name) { return big(static_cast<std::int32_t>(name.size() + 1)) + name + '\0'; }

}  // namespace

VrpnServer::VrpnServer(std::string device, const std::string& version)
    : device_(std::move(device)), cookie_("vrpn: ver. " + version + "  0"), server_(*this) {
    cookie_.resize(kCookie, '\0');
}

void VrpnServer::connected(int client) {
    clients_[client] = {};
    if (!mute_) server_.send(client, cookie_);
}

void VrpnServer::gone(int client) {
    const bool was_greeted = clients_.at(client).greeted;
    clients_.erase(client);
    felt_ = {};
    if (!was_greeted) return;
    VrpnForceField end;
    end.number = received_;
    end.is_end = true;
    fields_.push_back(end);
}

void VrpnServer::heard(int id, const std::string& bytes) {
    Client& client = clients_.at(id);
    client.bytes += bytes;
    if (!client.greeted) {
        if (client.bytes.size() < kCookie) return;
        const std::string cookie = client.bytes.substr(0, kCookie);
        client.bytes.erase(0, kCookie);
        if (cookie.substr(0, 14) != cookie_.substr(0, 14) || cookie.substr(16, 2) != "  ") {  // up to the last point
            ++malformed_;
            return server_.drop(id);
        }
        client.greeted = true;
        if (udp_) server_.send(id, messageOf(12345, kUdpDescription, std::string("127.0.0.1") + '\0'));
        server_.send(id, messageOf(0, kSenderDescription, named("VRPN Control")));
        server_.send(id, messageOf(1, kSenderDescription, named(device_)));
        std::int32_t number = first_type_;
        for (const std::string& type : typesOfServer()) {
            client.own_types[type] = number;
            server_.send(id, messageOf(number++, kTypeDescription, named(type)));
        }
    }
    for (auto found = clients_.find(id); found != clients_.end() && takeMessage(id, found->second);
         found = clients_.find(id)) {
    }
}

bool VrpnServer::takeMessage(int id, Client& client) {
    if (client.bytes.size() < kHead) return false;
    const std::uint32_t length = wordAt(client.bytes, 0);
    if (length < kHead || length > kLongest) {
        ++malformed_;
        server_.drop(id);
        return false;
    }
    const std::size_t whole = kHead + padded(length - kHead);
    if (client.bytes.size() < whole) return false;
    const auto sender = static_cast<std::int32_t>(wordAt(client.bytes, 12));
    const auto type = static_cast<std::int32_t>(wordAt(client.bytes, 16));
    VrpnMessage message;
    message.seconds = static_cast<std::int32_t>(wordAt(client.bytes, 4));
    message.microseconds = static_cast<std::int32_t>(wordAt(client.bytes, 8));
    message.body = client.bytes.substr(kHead, length - kHead);
    client.bytes.erase(0, whole);
    if (type == kSenderDescription || type == kTypeDescription) {
        if (message.body.size() < 5 || wordAt(message.body, 0) != message.body.size() - 4 ||
            message.body.back() != '\0') {
            ++malformed_;
            return true;
        }
        auto& names = type == kSenderDescription ? client.senders : client.types;
        names[sender] = message.body.substr(4, message.body.size() - 5);
        return true;
    }
    if (type < 0) return true;  // of UDP and logs
    if (client.senders.count(sender) == 0 || client.types.count(type) == 0) {
        ++malformed_;
        return true;
    }
    ++received_;
    message.sender = client.senders[sender];
    message.type = client.types[type];
    messages_.push_back(message);
    obey(id, client, message);
    return true;
}

void VrpnServer::obey(int id, Client& client, const VrpnMessage& message) {
    if (message.type == kPing && pongs_) return sendTo(id, client, kPong, "");
    if (message.type != kField || message.sender != device_) return;
    if (message.body.size() != 16 * 4) {
        ++malformed_;
        return;
    }
    VrpnForceField field;
    field.number = received_;
    std::array<double, 16> numbers{};
    for (std::size_t i = 0; i < 16; ++i) numbers[i] = floatAt(message.body, 4 * i);
    for (std::size_t i = 0; i < 3; ++i) {
        field.origin[i] = numbers[i];
        field.force[i] = numbers[3 + i];
    }
    for (std::size_t i = 0; i < 9; ++i) field.jacobian[i] = numbers[6 + i];
    field.radius = numbers[15];
    fields_.push_back(field);
    felt_ = field.force;
}

std::string VrpnServer::messageOf(std::int32_t sender, std::int32_t type, const std::string& body) const {
    std::string bytes = big(static_cast<std::int32_t>(kHead + body.size())) + big(seconds_) + big(microseconds_) +
                        big(sender) + big(type) + big(std::int32_t{0}) + body;
    bytes.resize(kHead + padded(body.size()), '\0');
    return bytes;
}

void VrpnServer::sendTo(int id, Client& client, const std::string& type, const std::string& body) {
    if (client.own_types.count(type) == 0) {
        const auto number = static_cast<std::int32_t>(first_type_ + static_cast<int>(client.own_types.size()));
        client.own_types[type] = number;
        server_.send(id, messageOf(number, kTypeDescription, named(type)));
    }
    std::string bytes = messageOf(1, client.own_types[type], body);
    if (std::exchange(cuts_, false)) bytes.resize(std::min(bytes.size(), cut_));
    server_.send(id, bytes);
}

void VrpnServer::sendAll(const std::string& type, const std::string& body) {
    const std::lock_guard lock(server_.mutex());
    for (auto& [id, client] : clients_) {
        if (client.greeted) sendTo(id, client, type, body);
    }
}

void VrpnServer::setTime(std::int32_t seconds, std::int32_t microseconds) {
    const std::lock_guard lock(server_.mutex());
    seconds_ = seconds;
    microseconds_ = microseconds;
}

void VrpnServer::sendPose(int sensor, const std::array<double, 3>& position, const std::array<double, 4>& xyzw) {
    std::string body = big(std::int32_t{sensor}) + big(std::int32_t{sensor});  // the second one only aligns
    for (const double x : position) body += big(x);
    for (const double x : xyzw) body += big(x);
    sendAll("vrpn_Tracker Pos_Quat", body);
}

void VrpnServer::sendVelocity(int sensor, const std::array<double, 3>& velocity, const std::array<double, 4>& xyzw,
                              double dt) {
    std::string body = big(std::int32_t{sensor}) + big(std::int32_t{sensor});  // the second one only aligns
    for (const double x : velocity) body += big(x);
    for (const double x : xyzw) body += big(x);
    sendAll("vrpn_Tracker Velocity", body + big(dt));
}

void VrpnServer::sendButton(int button, bool pressed) {
    sendAll("vrpn_Button Change", big(std::int32_t{button}) + big(std::int32_t{pressed}));
}

void VrpnServer::sendAnalog(const std::vector<double>& channels) {
    std::string body = big(static_cast<double>(channels.size()));
    for (const double x : channels) body += big(x);
    sendAll("vrpn_Analog Channel", body);
}

void VrpnServer::sendForce(const std::array<double, 3>& force) {
    std::string body;
    for (const double x : force) body += big(x);
    sendAll("vrpn_ForceDevice Force", body);
}

void VrpnServer::sendMessage(const std::string& type, const std::string& body) { sendAll(type, body); }

void VrpnServer::numberTypesFrom(int first) {
    const std::lock_guard lock(server_.mutex());
    first_type_ = first;
}

void VrpnServer::announceUdp(bool announces) {
    const std::lock_guard lock(server_.mutex());
    udp_ = announces;
}

void VrpnServer::stayMute(bool mute) {
    const std::lock_guard lock(server_.mutex());
    mute_ = mute;
}

void VrpnServer::cutNext(std::size_t bytes) {
    const std::lock_guard lock(server_.mutex());
    cuts_ = true;
    cut_ = bytes;
}

void VrpnServer::answerPings(bool answers) {
    const std::lock_guard lock(server_.mutex());
    pongs_ = answers;
}

void VrpnServer::sendRaw(const std::string& bytes) {
    const std::lock_guard lock(server_.mutex());
    for (const auto& [id, client] : clients_) server_.send(id, bytes);
}

void VrpnServer::dropConnections() {
    const std::lock_guard lock(server_.mutex());
    while (!clients_.empty()) server_.drop(clients_.begin()->first);
}

int VrpnServer::connections() const {
    const std::lock_guard lock(server_.mutex());
    int count = 0;
    for (const auto& [id, client] : clients_) count += client.greeted;
    return count;
}

std::int64_t VrpnServer::received() const {
    const std::lock_guard lock(server_.mutex());
    return received_;
}

std::int64_t VrpnServer::malformed() const {
    const std::lock_guard lock(server_.mutex());
    return malformed_;
}

std::vector<VrpnMessage> VrpnServer::messages() const {
    const std::lock_guard lock(server_.mutex());
    return messages_;
}

std::vector<VrpnForceField> VrpnServer::fields() const {
    const std::lock_guard lock(server_.mutex());
    return fields_;
}

std::array<double, 3> VrpnServer::felt() const {
    const std::lock_guard lock(server_.mutex());
    return felt_;
}

}  // namespace passung::fake
