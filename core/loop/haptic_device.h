#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "core/base/device_description.h"
#include "core/base/tick_record.h"
#include "core/base/types.h"
#include "core/scene/scene_spec.h"
#include "core/tick/scene_sequence.h"

namespace passung::loop {

/// What a person sees of the scene, at the display's rate: never more than is on the screen.
struct DisplayedImage {
    std::int64_t tick = 0;
    Pose X_WShown;         // the part in this device's hand as drawn (proxy or device pose: the protocol's choice)
    bool running = false;  // the trial has started, all hands are engaged (the "go" sign)
    // Every hand's part as drawn, in the order of the scene; of hands that it has not: identity.
    std::array<Pose, scene::kMostHands> X_WHeld = {};
    // Which part that is, in the order of the scene; of a hand that holds none, and of one that the scene has not,
    // kNoPart.
    std::array<std::int32_t, scene::kMostHands> held = nobodyHolds();
    tick::PartAtRest at_rest = {};  // of the parts that can be picked up one in turn, picture by picture
    std::uint64_t steps_done = 0;   // of an assembly: drawn as such

    static constexpr std::array<std::int32_t, scene::kMostHands> nobodyHolds() {
        std::array<std::int32_t, scene::kMostHands> none{};
        none.fill(kNoPart);
        return none;
    }
};

/// How a device stands. Only Ready gives poses and takes wrenches; Present is there and waits to be armed.
enum class DeviceState { Absent, Present, Calibrating, Ready, Lost, Stale, Fault };

constexpr const char* stateName(DeviceState state) {
    constexpr const char* kNames[] = {"absent", "present", "calibrating", "ready", "lost", "stale", "fault"};
    return kNames[static_cast<std::size_t>(state)];
}

/// What a reading says beside the pose; no tick looks at it.
struct DeviceStatus {
    DeviceState state = DeviceState::Ready;
    double age_s = 0.0;                                          // of what the newest reading is made from
    double grip_rad = std::numeric_limits<double>::quiet_NaN();  // opening of a gripper; NaN: there is none
    bool commanded = true;  // the last wrench was taken as it was; false: limited, or withheld
};

/// A haptic device, simulated or real. The loop calls read() then command() once a cycle, from one thread.
/// Both are rt-safe: no allocation, lock or throw.
class HapticDevice {
public:
    virtual ~HapticDevice() = default;
    virtual const DeviceDescription& description() const = 0;
    /// The newest reading. A simulated device first moves on by one tick under the last command.
    virtual DeviceReading read() noexcept = 0;
    /// Of the newest reading, and of the command before it. rt-safe.
    virtual DeviceStatus status() const noexcept { return {}; }
    /// `F_D_B`: wrench on the hand, about the handle's origin, in the device's base frame.
    virtual void command(const Wrench& F_D_B) noexcept = 0;
    /// False for a stand-in without motors, such as a mouse: no hand feels what it is commanded. Asked before the loop
    /// runs.
    virtual bool pushesHand() const { return true; }
    /// A new frame on the display. Real devices ignore it; a simulated hand looks at it.
    virtual void show(const DisplayedImage&) noexcept {}
};

}  // namespace passung::loop
