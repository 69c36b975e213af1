#pragma once

#include <cstdint>
#include <limits>

#include "core/base/tick_record.h"
#include "core/base/types.h"
#include "core/tick/stage.h"

namespace passung::tick {

// What the stages of one tick hand to each other. Each part has one owner in a scene, but for those that say who hands
// them on; a stage that is not the owner declares to read (stage.h).

/// As the device gave it. Nobody writes it.
struct Reading {
    static constexpr bool kOnlyRead = true;
    DeviceReading reading;
};

/// Where the hand is. Handed on: the input guard says it, navigation moves X_WH.
struct HandSample {
    static constexpr bool kHandedOn = true;
    Pose X_WH;                  // held part where the device asks it to be, after the input guard
    bool input_usable = false;  // false: the output is zero
    bool relocated = false;     // the device is believed to be where it cannot have come from: the past is void
    // Periods between this tick's sample and the good one before it; 0: no new sample (X_WH is held), nothing has
    // moved.
    std::int64_t sample_periods = 0;
};

/// How the device's space lies in the scene (navigation.h). Owner: navigation.
struct MappingRecord {
    bool clutched = false;
    double scale = std::numeric_limits<double>::quiet_NaN();  // s; NaN: the scene has no navigation
    Vec3 offset = Vec3::Zero();                               // R_WB o, scene axes [m]
    Quat turn = Quat::Identity();                             // Q
};

/// Owner: contacts at the hand, of area-weighted penalty.
struct AreaLoad {
    Wrench load;  // QueryAnswer::load at X_WH
};

/// What is told of the contacts. Owner: contacts at the hand, or proxy record.
struct ContactRecord {
    double proxy_depth = 0.0;  // [m], ≥ 0
    // No point of the held part is nearer to an obstacle, ≥ 0 [m]; NaN where nothing proves it.
    double proxy_gap = std::numeric_limits<double>::quiet_NaN();
    std::uint32_t contacts = 0;
    // No point of the hand has moved farther since it was where the proxy has followed it to, ≥ 0 [m]; NaN where
    // nothing says it.
    double proxy_lag = std::numeric_limits<double>::quiet_NaN();
};

/// Owner: contacts at the hand, or hand depth.
struct HandDepth {
    double hand_depth = 0.0;  // [m], ≥ 0
};

/// Owner: energy account.
struct EnergyRecord {
    double energy = 0.0;  // EnergyAccount::taken_in [J]
};

/// What each effect adds to the wrench on the hand, about the held part's origin, world axes (effect_sum.h). Owners:
/// the effects.
struct TransientsShare {
    Wrench of_transients;
};
struct WeightShare {
    Wrench of_weight;
};
struct ViscosityShare {
    Wrench of_viscosity;
};
struct GuidanceShare {
    Wrench of_guidance;
    double guided = std::numeric_limits<double>::quiet_NaN();  // share of the way that the guide has gone
};

struct SnapShare {
    Wrench of_snap;
};

struct InertiaShare {
    Wrench of_inertia;
};

struct KeepApartShare {
    Wrench of_keep_apart;
};

/// Owner: sum of effects.
struct EffectRecord {
    std::uint32_t effects = 0;  // HandModel::wrenchEffects, where records are to tell what they add
};

/// The wrench on its way to the hand. Handed on: the method of contact makes it, the sum of effects adds to it, the
/// output stage leaves what the hand then feels.
struct HandWrench {
    static constexpr bool kHandedOn = true;
    Wrench F_H_W;  // on the hand, about the held part's origin, world axes
};

/// Owner: output limits.
struct CommandedWrench {
    Wrench F_D_B;  // what is sent: on the hand, about the handle's origin, device base axes
};

/// What acted, and what the tick's queries and solver took. Handed on: each stage adds its own.
struct Report {
    static constexpr bool kHandedOn = true;
    double quality = 1.0;
    std::uint32_t status = 0;  // TickStatus bits
    std::uint32_t iterations = 0;
    std::uint32_t nodes_visited = 0;
    std::uint32_t work = 0;            // of looks at fields: nodes, points and contacts (account)
    std::uint32_t rows_taken = 0;      // most contacts taken up or let go for one motion (constrained_motion.h)
    std::uint32_t friction_turns = 0;  // most turns of one motion (friction_balance.h)
};

}  // namespace passung::tick
