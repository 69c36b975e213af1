#pragma once

#include <semaphore.h>

#include <array>
#include <atomic>
#include <cstdint>

#include "tests/devices/fakes/shared_block.h"
#include "tests/devices/fakes/stepping.h"

namespace passung::fake {

constexpr const char* kVirtuoseVariable = "PASSUNG_VIRTUOSE_SHIM";

/// What the hand does: metres, quaternion x, y, z, w, m/s and rad/s; x to the front, z up.
struct VirtuoseHand {
    double position[3] = {};
    double xyzw[4] = {0, 0, 0, 1};
    double speed[6] = {};
    double buttons = 0;   // mask, from button 0
    double dead_man = 1;  // the hand is on its switch
};

struct VirtuoseCommand {
    double tick = 0;       // of the periodic function, 0 outside it
    double asked[6] = {};  // [N] x3, [N·m] x3
    double felt[6] = {};   // after power, dead-man switch, emergency stop, factor and saturation
};

enum class VirtuoseFault { None, Unplugged, NotANumber, Frozen, Crash };

struct VirtuoseBlock {
    std::atomic<bool> plugged = true;
    std::atomic<int> type = 2, serial = 3545;
    std::atomic<int> version[2] = {4, 4};
    SharedValue<VirtuoseHand> hand;
    std::atomic<VirtuoseFault> fault = VirtuoseFault::None;
    std::atomic<bool> emergency_stop = false;
    std::atomic<unsigned> alarm = 0;  // VIRT_ALARM_...
    std::atomic<bool> opened = false;
    std::atomic<bool> power = false;
    std::atomic<int> command_type = 0;  // 3: impedance
    std::atomic<double> force_factor = 1;
    std::atomic<double> max_force = -1, max_torque = -1;  // virtSaturateTorque; < 0: none
    std::atomic<double> timeout_s = 0;                    // virtSetTimeoutValue; 0: none
    std::atomic<double> period_s = 0;                     // of the periodic function
    std::atomic<bool> foreign_frame = false;              // a base or observation frame other than the identity was set
    std::atomic<std::int64_t> non_finite = 0;
    std::atomic<std::int64_t> ticks = 0;
    std::atomic<bool> stepped = true;  // the loop ticks when `step` says so, not by the clock
    SharedRing<VirtuoseCommand> commands;
    sem_t go, done;

    VirtuoseBlock() {
        sem_init(&go, 1, 0);
        sem_init(&done, 1, 0);
    }
};

/// The force at the device now, or after its controller has heard nothing for so long: power, switch and stop act at
/// once, the timeout in the end.
inline std::array<double, 6> feltNow(const VirtuoseBlock& block, double silence_s = 0) {
    std::array<double, 6> felt{};
    const bool is_over = block.timeout_s > 0 && silence_s >= block.timeout_s;
    if (!block.power || block.emergency_stop || block.hand.load().dead_man == 0 || is_over) return felt;
    const VirtuoseCommand last = block.commands.last();
    for (std::size_t i = 0; i < felt.size(); ++i) felt[i] = last.felt[i];
    return felt;
}

}  // namespace passung::fake
