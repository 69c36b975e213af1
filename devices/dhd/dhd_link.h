#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/device_description.h"
#include "devices/dhd/dhd_library.h"
#include "devices/unit/axes.h"
#include "devices/unit/link.h"

namespace passung::dhd {

/// The vendor's x points to the operator, y to the right, z up; ours right, away from the operator, up. The origin of
/// both is the middle of the workspace.
inline constexpr const char* kDefaultAxes = "y -x z";

/// A sigma.7 through Force Dimension's library, in the process that may hang with it: a device host. It keeps the last
/// wrench, and ends it by itself only if it is not called for kWatchdog.
class DhdLink final : public unit::Link {
public:
    static constexpr int kWatchdog = 20;  // [ms]

    DhdLink(DeviceChoice choice, DeviceDescription limits);
    ~DhdLink() override;

    Result<DeviceUnit> open() override;
    unit::Exchange exchange(const Wrench& F_D_B, std::chrono::milliseconds longest) override;
    void close() noexcept override;

private:
    Result<Done> openChosen();
    Result<Done> prepare();
    unit::Exchange read();
    Error failed(const char* call) const;
    char id() const { return static_cast<char>(id_); }  // as the library takes it

    const DeviceChoice choice_;
    const DeviceDescription limits_;
    unit::Axes axes_;
    std::unique_ptr<DhdLibrary> dhd_;
    int id_ = -1;  // none
    bool has_grip_ = false;
};

/// The sigma.7s that the library sees and that nobody else has opened.
Result<std::vector<DeviceUnit>> look(const std::string& library);

}  // namespace passung::dhd
