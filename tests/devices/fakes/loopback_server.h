#pragma once

#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace passung::fake {

/// Who hears what clients of a LoopbackServer do. Called from its thread, or from that of who drops a client, one call
/// at a time.
class LoopbackHandler {
public:
    virtual ~LoopbackHandler() = default;
    virtual void connected(int client) = 0;
    virtual void heard(int client, const std::string& bytes) = 0;
    /// Told once, whoever hangs up.
    virtual void gone(int client) = 0;
};

/// A TCP server on a port of the loop-back that the system picks, with a thread of its own.
class LoopbackServer {
public:
    explicit LoopbackServer(LoopbackHandler& handler);
    ~LoopbackServer();
    LoopbackServer(const LoopbackServer&) = delete;
    LoopbackServer& operator=(const LoopbackServer&) = delete;

    int port() const noexcept { return port_; }
    void send(int client, const std::string& bytes);
    void drop(int client);
    bool has(int client) const;
    /// Taken while the handler is called; who calls `send` holding a lock of its own that the handler takes too waits
    /// for ever.
    std::recursive_mutex& mutex() const { return mutex_; }

private:
    void serve();
    void accept();
    void hear(int client);

    LoopbackHandler& handler_;
    int listener_ = -1;
    int wake_[2] = {-1, -1};
    int port_ = 0;
    int next_ = 1;
    std::map<int, int> sockets_;  // by client
    mutable std::recursive_mutex mutex_;
    std::thread thread_;
};

}  // namespace passung::fake
