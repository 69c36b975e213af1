#pragma once

#include <cstdint>

#include "core/base/result.h"
#include "core/scene/scene.h"

namespace passung::hard {

/// A scene whose parts are meshes that lie otherwise in frames of their own, so that the cells of their fields cut them
/// otherwise; in the world nothing has another place, and the same path of the handle leads the same part.
struct Relaid {
    scene::SceneSpec spec;
    Pose X_HN;  // the held part's new frame in its old one
};

/// Every part turned at random, and moved by up to a millimetre, before anything is built of it; shapes as triangles
/// with `chord_error` [m]. Errors: a mesh cannot be read.
Result<Relaid> relaid(const scene::SceneSpec& spec, std::uint64_t seed, double chord_error);

}  // namespace passung::hard
