#include "devices/mouse/mouse_device.h"

#include <numbers>

namespace passung::mouse {

namespace {

simulated::HandCoupling handFor(const simulated::DeviceParams& preset) {
    constexpr double w = MouseDevice::kFollowing;
    const double mass = preset.mass.value + MouseDevice::kHandMass;
    const double inertia = preset.inertia.value + MouseDevice::kHandInertia;
    simulated::HandCoupling hand;
    hand.attached = true;
    hand.mass = MouseDevice::kHandMass;
    hand.inertia = MouseDevice::kHandInertia;
    hand.stiffness = w * w * mass;
    hand.damping = 2.0 * w * mass;
    hand.rotational_stiffness = w * w * inertia;
    hand.rotational_damping = 2.0 * w * inertia;
    return hand;
}

}  // namespace

DeviceDescription mouseDescription(const simulated::DeviceParams& preset) {
    DeviceDescription description = simulated::describe(preset);
    description.name = "mouse";
    description.stands_for_preset = true;
    description.label += ", moved by mouse and keyboard";
    return description;
}

MouseDevice::MouseDevice(const simulated::DeviceParams& preset, const simulated::HandRegistration& registration,
                         const Pose& X_WHeldStart, Pointer& pointer)
    : description_(mouseDescription(preset)),
      registration_(registration),
      pointer_(pointer),
      dynamics_(preset, registration.handleFromPart(X_WHeldStart)),
      hand_(handFor(preset)),
      reach_(kPull * preset.max_force.value / hand_.stiffness),
      swing_(preset.max_torque.value > 0 ? kPull * preset.max_torque.value / hand_.rotational_stiffness
                                         : std::numbers::pi) {
    pointer_.place(X_WHeldStart);
}

DeviceReading MouseDevice::read() noexcept {
    const Pose& X_BD = dynamics_.truePose();
    const Pose X_BWish = registration_.handleFromPart(pointer_.latest());
    hand_.X_BSet.p = X_BD.p + shortened(X_BWish.p - X_BD.p, reach_);
    const Vec3 turn = rotationVector(X_BWish.q * X_BD.q.conjugate());
    hand_.X_BSet.q = (rotationFromVector(shortened(turn, swing_)) * X_BD.q).normalized();
    dynamics_.advance(hand_);
    return {.X_BD = dynamics_.readPose(), .buttons = pointer_.buttons(), .hand_energy_J = dynamics_.handEnergy()};
}

}  // namespace passung::mouse
