#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/tick_record.h"
#include "core/base/types.h"
#include "core/motion/friction.h"
#include "core/scene/scene.h"
#include "core/tick/energy_account.h"

namespace passung::tick {

struct TickModel;
struct TickState;

/// What one tick works on; dies with it.
struct TickFrame {
    DeviceReading reading;      // as the device gave it
    Pose X_WH;                  // held part where the device asks it to be, after the input guard
    bool input_usable = false;  // false: the output is zero
    bool relocated = false;     // the device is believed to be where it cannot have come from: the past is void
    // Periods between this tick's sample and the good one before it; 0: no new sample (X_WH is held), nothing has
    // moved.
    std::int64_t sample_periods = 0;
    Wrench load;               // QueryAnswer::load at X_WH, of area-weighted penalty
    Wrench F_H_W;              // on the hand, about the held part's origin, world axes
    Wrench F_D_B;              // what is sent: on the hand, about the handle's origin, device base axes
    double proxy_depth = 0.0;  // [m], ≥ 0
    double hand_depth = 0.0;   // [m], ≥ 0
    double energy = 0.0;       // EnergyAccount::taken_in [J]
    double quality = 1.0;
    std::uint32_t status = 0;  // TickStatus bits
    std::uint32_t contacts = 0;
    std::uint32_t iterations = 0;
    std::uint32_t nodes_visited = 0;
    std::uint32_t rows_taken = 0;      // most contacts taken up or let go for one motion (constrained_motion.h)
    std::uint32_t friction_turns = 0;  // most turns of one motion (friction_balance.h)
};

/// One step of the tick's work. `reason` says why this scene has it.
struct Stage {
    const char* name;
    const char* reason;
    bool before_start;  // runs also while the start gate is closed
    void (*run)(const TickModel&, TickState&, TickFrame&) noexcept;
};

/// An obstacle: a distance field fixed in the world.
struct Obstacle {
    const model::DistanceField* field;
    Pose X_WF;
    const model::SphereTree* shell = nullptr;  // two-way contact only
    const model::EdgeCurves* edges = nullptr;  // with the shell
};

/// Overlap of a proxy [m].
struct ProxyMargins {
    double keep = 0.0;     // kept in contact: tells contact from nearness
    double relieve = 0.0;  // after a step: more is pushed out again
    double accept = 0.0;   // after a step: more, and it is taken back
};

/// Everything that does not change while a trial runs. Borrows the scene's parts.
struct TickModel {
    const model::SphereTree* shell = nullptr;
    const model::EdgeCurves* edges = nullptr;
    const model::DistanceField* held_field = nullptr;  // two-way contact only
    std::vector<Obstacle> obstacles;
    std::vector<Friction> friction;  // of each obstacle with the held part; empty: the scene names none
    Pose X_WG_start;
    model::ContactSpec contact;
    model::OutputLimits limits;
    model::Registration registration;
    model::StartGate start_gate;
    std::vector<Stage> stages;
    double finest_cell = 0.0;    // of all fields [m]
    double metric_radius = 0.0;  // [m]: makes a rotation comparable with a translation (god_object_heuristic.h)
    ProxyMargins margins;
    double passivity_damping = 0.0;  // α_max of passivity.h [N·s/m]
    model::Transients transients;
};

/// Where contacts held the proxy's last motion: each is a point of the held part or of an obstacle.
struct HeldPoints {
    struct Point {
        Vec3 p_G, p_W;  // in the proxy, in the world
    };
    std::array<Point, 6> point;
    int count = 0;
};

/// Vibration after impacts: transients.h.
struct Ringing {
    Wrench now, next;  // of this tick and of the coming one, without a further impact
    Pose X_WH_last;    // at the last new sample
    bool has_last = false;
    bool in_contact = false;  // at the last tick
};

/// Everything that a tick carries to the next. Sized by makeState; a tick never allocates.
struct TickState {
    std::int64_t tick = 0;
    // input guard
    bool has_good_pose = false;
    Pose X_BD_good;
    bool good_confirmed = false;  // a sample that followed it, or those that led to it, agree with X_BD_good
    std::int64_t periods_since_good = 0;
    Pose X_BD_other;        // the last sample that does not follow from X_BD_good
    int other_samples = 0;  // that led to it, each following from the one before
    std::int64_t periods_since_other = 0;
    EnergyAccount energy;
    std::vector<PairAccount> pairs = std::vector<PairAccount>(1);  // of each obstacle, and of what none pushes: last
    // start gate
    bool engaged = false;
    int held_ticks = 0;
    // proxy
    Pose X_WG;
    ContactManifold manifold;      // at X_WG, points with φ < manifold_reach
    double manifold_reach = -1.0;  // < 0: nothing known
    double clearance = 0.0;        // least φ of the points that were looked at, as interpolated [m]
    double room = 0.0;             // least φ known of any point: beyond the reach proven, spheres included [m]
    FrictionPatches rubbing;       // of the last motion in contact
    HeldPoints held;               // of the last motion: where the solver of the next one begins
    double last_motion = 0.0;      // of the proxy, in the metric of metric_radius [m]
    Pose X_WG_last;                // for the proxy filter
    bool has_last_proxy = false;
    // penalty damping
    Pose X_WH_last;  // at the last new sample; of a coupled penalty at the last tick
    Twist V_H_last;  // measured there
    bool has_last_hand = false;
    // coupled penalty
    Motion tool_motion = Motion::Zero();  // in the last tick, in the metric of metric_radius [m]
    // coupling
    Vec3 last_stretch = Vec3::Zero(), last_twist = Vec3::Zero();  // at the last new sample
    Vec3 last_stretch_rate = Vec3::Zero(), last_twist_rate = Vec3::Zero();
    bool has_last_stretch = false;
    Ringing ringing;
    // output
    Wrench last_sent;       // F_D_B of the previous tick
    Wrench sent_at_sample;  // F_D_B of the last tick with a new sample
    bool latched = false;   // a computed wrench was not finite
    std::array<Wrench, model::kMaxDelayTicks + 1> delay_line{};
    std::vector<Wrench> push_line;             // the same of the pairs' pushes, tick by tick
    std::uint64_t hash = 0xcbf29ce484222325u;  // of all outputs so far, exact bits
    // scratch memory
    QueryWorkspace workspace;
    ContactManifold scratch;
};

/// The stages that the scene names, in order, and what they need. `scene` must outlive the result.
TickModel makeModel(const model::Scene& scene);

/// The state before the first tick, with all memory that the ticks will need.
TickState makeState(const TickModel& model);

}  // namespace passung::tick
