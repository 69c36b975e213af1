#include "core/field/shape_bound.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/field/interpolation.h"

namespace passung::field {

namespace {

constexpr int kHalf = SurfaceBlock::kCells / 2;
constexpr int kCubes = kHalf * kHalf * kHalf;
constexpr double kLeastSlope = 0.25;  // below, as halfway between two walls, cones are no help
constexpr double kFirstRadius = 2.0;  // tried, in cells; then twice as much each time
constexpr int kRadii = 9;
constexpr double kHalfSquare = 0.5 * 0.75;    // ½ t², in cells
constexpr double kDisappoints = 2.0;          // times what the octant's radius promises: then the cell's own is tried
constexpr double kRounding = 1e-10;           // of the way to a cone's tip, in cells
constexpr std::array kOutside{64.0, 4096.0};  // radii outside a convex solid; the larger wants a better direction

/// What is convex where: the shape itself, or for plates their box, or the hole in it, ψ = -φ.
enum class Piece { None, Whole, Hole };

double length(double x, double y) { return std::sqrt(x * x + y * y); }

/// From a quadrant, by the way beyond its two sides.
double excess(double x, double y) { return length(std::max(x, 0.0), std::max(y, 0.0)) + std::min(std::max(x, y), 0.0); }

/// Of the hole as an endless prism.
double holeDistance(const shape::BorePlate& plate, const Vec3& p, double wider) {
    return length(p.x(), p.y()) - 0.5 * plate.bore_diameter - wider;
}
double holeDistance(const shape::SquareBorePlate& plate, const Vec3& p, double wider) {
    return excess(std::abs(p.x()) - 0.5 * plate.pocket_width - wider,
                  std::abs(p.y()) - 0.5 * plate.pocket_depth - wider);
}
/// Not convex itself: the circle around it.
double holeDistance(const shape::KeyedBorePlate& plate, const Vec3& p, double wider) {
    const double bore = 0.5 * plate.bore_diameter;
    return length(p.x(), p.y()) - length(bore + plate.key_height + wider, 0.5 * plate.key_width + wider);
}

template <class Plate>
double boxDistance(const Plate& plate, const Vec3& p) {
    return shape::signedDistance(shape::Box{plate.width, plate.depth, plate.height},
                                 p + Vec3(0.0, 0.0, 0.5 * plate.height));
}

/// The plate is its box A without the hole; let P be the hole or more. In the ball around m, of radius r, with d the
/// distance of one:
///   |φ_A(m)| + 2 r ≤ φ_P(m): at no point is P nearer than ∂A, and the nearest point of A is not in P: φ = φ_A.
///   |φ_P(m)| + 2 r ≤ the distance to what is not the wall (all of it above the chamfer, below the floor, or on the
///   sides): the wall is nearest, and beside the wall is the plate: φ = -φ_P.
template <class Plate>
Piece pieceOf(const Plate& plate, const Vec3& m, double r, bool convex_hole) {
    if (std::abs(boxDistance(plate, m)) + 2.0 * r <= holeDistance(plate, m, plate.chamfer)) return Piece::Whole;
    if (!convex_hole) return Piece::None;
    const double floor_z = -std::min(plate.bore_depth, plate.height);
    const double others = std::min({-plate.chamfer - m.z(), m.z() - floor_z, 0.5 * plate.width - std::abs(m.x()),
                                    0.5 * plate.depth - std::abs(m.y())});
    return std::abs(holeDistance(plate, m, 0.0)) + 2.0 * r <= others ? Piece::Hole : Piece::None;
}

template <class Convex>
Piece pieceAround(const Convex&, const Vec3&, double) {
    return Piece::Whole;
}
Piece pieceAround(const shape::Torus&, const Vec3&, double) { return Piece::None; }
Piece pieceAround(const shape::ThreadBolt&, const Vec3&, double) { return Piece::None; }
Piece pieceAround(const shape::ThreadNut&, const Vec3&, double) { return Piece::None; }
Piece pieceAround(const shape::KeyedPeg&, const Vec3&, double) { return Piece::None; }
Piece pieceAround(const shape::BorePlate& s, const Vec3& m, double r) { return pieceOf(s, m, r, true); }
Piece pieceAround(const shape::SquareBorePlate& s, const Vec3& m, double r) { return pieceOf(s, m, r, true); }
Piece pieceAround(const shape::KeyedBorePlate& s, const Vec3& m, double r) { return pieceOf(s, m, r, false); }

/// ψ of the piece.
template <class Convex>
double pieceDistance(const Convex& shape, Piece, const Vec3& p) {
    return shape::signedDistance(shape, p);
}
template <class Plate>
double plateDistance(const Plate& plate, Piece piece, const Vec3& p) {
    return piece == Piece::Whole ? boxDistance(plate, p) : holeDistance(plate, p, 0.0);
}
double pieceDistance(const shape::BorePlate& s, Piece piece, const Vec3& p) { return plateDistance(s, piece, p); }
double pieceDistance(const shape::SquareBorePlate& s, Piece piece, const Vec3& p) { return plateDistance(s, piece, p); }
double pieceDistance(const shape::KeyedBorePlate& s, Piece piece, const Vec3& p) { return plateDistance(s, piece, p); }

/// A cell with exact values at its corners.
struct Cube {
    Vec3 low;
    double cell;
    CornerValues phi;

    Cube(const SurfaceBlock& block, const Vec3& block_low, double edge, const std::array<int, 3>& at)
        : low(block_low + edge * Vec3(at[0], at[1], at[2])), cell(edge) {
        constexpr std::size_t kRow = SurfaceBlock::kNodes, kSlab = kRow * kRow;
        const auto first =
            static_cast<std::size_t>((at[2] * SurfaceBlock::kNodes + at[1]) * SurfaceBlock::kNodes + at[0]);
        for (std::size_t i = 0; i < 8; ++i)
            phi[i] = block.node[first + (i & 1) + (i >> 1 & 1) * kRow + (i >> 2) * kSlab];
    }
    double least() const {
        double least = std::abs(phi[0]);
        for (const double value : phi) least = std::min(least, std::abs(value));
        return least;
    }
    Vec3 middle() const { return low + Vec3::Constant(0.5 * cell); }
    Vec3 slope() const { return trilinearSlope(phi, Vec3::Constant(0.5)) / cell; }

    /// How far the cone with the value `tip` at o stands off at the corners; `side` = 1: from above; -1: from below;
    /// `sign`: of the values that it bounds.
    double gap(double tip, const Vec3& o, double side, double sign) const {
        double most = 0.0;
        for (std::size_t i = 0; i < 8; ++i)
            most = std::max(most, side * (tip - sign * phi[i]) + (low + cell * cornerAt(i) - o).norm());
        return most;
    }
};

/// The radius that promises the least for a cell around `m` with the unit gradient `up`, in cells.
double bestRadius(const shape::Shape& shape, const Vec3& m, const Vec3& up, double side, double cell) {
    const double at_m = shape::signedDistance(shape, m);
    double best = kFirstRadius, least = 1.0, radius = kFirstRadius;
    for (int i = 0; i < kRadii; ++i, radius *= 2.0) {
        const double lost = side * (shape::signedDistance(shape, m - side * radius * cell * up) - at_m) / cell + radius;
        if (lost > least) break;
        const double promised = lost + kHalfSquare / radius;
        if (promised >= least) continue;
        least = promised;
        best = radius;
    }
    return best;
}

/// One octant; remembers the radii.
class OctantBound {
public:
    OctantBound(const shape::Shape& shape, double cell) : shape_(shape), cell_(cell) {}

    double of(const Cube& cube) {
        const Vec3 slope = cube.slope();
        const double steepness = slope.norm();
        if (!(steepness > kLeastSlope)) return cell_;
        const Vec3 m = cube.middle(), up = slope / steepness;
        const double reach = 0.87 * cell_;  // half the diagonal
        const Piece piece = std::visit([&](const auto& s) { return pieceAround(s, m, reach); }, shape_);
        if (piece != Piece::None) return ofConvex(cube, piece, piece == Piece::Hole ? -1.0 : 1.0, up);
        return std::max(ofCone(cube, 0, 1.0, up), ofCone(cube, 1, -1.0, up));
    }

private:
    double ofConvex(const Cube& cube, Piece piece, double sign, const Vec3& up) const {
        double least = cell_;
        for (const double radius : kOutside) {
            const Vec3 o = cube.middle() + sign * radius * cell_ * up;
            const double tip = std::visit([&](const auto& s) { return pieceDistance(s, piece, o); }, shape_);
            least = std::min(least, cube.gap(tip, o, -1.0, sign));
        }
        return least;
    }

    double ofCone(const Cube& cube, std::size_t s, double side, const Vec3& up) {
        if (radius_[s] == 0.0) radius_[s] = bestRadius(shape_, cube.middle(), up, side, cell_);
        const auto gap = [&](double radius) {
            const Vec3 o = cube.middle() - side * radius * cell_ * up;
            return cube.gap(shape::signedDistance(shape_, o), o, side, 1.0);
        };
        const double found = gap(radius_[s]);
        if (found <= kDisappoints * kHalfSquare / radius_[s] * cell_) return found;
        return std::min(found, gap(bestRadius(shape_, cube.middle(), up, side, cell_)));
    }

    const shape::Shape& shape_;
    double cell_;
    std::array<double, 2> radius_{};  // from above, from below; in cells
};

}  // namespace

double boundInterpolation(const shape::Shape& shape, const SurfaceBlock& block, const Vec3& low, double cell,
                          std::size_t octant, double reach) {
    std::array<int, 3> first{};
    for (unsigned axis = 0; axis < 3; ++axis) first[axis] = (octant >> axis & 1u) != 0 ? kHalf : 0;
    const auto cubeAt = [&](int k) {
        return Cube(block, low, cell,
                    {first[0] + k % kHalf, first[1] + k / kHalf % kHalf, first[2] + k / (kHalf * kHalf)});
    };
    // Begin at the surface, where there is most room for cones.
    int nearest = 0;
    for (int k = 1; k < kCubes; ++k)
        if (cubeAt(k).least() < cubeAt(nearest).least()) nearest = k;
    OctantBound bound(shape, cell);
    double most = 0.0;
    for (int i = 0; i < kCubes && most < cell; ++i) {
        const Cube cube = cubeAt((nearest + i) % kCubes);
        if (cube.least() <= reach) most = std::max(most, bound.of(cube));
    }
    return most + kRounding * cell;
}

}  // namespace passung::field
