#pragma once

#include <optional>
#include <string>

#include "core/base/types.h"

namespace passung::plan {

enum class Theme { Dark, Light };
const char* themeName(Theme theme);  // "dark", "light"

/// How the participant's window draws, in all conditions. The experimenter's own look is none of it.
struct View {
    Theme theme = Theme::Dark;
    double text_scale = 1.0;                      // of all text, 1: as designed
    Vec3 camera_from{0.34, -1.0, 0.62};           // from what it looks at towards the eye, world axes, any length > 0
    std::optional<Vec3> camera_target;            // that it looks at [m]; none: the middle of all that is drawn
    std::optional<double> camera_distance;        // from there [m], > 0; none: all is in the picture
    double camera_opening = 0.52359877559829887;  // vertical angle [rad], of 30 degrees
    std::optional<Vec3> light_from;               // as camera_from; none: over the camera's left shoulder
    double light = 1.0;                           // brightness of that light
    double fill_light = 0.32;                     // of the one beside the camera
    double ambient_light = 0.36;                  // of what comes from everywhere
    double shadow = 0.55;                         // how dark the light's shadows are, 0: none … 1: black
    bool ground = true;                           // a plane below all parts is drawn
    double max_picture_age = 1.0;                 // a trial with an older picture does not count [s], > 0
    double min_pictures_per_s = 10.0;             // nor one with fewer, ≥ 0
};

/// Every number of it, as stored and logged.
std::string viewJson(const View& view);

}  // namespace passung::plan
