#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace passung::haply {

/// Both WebSockets of the service, for one thread: what it is sent and what it says, in messages. Nothing here waits
/// longer than it is told to, whatever the service does, and no half of a message is ever seen.
class ServiceChannels {
public:
    static constexpr std::chrono::milliseconds kConnectTime{1000};

    ServiceChannels();
    ~ServiceChannels();
    ServiceChannels(const ServiceChannels&) = delete;
    ServiceChannels& operator=(const ServiceChannels&) = delete;

    /// Without its event channel the service is of use all the same.
    Result<Done> connect(const std::string& host, const std::string& port, const std::string& event_port);
    /// False if it is gone.
    bool send(const std::string& message, std::chrono::milliseconds longest);
    /// The oldest message that was not taken; waits for it.
    std::optional<std::string> message(std::chrono::milliseconds longest);
    std::optional<std::string> event();
    bool hears() const;  // events
    bool isOpen() const;

private:
    struct Streams;
    std::unique_ptr<Streams> streams_;
};

}  // namespace passung::haply
