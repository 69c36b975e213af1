#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "core/base/types.h"

namespace passung::simulated {

/// What of an interval is felt; how: impression.h.
enum class Quantity { Stiffness, Roughness, Force, Viscosity, Inertia, Position };

/// Two intervals are to be felt and compared.
struct CompareGoal {
    Quantity quantity = Quantity::Stiffness;
};

/// The held part is to be put to a pose that is drawn.
struct PlaceGoal {
    Pose X_WGoal;
    bool round = false;  // turning about its z axis does not matter
};

/// A drawn line is to be followed with the held part's origin.
struct FollowGoal {
    std::vector<Vec3> points;  // in the target's frame, whose +z points out of it
    double force = 2.0;        // [N] with which to press
};

/// Parts are to be picked up and put where they belong, each step after others. Poses as drawn.
struct AssembleGoal {
    struct Step {
        std::int32_t part = 0;   // its place in `parts`
        std::int32_t into = -1;  // the goal is in the frame of this part, where that part then is; -1: in the world
        Pose X_IGoal;
        int folds = 1;  // turned about its z axis by a full turn / folds the part is as before; 0: by any angle
        double insertion = 0.0;   // [m] that it goes in along the goal's -z; 0: it is only put there
        std::uint64_t after = 0;  // a bit for each step that has to be done before
        std::size_t hand = 0;     // that is to do it, in the order of DisplayedImage::held
    };
    struct Part {
        Pose X_W;                          // at the start
        Vec3 grip = Vec3::Zero();          // where the hand takes it, in the part's frame [m]
        double below = 0.0;                // how far it reaches below its origin, along its z [m]
        Vec3 shown_offset = Vec3::Zero();  // drawn so far from where images tell it to be, world axes [m]
    };
    /// A ball in which a hand can be.
    struct Reach {
        Vec3 middle = Vec3::Zero();
        double radius = std::numeric_limits<double>::infinity();  // [m]
    };
    std::vector<Part> parts;     // of the scene
    std::vector<Step> steps;     // in the order of DisplayedImage::steps_done
    std::uint32_t close = 1;     // the buttons that close the hand
    std::size_t hand = 0;        // whose goal this is, in the order of DisplayedImage::held
    std::vector<Reach> reaches;  // how far each hand gets, as practice has told; of those that are missing everywhere
    bool on_press = false;       // a press closes it, the next one opens it; else it is closed while they are down
};

/// The held part is to stay where it starts.
struct HoldGoal {};

/// What the display shows of the task and does not change during a trial: where things are drawn, which need not be
/// where they are touched. Poses of the held part and of the target: a bore's mouth (its axis +z points out of it), or
/// what is to be felt. Without a goal the held part is to be inserted.
struct VisibleTask {
    Pose X_WHeldStart;
    Pose X_WTarget;
    double insertion_depth = 0.020;  // [m], > 0
    std::variant<std::monostate, CompareGoal, PlaceGoal, FollowGoal, HoldGoal, AssembleGoal> goal = {};
    std::optional<std::size_t> target_hand = {};  // that holds the target, which then moves; none: it rests
    bool blind = false;                           // nothing is drawn once the trial has begun
    bool round = true;                            // seen: turned about its z axis the held part looks the same
};

/// How the handle maps to the held part: X_WH = X_WB · scale(X_BD) · X_DH, the scale acting on the position.
struct HandRegistration {
    Pose X_WB;
    double scale = 1.0;  // > 0
    Pose X_DH;

    Pose partFromHandle(const Pose& X_BD) const { return X_WB * Pose{X_BD.q, scale * X_BD.p} * X_DH; }
    Pose handleFromPart(const Pose& X_WH) const {
        const Pose X_BD = X_WB.inverse() * X_WH * X_DH.inverse();
        return {X_BD.q, X_BD.p / scale};
    }
};

/// A channel through which a cue of contact is perceived; see CueChannel.
struct CueSense {
    double threshold = 0.1;  // of the cue's full strength: what is weaker goes unnoticed, > 0
    double delay = 0.25;     // from cue to reaction [s], 0 … kMaxSenseDelay
    double noise = 0.2;      // of the strength: standard deviation of its natural logarithm, ≥ 0
};

/// A person's arm, senses and habits, as far as peg-in-hole needs them. SI units. The defaults are plausible for a calm
/// adult and proposed here; they are not measured on anybody.
struct HandParams {
    // the arm at the handle
    double mass = 0.5;                  // [kg]
    double inertia = 1.5e-3;            // [kg·m²]
    double stiffness = 300.0;           // [N/m], > 0
    double damping = 15.0;              // [N·s/m]
    double rotational_stiffness = 3.0;  // [N·m/rad], > 0
    double rotational_damping = 0.08;   // [N·m·s/rad]
    double tremor = 4e-5;               // root mean square per axis of the free hand, 8-12 Hz [m]

    // delays from sense to reaction
    double visual_delay = 0.20;  // [s], 0 … kMaxSenseDelay
    double haptic_delay = 0.13;  // [s], felt force and own posture

    // how wrongly the relative pose of part and bore is seen (standard deviations, drawn anew at every look)
    double lateral_error = 0.6e-3;  // [m] per axis
    double depth_error = 0.5e-3;    // [m]
    double tilt_error = 0.013;      // [rad] per axis

    // habits
    double pace = 1.0;                  // factor on the speed of all movements, > 0
    double approach_duration = 1.1;     // [s] for the reach to above the bore, > 0
    double approach_height = 8e-3;      // [m] above the mouth
    double descend_speed = 0.02;        // [m/s]
    double judgement = 0.35;            // [s] looking whether it goes in before searching
    double press_force = 3.0;           // [N] while searching
    double search_speed = 8e-3;         // [m/s] along the spiral
    double search_pitch = 0.6e-3;       // [m] between turns
    double first_search_radius = 2e-3;  // [m] before lifting and looking again; grows by itself at every attempt
    double last_search_radius = 6e-3;   // [m]
    double search_tilt = 0.008;         // wobble while searching [rad]
    double insert_speed = 0.025;        // [m/s]
    double insert_force = 7.0;          // [N], the most that is pushed
    double lapse_rate = 0.0;            // share of trials with a lapse, 0 … 1: a pause after the first look
    double lapse_duration = 1.5;        // [s], ≥ 0

    // how wrongly something felt is compared: standard deviation of the natural logarithm of what an interval felt like
    double feeling_error = 0.15;  // ≥ 0

    // cues beside the force
    CueSense visual_cue = {};
    CueSense vibration_cue = {};
    CueSense sound_cue = {};

    /// Everything out of range; key = field.
    std::vector<Error> validate() const;
};

inline constexpr double kMaxSenseDelay = 0.5;  // [s]

}  // namespace passung::simulated
