#include "study/run/person/responding_device.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "study/person/detection_response.h"

namespace passung::run {
namespace {

constexpr std::int64_t kPressTicks = 120;  // that the button stays down
constexpr double kTouch = 0.5;             // [N] that is noticed

std::uint64_t responsesOf(std::uint64_t attempt_seed) {
    std::uint64_t state = attempt_seed ^ fnv1a64("responses");
    return splitmix64(state);
}

}  // namespace

RespondingDevice::RespondingDevice(std::unique_ptr<loop::HapticDevice> device,
                                   const measures::DetectionSettings& settings, const person::SimulatedPerson& person,
                                   bool handles, std::uint64_t attempt_seed)
    : device_(std::move(device)),
      times_(settings, attempt_seed),
      person_(person),
      handles_(handles),
      random_(responsesOf(attempt_seed)),
      button_(1u << (settings.button - 1)) {}

DeviceReading RespondingDevice::read() noexcept {
    DeviceReading reading = device_->read();
    if (tick_ >= times_.next()) {
        times_.advance();
        const double load = touches_ ? 1.0 : handles_ ? 0.5 : 0.0;
        const auto response = person::respond(person_, load, random_);
        const auto tickOf = [this](const std::optional<double>& after) {
            return after ? tick_ + std::llround(*after / kTickSeconds) : -1;
        };
        presses_ = {tickOf(response.press), tickOf(response.mistake)};
    }
    const bool down = std::any_of(presses_.begin(), presses_.end(), [this](std::int64_t press) {
        return press >= 0 && tick_ >= press && tick_ < press + kPressTicks;
    });
    if (down) reading.buttons |= button_;
    ++tick_;
    return reading;
}

void RespondingDevice::command(const Wrench& F_D_B) noexcept {
    touches_ = F_D_B.force.norm() > kTouch;
    device_->command(F_D_B);
}

}  // namespace passung::run
