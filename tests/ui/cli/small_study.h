#pragma once

#include <stdexcept>
#include <string>

namespace passung::test {

/// A study that takes some 50 ms of real time a trial: coarse field and shell, a wide and shallow hole, the hand starts
/// near it. One condition ends by its time-out before anyone can have finished, the other in success.
inline std::string smallStudy(const std::string& name = "small") {
    return "passung = 1\n[study]\nname = \"" + name + "\"\n" + R"(version = "1.0"
seed = 7
participants = 4

[scene]
unit = "mm"

[[scene.part]]
name = "plate"
shape = { kind = "bore_plate", width = 40, depth = 40, height = 12, bore_diameter = 22, bore_depth = 10, chamfer = 1 }

[[scene.part]]
name = "peg"
held = true
shape = { kind = "peg", diameter = 20, length = 20, chamfer = 1 }
pose = { position = [4, 0, 8] }

[scene.contact]
cell_mm = 1.0
spacing_mm = 3.0

[scene.device]
preset = "sigma7"

[scene.start_gate]
position_tolerance_mm = 5
angle_tolerance_deg = 10
hold_ms = 20

[[factor]]
name = "chance"
levels = [
  { label = "none", set = { "task.timeout_s" = 0.4, "contact.method" = "penalty" } },
  { label = "fair", set = { "task.timeout_s" = 20, "contact.method" = "god_object_heuristic" } },
]

[task]
type = "peg_in_hole"
target = "plate"
insertion_depth_mm = 6
success_fraction = 0.9
max_speed_mm_per_s = 20
hold_s = 0.05
timeout_s = 20
leave_radius_mm = 2

[[block]]
name = "main"
order = "williams"
repetitions = 3
)";
}

/// The same with a chance in both conditions.
inline std::string fairStudy() {
    std::string text = smallStudy();
    const std::string hopeless = "\"task.timeout_s\" = 0.4";
    return text.replace(text.find(hopeless), hopeless.size(), "\"task.timeout_s\" = 20");
}

/// The same with the method that is the default in both conditions, which differ by a second of their time-outs.
inline std::string oneMethodStudy(const std::string& name = "small") {
    std::string text = smallStudy(name);
    const auto replace = [&](const std::string& what, const std::string& by) {
        text.replace(text.find(what), what.size(), by);
    };
    replace(R"("task.timeout_s" = 0.4, "contact.method" = "penalty")", R"("task.timeout_s" = 19)");
    replace(R"(, "contact.method" = "god_object_heuristic")", "");
    return text;
}

/// `text` of a scene or study with contact of fields, whatever its parts have. Throws if it has no table of contact.
inline std::string onFields(std::string text) {
    const std::string table = "contact]\n";
    const std::size_t at = text.find(table);
    if (at == std::string::npos) throw std::invalid_argument("no table of contact");
    return text.insert(at + table.size(), "geometry = \"field\"\n");
}

}  // namespace passung::test
