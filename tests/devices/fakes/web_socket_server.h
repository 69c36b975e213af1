#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <string>

#include "tests/devices/fakes/loopback_server.h"

namespace passung::fake {

/// Who hears what clients of a WebSocketServer do. Called from its thread, or from that of who drops a client, one call
/// at a time.
class WebSocketHandler {
public:
    virtual ~WebSocketHandler() = default;
    virtual void opened(int client) = 0;
    virtual void received(int client, const std::string& text) = 0;
    /// Told once, whoever closes.
    virtual void closed(int client) = 0;
};

/// A server of RFC 6455 on a port of the loop-back that the system picks: text messages, fragments, ping, close. It can
/// also break the rules on purpose. It keeps no time.
class WebSocketServer final : LoopbackHandler {
public:
    explicit WebSocketServer(WebSocketHandler& handler);
    WebSocketServer(const WebSocketServer&) = delete;
    WebSocketServer& operator=(const WebSocketServer&) = delete;

    int port() const noexcept { return server_.port(); }

    /// One message, in frames of at most `fragment` bytes (0: in one).
    void send(int client, const std::string& text, std::size_t fragment = 0);
    /// The bytes of that message's only frame.
    static std::string frame(const std::string& text);
    /// Bytes as they are, such as half a frame.
    void sendRaw(int client, const std::string& bytes);
    void ping(int client, const std::string& text);
    /// A close frame with a code; the client is to answer and to hang up.
    void close(int client, int code);
    /// Hangs up without a word.
    void drop(int client);

    /// What clients did that RFC 6455 forbids: unmasked frames, unknown opcodes, fragments out of order.
    std::int64_t violations() const noexcept { return violations_; }
    std::int64_t pongs() const noexcept { return pongs_; }

private:
    struct Client {
        bool upgraded = false;
        std::string bytes;    // not yet understood
        std::string message;  // the fragments so far
        bool in_message = false;
    };

    void connected(int client) override;
    void heard(int client, const std::string& bytes) override;
    void gone(int client) override;
    bool upgrade(int id, Client& client);
    bool takeFrame(int id, Client& client);

    WebSocketHandler& handler_;
    std::map<int, Client> clients_;
    std::atomic<std::int64_t> violations_ = 0;
    std::atomic<std::int64_t> pongs_ = 0;
    LoopbackServer server_;  // last, as its thread calls what stands above
};

}  // namespace passung::fake
