#include "tests/devices/fakes/web_socket_server.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace passung::fake {
namespace {

constexpr const char* kKeySuffix = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";  // RFC 6455, 1.3
constexpr unsigned kContinuation = 0, kText = 1, kClose = 8, kPing = 9, kPong = 10;

/// An unmasked frame, as a server sends it.
std::string frameOf(unsigned opcode, bool last, const std::string& payload) {
    std::string bytes(1, static_cast<char>((last ? 0x80u : 0u) | opcode));
    const std::size_t size = payload.size();
    if (size < 126) {
        bytes += static_cast<char>(size);
    } else if (size < 65536) {
        bytes += static_cast<char>(126);
        for (const int shift : {8, 0}) bytes += static_cast<char>(size >> shift & 0xff);
    } else {
        bytes += static_cast<char>(127);
        for (int shift = 56; shift >= 0; shift -= 8) bytes += static_cast<char>(size >> shift & 0xff);
    }
    return bytes + payload;
}

std::string acceptKey(const std::string& key) {
    const std::string text = key + kKeySuffix;
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    EVP_Digest(text.data(), text.size(), digest.data(), &length, EVP_sha1(), nullptr);
    std::array<unsigned char, 64> base64{};
    const int count = EVP_EncodeBlock(base64.data(), digest.data(), static_cast<int>(length));
    return {base64.begin(), base64.begin() + count};
}

/// The value of a header line, whose name is compared without regard to case; empty if there is none.
std::string headerOf(const std::string& request, std::string name) {
    std::string lower = request;
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::size_t at = lower.find("\r\n" + name + ":");
    if (at == std::string::npos) return {};
    std::size_t begin = at + name.size() + 3;
    const std::size_t end = request.find("\r\n", begin);
    while (begin < end && request[begin] == ' ') ++begin;
    return request.substr(begin, end - begin);
}

}  // namespace

WebSocketServer::WebSocketServer(WebSocketHandler& handler) : handler_(handler), server_(*this) {}

void WebSocketServer::connected(int client) { clients_[client] = {}; }

void WebSocketServer::heard(int id, const std::string& bytes) {
    Client& newest = clients_.at(id);
    newest.bytes += bytes;
    if (!newest.upgraded && !upgrade(id, newest)) return;
    // A handler may drop the client whose message it hears.
    for (auto client = clients_.find(id); client != clients_.end() && takeFrame(id, client->second);
         client = clients_.find(id)) {
    }
}

void WebSocketServer::gone(int client) {
    const bool was_open = clients_.at(client).upgraded;
    clients_.erase(client);
    if (was_open) handler_.closed(client);
}

bool WebSocketServer::upgrade(int id, Client& client) {
    const std::size_t end = client.bytes.find("\r\n\r\n");
    if (end == std::string::npos) return false;
    const std::string request = client.bytes.substr(0, end + 2);
    client.bytes.erase(0, end + 4);
    const std::string key = headerOf(request, "Sec-WebSocket-Key");
    if (request.rfind("GET ", 0) != 0 || key.empty() || headerOf(request, "Sec-WebSocket-Version") != "13") {
        sendRaw(id, "HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
        server_.drop(id);
        return false;
    }
    sendRaw(id,
            "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: " +
                acceptKey(key) + "\r\n\r\n");
    client.upgraded = true;
    handler_.opened(id);
    return clients_.count(id) != 0;
}

/// Takes one whole frame off the client's bytes. False if there is none, or no client any more.
bool WebSocketServer::takeFrame(int id, Client& client) {
    const auto byte = [&](std::size_t i) -> std::uint64_t { return static_cast<unsigned char>(client.bytes[i]); };
    if (client.bytes.size() < 2) return false;
    const unsigned opcode = static_cast<unsigned>(byte(0) & 0xf);
    const bool last = (byte(0) & 0x80) != 0, masked = (byte(1) & 0x80) != 0;
    std::uint64_t size = byte(1) & 0x7f;
    std::size_t head = 2;
    const std::size_t wide = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (client.bytes.size() < head + wide) return false;
    if (wide != 0) size = 0;
    for (std::size_t i = 0; i < wide; ++i) size = size << 8 | byte(head + i);
    head += wide;
    const bool known = opcode <= kText || (opcode >= kClose && opcode <= kPong);
    const bool in_order = opcode > kText || (opcode == kContinuation) == client.in_message;
    if (!masked || !known || !in_order || (byte(0) & 0x70) != 0 || (opcode >= kClose && (!last || size > 125))) {
        ++violations_;
        close(id, 1002);
        server_.drop(id);
        return false;
    }
    if (client.bytes.size() < head + 4 + size) return false;
    std::string payload = client.bytes.substr(head + 4, size);
    for (std::size_t i = 0; i < payload.size(); ++i)
        payload[i] = static_cast<char>(payload[i] ^ client.bytes[head + i % 4]);
    client.bytes.erase(0, head + 4 + size);
    if (opcode == kPing) {
        sendRaw(id, frameOf(kPong, true, payload));
    } else if (opcode == kPong) {
        ++pongs_;
    } else if (opcode == kClose) {
        sendRaw(id, frameOf(kClose, true, payload));
        server_.drop(id);
        return false;
    } else {
        client.message += payload;
        client.in_message = !last;
        if (last) {
            std::string message;
            message.swap(client.message);
            handler_.received(id, message);
        }
    }
    return true;
}

std::string WebSocketServer::frame(const std::string& text) { return frameOf(kText, true, text); }

void WebSocketServer::send(int client, const std::string& text, std::size_t fragment) {
    if (fragment == 0) fragment = std::max<std::size_t>(text.size(), 1);
    std::string bytes;
    std::size_t at = 0;
    do {
        const std::string part = text.substr(at, fragment);
        const unsigned opcode = at == 0 ? kText : kContinuation;
        at += fragment;
        bytes += frameOf(opcode, at >= text.size(), part);
    } while (at < text.size());
    sendRaw(client, bytes);
}

void WebSocketServer::sendRaw(int client, const std::string& bytes) { server_.send(client, bytes); }

void WebSocketServer::ping(int client, const std::string& text) { sendRaw(client, frameOf(kPing, true, text)); }

void WebSocketServer::close(int client, int code) {
    sendRaw(client, frameOf(kClose, true, {static_cast<char>(code >> 8), static_cast<char>(code & 0xff)}));
}

void WebSocketServer::drop(int client) { server_.drop(client); }

}  // namespace passung::fake
