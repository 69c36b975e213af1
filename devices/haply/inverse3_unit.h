#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "devices/haply/service_message.h"
#include "devices/unit/link.h"
#include "devices/unit/unit.h"

namespace passung::haply {

class ServiceChannels;

/// Host and ports of the service: "HOST:PORT:EVENTPORT", "HOST:PORT" or nothing.
struct ServiceAddress {
    std::string host = "localhost", port = "10001", event_port = "10020";
};
Result<ServiceAddress> serviceAddress(const std::string& address);

/// An Inverse3 through Haply's Inverse Service 3.5, which gives one state for each message: every exchange is a message
/// with the force of now, and waits for the state. While an answer is missing the force is zero: the device keeps that
/// of the last message.
class Inverse3Link final : public unit::Link {
public:
    Inverse3Link(DeviceChoice choice, ServiceAddress address);
    ~Inverse3Link() override;

    Result<DeviceUnit> open() override;
    unit::Exchange exchange(const Wrench& F_D_B, std::chrono::milliseconds longest) override;
    void close() noexcept override;

private:
    unit::Exchange taken(const std::string& text) const;

    DeviceChoice choice_;
    ServiceAddress address_;
    std::unique_ptr<ServiceChannels> channels_;
    std::string id_;
    bool opens_gate_ = false;  // with the next message
    bool unanswered_ = false;
};

Result<std::unique_ptr<unit::Unit>> openInverse3(const DeviceChoice& choice, const DeviceDescription& description);

/// The devices that the service has now.
Result<std::vector<SaidOfDevice>> inventory(const std::string& address);

}  // namespace passung::haply
