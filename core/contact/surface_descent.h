#pragma once

#include <cstdint>

#include "core/field/distance_field.h"
#include "core/shell/sphere_tree.h"

namespace passung::contact {

/// Where a search along a surface ended; frame of the shell.
struct Descent {
    Vec3 position;
    int points_tested = 0;
};

/// From point `start` of the shell, at which φ is `phi`, down to where φ is least on the surface around it, as far as
/// steps find it: the deepest point seldom is a sample. Eight steps at a time along the triangles, in directions that
/// turn from one time to the next; a third as long after a time without success. φ along a surface has ridges where the
/// obstacle's nearest face changes; there slopes do not lead down, and these steps still do.
/// rt-safe, at most kDescentRounds times eight points. Where the surface is not known: the start.
Descent descend(const field::DistanceField& field, const field::DistanceField::Placement& S,
                const shell::SphereTree& shell, std::uint32_t start, double phi) noexcept;
inline constexpr int kDescentRounds = 16;

}  // namespace passung::contact
