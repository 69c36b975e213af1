#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "core/base/types.h"
#include "core/field/field_mode.h"
#include "core/scene/assembly.h"
#include "core/shape/shape.h"

namespace passung::scene {

/// Where the geometry of a part comes from: a file or a parametric shape.
struct MeshFile {
    std::string path;  // as a reader can open it (already relative to the working directory)
    double metres_per_unit = 1e-3;
};

/// A part as a scene file describes it; SI units.
struct PartSpec {
    std::string name;
    std::variant<shape::Shape, MeshFile> geometry;
    Pose X_WP;                         // part to world at the start
    bool held = false;                 // by a hand, from the start; a hand holds one, or where it may pick up none
    std::size_t hand = 0;              // which one, in the order of SceneSpec::hand()
    bool pickable = false;             // hands may pick it up and let it go: Effects::pick
    double friction = 0.0;             // of the surface at rest: μ_s of a pair is the geometric mean, ≥ 0
    double sliding_friction = 0.0;     // likewise μ_d, ≤ friction
    double density = 0.0;              // [kg/m³], ≥ 0; 0: weighs nothing
    Vec3 shown_offset = Vec3::Zero();  // drawn this far from where it is touched, world axes [m]

    /// A hand holds it, or may.
    bool moves() const noexcept { return held || pickable; }
};

enum class ContactMethod { Penalty, GodObjectHeuristic, GodObject };
enum class PenaltyVariant { MaxNormalised, AreaWeighted, Raw };
enum class PenaltyCoupling { Direct, QuasiStatic, Virtual };
/// What contact is computed from: shapes' own faces and edges, triangles, or distance fields with point shells. Auto:
/// as contact_geometry.h picks it.
enum class Geometry { Auto, ClosedForm, Surface, Field };

struct ContactSpec {
    ContactMethod method = ContactMethod::GodObjectHeuristic;
    Geometry geometry = Geometry::Auto;
    PenaltyVariant variant = PenaltyVariant::MaxNormalised;
    double stiffness = 1000.0;          // [N/m], > 0
    double rotational_stiffness = 1.0;  // [N·m/rad], ≥ 0
    double damping = 0.0;               // [N·s/m], ≥ 0
    double rotational_damping = 0.0;    // [N·m·s/rad], ≥ 0
    double area_stiffness = 1e9;        // κ [N/m³], > 0; area-weighted penalty only
    // The penalty may act on a tool that the stiffness and damping above couple to the hand: core/tick/penalty_tool.h.
    PenaltyCoupling coupling = PenaltyCoupling::Direct;
    double penalty_stiffness = 10000.0;  // of a coupled penalty's contacts, in place of `stiffness` [N/m], > 0
    double tool_mass = 0.05;             // of PenaltyCoupling::Virtual [kg], > 0
    double tool_inertia = 5e-5;          // likewise [kg·m²], > 0
    // Of distance fields and point shells; Geometry::Field only.
    double tolerance = 20e-6;  // asked accuracy of the distance field near surfaces [m], > 0
    double cell = 0.0;         // edge of a field cell [m]; 0 = chosen from the tolerance
    double spacing = 1.0e-3;   // of the point shell [m], > 0
    field::FieldMode mode = field::FieldMode::Trilinear;
    int budget_nodes = 0;       // per query, of a god object per query and tick; 0 = no budget
    double quality = 0.0;       // least share of a shell's area that a query under a budget looks at; penalty only
    bool two_way = false;       // the obstacles' points are held against the held part's field too
    double proxy_filter = 0.0;  // corner of the god object's low-pass while in contact [Hz]; 0 = none

    /// True if forces come from the overlap at the hand's own pose, false if there is a proxy or tool.
    bool rendersAtHand() const { return method == ContactMethod::Penalty && coupling == PenaltyCoupling::Direct; }
};

inline constexpr int kMaxDelayTicks = 100;

/// Limits that the output stage holds; filled from the device's description, tightened by the scene.
struct OutputLimits {
    double max_force = 12.0;          // [N], > 0
    double max_torque = 0.2;          // [N·m], ≥ 0
    double max_force_rate = 10000.0;  // [N/s] while rising, > 0
    double max_speed = 20.0;          // [m/s], a faster reading is a broken one
    double max_spin = 200.0;          // [rad/s]
    bool actuates_torque = true;
    // Encoder steps of the handle's pose, which the energy account has to know; 0: none or not known.
    double quantum = 0.0;             // [m]
    double rotational_quantum = 0.0;  // [rad]
    int delay_ticks = 0;              // added between command and effect
};

/// Maps device space to the scene: X_WH = align · scale(X_BD) · handle, where navigation moves nothing.
struct Registration {
    Pose X_WB;           // device base in the scene
    double scale = 1.0;  // scene metres per device metre, > 0
    Pose X_DH;           // held part in the handle
};

/// When does contact start: the hand has to hold the start pose first (0 = at once).
struct StartGate {
    double position_tolerance = 0.0;  // [m]
    double angle_tolerance = 0.0;     // [rad]
    int hold_ticks = 0;
    Pose X_WH = {};  // the start pose of a hand that begins with nothing; of one with a part it is the part's
};

/// A decaying vibration at every impact.
struct Transients {
    double amplitude = 0.0;    // force per speed of the impact [N·s/m], ≥ 0; 0: none
    double frequency = 100.0;  // [Hz], > 0 and below half the tick's rate
    double decay = 0.02;       // time constant [s], > 0
};

/// Weight of the held parts.
struct Weight {
    Vec3 gravity = Vec3::Zero();  // world axes [m/s²]; zero: none
};

inline constexpr int kButtons = 24;  // of a device, from 1: as many as a record holds (core/base/tick_record.h)

/// Hands pick parts up and let them go, by a button of their device: core/tick/pick.h.
struct Pick {
    double reach = 0.0;     // from the hand's point to a part that it closes on [m], ≥ 0; 0: nothing is picked up
    int button = 1;         // 1 … kButtons
    bool on_press = false;  // each press closes or opens the hand; else it is closed while the button is down
    bool locks = false;     // what is let go stays there for good
    std::vector<AssemblyStep> steps = {};  // where parts belong: what is let go there is a step done
    int undo_button = 0;                   // takes back the last step, as `button`; 0: none does
};

inline constexpr double kStandardGravity = 9.80665;  // [m/s²]
/// A part's weight turns it by no more than this against the coupling's rotational stiffness [rad]: from half a turn on
/// nothing would tell which way, and contacts turn it too.
inline constexpr double kMostHangingTurn = 1.0;

/// While its button is held the hand moves and the part stays.
struct Clutch {
    int button = 0;           // 1 … kButtons; 0: none
    bool orientation = true;  // the part keeps its orientation too; false: it goes on turning with the hand
};
/// Another scale than the registration's while its button is held.
struct SecondScale {
    int button = 0;      // as Clutch::button
    double scale = 1.0;  // scene metres per device metre, > 0
};
/// The scene moves under the hand while the hand moves, so that the hand comes back to the middle of its workspace.
struct Drift {
    double share = 0.0;        // of the hand's speed, 0 … kMostDrift; 0: none
    double radius = 0.1;       // from the middle on it is the whole share [m] of the device, > 0
    Vec3 home = Vec3::Zero();  // the middle, device base frame [m]
};
inline constexpr double kMostDrift = 0.5;

/// How a hand gets about in a scene that is larger than the device's workspace (core/tick/navigation.h).
struct Navigation {
    Clutch clutch = {};
    SecondScale second_scale = {};
    Drift drift = {};

    bool any() const noexcept { return clutch.button > 0 || second_scale.button > 0 || drift.share > 0.0; }
};

/// A damper between the held part and the world: the part moves as in a viscous fluid.
struct Viscosity {
    double damping = 0.0;             // [N·s/m], ≥ 0; both 0: none
    double rotational_damping = 0.0;  // [N·m·s/rad], ≥ 0

    bool any() const noexcept { return damping > 0.0 || rotational_damping > 0.0; }
};

inline constexpr std::size_t kMostWayPoses = 64;

/// Shared control: a guide goes along a way before the first hand and draws it after itself (core/tick/guidance.h).
struct Guidance {
    double share = 0.0;           // of the guide's wrench that the hand feels, 0 … 1; 0: none
    std::vector<Pose> X_WG = {};  // the way on from where the held part starts, in the world; at most kMostWayPoses
    double speed = 0.03;          // of the guide [m/s], > 0
    double lead = 0.01;           // most that it goes before the hand, and that its spring is stretched [m], > 0
    double stiffness = 500.0;     // of that spring [N/m], ≥ 0
    double rotational_stiffness = 0.2;  // likewise [N·m/rad], ≥ 0
};

/// Near a place of its own a held part is drawn into it (core/tick/snap.h).
struct Snap {
    double stiffness = 0.0;       // in the place [N/m], ≥ 0; 0: none
    double range = 0.005;         // of each place, a turn counted by the coupling's stiffnesses [m], > 0
    std::vector<Pose> X_WG = {};  // places of what the first hand begins with, in the world, at most kMostWayPoses;
                                  // of parts that are picked up the steps say where each belongs

    bool any() const noexcept { return stiffness > 0.0; }
};

/// The held part keeps moving: core/tick/inertia.h.
struct Inertia {
    double scale = 0.0;  // of its own mass and moments, ≥ 0; 0: none

    bool any() const noexcept { return scale > 0.0; }
};

/// Parts in two hands push each other away before they touch (core/tick/keep_apart.h).
struct KeepApart {
    double stiffness = 0.0;  // [N/m], ≥ 0; 0: none
    double range = 0.02;     // between their surfaces [m], > 0

    bool any() const noexcept { return stiffness > 0.0; }
};

/// Effects beyond contact; what is 0 is not built.
struct Effects {
    double passivity_damping = 0.0;  // most of the passivity controller's damper [N·s/m], ≥ 0; 0: no controller
    Transients transients;
    Weight weight;
    Viscosity viscosity = {};
    Guidance guidance = {};  // of the first hand
    Snap snap = {};
    Inertia inertia = {};
    KeepApart keep_apart = {};
    Pick pick;
    Navigation navigation = {};  // of the first hand
    bool record = false;         // what each of them adds to the wrench is told of every tick

    bool picks() const noexcept { return pick.reach > 0.0; }
};

inline constexpr std::size_t kMostHands = 4;

/// One hand with its device.
struct HandSpec {
    OutputLimits limits;
    Registration registration;
    StartGate start_gate;
    std::string name = {};  // as records and exports call it; of the first hand empty
    Navigation navigation = {};
    /// Scene metres per device metre, the most that it may come to.
    double largestScale() const noexcept {
        return navigation.second_scale.button > 0 ? std::max(registration.scale, navigation.second_scale.scale)
                                                  : registration.scale;
    }
};

struct SceneSpec {
    std::vector<PartSpec> parts;
    ContactSpec contact;
    // Of the first hand
    OutputLimits limits;
    Registration registration;
    StartGate start_gate;
    std::vector<HandSpec> other_hands;
    Effects effects;
    bool record_hand_depth = true;  // an extra query at the device pose for god objects
    bool display_wrench = true;     // false: contact is computed and recorded, but the device commands nothing

    std::size_t handCount() const { return 1 + other_hands.size(); }
    /// @pre `i` < handCount()
    HandSpec hand(std::size_t i) const {
        return i == 0 ? HandSpec{limits, registration, start_gate, {}, effects.navigation} : other_hands[i - 1];
    }
    /// Index of the part that hand `i` begins with; parts.size() if it begins with nothing.
    /// @pre validate() found nothing, `i` < handCount()
    std::size_t heldBy(std::size_t i) const;
    /// True if hand `i` can ever hold another part than the one that it begins with. @pre as heldBy
    bool canPick(std::size_t i) const;
    /// Index of each part that what hand `i` holds may touch. @pre as heldBy
    std::vector<std::size_t> obstaclesOf(std::size_t i) const;

    /// Everything wrong with the values, cross-field rules included. Finite first.
    std::vector<Error> validate() const;
};

/// For paths of the held parts in the world, in place of devices' poses: no registration, and navigation as it is in
/// the scene's metres.
void dropRegistrations(SceneSpec& spec);

}  // namespace passung::scene
