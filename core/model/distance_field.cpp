#include "core/model/distance_field.h"

#include <algorithm>
#include <cmath>

#include "core/model/parallel.h"

namespace passung::model {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{2} << 30;
constexpr double kFloatRounding = 1e-8;  // [m], of a distance below 0.1 m stored as a float, with a margin

/// Weight of each corner (bit 0: x, bit 1: y, bit 2: z) at the local coordinates u in [0, 1]³.
std::array<double, 8> trilinearWeights(const Vec3& u) {
    std::array<double, 8> w{};
    for (int i = 0; i < 8; ++i) {
        w[static_cast<std::size_t>(i)] =
            ((i & 1) ? u.x() : 1.0 - u.x()) * ((i & 2) ? u.y() : 1.0 - u.y()) * ((i & 4) ? u.z() : 1.0 - u.z());
    }
    return w;
}

/// The corner nearest to u, which is the centre of the thesis's voxel around the point.
unsigned nearestCorner(const Vec3& u) {
    return (u.x() > 0.5 ? 1u : 0u) | (u.y() > 0.5 ? 2u : 0u) | (u.z() > 0.5 ? 4u : 0u);
}

/// The thesis's V_I as weights of four corners: value at the nearest one and one-sided differences to its three
/// neighbours on the point's side. (Sagardia 2019, eqs. 3.28-3.29, with V = -φ.)
std::array<double, 8> oneSidedWeights(const Vec3& u) {
    std::array<double, 8> w{};
    const unsigned c = nearestCorner(u);
    w[c] = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const unsigned bit = 1u << axis;
        const double away = (c & bit) ? 1.0 - u[axis] : u[axis];  // in cells, towards the neighbour
        w[c ^ bit] += away;
        w[c] -= away;
    }
    return w;
}

}  // namespace

struct DistanceField::Cell {
    std::array<double, 8> corner;  // φ, bit order as above
    Vec3 u;                        // local coordinates in [0, 1]³
    double edge;                   // [m]
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
    field.sampleCoarse(source);
    field.sampleBricks(source, band);
    if (field.memoryBytes() > kMaxBytes) {
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
        double last_distance = 0.0;
        bool last_inside = false;
        for (int x = 0; x < nx; ++x) {
            const Vec3 p = origin_ + brick_edge_ * Vec3(x, y, z);
            const double d = source.distance(p);
            // A node farther from the surface than from its neighbour lies on the neighbour's side.
            bool inside = false;
            if (!source.open_sheet) inside = last_distance > brick_edge_ ? last_inside : source.inside(p);
            last_distance = d;
            last_inside = inside;
            coarse_[coarseNode(x, y, z)] = static_cast<float>((inside ? -d : d) - sheet_offset_);
        }
    });
}

void DistanceField::sampleBricks(const DistanceSource& source, double band) {
    brick_of_cell_.assign(static_cast<std::size_t>(coarse_cells_[0]) * static_cast<std::size_t>(coarse_cells_[1]) *
                              static_cast<std::size_t>(coarse_cells_[2]),
                          -1);
    const double half_diagonal = 0.5 * std::sqrt(3.0) * brick_edge_;
    std::vector<std::array<int, 3>> places;
    for (int z = 0; z < coarse_cells_[2]; ++z) {
        for (int y = 0; y < coarse_cells_[1]; ++y) {
            for (int x = 0; x < coarse_cells_[0]; ++x) {
                // The corner's distance bounds the centre's: ask for the exact one only where it can matter.
                const double corner = std::abs(static_cast<double>(coarse_[coarseNode(x, y, z)]) + sheet_offset_);
                if (corner > band + 2.0 * half_diagonal + kFloatRounding) continue;
                const Vec3 centre = origin_ + brick_edge_ * (Vec3(x, y, z) + Vec3::Constant(0.5));
                if (source.distance(centre) > band + sheet_offset_ + half_diagonal) continue;
                brick_of_cell_[coarseCell(x, y, z)] = static_cast<std::int32_t>(places.size());
                places.push_back({x, y, z});
            }
        }
    }
    bricks_.resize(places.size() * kBrickSamples);
    parallelFor(places.size(), [&](std::size_t b) {
        const auto& place = places[b];
        const Vec3 low = origin_ + brick_edge_ * Vec3(place[0], place[1], place[2]);
        std::size_t i = b * kBrickSamples;
        for (int z = 0; z < kBrickNodes; ++z) {
            for (int y = 0; y < kBrickNodes; ++y) {
                double last_distance = 0.0;
                bool last_inside = false;
                for (int x = 0; x < kBrickNodes; ++x, ++i) {
                    const Vec3 p = low + cell_ * Vec3(x, y, z);
                    const double d = source.distance(p);
                    bool inside = false;
                    if (!source.open_sheet) inside = last_distance > cell_ ? last_inside : source.inside(p);
                    last_distance = d;
                    last_inside = inside;
                    bricks_[i] = static_cast<float>((inside ? -d : d) - sheet_offset_);
                }
            }
        }
    });
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
    // Along x, then y, then z; the differences on the way are the gradient.
    const double x00 = c[0] + u.x() * (c[1] - c[0]), x10 = c[2] + u.x() * (c[3] - c[2]);
    const double x01 = c[4] + u.x() * (c[5] - c[4]), x11 = c[6] + u.x() * (c[7] - c[6]);
    const double y0 = x00 + u.y() * (x10 - x00), y1 = x01 + u.y() * (x11 - x01);
    const double dx0 = (c[1] - c[0]) + u.y() * ((c[3] - c[2]) - (c[1] - c[0]));
    const double dx1 = (c[5] - c[4]) + u.y() * ((c[7] - c[6]) - (c[5] - c[4]));
    const double dy0 = x10 - x00, dy1 = x11 - x01;
    return {y0 + u.z() * (y1 - y0), Vec3(dx0 + u.z() * (dx1 - dx0), dy0 + u.z() * (dy1 - dy0), y1 - y0) / cell.edge};
}

double DistanceField::lowerBound(const Vec3& p) const noexcept {
    Cell cell;
    if (!locate(p, cell)) return boxDistance(p) - sheet_offset_;
    const auto& c = cell.corner;
    const Vec3& u = cell.u;
    const double x00 = c[0] + u.x() * (c[1] - c[0]), x10 = c[2] + u.x() * (c[3] - c[2]);
    const double x01 = c[4] + u.x() * (c[5] - c[4]), x11 = c[6] + u.x() * (c[7] - c[6]);
    const double y0 = x00 + u.y() * (x10 - x00), y1 = x01 + u.y() * (x11 - x01);
    // Σ w_i |c_i - p| ≤ sqrt(Σ w_i |c_i - p|²) (Jensen) = edge · sqrt(Σ_axis u(1-u)): the corners' mean square
    // distance.
    const double variance = u.x() * (1.0 - u.x()) + u.y() * (1.0 - u.y()) + u.z() * (1.0 - u.z());
    return y0 + u.z() * (y1 - y0) - cell.edge * std::sqrt(variance) - kFloatRounding;
}

double DistanceField::errorBound(const Vec3& p, FieldMode mode) const noexcept {
    Cell cell;
    if (!locate(p, cell)) {
        // The true value lies between the distance to the part's box and the distance to its farthest corner.
        const Vec3 far = (p - surface_bounds_.low).cwiseAbs().cwiseMax((p - surface_bounds_.high).cwiseAbs());
        return far.norm() - boxDistance(p);
    }
    const auto w = mode == FieldMode::Linear ? oneSidedWeights(cell.u) : trilinearWeights(cell.u);
    double bound = 0.0;
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3 corner((i & 1) ? 1.0 : 0.0, (i & 2) ? 1.0 : 0.0, (i & 4) ? 1.0 : 0.0);
        bound += std::abs(w[i]) * (corner - cell.u).norm();
    }
    return bound * cell.edge + kFloatRounding;
}

}  // namespace passung::model
