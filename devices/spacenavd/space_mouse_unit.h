#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "devices/unit/axes.h"
#include "devices/unit/link.h"
#include "devices/unit/linked_unit.h"

namespace passung::spacenavd {

/// The socket of the daemon: `address`, else $SPNAV_SOCKET, else `socket =` of /etc/spnavrc, else /run/spnav.sock.
std::string socketPath(const std::string& address);

/// A SpaceMouse through spacenavd, with its protocol spoken here. It has no serial number; a serial that the choice
/// names is compared with its name. The daemon says nothing while a cap is held still, nor when a mouse is pulled that
/// was deflected: after kHeld such a motion ends, and the unit is stale.
class SpaceMouseLink final : public unit::Link {
public:
    static constexpr std::chrono::milliseconds kHeld{1000};
    static constexpr std::chrono::milliseconds kAnswerTime{1000};  // for its name

    SpaceMouseLink(DeviceChoice choice, unit::Axes axes);
    ~SpaceMouseLink() override;

    Result<DeviceUnit> open() override;
    unit::Exchange exchange(const Wrench& F_D_B, std::chrono::milliseconds longest) override;
    void close() noexcept override;

private:
    struct Connection;

    Result<std::string> askName();

    DeviceChoice choice_;
    unit::Axes axes_;
    std::string path_;
    std::unique_ptr<Connection> connection_;
};

/// Errors: axes that are none.
Result<std::unique_ptr<unit::Unit>> openSpaceMouse(const DeviceChoice& choice, const DeviceDescription& description);

}  // namespace passung::spacenavd
