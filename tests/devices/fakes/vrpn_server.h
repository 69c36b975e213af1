#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "tests/devices/fakes/loopback_server.h"

namespace passung::fake {

/// The force that a client has asked for: f(p) = force + jacobian · (p - origin) within `radius` of `origin`; 32-bit
/// numbers on the wire.
struct VrpnForceField {
    std::int64_t number = 0;  // of the message, from 1, among all that the server has received
    bool is_end = false;      // the connection has gone
    std::array<double, 3> origin{}, force{};
    std::array<double, 9> jacobian{};
    double radius = 0.0;
};

/// A message as it came, with its numbers resolved to names.
struct VrpnMessage {
    std::string sender, type;
    std::int32_t seconds = 0, microseconds = 0;
    std::string body;
};

/// A VRPN server for one device that is tracker, buttons, analog and force device at once, over TCP alone.
///
/// Both sides send a cookie of 24 bytes (16 of magic with the version, two blanks, the log mode, zeros) and then
/// messages. A message has a head of 24 bytes, big endian: length of head and body (without the padding), seconds,
/// microseconds, sender, type, and a number in the place of padding; its body is padded to 8 bytes. Negative types are
/// the system's: -1 names a sender, -2 a type, -3 a port of UDP, -4 a log; -1 and -2 carry the number that is named in
/// the place of the sender and the name with its length. Every other type, and every sender, is known by that name
/// alone: each side has numbers of its own.
///
/// `vrpn_ForceDevice Force` is what a server reports; a client commands with `vrpn_ForceDevice Force_Field`.
///
/// It is one stepped from outside: it sends when it is told to, with the time that it is told. Only pings are answered
/// by itself.
class VrpnServer final : LoopbackHandler {
public:
    explicit VrpnServer(std::string device = "Phantom0", const std::string& version = "07.38");
    ~VrpnServer() = default;
    VrpnServer(const VrpnServer&) = delete;
    VrpnServer& operator=(const VrpnServer&) = delete;

    int port() const noexcept { return server_.port(); }

    void setTime(std::int32_t seconds, std::int32_t microseconds);
    /// Metres; the quaternion is x, y, z, w.
    void sendPose(int sensor, const std::array<double, 3>& position, const std::array<double, 4>& xyzw);
    /// m/s, and the rotation made in `dt` seconds.
    void sendVelocity(int sensor, const std::array<double, 3>& velocity, const std::array<double, 4>& xyzw, double dt);
    void sendButton(int button, bool pressed);
    void sendAnalog(const std::vector<double>& channels);
    void sendForce(const std::array<double, 3>& force);  // [N], a report
    /// A message of a type that a client may not know.
    void sendMessage(const std::string& type, const std::string& body);

    // What may be otherwise, or wrong.
    void numberTypesFrom(int first);   // for clients that come later
    void announceUdp(bool announces);  // as servers do that would rather send by UDP
    void stayMute(bool mute);          // no cookie for clients that come later
    void cutNext(std::size_t bytes);   // of the next message so many bytes, and nothing of it later
    void sendRaw(const std::string& bytes);
    void answerPings(bool answers);
    void dropConnections();

    // What it has seen.
    int connections() const;         // whose cookie has come
    std::int64_t received() const;   // messages but descriptions
    std::int64_t malformed() const;  // cookies and messages that are none
    std::vector<VrpnMessage> messages() const;
    std::vector<VrpnForceField> fields() const;
    /// The force at the device when the handle is at its field's origin: that of the last field, zero without a client.
    std::array<double, 3> felt() const;

private:
    struct Client {
        std::string bytes;
        bool greeted = false;
        std::map<std::int32_t, std::string> senders, types;  // the client's numbers
        std::map<std::string, std::int32_t> own_types;       // ours, as told to it
    };

    void connected(int client) override;
    void heard(int client, const std::string& bytes) override;
    void gone(int client) override;
    bool takeMessage(int id, Client& client);
    void obey(int id, Client& client, const VrpnMessage& message);
    std::string messageOf(std::int32_t sender, std::int32_t type, const std::string& body) const;
    void sendTo(int id, Client& client, const std::string& type, const std::string& body);
    void sendAll(const std::string& type, const std::string& body);

    std::string device_, cookie_;
    std::map<int, Client> clients_;
    std::vector<VrpnMessage> messages_;
    std::vector<VrpnForceField> fields_;
    std::array<double, 3> felt_{};
    std::int32_t seconds_ = 0, microseconds_ = 0;
    int first_type_ = 0;
    bool udp_ = false, mute_ = false, pongs_ = true, cuts_ = false;
    std::size_t cut_ = 0;
    std::int64_t received_ = 0, malformed_ = 0;
    LoopbackServer server_;  // last, as its thread calls what stands above, under its lock
};

}  // namespace passung::fake
