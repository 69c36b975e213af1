#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/types.h"

namespace passung::plan {

/// A peg goes into the bore of the target, whose frame has its origin at the bore's mouth and the bore along -z.
struct PegInHoleTask {
    double clearance = 0.0;           // [m] radial, of the peg in that bore
    Pose X_TMouth = {};               // centre of the bore's mouth in the target's frame, +z out of it
    double insertion_depth = 0.020;   // [m] of the tip below the mouth that counts as fully inserted
    double success_fraction = 0.95;   // of that depth
    double max_speed = 0.005;         // [m/s] while the depth is held
    double hold = 0.5;                // [s]
    double engagement_depth = 0.001;  // [m] search ends at this depth
};

/// The held part's origin goes through a passage of the target, from its mouth in the plane z = 0 along -z.
struct NarrowPassageTask {
    double length = 0.0;  // [m], > 0
    double width = 0.0;   // [m], > 0: the origin is in the passage up to half of it from the axis
};

/// The held part's origin follows a line on the target.
struct ContourFollowingTask {
    std::vector<Vec3> points;  // corners of the line in the target's frame [m], at least two
    double reach = 0.005;      // [m] from the line: farther away nothing is followed
    double coverage = 0.95;    // share of the line's length that is success
    double force = 2.0;        // [N] with which to press
};

/// The held part is put to a pose, and the person says when it is there.
struct FreePlacementTask {
    Pose X_WGoal;
    double position_tolerance = 0.005;  // [m] within both it is a success
    double angle_tolerance = 0.1;       // [rad]
    bool round = false;                 // turning about the part's z axis is no error
    std::uint32_t other_buttons = 0;    // of the scene's effects, as in DeviceReading: they confirm nothing
};

/// What a simulated person compares in the intervals of a pair.
enum class Judged { Stiffness, Roughness, Force, Viscosity, Inertia, Position };
inline constexpr std::array<const char*, 6> kJudgedNames{"stiffness", "roughness", "force",
                                                         "viscosity", "inertia",   "position"};

/// Two intervals feel different, and the person says in which there was more of something.
struct DiscriminationPairTask {
    double interval = 3.0;  // [s] each, from the moment the hand holds the start pose
    double answer = 10.0;   // [s] time for the answer
    std::string question;
    Judged judged = Judged::Stiffness;
};

/// How a step of an assembly is asked for; what it is stands in the scene, Effects::pick.steps.
struct AskedStep {
    std::string name;
    double insertion = 0.0;  // [m] that the part's origin goes along its goal's -z, guided by what is around, ≥ 0
    std::size_t hand = 0;    // that is asked to do it; any may
    std::optional<double> free_path = {};  // [m] of a collision-free path, > 0; none: none is known
};

/// Hands pick parts up and put each where it belongs; success once all steps are done.
struct AssemblyTask {
    std::vector<AskedStep> steps;  // in the order of the scene's
    bool hints = true;             // the goals of the steps that may be done next are drawn
    double hint_after = 0.0;       // [s] without a step done until a hint comes up; 0: never
};

/// What a trial asks for; `form` says the type of the trial.
struct Task {
    std::string target;              // name of the part that it is about; empty for free_placement
    double timeout = 30.0;           // [s] from the start; of a pair: how long it takes at most
    double motion_bandwidth = 10.0;  // [Hz] of the hand's motion, as measures take it
    double leave_radius = 0.020;     // [m] the trial's clock starts when the part leaves this sphere about its start
    std::variant<PegInHoleTask, NarrowPassageTask, ContourFollowingTask, FreePlacementTask, DiscriminationPairTask,
                 AssemblyTask>
        form;
};

/// Where a trial is judged, with its target at `X_WT`: of a peg_in_hole the bore's mouth, else the target.
inline Pose judgedFrame(const Task& task, const Pose& X_WT) {
    const auto* peg = std::get_if<PegInHoleTask>(&task.form);
    return peg != nullptr ? X_WT * peg->X_TMouth : X_WT;
}

}  // namespace passung::plan
