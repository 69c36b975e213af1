#pragma once

#include <array>

#include "study/protocol/key_ranges.h"
#include "study/protocol/key_table.h"

namespace passung::protocol::view_rows {

using enum KeyType;
using namespace ranges;

// Rows of the key table for what the participant's window looks like.
// clang-format off
inline constexpr std::array kViewKeys{
    Key{"protocol", "view", Table, kAny, "", "(its defaults)", "Appearance of the participant's window."},

    Key{"view", "theme", Choice, kAny, "dark|light", "dark", "Ground, parts and pages."},
    Key{"view", "text_percent", Number, from(75, 200), "", "100", "Size of all text."},
    Key{"view", "camera_from", Vector, kAny, "", "([0.34, -1, 0.62])", "Direction from what the camera looks at towards the eye, in the world, z up; its length means nothing."},
    Key{"view", "camera_target_mm", Vector, kAny, "", "(the middle of all that is drawn)", "Point that the camera looks at, in the world."},
    Key{"view", "camera_distance_mm", Number, above(0), "", "(all is in the picture)", "Distance from that point to the eye. With both, the camera stands still whatever a condition's parts are."},
    Key{"view", "camera_angle_deg", Number, from(5, 120), "", "30", "Angle of view from the picture's lower to its upper edge."},
    Key{"view", "light_from", Vector, kAny, "", "(over the camera's left shoulder)", "Direction towards the light that casts shadows, in the world."},
    Key{"view", "light_percent", Number, from(0, 300), "", "100", "Brightness of that light."},
    Key{"view", "fill_light_percent", Number, from(0, 300), "", "32", "Brightness of the light beside the camera, without shadows."},
    Key{"view", "ambient_light_percent", Number, from(0, 100), "", "36", "Brightness of the light from everywhere."},
    Key{"view", "shadow_percent", Number, from(0, 100), "", "55", "Darkness of shadows; 0: no shadows are drawn."},
    Key{"view", "ground", Boolean, kAny, "", "true", "True for a plane below all parts."},
    Key{"view", "max_picture_age_ms", Number, above(0), "", "1000", "Largest age of what is on the screen in a person's trial that counts: from the reading of the device for the newest tick that it shows until another picture takes its place."},
    Key{"view", "min_pictures_per_s", Number, from(0, 240), "", "10", "A person's trial does not count with fewer pictures a second that show something new. Pictures of simulated participants are not judged."},
};
// clang-format on

}  // namespace passung::protocol::view_rows
