#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "core/base/random.h"
#include "core/loop/haptic_device.h"
#include "study/measures/detection.h"
#include "study/person/simulated_person.h"

namespace passung::run {

/// A simulated device whose person has a secondary task too: feels its stimuli and presses the device's button. What
/// they have at hand meanwhile slows them down: person::respond(). All but the constructor rt-safe.
class RespondingDevice final : public loop::HapticDevice {
public:
    /// `handles`: the person is busy with a part, even while nothing is touched. `attempt_seed`: what the stimuli
    /// follow from, see measures::StimulusTimes.
    RespondingDevice(std::unique_ptr<loop::HapticDevice> device, const measures::DetectionSettings& settings,
                     const person::SimulatedPerson& person, bool handles, std::uint64_t attempt_seed);

    const DeviceDescription& description() const override { return device_->description(); }
    DeviceReading read() noexcept override;
    void command(const Wrench& F_D_B) noexcept override;
    bool pushesHand() const override { return device_->pushesHand(); }
    void show(const loop::DisplayedImage& image) noexcept override { device_->show(image); }

private:
    std::unique_ptr<loop::HapticDevice> device_;
    measures::StimulusTimes times_;
    person::SimulatedPerson person_;
    bool handles_;
    Random random_;
    std::uint32_t button_;
    std::int64_t tick_ = 0;
    bool touches_ = false;
    std::array<std::int64_t, 2> presses_ = {-1, -1};  // ticks at which the button goes down; < 0: none
};

}  // namespace passung::run
