#include "tests/devices/fakes/loopback_server.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <vector>

namespace passung::fake {

LoopbackServer::LoopbackServer(LoopbackHandler& handler) : handler_(handler) {
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(listener_, 8) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0 || pipe2(wake_, O_CLOEXEC) != 0)
        throw std::runtime_error("no port on the loop-back");
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
}

LoopbackServer::~LoopbackServer() {
    ::close(wake_[1]);
    thread_.join();
    while (!sockets_.empty()) drop(sockets_.begin()->first);
    ::close(wake_[0]);
    ::close(listener_);
}

void LoopbackServer::serve() {
    for (;;) {
        std::vector<pollfd> entries{{wake_[0], POLLIN, 0}, {listener_, POLLIN, 0}};
        std::vector<int> clients;
        {
            const std::lock_guard lock(mutex_);
            for (const auto& [client, socket] : sockets_) {
                entries.push_back({socket, POLLIN, 0});
                clients.push_back(client);
            }
        }
        // A client that was dropped meanwhile is looked for anew within a slice.
        if (poll(entries.data(), entries.size(), 20) < 0) continue;
        if (entries[0].revents != 0) return;
        const std::lock_guard lock(mutex_);
        for (std::size_t i = 0; i < clients.size(); ++i) {
            if (entries[i + 2].revents != 0) hear(clients[i]);
        }
        if (entries[1].revents != 0) accept();
    }
}

void LoopbackServer::accept() {
    const int socket = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) return;
    const int on = 1;
    setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    // Who does not read is not waited for for ever: what the system does not take within a second is lost.
    const timeval limit{1, 0};
    setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
    const int client = next_++;
    sockets_[client] = socket;
    handler_.connected(client);
}

void LoopbackServer::hear(int client) {
    const auto found = sockets_.find(client);
    if (found == sockets_.end()) return;
    std::array<char, 65536> bytes{};
    const ssize_t count = recv(found->second, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (count <= 0) return drop(client);
    handler_.heard(client, std::string(bytes.data(), static_cast<std::size_t>(count)));
}

void LoopbackServer::send(int client, const std::string& bytes) {
    const std::lock_guard lock(mutex_);
    const auto found = sockets_.find(client);
    if (found != sockets_.end()) ::send(found->second, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

void LoopbackServer::drop(int client) {
    const std::lock_guard lock(mutex_);
    const auto found = sockets_.find(client);
    if (found == sockets_.end()) return;
    ::close(found->second);
    sockets_.erase(found);
    handler_.gone(client);
}

bool LoopbackServer::has(int client) const {
    const std::lock_guard lock(mutex_);
    return sockets_.count(client) != 0;
}

}  // namespace passung::fake
