#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "tests/devices/fakes/shared_block.h"

namespace passung::fake {

constexpr const char* kDhdVariable = "PASSUNG_DHD_SHIM";
constexpr int kDhdDevices = 2;

/// What the hand does, in the device's base: x to the operator, y to the right, z up, origin in the middle of the
/// workspace.
struct DhdHand {
    double position[3] = {};                        // [m]
    double frame[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // rotation of the handle, row by row
    double velocity[3] = {};                        // [m/s]
    double spin[3] = {};                            // [rad/s]
    double grip_angle = 0;                          // [rad]
    double grip_gap = 0;                            // [m]
    double buttons = 0;                             // mask
};

/// One call that sets a force: what the caller asked for and what the device does.
struct DhdCommand {
    double call = 0;       // number of this servo call, from 1
    double asked[7] = {};  // [N] x3, [N·m] x3, [N] of the grip, as the caller gave them
    double felt[7] = {};   // after the units of a trap, limits, brakes and disabled forces
};

/// How a call of the shim goes wrong; -1 is what it returns, as the vendor's do.
enum class DhdFault { None, Unplugged, Timeout, NotANumber, Frozen, Hang, Crash };

struct DhdDevice {
    std::atomic<bool> plugged = true;
    std::atomic<int> serial = 0;
    std::atomic<int> type = 104;  // DHD_DEVICE_SIGMA331, which is sold as sigma.7
    std::atomic<bool> left_handed = false;
    SharedValue<DhdHand> hand;
    std::atomic<DhdFault> fault = DhdFault::None;
    /// Readings before `fault` begins; negative: at once.
    std::atomic<std::int64_t> fault_at_reading = -1;
    std::atomic<bool> opened = false;
    std::atomic<bool> forces_enabled = false;
    std::atomic<bool> brakes = false;          // engaged by the device or its driver: nothing is felt
    std::atomic<int> force_off_cause = 0;      // DHD_FORCEOFF_..., as dhdGetStatus says
    std::atomic<double> max_force = -1;        // [N], < 0: none
    std::atomic<double> max_torque = -1;       // [N·m], < 0: none
    std::atomic<int> watchdog_ms = 0;          // 0: off
    std::atomic<std::int64_t> readings = 0;    // calls that gave a pose
    std::atomic<std::int64_t> non_finite = 0;  // commands with NaN or infinity in them
    std::atomic<double> vibration_hz = 0, vibration_amplitude = 0;
    SharedRing<DhdCommand> commands;
};

struct DhdBlock {
    std::array<DhdDevice, kDhdDevices> devices;
    std::atomic<int> present = 1;       // devices that are counted
    std::atomic<bool> swapped = false;  // the second one is counted first
    std::atomic<int> version[4] = {3, 17, 6, 0};
    std::atomic<bool> millimetres = false;        // a trap: lengths come in mm
    std::atomic<bool> millinewtonmetres = false;  // a trap: torques are taken for mN·m
    std::atomic<int> call_result = 0;             // what a call that succeeds returns: 0, 1 (time guard), 2 (saturated)
    std::atomic<bool> released = false;           // lets go what hangs
    std::atomic<bool> expert = false;

    DhdBlock() {
        devices[0].serial = 4711;
        devices[1].serial = 4712;
    }
};

/// The force at the device when it has heard nothing for so many milliseconds: its own watchdog is the only thing that
/// ends a force whose program is dead.
inline std::array<double, 7> feltAfterSilence(const DhdDevice& device, int milliseconds) {
    std::array<double, 7> felt{};
    if (device.watchdog_ms > 0 && milliseconds >= device.watchdog_ms) return felt;
    const DhdCommand last = device.commands.last();
    for (std::size_t i = 0; i < felt.size(); ++i) felt[i] = last.felt[i];
    return felt;
}

}  // namespace passung::fake
