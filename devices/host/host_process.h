#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "devices/host/shared_pages.h"

namespace passung::host {

/// A running device host, with what it shares. It ends with this: by itself, for its bell has gone, else it is killed.
class HostProcess {
public:
    /// Starts it for the backend. Errors: what is missing, and where.
    static Result<std::unique_ptr<HostProcess>> start(const std::string& backend, const HostTask& task);
    ~HostProcess();
    HostProcess(const HostProcess&) = delete;
    HostProcess& operator=(const HostProcess&) = delete;

    /// Waits until the library has been opened. Errors: why not.
    Result<Done> awaitRunning(std::chrono::milliseconds longest);
    const HostPage& told() const { return *told_; }

    void give(const StudyCommand& command);
    /// The newest report, once there is one that answers the command of that number, or the time is over.
    std::optional<HostReport> awaitReport(std::uint64_t answers, std::chrono::milliseconds longest);
    bool hasGone() const { return gone_; }
    /// How it has ended, for people.
    std::string ending();

private:
    HostProcess() = default;
    bool awaitBell(std::chrono::steady_clock::time_point until);
    std::optional<int> reap(std::chrono::milliseconds longest);

    StudyPage* asked_ = nullptr;
    const HostPage* told_ = nullptr;
    int bell_ = -1;
    int process_ = -1;
    bool gone_ = false;
    std::optional<int> status_;  // that it has ended with
};

}  // namespace passung::host
