#include "core/model/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/model/interpolation.h"
#include "core/model/parallel.h"

namespace passung::model {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{2} << 30;
constexpr double kFloatRounding = 0x1p-24 * (1.0 + 0x1p-20);  // of a value stored as a float, relative
constexpr double kArithmetic = 0x1p-45;  // 128 roundings of a coordinate: far more than a query makes

/// φ less `offset` at `count` nodes that follow each other by `step` along x.
void sampleRow(const DistanceSource& source, const Vec3& first, double step, int count, double offset, float* row) {
    double last_distance = 0.0;
    bool inside = false;
    for (int x = 0; x < count; ++x) {
        const Vec3 p = first + step * Vec3(x, 0.0, 0.0);
        const double d = source.distance(p);
        // On closed geometry a node farther from the surface than from its neighbour lies on the neighbour's side.
        const bool same_side = source.closed && last_distance > step;
        if (!source.open_sheet && !same_side) inside = source.inside(p);
        last_distance = d;
        row[x] = static_cast<float>((inside ? -d : d) - offset);
    }
}

}  // namespace

struct DistanceField::Cell {
    Corners corner;  // φ
    Vec3 u;          // local coordinates in [0, 1]³
    double edge;     // [m]
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

Result<DistanceField> DistanceField::build(const DistanceSource& source, double cell, double band) {
    DistanceField field;
    field.surface_bounds_ = source.bounds;
    field.cell_ = cell;
    field.brick_edge_ = cell * kBrickCells;
    field.inverse_brick_edge_ = 1.0 / field.brick_edge_;
    // Between the two sides of a sheet the distance has a kink that interpolation cannot show: keep the zero level
    // one cell in front of it.
    field.sheet_offset_ = source.open_sheet ? cell : 0.0;
    field.bound_proven_ = source.closed || source.open_sheet;

    const double margin = source.bounds.size().maxCoeff() + band + field.brick_edge_;
    field.origin_ = source.bounds.low - Vec3::Constant(margin);
    double nodes = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double cells =
            std::ceil((source.bounds.size()[static_cast<int>(axis)] + 2.0 * margin) * field.inverse_brick_edge_);
        nodes *= cells + 1.0;
        if (nodes * 8.0 > static_cast<double>(kMaxBytes)) {
            return Error{.message = "the distance field would need more than 2 GiB: choose larger cells"};
        }
        field.coarse_cells_[axis] = static_cast<int>(cells);
    }
    const Vec3 reach = field.origin_.cwiseAbs().cwiseMax((source.bounds.high + Vec3::Constant(margin)).cwiseAbs());
    field.arithmetic_ = kArithmetic * (reach.maxCoeff() + field.brick_edge_);
    field.sampleCoarse(source);
    if (!field.sampleBricks(source, band)) {
        return Error{.message = "the distance field needs more than 2 GiB: choose larger cells"};
    }
    return field;
}

void DistanceField::sampleCoarse(const DistanceSource& source) {
    const int nx = coarse_cells_[0] + 1, ny = coarse_cells_[1] + 1, nz = coarse_cells_[2] + 1;
    coarse_.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz));
    parallelFor(static_cast<std::size_t>(nz) * static_cast<std::size_t>(ny), [&](std::size_t row) {
        const int y = static_cast<int>(row % static_cast<std::size_t>(ny));
        const int z = static_cast<int>(row / static_cast<std::size_t>(ny));
        sampleRow(source, origin_ + brick_edge_ * Vec3(0.0, y, z), brick_edge_, nx, sheet_offset_,
                  &coarse_[coarseNode(0, y, z)]);
    });
}

bool DistanceField::sampleBricks(const DistanceSource& source, double band) {
    brick_of_cell_.assign(static_cast<std::size_t>(coarse_cells_[0]) * static_cast<std::size_t>(coarse_cells_[1]) *
                              static_cast<std::size_t>(coarse_cells_[2]),
                          -1);
    const double half_diagonal = 0.5 * std::sqrt(3.0) * brick_edge_;
    const std::size_t most = (kMaxBytes - std::min(kMaxBytes, memoryBytes())) / (kBrickSamples * sizeof(float));
    std::vector<std::array<int, 3>> places;
    for (int z = 0; z < coarse_cells_[2]; ++z) {
        for (int y = 0; y < coarse_cells_[1]; ++y) {
            for (int x = 0; x < coarse_cells_[0]; ++x) {
                // The corner's distance bounds the centre's: ask for the exact one only where it can matter.
                const double corner = std::abs(static_cast<double>(coarse_[coarseNode(x, y, z)]) + sheet_offset_);
                if (corner * (1.0 - kFloatRounding) > band + sheet_offset_ + 2.0 * half_diagonal) continue;
                const Vec3 centre = origin_ + brick_edge_ * (Vec3(x, y, z) + Vec3::Constant(0.5));
                if (source.distance(centre) > band + sheet_offset_ + half_diagonal) continue;
                if (places.size() == most) return false;
                brick_of_cell_[coarseCell(x, y, z)] = static_cast<std::int32_t>(places.size());
                places.push_back({x, y, z});
            }
        }
    }
    bricks_.resize(places.size() * kBrickSamples);
    parallelFor(places.size(), [&](std::size_t b) {
        const auto& place = places[b];
        const Vec3 low = origin_ + brick_edge_ * Vec3(place[0], place[1], place[2]);
        for (int row = 0; row < kBrickNodes * kBrickNodes; ++row) {
            const Vec3 first = low + cell_ * Vec3(0.0, row % kBrickNodes, row / kBrickNodes);
            sampleRow(source, first, cell_, kBrickNodes, sheet_offset_,
                      &bricks_[b * kBrickSamples + static_cast<std::size_t>(row * kBrickNodes)]);
        }
    });
    return true;
}

std::size_t DistanceField::memoryBytes() const {
    return coarse_.size() * sizeof(float) + brick_of_cell_.size() * sizeof(std::int32_t) +
           bricks_.size() * sizeof(float);
}

double DistanceField::boxDistance(const Vec3& p) const noexcept {
    return (surface_bounds_.low - p).cwiseMax(p - surface_bounds_.high).cwiseMax(0.0).norm();
}

bool DistanceField::locate(const Vec3& p, Cell& cell) const noexcept {
    const Vec3 g = (p - origin_) * inverse_brick_edge_;
    std::array<int, 3> c{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        if (!(g[axis] >= 0.0 && g[axis] < coarse_cells_[a])) return false;  // a NaN is outside too
        c[a] = static_cast<int>(g[axis]);
    }
    const Vec3 in_brick = g - Vec3(c[0], c[1], c[2]);
    const std::int32_t brick = brick_of_cell_[coarseCell(c[0], c[1], c[2])];
    const float* data = nullptr;
    std::size_t row = 0, slab = 0;
    if (brick < 0) {
        cell.u = in_brick;
        cell.edge = brick_edge_;
        data = coarse_.data() + coarseNode(c[0], c[1], c[2]);
        row = static_cast<std::size_t>(coarse_cells_[0] + 1);
        slab = row * static_cast<std::size_t>(coarse_cells_[1] + 1);
    } else {
        const Vec3 f = in_brick * kBrickCells;
        const int x = std::min(static_cast<int>(f.x()), kBrickCells - 1);
        const int y = std::min(static_cast<int>(f.y()), kBrickCells - 1);
        const int z = std::min(static_cast<int>(f.z()), kBrickCells - 1);
        cell.u = f - Vec3(x, y, z);
        cell.edge = cell_;
        row = kBrickNodes;
        slab = std::size_t{kBrickNodes} * kBrickNodes;
        data = bricks_.data() + static_cast<std::size_t>(brick) * kBrickSamples + static_cast<std::size_t>(z) * slab +
               static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
    }
    for (std::size_t i = 0; i < 8; ++i) {
        cell.corner[i] = static_cast<double>(data[(i & 1) + ((i >> 1) & 1) * row + (i >> 2) * slab]);
    }
    return true;
}

FieldSample DistanceField::sample(const Vec3& p, FieldMode mode) const noexcept {
    Cell cell;
    if (!locate(p, cell)) {
        const Vec3 nearest = p.cwiseMax(surface_bounds_.low).cwiseMin(surface_bounds_.high);
        const double d = boxDistance(p);
        return {d - sheet_offset_, d > 0.0 ? Vec3((p - nearest) / d) : Vec3(Vec3::Zero())};
    }
    const auto& c = cell.corner;
    const Vec3& u = cell.u;
    if (mode == FieldMode::Linear) {
        const unsigned n = nearestCorner(u);
        FieldSample s{c[n], Vec3::Zero()};
        for (int axis = 0; axis < 3; ++axis) {
            const unsigned bit = 1u << axis;
            const double sign = (n & bit) ? -1.0 : 1.0;
            const double slope = sign * (c[n ^ bit] - c[n]);  // per cell
            s.phi += slope * (u[axis] - ((n & bit) ? 1.0 : 0.0));
            s.gradient[axis] = slope / cell.edge;
        }
        return s;
    }
    return {trilinearValue(c, u), trilinearSlope(c, u) / cell.edge};
}

/// The float that holds a corner is off by half a unit in its last place, the weighted sum by the weighted sum of that.
double DistanceField::rounding(const Cell& cell, double weights) const noexcept {
    double largest = 0.0;
    for (const double c : cell.corner) largest = std::max(largest, std::abs(c));
    return kFloatRounding * weights * largest + arithmetic_;
}

/// An upper bound of the unsigned distance from the cell's point to the surface: that of each corner and the way there.
double DistanceField::farthestSurface(const Cell& cell) const noexcept {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 8; ++i)
        nearest = std::min(nearest, std::abs(cell.corner[i]) + cell.edge * (cornerAt(i) - cell.u).norm());
    return nearest + rounding(cell, 1.0);
}

double DistanceField::lowerBound(const Vec3& p) const noexcept {
    Cell cell;
    if (!locate(p, cell)) return boxDistance(p) - sheet_offset_ - arithmetic_;
    if (!bound_proven_) return -farthestSurface(cell);
    const Corners w = trilinearWeights(cell.u);
    const double off = rounding(cell, 1.0);
    double mean = 0.0, mean_square = 0.0;
    for (std::size_t i = 0; i < 8; ++i) {
        const double d = std::max(0.0, cell.corner[i] + sheet_offset_ - off);
        mean += w[i] * cell.corner[i];
        mean_square += w[i] * d * d;
    }
    const Vec3& u = cell.u;
    const double spread = cell.edge * cell.edge * u.cwiseProduct(Vec3::Ones() - u).sum();
    const double near = mean - std::sqrt(spread) - off;
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
    if (!bound_proven_) return std::abs(sample(p, mode).phi) + farthestSurface(cell);
    const Corners w = mode == FieldMode::Linear ? oneSidedWeights(cell.u) : trilinearWeights(cell.u);
    double bound = 0.0, weights = 0.0;
    for (std::size_t i = 0; i < 8; ++i) {
        bound += std::abs(w[i]) * (cornerAt(i) - cell.u).norm();
        weights += std::abs(w[i]);
    }
    return bound * cell.edge + rounding(cell, weights);
}

}  // namespace passung::model
