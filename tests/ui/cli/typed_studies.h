#pragma once

#include <string>

namespace passung::test {

/// A small study of every type of trial: coarse, two conditions, some seconds of virtual time a trial.
/// `task`: the [task] table and what belongs to it; `parts`: the [[scene.part]] tables; `factor`: what is varied.
inline std::string typedStudy(const std::string& name, const std::string& parts, const std::string& factor,
                              const std::string& task) {
    return "passung = 1\n[study]\nname = \"" + name + "\"\nversion = \"1.0\"\nseed = 7\nparticipants = 2\n\n[scene]\n" +
           parts + R"(
[scene.contact]
cell_mm = 1.0
spacing_mm = 2.0
method = "god_object"
stiffness_N_per_m = 1000

[scene.device]
preset = "sigma7"

[scene.start_gate]
position_tolerance_mm = 3
angle_tolerance_deg = 10
hold_ms = 20

)" + factor +
           "\n" + task + "\n[[block]]\nname = \"main\"\norder = \"williams\"\nrepetitions = 2\n";
}

/// A ball over a table.
inline constexpr const char* kBallOverTable = R"([[scene.part]]
name = "table"
shape = { kind = "box", width = 60, depth = 60, height = 10 }
pose = { position = [0, 0, -5] }
[[scene.part]]
name = "ball"
held = true
shape = { kind = "sphere", diameter = 10 }
pose = { position = [0, 0, 15] }
)";

/// Pairs of 1000 N/m against 330 or 1500 N/m.
inline std::string pairStudy() {
    return typedStudy("pairs", kBallOverTable, R"([[factor]]
name = "comparison_stiffness"
unit = "N/m"
key = "task.comparison.contact.stiffness_N_per_m"
levels = [330, 1500]
)",
                      R"([task]
type = "discrimination_pair"
target = "table"
interval_s = 2
answer_s = 5
question = "Which was stiffer?"
comparison = { "contact.stiffness_N_per_m" = 400 }
)");
}

/// A ball through a bore that goes through.
inline std::string passageStudy() {
    return typedStudy("passage", R"([[scene.part]]
name = "wall"
shape = { kind = "bore_plate", width = 40, depth = 40, height = 12, bore_diameter = 13, bore_depth = "through", chamfer = 1 }
[[scene.part]]
name = "ball"
held = true
shape = { kind = "sphere", diameter = 10 }
pose = { position = [4, 0, 14] }
)",
                      R"([[factor]]
name = "bore"
unit = "mm"
key = "part.wall.shape.bore_diameter"
levels = [12, 14]
)",
                      R"([task]
type = "narrow_passage"
target = "wall"
passage_length_mm = 14
passage_width_mm = 13
timeout_s = 20
leave_radius_mm = 2
)");
}

/// An L of 2 × 15 mm on the table.
inline std::string contourStudy() {
    return typedStudy("contour", kBallOverTable, R"([[factor]]
name = "pressure"
unit = "N"
key = "task.force_N"
levels = [1, 3]
)",
                      R"([task]
type = "contour_following"
target = "table"
points = [[0, 0, 10], [15, 0, 10], [15, 15, 10]]
reach_mm = 6
timeout_s = 20
leave_radius_mm = 2
)");
}

/// A peg put down 2 mm over the table, 15 mm to the side.
inline std::string placementStudy() {
    return typedStudy("placement", R"([[scene.part]]
name = "table"
shape = { kind = "box", width = 60, depth = 60, height = 10 }
pose = { position = [0, 0, -5] }
[[scene.part]]
name = "peg"
held = true
shape = { kind = "peg", diameter = 8, length = 20 }
pose = { position = [0, 0, 10] }
)",
                      R"([[factor]]
name = "demand"
key = "task.position_tolerance_mm"
levels = [0.05, 5]
)",
                      R"([task]
type = "free_placement"
position = [15, 0, 2]
rotation_deg = [0, 10, 0]
symmetric_about_z = true
timeout_s = 20
leave_radius_mm = 2
)");
}

}  // namespace passung::test
