#include <algorithm>
#include <cmath>
#include <limits>

#include "core/field/distance_field_builder.h"

/// Where a field must be refined.
namespace passung::field {

namespace {

constexpr double kDeepShare = 0.1;   // of φ: what may be wrong where nobody presses
constexpr double kDoubtShare = 0.5;  // of the allowed error: what second differences may claim without a measurement
constexpr int kMeasured = 3;         // points of a cell along each axis
constexpr double kMeasuredShare = 0.95;  // of the allowed error: between the measured points it may be more
constexpr double kCentreShare = 0.25;    // of that
constexpr double kLipschitzSlack = 1.01;
constexpr std::size_t kFewTriangles = 128;  // of a cell: of more a tree looks at few

}  // namespace

/// Octants whose cells are still too large, if they reach into the band.
std::array<double, 8> DistanceField::Builder::inBand(const Vec3& corner) const {
    std::array<double, 8> depth;
    depth.fill(std::numeric_limits<double>::infinity());
    if (cell < 1.5 * field.cell_) return depth;
    const double half = 0.5 * kBrickCells * cell, near = band + field.sheet_offset_ + 0.5 * std::sqrt(3.0) * half;
    for (std::size_t octant = 0; octant < 8; ++octant) {
        const Vec3 centre = corner + half * (cornerAt(octant) + Vec3::Constant(0.5));
        const double d = exact.unsignedWithin(centre, near);
        if (d <= near) depth[octant] = d;
    }
    return depth;
}

double DistanceField::Builder::allowed(double phi) const {
    const double depth = std::abs(phi);
    return depth <= accuracy.depth ? accuracy.tolerance : std::max(accuracy.tolerance, kDeepShare * depth);
}

/// Exact distance at `u` in a cell with its first corner at `origin`.
double DistanceField::Builder::distanceIn(const CornerValues& values, std::span<const std::uint32_t> triangles,
                                          const Vec3& origin, const Vec3& u) const {
    if (!triangles.empty() && triangles.size() <= kFewTriangles)
        return exact.source.distance_to(origin + cell * u, triangles);
    const unsigned near = nearestCorner(u);
    // The stored corner is rounded: a step is far below this share of a cell.
    const double way = cell * ((u - cornerAt(near)).norm() + 1e-3);
    return exact.unsignedWithin(origin + cell * u, std::abs(values[near] + field.sheet_offset_) + way);
}

/// How much the values bend at each node: the sum of the sizes of the second differences, at the border of the brick
/// those of the next node inside.
DistanceField::Builder::Nodes DistanceField::Builder::bends(const Nodes& nodes) {
    Nodes bend{};
    constexpr std::array<std::ptrdiff_t, 3> kStride{1, kBrickNodes, std::ptrdiff_t{kBrickNodes} * kBrickNodes};
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < kBrickSamples; ++i) {
            const auto at = static_cast<std::ptrdiff_t>(i) / kStride[axis] % kBrickNodes;
            const double* middle =
                &nodes[i] + (std::clamp<std::ptrdiff_t>(at, 1, kBrickCells - 1) - at) * kStride[axis];
            bend[i] += std::abs(*(middle - kStride[axis]) + *(middle + kStride[axis]) - 2.0 * *middle);
        }
    return bend;
}

/// What interpolation of a cell errs by at `u`, where the exact distance is d; 0 behind the offset of a sheet.
double DistanceField::Builder::errorOf(const CornerValues& values, const Vec3& u, double d) const {
    const double offset = field.sheet_offset_;
    if (d < offset) return 0.0;
    const double phi = trilinearValue(values, u);
    // The sign would cost more than the distance, and a wrong one does not hide behind equal amounts at all points.
    return offset > 0.0 ? std::abs(phi + offset - d) : std::abs(std::abs(phi) - d);
}

/// The least |φ| at the corners of a cell in which interpolation errs too much, or infinity.
double DistanceField::Builder::wrongDepth(const Nodes& nodes, const Nodes& bends, const SurfaceBlock& block,
                                          const Vec3& corner, int x, int y, int z) const {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    CornerValues values;
    double least = kNever, bend = 0.0;
    for (std::size_t i = 0; i < 8; ++i) {
        const std::size_t at =
            node(x + static_cast<int>(i & 1), y + static_cast<int>(i >> 1 & 1), z + static_cast<int>(i >> 2));
        values[i] = nodes[at];
        least = std::min(least, std::abs(values[i]));
        bend = std::max(bend, bends[at]);
    }
    // A kink between two nodes, the worst case, errs by a quarter of its jump in slope, of which either node sees half.
    if (0.5 * bend <= kDoubtShare * allowed(least)) return kNever;
    if (!field.bound_proven_) {
        const auto [low_value, high_value] = std::minmax_element(values.begin(), values.end());
        if (*high_value - *low_value > kLipschitzSlack * std::sqrt(3.0) * cell) return kNever;
    }
    const double limit = kMeasuredShare * allowed(least);
    const Vec3 origin = corner + cell * Vec3(x, y, z), middle = Vec3::Constant(0.5);
    const auto number = static_cast<std::size_t>((z * kBrickCells + y) * kBrickCells + x);
    const std::span<const std::uint32_t> triangles = block.trianglesOf(number);
    const double given = block.centre[number];
    const double centre =
        errorOf(values, middle, std::isnan(given) ? distanceIn(values, triangles, origin, middle) : given);
    if (centre > limit) return least;
    // The centre has the largest error of a smooth bend, a quarter of the largest of a kink that passes it by.
    if (centre <= kCentreShare * limit) return kNever;
    for (int i = 0; i < kMeasured * kMeasured * kMeasured; ++i) {
        const Vec3 u =
            (Vec3(i % kMeasured, i / kMeasured % kMeasured, i / (kMeasured * kMeasured)) + Vec3::Constant(0.5)) /
            kMeasured;
        if (errorOf(values, u, distanceIn(values, triangles, origin, u)) > limit) return least;
    }
    return kNever;
}

/// For each octant of a brick: |φ| where it errs too much, or infinity.
std::array<double, 8> DistanceField::Builder::measure(const Nodes& nodes, const SurfaceBlock& block,
                                                      const Vec3& corner) const {
    constexpr int kHalf = kBrickCells / 2;
    const Nodes bend = bends(nodes);
    std::array<double, 8> depth;
    for (std::size_t octant = 0; octant < 8; ++octant) {
        depth[octant] = std::numeric_limits<double>::infinity();
        for (int i = 0; i < kHalf * kHalf * kHalf && !std::isfinite(depth[octant]); ++i) {
            const int x = i % kHalf, y = i / kHalf % kHalf, z = i / (kHalf * kHalf);
            depth[octant] = wrongDepth(nodes, bend, block, corner, x + ((octant & 1) ? kHalf : 0),
                                       y + ((octant & 2) ? kHalf : 0), z + ((octant & 4) ? kHalf : 0));
        }
    }
    return depth;
}

/// Features smaller than a cell may slip between the nodes and the points of `wrongDepth`; their tips do not.
void DistanceField::Builder::measureLandmarks() {
    if (field.sheet_offset_ > 0.0 || accuracy.tolerance == 0.0) return;
    for (const Vec3& p : exact.source.landmarks) {
        const Vec3 g = (p - field.origin_) * field.inverse_brick_edge_;
        const Vec3 whole = g.array().floor();
        const std::int32_t root = field.brick_of_cell_[field.coarseCell(
            static_cast<int>(whole.x()), static_cast<int>(whole.y()), static_cast<int>(whole.z()))];
        if (root < 0) continue;
        const CellPlace place = field.descend(root, g - whole);
        if (place.brick < first) continue;
        if (std::abs(field.sample(p, FieldMode::Trilinear).phi) > accuracy.tolerance)
            wrong[place.brick - first][place.octant] = 0.0;
    }
}

}  // namespace passung::field
