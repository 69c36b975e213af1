#pragma once

#include <optional>

#include "core/shape/shape.h"

namespace passung::truth {

/// A shape that holds all points within some distance of another one, and whose convex sets outside (shape_outside.h)
/// are those of the other moved away by that distance. (Own.)
///   A half-space, the room of a bore or a pocket and that between the slopes of a mouth, less a rim of width d, is
/// convex and has no point within d of the solid. Those that belong together make a shape of the same kind: lengths
/// grow by 2 d, bores shrink by 2 d, and as a 45° slope moves by √2 d along the axis, of which the origin's face moves
/// d and the wall another d, a chamfer grows by (2 - √2) d.
struct GrownShape {
    shape::Shape shape;
    double lift = 0.0;  // of the other's origin in the frame of `shape`, along z [m]
};

/// `by` > 0 [m]. Nothing for kinds that are not known: sheets, keys and threads.
std::optional<GrownShape> grown(const shape::Shape& shape, double by);

}  // namespace passung::truth
