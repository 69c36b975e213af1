#pragma once

#include <semaphore.h>

#include <array>
#include <atomic>
#include <cstdint>

#include "tests/devices/fakes/shared_block.h"
#include "tests/devices/fakes/stepping.h"

namespace passung::fake {

constexpr const char* kHdVariable = "PASSUNG_HD_SHIM";
constexpr int kHdDevices = 2;

/// What the hand does, in SI and in the device's frame: x to the right, y up, z to the user. The shim makes the
/// vendor's units of it.
struct HdHand {
    double position[3] = {};                        // [m]
    double frame[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // rotation of the handle, row by row
    double velocity[3] = {};                        // [m/s]
    double spin[3] = {};                            // [rad/s]
    double gimbal[3] = {};                          // [rad]
    double buttons = 0;                             // mask
};

/// What one frame has commanded.
struct HdCommand {
    double tick = 0;       // of the scheduler, from 1
    double asked[6] = {};  // [N] x3, [mN·m] x3, as the caller gave them
    double felt[6] = {};   // [N] x3, [N·m] x3, after output, limits and traps
};

enum class HdFault { None, Unplugged, NotANumber, Frozen, WarmMotors, Crash };

struct HdDevice {
    std::atomic<bool> plugged = true;
    std::atomic<int> serial = 0;
    SharedValue<HdHand> hand;
    std::atomic<HdFault> fault = HdFault::None;
    std::atomic<std::int64_t> fault_at_tick = 0;
    std::atomic<bool> opened = false;
    std::atomic<int> owner = 0;  // the process that has opened it; a dead one lets go
    std::atomic<bool> force_output = false;
    std::atomic<bool> clamping = false;      // HD_MAX_FORCE_CLAMPING
    std::atomic<bool> ramping = false;       // HD_FORCE_RAMPING; kept only
    std::atomic<double> max_force = 3.3;     // [N]
    std::atomic<double> max_torque = 188.0;  // [mN·m]
    std::atomic<int> output_degrees = 6;
    std::atomic<unsigned> calibration = 0x5000;  // HD_CALIBRATION_OK
    std::atomic<std::int64_t> frames = 0;
    std::atomic<std::int64_t> non_finite = 0;
    SharedRing<HdCommand> commands;
};

struct HdBlock {
    std::array<HdDevice, kHdDevices> devices;  // "Default Device", "Left Device"
    std::atomic<int> present = 1;
    std::atomic<bool> swapped = false;       // the names change places
    std::atomic<bool> stepped = true;        // the scheduler ticks when `step` says so, not by the clock
    std::atomic<int> granted_rate = 1000;    // [Hz]; another one that is asked for is refused
    std::atomic<bool> stalled = false;       // the scheduler ticks but calls nobody
    std::atomic<bool> metres = false;        // a trap: lengths come in m
    std::atomic<bool> newtonmetres = false;  // a trap: torques are taken for N·m
    std::atomic<std::int64_t> ticks = 0;
    std::atomic<std::int64_t> calls = 0;   // of callbacks
    std::atomic<std::int64_t> errors = 0;  // that the shim has put on its stack
    std::atomic<unsigned> last_error = 0;
    sem_t go, done;

    HdBlock() {
        devices[0].serial = 815;
        devices[1].serial = 816;
        sem_init(&go, 1, 0);
        sem_init(&done, 1, 0);
    }
};

}  // namespace passung::fake
