#include "analysis/truth/grown_shape.h"

#include <algorithm>
#include <numbers>

namespace passung::truth {
namespace {

using namespace shape;
using Grown = std::optional<GrownShape>;

double grownChamfer(double chamfer, double by) { return chamfer + (2.0 - std::numbers::sqrt2) * by; }

Grown grow(const Sphere& s, double by) { return GrownShape{Sphere{s.diameter + 2.0 * by}}; }

Grown grow(const Torus& t, double by) { return GrownShape{Torus{t.diameter, t.tube_diameter + 2.0 * by}}; }

Grown grow(const Cylinder& c, double by) { return GrownShape{Cylinder{c.diameter + 2.0 * by, c.length + 2.0 * by}}; }

Grown grow(const Box& b, double by) {
    return GrownShape{Box{b.width + 2.0 * by, b.depth + 2.0 * by, b.height + 2.0 * by}};
}

Grown grow(const Peg& p, double by) {
    return GrownShape{Peg{p.diameter + 2.0 * by, p.length + 2.0 * by, grownChamfer(p.chamfer, by)}, by};
}

Grown grow(const SquarePeg& p, double by) {
    return GrownShape{
        SquarePeg{p.width + 2.0 * by, p.depth + 2.0 * by, p.length + 2.0 * by, grownChamfer(p.chamfer, by)}, by};
}

/// Of a plate whose bore is no more, the block. Of a mouth that would reach below the floor nothing is kept.
template <class Plate>
Grown growPlate(Plate plate, bool closed, double by) {
    const double height = plate.height + 2.0 * by;
    const Box block{plate.width + 2.0 * by, plate.depth + 2.0 * by, height};
    if (closed) return GrownShape{block, 0.5 * plate.height};
    const bool through = plate.bore_depth >= plate.height;
    plate.width = block.width;
    plate.depth = block.depth;
    plate.height = height;
    if (through) plate.bore_depth = height;
    plate.chamfer = grownChamfer(plate.chamfer, by);
    if (!through && plate.chamfer > plate.bore_depth) plate.chamfer = 0.0;
    return GrownShape{plate, -by};
}

Grown grow(BorePlate plate, double by) {
    plate.bore_diameter -= 2.0 * by;
    return growPlate(plate, !(plate.bore_diameter > 0.0), by);
}

Grown grow(SquareBorePlate plate, double by) {
    plate.pocket_width -= 2.0 * by;
    plate.pocket_depth -= 2.0 * by;
    return growPlate(plate, !(std::min(plate.pocket_width, plate.pocket_depth) > 0.0), by);
}

template <class Other>
Grown grow(const Other&, double) {
    return std::nullopt;
}

}  // namespace

std::optional<GrownShape> grown(const Shape& shape, double by) {
    return std::visit([by](const auto& s) { return grow(s, by); }, shape);
}

}  // namespace passung::truth
