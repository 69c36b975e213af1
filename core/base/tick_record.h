#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "core/base/types.h"

namespace passung {

/// Which guard or limit acted in a tick, as a bit set. 0 = nothing to report.
enum TickStatus : std::uint32_t {
    kStatusOk = 0,
    kInputHeld = 1u << 0,         // bad input sample: the last good pose was used
    kInputRejected = 1u << 1,     // no sample to go by, mostly bad input for more than one tick: zero wrench
    kDeviceStale = 1u << 2,       // no fresh sample
    kNonFiniteLatched = 1u << 3,  // a computed wrench was not finite: zero until re-armed
    kForceLimited = 1u << 4,      // the device's force or torque limit acted
    kRateLimited = 1u << 5,       // the limit of rising force acted
    kBudgetReached = 1u << 6,     // a query stopped at its node budget
    kIterationLimit = 1u << 7,    // the solver or the proxy's sub-steps stopped at their cap: the proxy lags
    kContactCap = 1u << 8,        // more contacts than the manifold holds
    kStepRejected = 1u << 9,      // the proxy's step was shortened by the acceptance test
    kOverrun = 1u << 10,          // the previous cycle ended after its deadline: DeviceReading::periods > 1
    kInputNotAPose = 1u << 11,    // fresh, but not finite, no rotation or out of any device's reach
    kInputJump = 1u << 12,        // fresh, but farther from the last good sample than the device can move
    kInputRelocated = 1u << 13,   // jumps that agreed were believed: the device is elsewhere than it can have come from
    kPassivityActed = 1u << 14,   // the passivity controller added a damper
    kEngaged = 1u << 16,          // the hand has reached the start pose: contact is rendered
    kWrenchWithheld = 1u << 17,   // the scene displays no wrench: zero, whatever contact asks for
    kSuspended = 1u << 18,        // the tick's work was not done: what is left of it goes on in the next tick
    kLedOut = 1u << 19,           // the held part was put where it overlaps: it is led out, and no contact counts
    kWeighed = 1u << 20,          // the held part's weight is in the wrench: a force is no sign of contact
    kAidedInAir = 1u << 21,       // an effect that acts in the air (effect_sum.h) may be in it: likewise
};

/// What a device reports for one tick.
struct DeviceReading {
    Pose X_BD;                  // handle in the device's base frame
    bool fresh = true;          // false: the device had nothing new
    std::uint32_t buttons = 0;  // bit per button
    std::uint32_t periods = 1;  // haptic periods since the previous tick: 1, more after missed cycles; set by the loop
    // That the hand has put into the handle since the device was made; for the record, no tick looks at it. NaN: not
    // known, as of every real device.
    double hand_energy_J = std::numeric_limits<double>::quiet_NaN();
};

/// What may add to the wrench beside contact, in the order in which it does (core/tick/effect_sum.h).
enum class WrenchEffect { Transients, Weight, Viscosity, Guidance, Snap, Inertia, KeepApart };
inline constexpr std::size_t kWrenchEffects = 7;

inline constexpr std::int32_t kNoPart = -1, kPartNotTold = -2;

/// One tick: its exact inputs, from which a replay reproduces everything else, and its outputs.
/// Trivially copyable and of fixed size: it travels through a lock-free ring.
struct TickRecord {
    std::int64_t tick = 0;
    // inputs, exact
    std::array<double, 3> device_position_m{};  // raw reading, device base frame
    std::array<double, 4> device_quaternion{};  // w, x, y, z
    std::uint32_t input_flags = 0;              // bit 0: fresh; bits 8…31: buttons 0…23
    std::uint32_t periods = 1;                  // as in DeviceReading
    // outputs as they are stored: 32-bit floats; scene frame W unless said otherwise
    std::array<float, 3> hand_position_m{};  // X_WH: the held part where the device asks it to be
    std::array<float, 4> hand_quaternion{};
    std::array<float, 3> proxy_position_m{};  // X_WG; equals X_WH for penalty
    std::array<float, 4> proxy_quaternion{};
    std::array<float, 3> force_N{};    // on the hand, after the output stage
    std::array<float, 3> torque_Nm{};  // about the held part's origin
    // Depth of the held part's deepest sample point in an obstacle, ≥ 0; the points lie about ContactSpec::spacing
    // apart, and what stands between them, such as an obstacle's edge, may be deeper (measured by
    // obstacle_edge_test.cpp).
    float hand_depth_m = 0.0f;     // at X_WH
    float proxy_depth_m = 0.0f;    // at X_WG
    float energy_J = 0.0f;         // that the controller took in through the handle since the trial began
    float quality = 1.0f;          // area fraction of the shell proven or evaluated
    std::uint32_t status = 0;      // TickStatus bits
    std::uint32_t contacts = 0;    // points inside an obstacle at the proxy
    std::uint32_t iterations = 0;  // proxy sub-steps
    std::uint32_t nodes_visited = 0;
    // an input, known of simulated hands only: DeviceReading::hand_energy_J
    float hand_energy_J = std::numeric_limits<float>::quiet_NaN();
    // An output: no point of the held part at X_WG is nearer to an obstacle than this, ≥ 0 [m]. NaN: the contact's
    // geometry proves none, as sampled points and fields.
    float proxy_gap_m = std::numeric_limits<float>::quiet_NaN();
    // An output of scenes whose parts are picked up: which part the hand holds, in the order of the scene, or kNoPart.
    std::int32_t held = kPartNotTold;
    // An output of assemblies, one for all hands: the steps that were done as the tick began (core/scene/assembly.h).
    std::uint64_t steps_done = 0;
    // Outputs of scenes with navigation (core/tick/navigation.h); of others the scale is NaN.
    std::uint32_t navigation_clutched = 0;                               // 1: the clutch is held
    float navigation_scale = std::numeric_limits<float>::quiet_NaN();    // scene metres per device metre now
    std::array<float, 3> navigation_offset_m{};                          // scene axes, beside the registration
    std::array<float, 4> navigation_quaternion{1.0f, 0.0f, 0.0f, 0.0f};  // w, x, y, z: of the part in the handle
    // Outputs of scenes that ask for them: which of WrenchEffect there are, a bit each, and what each added to the
    // wrench on the hand, before its delay and limits: force and torque about the held part's origin, scene frame.
    std::uint32_t effects = 0;
    std::array<std::array<float, 6>, kWrenchEffects> effect_wrench{};  // [N], [N·m]
    float guided = std::numeric_limits<float>::quiet_NaN();  // share of its way that the guide has gone, 0 … 1
    // measured, never compared by a replay
    std::int64_t duration_ns = 0;   // of the tick's computation, by the wall clock
    std::int64_t processor_ns = 0;  // of it, that the loop's thread spent on a processor
};
static_assert(std::is_trivially_copyable_v<TickRecord>);

inline constexpr double kTickSeconds = 1e-3;  // [s], the haptic period
inline constexpr std::int64_t kTickNanoseconds = 1'000'000;

}  // namespace passung
