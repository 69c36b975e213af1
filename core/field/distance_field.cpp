#include "core/field/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/single_precision.h"
#include "core/field/distance_field_modes.h"
#include "core/field/interpolation.h"
#include "core/geometry/parallel.h"

namespace passung::field {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSlackUnit = 1.0 / 255.0 * (1.0 + 0x1p-40);
constexpr double kStepRounding = 0.5 * (1.0 + 0x1p-20);  // of a value stored in a brick, in steps

/// Edge of a cell of each level over that of a brick of the first.
constexpr auto kCellEdge = [] {
    std::array<double, DistanceField::kMostLevels + 1> edge{};
    for (std::size_t level = 0; level < edge.size(); ++level)
        edge[level] = 1.0 / static_cast<double>(DistanceField::kBrickCells << level);
    return edge;
}();

}  // namespace

struct DistanceField::Cell : Spot {
    CornerValues stored;  // φ = low + step · stored

    double corner(std::size_t i) const noexcept { return low + step * stored[i]; }
};

std::size_t DistanceField::coarseNode(int x, int y, int z) const noexcept {
    const auto nx = static_cast<std::size_t>(coarse_cells_[0] + 1);
    const auto ny = static_cast<std::size_t>(coarse_cells_[1] + 1);
    return (static_cast<std::size_t>(z) * ny + static_cast<std::size_t>(y)) * nx + static_cast<std::size_t>(x);
}

std::size_t DistanceField::coarseCell(int x, int y, int z) const noexcept {
    const auto nx = static_cast<std::size_t>(coarse_cells_[0]);
    const auto ny = static_cast<std::size_t>(coarse_cells_[1]);
    return (static_cast<std::size_t>(z) * ny + static_cast<std::size_t>(y)) * nx + static_cast<std::size_t>(x);
}

std::size_t DistanceField::memoryBytes() const {
    return coarse_.size() * sizeof(float) + brick_of_cell_.size() * sizeof(std::int32_t) +
           bricks_.size() * (sizeof(Brick) + sizeof(Slacks) + sizeof(Head)) + samples_.size() * sizeof(std::uint16_t) +
           index_.brick.size() * sizeof(std::int32_t);
}

double DistanceField::boxDistance(const Vec3& p) const noexcept {
    return (surface_bounds_.low - p).cwiseMax(p - surface_bounds_.high).cwiseMax(0.0).norm();
}

DistanceField::CellPlace DistanceField::descend(std::int32_t root, const Vec3& in_root) const noexcept {
    // The place in cells of the last level that may be; those of a level above are its leading bits, exactly.
    constexpr int kBits = 3 + kMostLevels;
    constexpr double kPlaces = 1 << kBits;
    const auto x = static_cast<unsigned>(static_cast<int>(in_root.x() * kPlaces));
    const auto y = static_cast<unsigned>(static_cast<int>(in_root.y() * kPlaces));
    const auto z = static_cast<unsigned>(static_cast<int>(in_root.z() * kPlaces));
    CellPlace place{static_cast<std::size_t>(root), 0, 0, {}};
    for (; place.level < kMostLevels; ++place.level) {
        const int bit = kBits - 1 - place.level;
        place.octant = (x >> bit & 1u) | (y >> bit & 1u) << 1 | (z >> bit & 1u) << 2;
        const std::int32_t child = bricks_[place.brick].child[place.octant];
        if (child < 0) break;
        place.brick = static_cast<std::size_t>(child);
    }
    const int shift = kMostLevels - place.level;
    place.cell = {static_cast<int>(x >> shift), static_cast<int>(y >> shift), static_cast<int>(z >> shift)};
    return place;
}

bool DistanceField::find(const Vec3& p, Spot& spot) const noexcept {
    const Vec3 g = (p - origin_) * inverse_brick_edge_;
    // A NaN is outside too.
    if (!(g.x() >= 0.0 && g.x() < coarse_cells_[0] && g.y() >= 0.0 && g.y() < coarse_cells_[1] && g.z() >= 0.0 &&
          g.z() < coarse_cells_[2]))
        return false;
    const int gx = static_cast<int>(g.x()), gy = static_cast<int>(g.y()), gz = static_cast<int>(g.z());
    const Vec3 in_root = g - Vec3(gx, gy, gz);
    const std::int32_t root = brick_of_cell_[coarseCell(gx, gy, gz)];
    if (root < 0) {
        spot.u = in_root;
        spot.edge = brick_edge_;
        spot.inverse_edge = inverse_brick_edge_;
        spot.low = 0.0;
        spot.step = 1.0;
        spot.slack = 1.0;
        spot.most = kInfinity;
        spot.in_brick = false;
        spot.at = {gx, gy, gz};
        spot.cells = coarse_cells_;
        spot.first = 0;
        return true;
    }
    const CellPlace place = descend(root, in_root);
    const double cells = static_cast<double>(kBrickCells << place.level);  // along the root's edge
    const auto [x, y, z] = place.cell;
    spot.u = in_root * cells - Vec3(x, y, z);
    spot.inverse_edge = inverse_brick_edge_ * cells;
    spot.edge = kCellEdge[static_cast<std::size_t>(place.level)] * brick_edge_;
    const Brick& brick = bricks_[place.brick];
    spot.low = brick.low;
    spot.step = brick.step;
    const double slack = kSlackUnit * slacks_[place.brick][place.octant];
    spot.slack = bounded_within_ >= 0.0 ? 1.0 : slack;
    spot.most = bounded_within_ >= 0.0 ? slack * slack * spot.edge : kInfinity;
    spot.in_brick = true;
    constexpr int kIn = kBrickCells - 1;
    spot.at = {x & kIn, y & kIn, z & kIn};
    spot.cells = {kBrickCells, kBrickCells, kBrickCells};
    spot.first = place.brick;
    return true;
}

bool DistanceField::locate(const Vec3& p, Cell& cell) const noexcept {
    if (!find(p, cell)) return false;
    const auto [x, y, z] = cell.at;
    if (!cell.in_brick) {
        const float* data = coarse_.data() + coarseNode(x, y, z);
        const auto row = static_cast<std::size_t>(coarse_cells_[0] + 1);
        const std::size_t slab = row * static_cast<std::size_t>(coarse_cells_[1] + 1);
        for (std::size_t i = 0; i < 8; ++i)
            cell.stored[i] = static_cast<double>(data[(i & 1) + ((i >> 1) & 1) * row + (i >> 2) * slab]);
        return true;
    }
    constexpr std::size_t kRow = kBrickNodes, kSlab = kRow * kBrickNodes;
    const std::uint16_t* data = samples_.data() + cell.first * kBrickSamples +
                                static_cast<std::size_t>((z * kBrickNodes + y) * kBrickNodes + x);
    for (std::size_t i = 0; i < 8; ++i)
        cell.stored[i] = static_cast<int>(data[(i & 1) + ((i >> 1) & 1) * kRow + (i >> 2) * kSlab]);
    return true;
}

FieldSample DistanceField::sampleOutside(const Vec3& p) const noexcept {
    const Vec3 nearest = p.cwiseMax(surface_bounds_.low).cwiseMin(surface_bounds_.high);
    const double d = boxDistance(p);
    return {d - sheet_offset_, d > 0.0 ? Vec3((p - nearest) / d) : Vec3(Vec3::Zero())};
}

FieldSample DistanceField::sampleAt(const Spot& spot, FieldMode mode, const Vec3& inward) const noexcept {
    if (spot.in_brick)
        return Lattice<std::uint16_t>(samples_.data() + spot.first * kBrickSamples, spot).sample(mode, inward);
    return Lattice<float>(coarse_.data(), spot).sample(mode, inward);
}

[[gnu::flatten]] FieldSample DistanceField::sample(const Vec3& p, FieldMode mode, const Vec3& inward) const noexcept {
    if (mode != FieldMode::Trilinear) {
        Spot spot;
        return find(p, spot) ? sampleAt(spot, mode, inward) : sampleOutside(p);
    }
    Cell cell;
    if (!locate(p, cell)) return sampleOutside(p);
    return {cell.low + cell.step * trilinearValue(cell.stored, cell.u),
            trilinearSlope(cell.stored, cell.u) * (cell.step * cell.inverse_edge)};
}

/// The number that holds a corner is off by half a unit in its last place, a weighted mean by no more.
double DistanceField::rounding(const Cell& cell) const noexcept {
    if (cell.in_brick) return kStepRounding * cell.step + arithmetic_;
    double largest = 0.0;
    for (const double c : cell.stored) largest = std::max(largest, std::abs(c));
    return kFloatRounding * largest + arithmetic_;
}

/// An upper bound of the unsigned distance from the cell's point to the surface: that of each corner and the way there.
double DistanceField::farthestSurface(const Cell& cell) const noexcept {
    double nearest = kInfinity;
    for (std::size_t i = 0; i < 8; ++i)
        nearest = std::min(nearest, std::abs(cell.corner(i)) + cell.edge * (cornerAt(i) - cell.u).norm());
    return nearest + rounding(cell);
}

/// Of the interpolant `phi`, but for rounding, where the corners are `way` away on average; see errorBound.
double DistanceField::bound(const Cell& cell, double way, double phi) const noexcept {
    const double by_slack = cell.slack * way;
    return std::abs(phi) <= bounded_within_ ? std::min(by_slack, cell.most) : by_slack;
}

[[gnu::flatten]] double DistanceField::lowerBound(const Vec3& p) const noexcept {
    Cell cell;
    if (!locate(p, cell)) return boxDistance(p) - sheet_offset_ - arithmetic_;
    if (!bound_proven_) return -farthestSurface(cell);
    const CornerValues w = trilinearWeights(cell.u);
    const double off = rounding(cell);
    double mean = 0.0, mean_square = 0.0;
    for (std::size_t i = 0; i < 8; ++i) {
        const double d = std::max(0.0, cell.corner(i) + sheet_offset_ - off);
        mean += w[i] * cell.corner(i);
        mean_square += w[i] * d * d;
    }
    const Vec3& u = cell.u;
    const double spread = cell.edge * cell.edge * u.cwiseProduct(Vec3::Ones() - u).sum();
    const double near = mean - bound(cell, std::sqrt(spread), mean) - off;
    const double far = mean_square * (1.0 - 1e-12) - spread;
    return far > 0.0 ? std::max(near, std::sqrt(far) - sheet_offset_ - arithmetic_) : near;
}

double DistanceField::errorBound(const Vec3& p, FieldMode mode) const noexcept {
    Cell cell;
    if (!locate(p, cell)) {
        // The true value lies between the distance to the part's box and the distance to its farthest corner.
        const Vec3 far = (p - surface_bounds_.low).cwiseAbs().cwiseMax((p - surface_bounds_.high).cwiseAbs());
        return far.norm() - boxDistance(p) + arithmetic_;
    }
    // Of the projection of layered values, on a normal that is not known here.
    const double aside =
        mode == FieldMode::Layered ? cell.edge * (cornerAt(nearestCorner(cell.u)) - cell.u).norm() : 0.0;
    if (!bound_proven_) return std::abs(sample(p, mode).phi) + aside + farthestSurface(cell);
    if (mode == FieldMode::Layered) return 0.5 * cell.edge + 2.0 * aside + rounding(cell);
    const CornerValues w = trilinearWeights(cell.u);
    double ways = 0.0;
    for (std::size_t i = 0; i < 8; ++i) ways += w[i] * (cornerAt(i) - cell.u).norm();
    const double trilinear = cell.low + cell.step * trilinearValue(cell.stored, cell.u);
    const double of_trilinear = bound(cell, cell.edge * ways, trilinear) + rounding(cell);
    if (mode == FieldMode::Trilinear) return of_trilinear;
    return of_trilinear + std::abs(sample(p, mode).phi - trilinear) + arithmetic_;
}

}  // namespace passung::field
