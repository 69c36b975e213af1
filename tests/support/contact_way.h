#pragma once

#include <ostream>

#include "core/scene/scene_spec.h"

namespace passung::test {

/// How contact is computed in a test that runs for several ways.
struct ContactWay {
    const char* name;
    scene::ContactMethod method;
    scene::Geometry geometry;
    double error;  // of a pose [m]
};
inline void PrintTo(const ContactWay& way, std::ostream* out) { *out << way.name; }

/// Without a turn.
inline Pose at(double x, double y, double z) { return {Quat::Identity(), Vec3(x, y, z)}; }

}  // namespace passung::test
