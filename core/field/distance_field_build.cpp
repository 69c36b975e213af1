#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include "core/base/single_precision.h"
#include "core/field/distance_field_builder.h"
#include "core/field/interpolation.h"
#include "core/geometry/parallel.h"

namespace passung::field {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{2} << 30;
constexpr double kEverywhere = 1e30;        // [m]
constexpr double kSinglePrecision = 1.001;  // more than what sampleMany errs by
constexpr double kArithmetic = 0x1p-45;     // 128 roundings of a coordinate: far more than a query makes
constexpr double kLargestStored = 65535.0;
constexpr std::size_t kTellings = 100;  // of a level

}  // namespace

Result<DistanceField> DistanceField::build(const DistanceSource& source, double cell, double band,
                                           const FieldAccuracy& accuracy) {
    constexpr const char* kTooLarge = "the distance field would need more than 2 GiB: choose larger cells";
    // A brick seldom holds four times its face of the surface: refuse at once what would be refused after minutes.
    const double edge = kBrickCells * cell;
    if (accuracy.tolerance == 0.0 && source.area / (4.0 * edge * edge) * kBrickBytes > kMaxBytes)
        return Error{.message = kTooLarge};
    DistanceField field;
    field.surface_bounds_ = source.bounds;
    field.cell_ = cell;
    field.largest_cell_ = field.finest_cell_ = accuracy.largest_cell > 0.0 ? accuracy.largest_cell : cell;
    field.brick_edge_ = field.largest_cell_ * kBrickCells;
    field.inverse_brick_edge_ = 1.0 / field.brick_edge_;
    // Between the two sides of a sheet the distance has a kink that interpolation cannot show: keep the zero level
    // one cell in front of it.
    field.sheet_offset_ = source.open_sheet ? cell : 0.0;
    field.bound_proven_ = source.closed || source.open_sheet;
    if (source.error_bound)
        field.bounded_within_ = source.open_sheet || accuracy.tolerance == 0.0 ? kEverywhere : accuracy.depth;

    // Whole bricks, so that the faces of a part whose sides measure whole bricks coincide with those of cells: then the
    // ridges of the distance, at 45° to the faces, are diagonals of cells and meet the fewest.
    const double beyond = accuracy.reach > 0.0 ? accuracy.reach : source.bounds.size().maxCoeff();
    const double margin = std::ceil((beyond + band) * field.inverse_brick_edge_ + 1.0) * field.brick_edge_;
    field.origin_ = source.bounds.low - Vec3::Constant(margin);
    double nodes = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double cells =
            std::ceil((source.bounds.size()[static_cast<int>(axis)] + 2.0 * margin) * field.inverse_brick_edge_);
        nodes *= cells + 1.0;
        if (nodes * 8.0 > static_cast<double>(kMaxBytes)) {
            return Error{.message = kTooLarge};
        }
        field.coarse_cells_[axis] = static_cast<int>(cells);
    }
    const Vec3 reach = field.origin_.cwiseAbs().cwiseMax((source.bounds.high + Vec3::Constant(margin)).cwiseAbs());
    field.arithmetic_ = kArithmetic * (reach.maxCoeff() + field.brick_edge_);

    Builder builder{.field = field, .exact = {source}, .accuracy = accuracy, .band = band};
    builder.sampleCoarse();
    builder.placeBricks();
    if (field.memoryBytes() + builder.low.size() * kBrickBytes > kMaxBytes) return Error{.message = kTooLarge};
    builder.sampleLevel();
    while (builder.level < kMostLevels && builder.refine()) {
    }
    if (!field.refined_ && accuracy.tolerance == 0.0) {
        return Error{.message = kTooLarge};
    }
    field.fillIndex();
    field.measureChange();
    return field;
}

void DistanceField::Builder::sampleCoarse() {
    const auto& cells = field.coarse_cells_;
    const int nx = cells[0] + 1, ny = cells[1] + 1, nz = cells[2] + 1;
    field.coarse_.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz));
    const double edge = field.brick_edge_;
    geometry::parallelFor(static_cast<std::size_t>(nz) * static_cast<std::size_t>(ny), [&](std::size_t row) {
        const int y = static_cast<int>(row % static_cast<std::size_t>(ny));
        const int z = static_cast<int>(row / static_cast<std::size_t>(ny));
        const Vec3 start = field.origin_ + edge * Vec3(0.0, y, z);
        float* nodes = &field.coarse_[field.coarseNode(0, y, z)];
        double phi = exact.at(start);
        Vec3 nearest = start;
        if (exact.source.nearest_within) nearest = exact.source.nearest_within(start, 2.0 * std::abs(phi) + edge).point;
        for (int x = 0; x < nx; ++x) {
            if (x > 0) phi = exact.along(start + edge * Vec3(x, 0.0, 0.0), phi, edge, nearest);
            nodes[x] = static_cast<float>(phi - field.sheet_offset_);
        }
    });
}

void DistanceField::Builder::placeBricks() {
    const auto& cells = field.coarse_cells_;
    const double edge = field.brick_edge_, half_diagonal = 0.5 * std::sqrt(3.0) * edge;
    const double near = band + field.sheet_offset_ + half_diagonal;
    field.brick_of_cell_.assign(
        static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) * static_cast<std::size_t>(cells[2]),
        -1);
    const auto lowOf = [&](int x, int y, int z) { return Vec3(field.origin_ + edge * Vec3(x, y, z)); };
    const auto rows = static_cast<std::size_t>(cells[1]) * static_cast<std::size_t>(cells[2]);
    geometry::parallelFor(rows, [&](std::size_t row) {
        const int y = static_cast<int>(row % static_cast<std::size_t>(cells[1]));
        const int z = static_cast<int>(row / static_cast<std::size_t>(cells[1]));
        for (int x = 0; x < cells[0]; ++x) {
            // The corner's distance bounds the centre's: ask for the exact one only where it can matter.
            const double stored = static_cast<double>(field.coarse_[field.coarseNode(x, y, z)]);
            const double corner = std::abs(stored + field.sheet_offset_);
            if (corner * (1.0 - kFloatRounding) > near + half_diagonal) continue;
            const double limit = std::min(corner * (1.0 + kFloatRounding) + half_diagonal, near);
            const double d = exact.unsignedWithin(lowOf(x, y, z) + Vec3::Constant(0.5 * edge), limit);
            if (d <= near) field.brick_of_cell_[field.coarseCell(x, y, z)] = 0;
        }
    });
    for (int z = 0; z < cells[2]; ++z) {
        for (int y = 0; y < cells[1]; ++y) {
            for (int x = 0; x < cells[0]; ++x) {
                std::int32_t& brick = field.brick_of_cell_[field.coarseCell(x, y, z)];
                if (brick < 0) continue;
                brick = static_cast<std::int32_t>(low.size());
                low.push_back(lowOf(x, y, z));
            }
        }
    }
    cell = field.largest_cell_;
}

/// Fills the bricks from `first` on, and tells which of their octants are wrong.
void DistanceField::Builder::sampleLevel() {
    field.bricks_.resize(low.size());
    field.slacks_.resize(low.size());
    field.samples_.resize(low.size() * kBrickSamples);
    wrong.resize(low.size() - first);
    if (!accuracy.told) return geometry::parallelFor(wrong.size(), [&](std::size_t i) { sampleBrick(first + i); });
    const std::size_t every = std::max<std::size_t>(wrong.size() / kTellings, 1);
    std::atomic<std::size_t> done{0};
    std::mutex telling;
    geometry::parallelFor(wrong.size(), [&](std::size_t i) {
        sampleBrick(first + i);
        const std::size_t now = done.fetch_add(1) + 1;
        if (now % every != 0) return;
        const std::lock_guard lock(telling);
        accuracy.told(level, static_cast<double>(now) / static_cast<double>(wrong.size()));
    });
}

/// What the source says of a block, in one piece or point by point; then without the cells' centres, which are NaN.
SurfaceBlock DistanceField::Builder::blockAt(const Vec3& corner) const {
    SurfaceBlock block;
    if (exact.source.block) {
        exact.source.block(corner, cell, block);
        return block;
    }
    block.centre.fill(std::numeric_limits<double>::quiet_NaN());
    block.slack.fill(1.0);
    for (int z = 0; z < kBrickNodes; ++z) {
        for (int y = 0; y < kBrickNodes; ++y) {
            for (int x = 0; x < kBrickNodes; ++x) {
                const Vec3 p = corner + cell * Vec3(x, y, z);
                if (x + y + z == 0) {
                    block.node[0] = exact.at(p);
                    continue;
                }
                const std::size_t neighbour = x > 0 ? node(x - 1, y, z) : y > 0 ? node(x, y - 1, z) : node(x, y, z - 1);
                block.node[node(x, y, z)] = exact.from(p, block.node[neighbour], cell);
            }
        }
    }
    return block;
}

void DistanceField::Builder::sampleBrick(std::size_t brick) {
    Brick& info = field.bricks_[brick];
    info = {};
    info.step = 1.0;
    info.child.fill(-1);
    info.level = level;
    auto& slacks = field.slacks_[brick];
    auto& depths = wrong[brick - first];
    if (accuracy.tolerance == 0.0) {
        depths = inBand(low[brick]);
        // A brick that is replaced as a whole is never looked at; those of the last level stay.
        if (level < kMostLevels &&
            std::all_of(depths.begin(), depths.end(), [](double depth) { return std::isfinite(depth); }))
            return;
    }
    const SurfaceBlock block = blockAt(low[brick]);
    const Nodes stored = store(brick, block.node);
    if (accuracy.tolerance > 0.0) depths = measure(stored, block, low[brick]);
    if (field.bounded_within_ >= 0.0) {
        // Cells in which the interpolant may be within; it may where the surface passes, however large the cell.
        const double reach = std::max(field.bounded_within_, cell) * kSinglePrecision;
        for (std::size_t octant = 0; octant < 8; ++octant) {
            // Where finer cells follow nobody asks, or memory ends: then the Lipschitz constant alone bounds.
            const double most =
                std::isfinite(depths[octant]) ? cell : exact.source.error_bound(block, low[brick], cell, octant, reach);
            slacks[octant] = static_cast<std::uint8_t>(std::ceil(255.0 * std::sqrt(std::min(most / cell, 1.0))));
        }
        return;
    }
    for (std::size_t i = 0; i < SurfaceBlock::kAllCells; ++i) {
        constexpr std::size_t kHalf = kBrickCells / 2;
        const std::size_t x = i % kBrickCells, y = i / kBrickCells % kBrickCells, z = i / (kBrickCells * kBrickCells);
        std::uint8_t& slack = slacks[x / kHalf | y / kHalf << 1 | z / kHalf << 2];
        slack = std::max(slack, static_cast<std::uint8_t>(std::ceil(255.0 * block.slack[i])));
    }
}

/// Puts φ into the brick as numbers; the values that they stand for.
DistanceField::Builder::Nodes DistanceField::Builder::store(std::size_t brick, const Nodes& phi) {
    const auto [least, largest] = std::minmax_element(phi.begin(), phi.end());
    Brick& info = field.bricks_[brick];
    info.low = *least - field.sheet_offset_;
    // Never 0: the numbers are divided by it.
    info.step = std::max((*largest - *least) / kLargestStored, std::numeric_limits<double>::min());
    Nodes stored;
    for (std::size_t i = 0; i < kBrickSamples; ++i) {
        const auto number = static_cast<std::uint16_t>(std::min((phi[i] - *least) / info.step + 0.5, kLargestStored));
        field.samples_[brick * kBrickSamples + i] = number;
        stored[i] = info.low + info.step * static_cast<int>(number);
    }
    return stored;
}

/// Adds the bricks of the next level; false if there are none.
bool DistanceField::Builder::refine() {
    // Exact samples of a 1-Lipschitz function: no point of a cell errs by more than half its diagonal.
    if (0.5 * std::sqrt(3.0) * cell <= accuracy.tolerance) return false;
    measureLandmarks();
    std::vector<Request> requests;
    for (std::size_t i = 0; i < wrong.size(); ++i)
        for (unsigned octant = 0; octant < 8; ++octant)
            if (std::isfinite(wrong[i][octant]))
                requests.push_back({static_cast<std::int32_t>(first + i), octant, wrong[i][octant]});
    if (requests.empty()) return false;

    const std::size_t used = field.memoryBytes();
    const std::size_t bytes = accuracy.tolerance > 0.0 ? std::min(accuracy.bytes, kMaxBytes) : kMaxBytes;
    constexpr std::size_t kIndexBytes = kIndexPerBrick * sizeof(std::int32_t);
    const std::size_t taken = used + low.size() * kIndexBytes;
    const std::size_t room = taken < bytes ? (bytes - taken) / kBrickBytes : 0;
    if (requests.size() > room) {  // the surface first
        field.refined_ = false;
        std::stable_sort(requests.begin(), requests.end(),
                         [](const Request& a, const Request& b) { return a.depth < b.depth; });
        requests.resize(room);
        if (requests.empty()) return false;
    }
    first = low.size();
    for (const Request& request : requests) {
        Brick& parent = field.bricks_[static_cast<std::size_t>(request.brick)];
        parent.child[request.octant] = static_cast<std::int32_t>(low.size());
        parent.refined = true;
        low.push_back(low[static_cast<std::size_t>(request.brick)] +
                      0.5 * kBrickCells * cell * cornerAt(request.octant));
    }
    cell *= 0.5;
    ++level;
    field.finest_cell_ = cell;
    sampleLevel();
    return true;
}

}  // namespace passung::field
