#include "devices/simulated/simulated_device.h"

#include "core/base/random.h"

namespace passung::simulated {
namespace {

constexpr double kHomeDistance = 6e-3;  // [m], most per axis
constexpr double kHomeTurn = 0.05;      // [rad], most per axis

Pose homePose(const DeviceParams& device, const VisibleTask& task, const HandRegistration& registration,
              std::uint64_t seed) {
    Random random(seed);
    const auto draw = [&random](double most) {
        const double x = random.uniform(-most, most);
        const double y = random.uniform(-most, most);
        return Vec3(x, y, random.uniform(-most, most));
    };
    const Vec3 shift = draw(kHomeDistance);
    // A handle that cannot turn keeps the orientation that the study registered.
    const Vec3 turn = device.sensed_degrees == 6 ? draw(kHomeTurn) : Vec3(Vec3::Zero());
    const Pose X_BD = registration.handleFromPart(task.X_WHeldStart);
    return {(rotationFromVector(turn) * X_BD.q).normalized(), X_BD.p + shift};
}

}  // namespace

SimulatedDevice::SimulatedDevice(const DeviceParams& device, const HandParams& hand, const VisibleTask& task,
                                 const HandRegistration& registration, std::uint64_t seed)
    : description_(describe(device)),
      dynamics_(device, homePose(device, task, registration, seed)),
      hand_(makeHand(hand, task, registration, seed)) {}

DeviceReading SimulatedDevice::read() noexcept {
    // The hand feels the handle itself and what the motors gave, not the encoders.
    dynamics_.advance(hand_->act(dynamics_.truePose(), dynamics_.actingWrench()));
    return {.X_BD = dynamics_.readPose(),
            .fresh = true,
            .buttons = hand_->buttons(),
            .hand_energy_J = dynamics_.handEnergy()};
}

}  // namespace passung::simulated
