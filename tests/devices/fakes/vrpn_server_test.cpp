#include "tests/devices/fakes/vrpn_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>

#include "tests/devices/fakes/waiting.h"

/// The fake VRPN server byte by byte. What is expected is written out by hand from the format; no real server or client
/// is at hand to check it.
namespace passung {
namespace {

using fake::VrpnForceField;
using fake::VrpnServer;

/// The bytes that hexadecimal digits say; blanks part them for the eye.
std::string bytesOf(const std::string& digits) {
    std::string bytes;
    std::string pair;
    for (const char digit : digits) {
        if (digit == ' ') continue;
        pair += digit;
        if (pair.size() < 2) continue;
        bytes += static_cast<char>(std::stoi(pair, nullptr, 16));
        pair.clear();
    }
    return bytes;
}

/// A cookie: 16 characters of magic, two blanks, the log mode, zeros.
std::string cookie(const std::string& version) {
    std::string bytes = "vrpn: ver. " + version + "  0";
    bytes.resize(24, '\0');
    return bytes;
}

class Peer {
public:
    explicit Peer(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
            throw std::runtime_error("no server");
    }
    ~Peer() { close(socket_); }
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    void send(const std::string& bytes) const { ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL); }
    /// Exactly so many bytes; fewer if the server hangs up.
    std::string take(std::size_t count) const {
        std::string bytes;
        bool ended = false;
        fake::waitFor(
            "bytes of the server",
            [&] {
                if (!fake::readable(socket_)) return false;
                std::string more(count - bytes.size(), '\0');
                const ssize_t got = recv(socket_, more.data(), more.size(), 0);
                ended = got <= 0;
                if (!ended) bytes.append(more, 0, static_cast<std::size_t>(got));
                return true;
            },
            [&] { return ended || bytes.size() == count; });
        return bytes;
    }
    bool hasMore() const { return fake::readable(socket_, 1); }

private:
    int socket_;
};

/// One whole message: its head of six words and its body without the padding.
struct Message {
    std::array<std::uint32_t, 6> head{};
    std::string body;
};

Message takeMessage(const Peer& peer) {
    Message message;
    const std::string head = peer.take(24);
    if (head.size() != 24) throw std::runtime_error("the server has hung up");
    for (std::size_t i = 0; i < 6; ++i) {
        std::uint32_t word = 0;
        std::memcpy(&word, head.data() + 4 * i, 4);
        message.head[i] = ntohl(word);
    }
    const std::size_t size = message.head[0] - 24;
    message.body = peer.take((size + 7) / 8 * 8).substr(0, size);
    return message;
}

/// Greets, and reads the names of senders and types as the server numbers them.
std::map<std::string, std::uint32_t> greet(const Peer& peer, const VrpnServer& server) {
    EXPECT_EQ(peer.take(24), cookie("07.38"));
    peer.send(cookie("07.35"));  // minor versions talk to each other
    std::map<std::string, std::uint32_t> numbers;
    while (numbers.count("vrpn_ForceDevice Force_Field") == 0) {
        const Message message = takeMessage(peer);
        numbers[message.body.substr(4, message.body.size() - 5)] = message.head[3];
    }
    fake::waitFor(
        "the greeting", [] { return fake::readable(-1, 1); }, [&] { return server.connections() > 0; });
    return numbers;
}

void until(const VrpnServer& server, std::int64_t received) {
    fake::waitFor(
        "messages", [] { return fake::readable(-1, 1); }, [&] { return server.received() >= received; });
}

TEST(VrpnServer, IntroducesItselfWithACookieSendersAndTypes) {
    // Truth: closed form: the format, written out by hand.
    VrpnServer server("Phantom0");
    server.setTime(1, 2);
    const Peer peer(server.port());
    EXPECT_EQ(peer.take(24), cookie("07.38"));
    EXPECT_FALSE(peer.hasMore()) << "nothing comes before the client's cookie";
    peer.send(cookie("07.38"));
    // 24 + 4 + 13 = 41 bytes and 7 of padding; sender 0, type -1; the name has 12 characters and a zero.
    EXPECT_EQ(peer.take(48), bytesOf("00000029 00000001 00000002 00000000 ffffffff 00000000 0000000d") +
                                 "VRPN Control" + std::string(8, '\0'));
    EXPECT_EQ(peer.take(40), bytesOf("00000025 00000001 00000002 00000001 ffffffff 00000000 00000009") + "Phantom0" +
                                 std::string(4, '\0'));
    const Message type = takeMessage(peer);
    EXPECT_EQ(type.head[3], 0u);
    EXPECT_EQ(type.head[4], 0xfffffffeu);
    EXPECT_EQ(type.body.substr(4), std::string("VRPN_Connection_Got_First_Connection") + '\0');
}

TEST(VrpnServer, SendsTrackerButtonsAnalogAndForceInBigEndian) {
    // Truth: closed form: the format, written out by hand; the quaternion is x, y, z, w.
    VrpnServer server;
    server.numberTypesFrom(0x20);
    const Peer peer(server.port());
    auto numbers = greet(peer, server);
    EXPECT_EQ(numbers["vrpn_Tracker Pos_Quat"], 0x25u);
    server.setTime(1, 2);
    server.sendPose(3, {1.0, -2.0, 0.5}, {0.0, 0.0, 1.0, 0.0});
    EXPECT_EQ(peer.take(88), bytesOf("00000058 00000001 00000002 00000001 00000025 00000000 00000003 00000003"
                                     "3ff0000000000000 c000000000000000 3fe0000000000000"
                                     "0000000000000000 0000000000000000 3ff0000000000000 0000000000000000"));
    server.sendVelocity(3, {1.0, -2.0, 0.5}, {0.0, 0.0, 0.0, 1.0}, 2.0);
    EXPECT_EQ(peer.take(96), bytesOf("00000060 00000001 00000002 00000001 00000026 00000000 00000003 00000003"
                                     "3ff0000000000000 c000000000000000 3fe0000000000000"
                                     "0000000000000000 0000000000000000 0000000000000000 3ff0000000000000"
                                     "4000000000000000"));
    server.sendButton(2, true);
    EXPECT_EQ(peer.take(32), bytesOf("00000020 00000001 00000002 00000001 00000027 00000000 00000002 00000001"));
    server.sendAnalog({0.5, -2.0});
    EXPECT_EQ(peer.take(48), bytesOf("00000030 00000001 00000002 00000001 00000028 00000000"
                                     "4000000000000000 3fe0000000000000 c000000000000000"));
    server.sendForce({1.0, 0.5, -2.0});
    EXPECT_EQ(peer.take(48), bytesOf("00000030 00000001 00000002 00000001 00000029 00000000"
                                     "3ff0000000000000 3fe0000000000000 c000000000000000"));
}

/// The client's own numbers for the device and a type: 7 and 42.
std::string introduction(const std::string& type) {
    std::string bytes =
        bytesOf("00000025 00000000 00000000 00000007 ffffffff 00000000 00000009") + "Phantom0" + std::string(4, '\0');
    const std::size_t size = 24 + 4 + type.size() + 1;
    std::string named = bytesOf("000000") + static_cast<char>(size) +
                        bytesOf("00000000 00000000 0000002a fffffffe 00000000 000000") +
                        static_cast<char>(type.size() + 1) + type;
    named.resize(24 + (size - 24 + 7) / 8 * 8, '\0');
    return bytes + named;
}

/// 24 + 64 = 88 bytes: origin 1 2 3, force 0.5 -2 0, jacobian zero, radius 100.
std::string fieldMessage() {
    std::string bytes = bytesOf(
        "00000058 00000000 00000000 00000007 0000002a 00000000"
        "3f800000 40000000 40400000 3f000000 c0000000 00000000");
    return bytes + std::string(36, '\0') + bytesOf("42c80000");
}

TEST(VrpnServer, FeelsTheForceFieldOfAClientThatNumbersItsOwnWay) {
    // Truth: closed form: the format, written out by hand, 32-bit numbers.
    VrpnServer server;
    {
        const Peer peer(server.port());
        greet(peer, server);
        peer.send(introduction("vrpn_ForceDevice Force_Field"));
        const std::string message = fieldMessage();
        for (const char byte : message) peer.send(std::string(1, byte));  // TCP keeps no borders
        until(server, 1);
        const VrpnForceField field = server.fields().at(0);
        EXPECT_EQ(field.number, 1);
        EXPECT_EQ(field.origin, (std::array<double, 3>{1.0, 2.0, 3.0}));
        EXPECT_EQ(field.force, (std::array<double, 3>{0.5, -2.0, 0.0}));
        EXPECT_EQ(field.jacobian, (std::array<double, 9>{}));
        EXPECT_EQ(field.radius, 100.0);
        EXPECT_EQ(server.felt(), (std::array<double, 3>{0.5, -2.0, 0.0}));
        peer.send(message + message);
        until(server, 3);
        EXPECT_EQ(server.messages().at(2).type, "vrpn_ForceDevice Force_Field");
        EXPECT_EQ(server.messages().at(2).sender, "Phantom0");
    }
    fake::waitFor(
        "the end", [] { return fake::readable(-1, 1); }, [&] { return server.connections() == 0; });
    EXPECT_TRUE(server.fields().back().is_end);
    EXPECT_EQ(server.fields().back().number, 3);
    EXPECT_EQ(server.felt(), (std::array<double, 3>{}));
    EXPECT_EQ(server.malformed(), 0);
}

TEST(VrpnServer, KeepsButDoesNotFeelTheReportOfAForceThatAClientSends) {
    // Truth: public sources of VRPN: `Force` is what servers report; they listen to `Force_Field`.
    VrpnServer server;
    const Peer peer(server.port());
    greet(peer, server);
    peer.send(introduction("vrpn_ForceDevice Force"));
    peer.send(
        bytesOf("00000030 00000000 00000000 00000007 0000002a 00000000"
                "3ff0000000000000 3ff0000000000000 3ff0000000000000"));
    until(server, 1);
    EXPECT_EQ(server.messages().at(0).body.size(), 24u);
    EXPECT_EQ(server.felt(), (std::array<double, 3>{}));
    EXPECT_TRUE(server.fields().empty());
}

TEST(VrpnServer, AnswersPingsUnlessItIsToldNotTo) {
    // Truth: closed form: a pong is an empty message with its own type.
    VrpnServer server;
    const Peer peer(server.port());
    const auto numbers = greet(peer, server);
    peer.send(introduction("vrpn_Base ping_message"));
    const std::string ping = bytesOf("00000018 00000000 00000000 00000007 0000002a 00000000");
    peer.send(ping);
    const Message pong = takeMessage(peer);
    EXPECT_EQ(pong.head[0], 24u);
    EXPECT_EQ(pong.head[4], numbers.at("vrpn_Base pong_message"));
    server.answerPings(false);
    peer.send(ping);
    until(server, 2);
    EXPECT_FALSE(peer.hasMore());
}

TEST(VrpnServer, BreaksTheRulesAsItIsTold) {
    // Truth: invariant.
    VrpnServer server;
    server.announceUdp(true);
    const Peer peer(server.port());
    peer.take(24);
    peer.send(cookie("07.38"));
    const Message udp = takeMessage(peer);
    EXPECT_EQ(udp.head[3], 12345u) << "the port stands for the sender";
    EXPECT_EQ(udp.head[4], 0xfffffffdu);
    EXPECT_EQ(udp.body, std::string("127.0.0.1") + '\0');
    for (Message message; message.body.find("Force_Field") == std::string::npos;) message = takeMessage(peer);
    server.sendMessage("a type of tomorrow", "12345");
    Message message = takeMessage(peer);
    EXPECT_EQ(message.head[4], 0xfffffffeu);
    const std::uint32_t number = message.head[3];
    message = takeMessage(peer);
    EXPECT_EQ(message.head[4], number);
    EXPECT_EQ(message.body, "12345");
    server.cutNext(10);
    server.sendButton(0, true);
    EXPECT_EQ(peer.take(10), bytesOf("00000020 00000000 0000"));
    server.sendButton(0, false);
    EXPECT_EQ(takeMessage(peer).head[0], 32u) << "who counts on bytes alone reads this one shifted";
    server.sendRaw("noise");
    EXPECT_EQ(peer.take(5), "noise");
    server.dropConnections();
    EXPECT_EQ(peer.take(1), "");
    server.stayMute(true);
    const Peer unheard(server.port());
    EXPECT_FALSE(unheard.hasMore());
}

TEST(VrpnServer, HangsUpOnWhatIsNoClient) {
    // Truth: invariant: no bytes of a peer can make it crash or feel a force.
    for (const std::string& noise :
         {std::string("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"), cookie("06.00"),
          cookie("07.38") + std::string(24, '\0'), cookie("07.38") + std::string(24, '\x7f')}) {
        VrpnServer server;
        const Peer peer(server.port());
        peer.take(24);
        peer.send(noise);
        std::string rest;
        for (std::string more; !(more = peer.take(1)).empty();) rest += more;
        fake::waitFor(
            "the end", [] { return fake::readable(-1, 1); }, [&] { return server.malformed() == 1; });
        EXPECT_EQ(server.connections(), 0);
    }
}

}  // namespace
}  // namespace passung
