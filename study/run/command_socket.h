#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/base/result.h"
#include "study/session/command.h"

namespace passung::run {

/// Takes an experimenter's commands for a running session from other programs of the same user: a local socket beside
/// the database, "<database>.socket". Its thread only receives; whoever runs the session takes the commands between two
/// of its steps and answers. An emergency stop calls `stop` at once, in that thread.
class CommandSocket {
public:
    static constexpr std::chrono::milliseconds kServeWait{20};

    /// @pre this process holds the database's lock, so that a socket found there is left from a killed one.
    static Result<std::unique_ptr<CommandSocket>> listen(const std::string& database, std::function<void()> stop);
    ~CommandSocket();  // refuses what was not answered
    CommandSocket(const CommandSocket&) = delete;
    CommandSocket& operator=(const CommandSocket&) = delete;

    /// Lets `obey` answer the commands that have come, in the order of their arrival; if there is none and `wait`,
    /// waits kServeWait for one.
    void serve(const std::function<session::Reply(const session::Command&)>& obey, bool wait);

private:
    struct Request {
        session::Command command;
        int connection;
    };

    CommandSocket(std::string path, int listener, int wake, std::function<void()> stop);
    void receive();
    void receiveFrom(int connection);
    std::deque<Request> takeAll(bool wait);

    std::string path_;
    int listener_, wake_;
    std::function<void()> stop_;
    std::mutex mutex_;
    std::condition_variable arrived_;
    std::deque<Request> requests_;
    std::thread thread_;  // last: starts when everything else is there
};

/// Tells the session that runs on this database; nothing if none does. Errors: it does not answer.
Result<std::optional<session::Reply>> tellSession(const std::string& database, const session::Command& command);

}  // namespace passung::run
