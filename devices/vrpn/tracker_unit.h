#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "devices/unit/axes.h"
#include "devices/unit/link.h"
#include "devices/unit/unit.h"

namespace passung::vrpn {

/// "NAME@HOST:PORT#SENSOR" of a station file. All may be missing: the host is then this machine, the port VRPN's, the
/// sensor 0, and the tracker the only one that there is.
struct TrackerAddress {
    std::string host = "localhost", port = "3883";
    std::string serial;  // "NAME#SENSOR"; empty: nobody has named one
};
Result<TrackerAddress> trackerAddress(const std::string& address);

/// A tracker that a VRPN server serves, its protocol spoken here, over TCP alone: pose of one sensor, and buttons and
/// the first analog channel (taken for a grip's angle [rad]) of the device of the same name. It pushes nobody: of what
/// VRPN can ask of a force device only a force field would do, which stays where its client stops or hangs. A server
/// whose device pushes all the same is told of.
class TrackerLink final : public unit::Link {
public:
    static constexpr std::chrono::milliseconds kConnectTime{1000};
    static constexpr std::chrono::milliseconds kFirstPose{1000};  // that the tracker has after the connection
    static constexpr std::chrono::milliseconds kCensus{300};      // of trackers, where none is named
    static constexpr std::chrono::milliseconds kSilent{1000};     // without a pose it is looked for anew

    /// Of an address without a serial: the only tracker.
    TrackerLink(DeviceChoice choice, TrackerAddress address, unit::Axes axes);
    ~TrackerLink() override;

    Result<DeviceUnit> open() override;
    unit::Exchange exchange(const Wrench& F_D_B, std::chrono::milliseconds longest) override;
    void close() noexcept override;

    /// The trackers that say where they are. Errors: no server, or no tracker.
    static Result<std::vector<DeviceUnit>> look(const TrackerAddress& address);

private:
    class Connection;

    DeviceChoice choice_;
    TrackerAddress address_;
    unit::Axes axes_;
    std::unique_ptr<Connection> connection_;
};

/// Errors: an address or axes that are none, or a serial that is not the address's.
Result<std::unique_ptr<unit::Unit>> openTracker(const DeviceChoice& choice, const DeviceDescription& description);

}  // namespace passung::vrpn
