#pragma once

#include <array>

#include "core/scene/scene_spec.h"
#include "study/protocol/key_table.h"

namespace passung::protocol {

// Rows of the key table for [task]: a table of its own for every type of trial, see trial_types.h.
// clang-format off
inline constexpr Range kPositive{.low = 0, .low_excluded = true};
inline constexpr Range kTimeout{.low = 0, .high = 3600, .low_excluded = true};
inline constexpr std::array kTaskKeys{
    Key{"task", "type", KeyType::Choice, {}, "peg_in_hole|narrow_passage|contour_following|free_placement|discrimination_pair|assembly", "!", "Kind of trial; its own keys follow."},
    Key{"task", "motion_bandwidth_hz", KeyType::Number, {.low = 1, .high = 100}, "", "10", "Bandwidth of what measures take for the hand's motion: its path, rotation, work and smoothness are of a low-pass, for steps of an encoder are no way. -3 dB in each of two passes."},

    Key{"task.peg_in_hole", "target", KeyType::Text, {}, "", "!", "Name of the part to insert into: a bore_plate, or with `clearance_mm` any part."},
    Key{"task.peg_in_hole", "clearance_mm", KeyType::Number, kPositive, "", "(what the diameters leave)", "Play of the held part in the bore on every side of the axis. Of a peg in a bore_plate their diameters say it; of other parts, such as meshes, it has to be said here."},
    Key{"task.peg_in_hole", "mouth", KeyType::Table, {}, "", "(the target's frame)", "Where the bore begins: a pose in the target's frame, its origin in the middle of the mouth, +z out of it. Not for a bore_plate, whose frame is that. The held part's origin is what goes in: its depth is that below the mouth."},
    Key{"task.peg_in_hole", "insertion_depth_mm", KeyType::Number, kPositive, "", "20", "Depth of the tip below the mouth that counts as fully inserted."},
    Key{"task.peg_in_hole", "success_fraction", KeyType::Number, {.low = 0, .high = 1, .low_excluded = true}, "", "0.95", "Part of that depth that is success."},
    Key{"task.peg_in_hole", "max_speed_mm_per_s", KeyType::Number, kPositive, "", "5", "Largest speed while the depth is held."},
    Key{"task.peg_in_hole", "hold_s", KeyType::Number, {0, 60}, "", "0.5", "Time for which the depth is held."},
    Key{"task.peg_in_hole", "timeout_s", KeyType::Number, kTimeout, "", "30", "Time from the start of the trial after which the trial ends without success."},
    Key{"task.peg_in_hole", "leave_radius_mm", KeyType::Number, {.low = 0}, "", "20", "Radius of a sphere about the part's start; the trial's clock starts when the part leaves the sphere. Less than the way to full depth."},
    Key{"task.peg_in_hole", "engagement_depth_mm", KeyType::Number, kPositive, "", "1", "Depth at which search ends and insertion begins."},

    Key{"task.narrow_passage", "target", KeyType::Text, {}, "", "!", "Name of the part with the passage. The passage begins in the plane z = 0 of that part's frame and runs along -z about the z axis, as the bore of a bore_plate does."},
    Key{"task.narrow_passage", "passage_length_mm", KeyType::Number, kPositive, "", "!", "Distance from the plane z = 0 to where the held part's origin has come through."},
    Key{"task.narrow_passage", "passage_width_mm", KeyType::Number, kPositive, "", "!", "Width of the passage: the held part's origin is in the passage up to half of this from the axis. Whoever goes round has not come through."},
    Key{"task.narrow_passage", "timeout_s", KeyType::Number, kTimeout, "", "30", "Time from the start of the trial after which the trial ends without success."},
    Key{"task.narrow_passage", "leave_radius_mm", KeyType::Number, {.low = 0}, "", "20", "Radius of a sphere about the part's start; the completion time starts when the part leaves the sphere."},

    Key{"task.contour_following", "target", KeyType::Text, {}, "", "!", "Name of the part that the line lies on; +z of its frame points out of it."},
    Key{"task.contour_following", "points", KeyType::Levels, {}, "", "!", "Corners of the line, `[[x, y, z], ...]`, lengths in the target's frame, at least two. The held part's origin is to follow it from the first to the last."},
    Key{"task.contour_following", "reach_mm", KeyType::Number, kPositive, "", "5", "Largest distance from the line at which the line counts as followed."},
    Key{"task.contour_following", "coverage", KeyType::Number, {.low = 0, .high = 1, .low_excluded = true}, "", "0.95", "Part of the line's length that is success."},
    Key{"task.contour_following", "force_N", KeyType::Number, kPositive, "", "2", "Force to press with while following."},
    Key{"task.contour_following", "timeout_s", KeyType::Number, kTimeout, "", "60", "Time from the start of the trial after which the trial ends without success."},
    Key{"task.contour_following", "leave_radius_mm", KeyType::Number, {.low = 0}, "", "0", "Radius of a sphere about the part's start; the completion time starts when the part leaves the sphere."},

    Key{"task.free_placement", "position", KeyType::LengthVector, {}, "", "!", "Goal of the held part's origin, in the world."},
    Key{"task.free_placement", "rotation_deg", KeyType::Vector, {}, "", "(zero)", "Goal of the held part's rotation, as in a pose."},
    Key{"task.free_placement", "symmetric_about_z", KeyType::Boolean, {}, "", "false", "True where turning the held part about its z axis is no error."},
    Key{"task.free_placement", "position_tolerance_mm", KeyType::Number, kPositive, "", "5", "Largest distance from the goal that is a success."},
    Key{"task.free_placement", "angle_tolerance_deg", KeyType::Number, {.low = 0, .high = 180, .low_excluded = true}, "", "5", "Largest angle from the goal that is a success. A button confirms the placement; a placement farther away is a failure."},
    Key{"task.free_placement", "timeout_s", KeyType::Number, kTimeout, "", "30", "Time from the start of the trial within which the placement is confirmed."},
    Key{"task.free_placement", "leave_radius_mm", KeyType::Number, {.low = 0}, "", "20", "Radius of a sphere about the part's start; the completion time starts when the part leaves the sphere."},

    Key{"task.discrimination_pair", "target", KeyType::Text, {}, "", "!", "Name of the part that is felt; +z of its frame points out of it."},
    Key{"task.discrimination_pair", "comparison", KeyType::Table, {}, "", "!", "Difference of one of the two intervals: keys of the scene as in a level's `set`, such as `{ \"contact.stiffness_N_per_m\" = 800 }`. A factor varies them as task.comparison.contact.stiffness_N_per_m. Device, registration, start gate and the held part's form and start are those of both intervals."},
    Key{"task.discrimination_pair", "interval_s", KeyType::Number, {.low = 0, .high = 600, .low_excluded = true}, "", "3", "Length of an interval, from the moment the hand holds the start pose: a pair needs a start_gate. Which interval has the comparison is drawn for every attempt."},
    Key{"task.discrimination_pair", "answer_s", KeyType::Number, {.low = 0, .high = 600, .low_excluded = true}, "", "10", "Time for the answer after the second interval, while nothing is felt: the first button says the first interval, the second button the second."},
    Key{"task.discrimination_pair", "question", KeyType::Text, {}, "", "!", "Question to the participant, such as \"Which was stiffer?\"."},
    Key{"task.discrimination_pair", "judged", KeyType::Choice, {}, "stiffness|roughness|force|viscosity|inertia|position", "stiffness", "Property that a simulated person compares, going by posture and displayed force alone; people are asked the question. force: of the held part at rest; inertia: of shaking it; position: how far it goes down to the target; else: of pressing on the target, or stroking it."},

    Key{"task.assembly", "step", KeyType::Tables, {}, "", "!", "Steps of the assembly, at most 63: success once all are done."},
    Key{"task.assembly", "hints", KeyType::Boolean, {}, "", "true", "True where the goals of the steps that may be done next are drawn."},
    Key{"task.assembly", "hint_after_s", KeyType::Number, kTimeout, "", "(none)", "Time in which no step is done or taken back, also from the start of the trial, after which a hint comes up: of the first step that may be done next the part is marked, with its line in the list and its goal. It stays until a step is done or taken back. Simulated people do not look at it."},
    Key{"task.assembly", "undo_button", KeyType::Integer, {1, scene::kButtons}, "", "(none)", "Number of the device's button, from 1, that takes back the step that was done last: its part can be picked up again. No effect may have it."},
    Key{"task.assembly", "timeout_s", KeyType::Number, kTimeout, "", "300", "Time from the start of the trial after which the trial ends without success."},
    Key{"task.assembly", "leave_radius_mm", KeyType::Number, {.low = 0}, "", "0", "Radius of a sphere about each hand's start; the completion time starts when a hand leaves its sphere. Some part of a step must start or belong outside."},

    Key{"task.step", "part", KeyType::Text, {}, "", "!", "Name of a part with pickable = true; each belongs to one step."},
    Key{"task.step", "name", KeyType::Text, {}, "", "(the part's)", "Name of the step."},
    Key{"task.step", "into", KeyType::Text, {}, "", "(the world)", "Name of the part in whose frame the goal is, where that part then is: one that no hand moves, or one that a step before it locks."},
    Key{"task.step", "position", KeyType::LengthVector, {}, "", "!", "Goal of the part's origin."},
    Key{"task.step", "rotation_deg", KeyType::Vector, {}, "", "(zero)", "Goal of the part's rotation, as in a pose."},
    Key{"task.step", "position_tolerance_mm", KeyType::Number, kPositive, "", "1", "Largest distance from the goal at which the step is done when the part is let go."},
    Key{"task.step", "angle_tolerance_deg", KeyType::Number, {.low = 0, .high = 180, .low_excluded = true}, "", "5", "Largest angle from the goal."},
    Key{"task.step", "symmetry", KeyType::Integer, {0, 360}, "", "1", "In how many turns about its z axis the part looks the same: 1 in a full turn only, 4 for a square; 0 in any, as a round pin."},
    Key{"task.step", "after", KeyType::Texts, {}, "", "(none)", "Names of the steps that have to be done before. A part that is let go at its goal earlier waits for them."},
    Key{"task.step", "locks", KeyType::Boolean, {}, "", "true", "True: done, the part stays there for good, or until it is taken back. False: it can be taken out again, and the step is not done any more."},
    Key{"task.step", "insertion_mm", KeyType::Number, {.low = 0}, "", "0", "Way along the goal's -z by which the part goes in at the end; 0: it is only put there. Simulated people go by it; people see where the part goes."},
    Key{"task.step", "hand", KeyType::Text, {}, "", "(the first)", "Name of the `[[hand]]` that is asked to do it; any may."},
    Key{"task.step", "path_mm", KeyType::Number, kPositive, "", "(none)", "Length of a collision-free path of the part's origin from its start to the goal, as `passung feasible --keys` prints it: path_ratio is the way in the hands over it."},
};
// clang-format on

}  // namespace passung::protocol
