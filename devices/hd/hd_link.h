#pragma once

#include <atomic>
#include <memory>
#include <semaphore>
#include <string>
#include <vector>

#include "core/base/device_description.h"
#include "devices/hd/hd_library.h"
#include "devices/host/paced_link.h"
#include "devices/unit/axes.h"

namespace passung::hd {

/// The vendor's x points to the right, y up, z to the operator; ours right, away from the operator, up. The origin is
/// the library's.
inline constexpr const char* kDefaultAxes = "x -z y";

/// A Touch through OpenHaptics' HD interface, in the process that may hang with it: a device host. Its servo thread
/// makes the cycles; a frame is an exchange. Force alone: three degrees are driven.
class HdLink final : public host::PacedLink {
public:
    static constexpr unsigned long kRate = 1000;  // [Hz] that is asked for

    HdLink(DeviceChoice choice, DeviceDescription limits);
    ~HdLink() override;

    Result<DeviceUnit> open() override;
    Result<Done> pace(const std::function<bool()>& cycle) override;
    unit::Exchange exchange(const Wrench& F_D_B, std::chrono::milliseconds longest) override;
    void close() noexcept override;

private:
    Result<DeviceUnit> openChosen();
    Result<Done> prepare();
    unit::Exchange read();
    unit::Exchange failed(unsigned error);
    unit::Exchange calibrated(unit::Exchange exchange);
    static unsigned tick(void* self);

    const DeviceChoice choice_;
    const DeviceDescription limits_;
    unit::Axes axes_;
    std::unique_ptr<HdLibrary> hd_;
    unsigned device_ = kNoDevice;
    bool scheduled_ = false;
    const std::function<bool()>* cycle_ = nullptr;
    std::atomic<std::uint64_t> ticks_{0};  // of the servo thread
    std::binary_semaphore over_{0};
};

/// The devices that the library opens and that nobody else has.
Result<std::vector<DeviceUnit>> look(const std::string& address);

}  // namespace passung::hd
