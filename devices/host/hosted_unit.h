#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/device_description.h"
#include "core/base/device_unit.h"
#include "core/base/result.h"
#include "devices/unit/link.h"
#include "devices/unit/unit.h"

namespace passung::host {

class HostProcess;
struct HostReport;

/// A unit whose link lives in a device host: the vendor's library can stop, hang or end that program, and no more.
class HostedLink final : public unit::Link {
public:
    /// Without a word for so long the host hangs in the vendor's library, and is ended.
    static constexpr std::chrono::milliseconds kHangs{500};

    HostedLink(DeviceChoice choice, DeviceDescription limits);
    ~HostedLink() override;

    Result<DeviceUnit> open() override;
    /// A wrench without a stamp is of now.
    unit::Exchange exchange(const Wrench& F_D_B, std::chrono::milliseconds longest) override;
    void stamp(std::int64_t made_at) noexcept override { made_at_ = made_at; }
    void close() noexcept override;

private:
    unit::Exchange taken(const HostReport& report);

    const DeviceChoice choice_;
    const DeviceDescription limits_;
    std::unique_ptr<HostProcess> process_;
    std::chrono::steady_clock::time_point heard_at_;
    std::optional<std::int64_t> made_at_;  // of the wrench that comes
    std::uint64_t commands_ = 0;
    std::uint64_t reports_ = 0, withheld_ = 0, gaps_ = 0;  // that were told of so far
};

/// A unit of a backend that the host knows, with the limits of its description.
Result<std::unique_ptr<unit::Unit>> openHosted(const DeviceChoice& choice, const DeviceDescription& description);

/// The units that such a backend's library sees; `library` is its file, empty: the usual ones.
Result<std::vector<DeviceUnit>> lookHosted(const std::string& backend, const std::string& library);

}  // namespace passung::host
