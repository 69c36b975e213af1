#include <algorithm>
#include <cmath>
#include <limits>

#include "core/model/distance_field.h"
#include "core/model/interpolation.h"
#include "core/model/parallel.h"

namespace passung::model {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{2} << 30;
constexpr double kFloatRounding = 0x1p-24 * (1.0 + 0x1p-20);  // of a value stored as a float, relative
constexpr double kEverywhere = 1e30;                          // [m]
constexpr double kSinglePrecision = 1.001;                    // more than what sampleMany errs by
constexpr double kArithmetic = 0x1p-45;     // 128 roundings of a coordinate: far more than a query makes
constexpr double kLimitSlack = 1.0 + 1e-9;  // for the rounding of a limit d(q) + |p - q|
constexpr double kLargestStored = 65535.0;
constexpr double kDeepShare = 0.1;   // of φ: what may be wrong where nobody presses
constexpr double kDoubtShare = 0.5;  // of the allowed error: what second differences may claim without a measurement
constexpr int kMeasured = 3;         // points of a cell along each axis
constexpr double kMeasuredShare = 0.95;  // of the allowed error: between the measured points it may be more
constexpr double kCentreShare = 0.25;    // of that
constexpr double kLipschitzSlack = 1.01;

/// Exact φ without the sheet's offset.
struct Exact {
    const DistanceSource& source;

    /// The unsigned distance, or at least `limit` if it is more.
    double unsignedWithin(const Vec3& p, double limit) const {
        return source.nearest_within ? source.nearest_within(p, limit * kLimitSlack).distance : source.distance(p);
    }

    /// φ at `p`, `way` from a place where it is `known`.
    double from(const Vec3& p, double known, double way) const {
        return signedAt(p, unsignedWithin(p, std::abs(known) + way), known, way);
    }

    /// As `from`; `nearest` is the surface's nearest point there, then here: seldom much farther away than need be.
    double along(const Vec3& p, double known, double way, Vec3& nearest) const {
        if (!source.nearest_within) return from(p, known, way);
        const double limit = std::min(std::abs(known) + way, (p - nearest).norm());
        const DistanceSource::Nearest found = source.nearest_within(p, limit * kLimitSlack);
        if (found.distance < limit * kLimitSlack) nearest = found.point;
        return signedAt(p, found.distance, known, way);
    }

    double signedAt(const Vec3& p, double d, double known, double way) const {
        if (source.open_sheet) return d;
        // On closed geometry a point farther from the surface than from its neighbour lies on the neighbour's side.
        const bool inside = source.closed && std::abs(known) > way ? known < 0.0 : source.inside(p);
        return inside ? -d : d;
    }

    double at(const Vec3& p) const {
        const double d = source.distance(p);
        return !source.open_sheet && source.inside(p) ? -d : d;
    }
};

}  // namespace

/// Builds a field: the coarse grid, bricks in the band, then level by level those that replace octants.
struct DistanceField::Builder {
    using Nodes = std::array<double, kBrickSamples>;

    /// An octant that errs too much.
    struct Request {
        std::int32_t brick;
        unsigned octant;
        double depth;  // |φ| where that was seen
    };

    DistanceField& field;
    const Exact exact;
    const FieldAccuracy& accuracy;
    const double band;
    std::vector<Vec3> low{};  // corner of each brick
    std::size_t first = 0;    // brick of the level that was built last
    int level = 0;            // that level
    double cell = 0.0;        // of it
    /// For each octant of each brick of the level: |φ| where it must be refined, or infinity.
    std::vector<std::array<double, 8>> wrong{};

    static std::size_t node(int x, int y, int z) {
        return static_cast<std::size_t>((z * kBrickNodes + y) * kBrickNodes + x);
    }

    void sampleCoarse();
    void placeBricks();
    void sampleLevel();
    void sampleBrick(std::size_t brick);
    double allowed(double phi) const;
    SurfaceBlock blockAt(const Vec3& corner) const;
    Nodes store(std::size_t brick, const Nodes& phi);
    double distanceIn(const Corners& values, std::span<const std::uint32_t> triangles, const Vec3& origin,
                      const Vec3& u) const;
    static Nodes bends(const Nodes& nodes);
    double errorOf(const Corners& values, const Vec3& u, double distance) const;
    double wrongDepth(const Nodes& nodes, const Nodes& bends, const SurfaceBlock& block, const Vec3& corner, int x,
                      int y, int z) const;
    std::array<double, 8> measure(const Nodes& nodes, const SurfaceBlock& block, const Vec3& corner) const;
    std::array<double, 8> inBand(const Vec3& corner) const;
    void measureLandmarks();
    bool refine();
};

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
    return field;
}

void DistanceField::Builder::sampleCoarse() {
    const auto& cells = field.coarse_cells_;
    const int nx = cells[0] + 1, ny = cells[1] + 1, nz = cells[2] + 1;
    field.coarse_.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz));
    const double edge = field.brick_edge_;
    parallelFor(static_cast<std::size_t>(nz) * static_cast<std::size_t>(ny), [&](std::size_t row) {
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
    parallelFor(rows, [&](std::size_t row) {
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
    parallelFor(wrong.size(), [&](std::size_t i) { sampleBrick(first + i); });
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
double DistanceField::Builder::distanceIn(const Corners& values, std::span<const std::uint32_t> triangles,
                                          const Vec3& origin, const Vec3& u) const {
    if (!triangles.empty()) return exact.source.distance_to(origin + cell * u, triangles);
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
double DistanceField::Builder::errorOf(const Corners& values, const Vec3& u, double d) const {
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
    Corners values;
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
        const Place place = field.descend(root, g - whole);
        if (place.brick < first) continue;
        if (std::abs(field.sample(p, FieldMode::Trilinear).phi) > accuracy.tolerance)
            wrong[place.brick - first][place.octant] = 0.0;
    }
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

}  // namespace passung::model
