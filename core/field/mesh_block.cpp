#include "core/field/mesh_block.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/field/interpolation.h"
#include "core/field/mesh_block_kernels.h"
#include "core/field/mesh_block_signs.h"
#include "core/geometry/parallel.h"

namespace passung::field {

namespace {

constexpr int kCells = SurfaceBlock::kCells;
constexpr int kNodes = SurfaceBlock::kNodes;
constexpr std::size_t kParts = 64;
constexpr std::size_t kExpected = 16;    // triangles that may be nearest in a cell
constexpr double kSlackRounding = 1e-7;  // of the sine of a small angle from its cosine
constexpr double kInFront = 1e-6;        // of an edge: where a triangle is asked what it parts

/// A cube of two cells and its nodes; those between parts belong to the later one. Points from the block's centre.
struct PartPoints {
    std::array<PointGroup, kMostGroups> nodes;  // in whole groups: what is beyond `count` is the last node again
    std::size_t count = 0, groups = 0;
    std::array<std::size_t, 27> node{};  // where each is in the block
    PointGroup centres;
    std::array<std::size_t, kLanes> cell{};
};

void place(PointGroup& group, std::size_t lane, const Vec3& p) {
    const Eigen::Vector3f from_centre = (p - Vec3::Constant(0.5 * kCells)).cast<float>();
    group.x[lane] = from_centre[0];
    group.y[lane] = from_centre[1];
    group.z[lane] = from_centre[2];
}

/// The centres of the eight cubes with the given edge around a corner.
PointGroup centresOf(const Vec3& first, double edge) {
    PointGroup centres;
    for (std::size_t i = 0; i < 8; ++i) place(centres, i, first + edge * (cornerAt(i) + Vec3::Constant(0.5)));
    return centres;
}

PartPoints partAt(const std::array<int, 3>& first) {
    PartPoints part;
    const auto end = [&](std::size_t axis) { return first[axis] + (first[axis] + 2 == kCells ? 3 : 2); };
    for (int z = first[2]; z < end(2); ++z)
        for (int y = first[1]; y < end(1); ++y)
            for (int x = first[0]; x < end(0); ++x) {
                part.node[part.count] = static_cast<std::size_t>((z * kNodes + y) * kNodes + x);
                for (std::size_t i = part.count; i < (part.count / kLanes + 1) * kLanes; ++i)
                    place(part.nodes[i / kLanes], i % kLanes, Vec3(x, y, z));
                ++part.count;
            }
    part.groups = (part.count + kLanes - 1) / kLanes;
    part.centres = centresOf(Vec3(first[0], first[1], first[2]), 1.0);
    for (std::size_t i = 0; i < kLanes; ++i) {
        const auto at = [&](std::size_t axis) { return static_cast<std::size_t>(first[axis]) + (i >> axis & 1); };
        part.cell[i] = (at(2) * kCells + at(1)) * kCells + at(0);
    }
    return part;
}

/// Eight parts in each octant, by octants.
const std::array<PartPoints, kParts>& allParts() {
    static const auto parts = [] {
        std::array<PartPoints, kParts> all;
        for (std::size_t i = 0; i < kParts; ++i) {
            const auto at = [&](std::size_t axis) {
                return 4 * static_cast<int>(i / 8 >> axis & 1) + 2 * static_cast<int>(i >> axis & 1);
            };
            all[i] = partAt({at(0), at(1), at(2)});
        }
        return all;
    }();
    return parts;
}

class Sampling {
public:
    Sampling(const geometry::TriangleTree& tree, const std::vector<FlatTriangle>& flats, const Vec3& low, double cell,
             SurfaceBlock& block)
        : tree_(tree), flats_(flats), low_(low), cell_(cell), block_(block) {}

    void run(bool closed);

private:
    std::array<Choice, kLanes> choose(const Choice& triangles, const PointGroup& centres, double half);
    void samplePart(const PartPoints& part, const Choice& triangles);
    double least(const Choice& triangles, std::size_t lane, const Vec3& p) const;
    double slackOf(std::size_t lane) const;

    const geometry::TriangleTree& tree_;
    const std::vector<FlatTriangle>& flats_;
    const Vec3 low_;
    const double cell_;
    SurfaceBlock& block_;
    std::vector<float> scratch_;
    Chosen cubes_, points_;
    // Of a part:
    std::vector<Vec3> normals_;
    Choice kept_;
};

void Sampling::run(bool closed) {
    block_.triangles.clear();
    block_.triangles.reserve(kExpected * SurfaceBlock::kAllCells);
    constexpr double half = 0.5 * kCells;
    const Vec3 centre = low_ + Vec3::Constant(half * cell_);
    std::vector<std::uint32_t> found;
    // Lines along which crossings are counted run a little beside the nodes.
    tree_.findNearest(centre, (half + kLineShift) * cell_, found);
    std::vector<NearTriangle> near;
    near.reserve(found.size());
    for (const std::uint32_t i : found) near.emplace_back(flats_[i], centre, 1.0 / cell_);
    Choice all;
    for (const NearTriangle& triangle : near) all.push_back(&triangle);
    const auto octants = choose(all, centresOf(Vec3::Zero(), half), 0.5 * half);
    for (std::size_t i = 0; i < 8; ++i) {
        const auto parts = choose(octants[i], centresOf(half * cornerAt(i), 0.5 * half), 0.25 * half);
        for (std::size_t k = 0; k < 8; ++k) samplePart(allParts()[8 * i + k], parts[k]);
    }
    if (!closed) return;
    // Those that meet the block are nearest to their own points there.
    std::vector<const FlatTriangle*> flats;
    for (const NearTriangle& triangle : near) flats.push_back(triangle.flat);
    giveSigns(tree_, flats, low_, cell_, block_);
}

/// The triangles that may be nearest in each of eight cubes.
std::array<Choice, kLanes> Sampling::choose(const Choice& triangles, const PointGroup& centres, double half) {
    blockKernels().judge(triangles, centres, static_cast<float>(half), scratch_, cubes_, points_);
    std::array<Choice, kLanes> kept;
    for (Choice& one : kept) one.reserve(triangles.size());
    for (std::size_t i = 0; i < kLanes; ++i) cubes_.forEach(i, [&](std::size_t k) { kept[i].push_back(triangles[k]); });
    return kept;
}

/// Its triangles hold the nearest one of each of its points.
void Sampling::samplePart(const PartPoints& part, const Choice& triangles) {
    blockKernels().judge(triangles, part.centres, 0.5f, scratch_, cubes_, points_);
    normals_.clear();
    for (const NearTriangle* const triangle : triangles) normals_.push_back(triangle->flat->normal);
    for (std::size_t i = 0; i < kLanes; ++i) {
        const int cell = static_cast<int>(part.cell[i]);
        const Vec3 place(cell % kCells + 0.5, cell / kCells % kCells + 0.5, cell / (kCells * kCells) + 0.5);
        block_.centre[part.cell[i]] = least(triangles, i, low_ + cell_ * place);
        block_.slack[part.cell[i]] = slackOf(i);
        block_.first[part.cell[i]] = static_cast<std::uint32_t>(block_.triangles.size());
        cubes_.forEach(i, [&](std::size_t k) {
            block_.triangles.push_back(static_cast<std::uint32_t>(triangles[k]->flat - flats_.data()));
        });
        block_.last[part.cell[i]] = static_cast<std::uint32_t>(block_.triangles.size());
    }
    // Each node is the corner of a cell.
    kept_.clear();
    for (std::size_t k = 0; k < triangles.size(); ++k)
        if (cubes_.anyLane(k)) kept_.push_back(triangles[k]);
    blockKernels().nearest(kept_, part.nodes.data(), part.groups, scratch_, points_);
    for (std::size_t i = 0; i < part.count; ++i) {
        const int node = static_cast<int>(part.node[i]);
        const Vec3 place(node % kNodes, node / kNodes % kNodes, node / (kNodes * kNodes));
        block_.node[part.node[i]] = least(kept_, i, low_ + cell_ * place);
    }
}

/// The distance of a point from the triangles chosen for it.
double Sampling::least(const Choice& triangles, std::size_t lane, const Vec3& p) const {
    double square = std::numeric_limits<double>::infinity();
    points_.forEach(lane, [&](std::size_t k) { square = std::min(square, triangles[k]->flat->squaredDistance(p)); });
    return std::sqrt(square);
}

/// How little ∇φ turns in a cell.
///   Where φ has a gradient, the nearest point x(p) lies on a triangle that may be nearest. As every triangle parts
/// outside from inside (where solids overlap or contain each other there are faces from which φ falls on both sides),
/// ∇φ(p), of unit length, lies in the cone of their outward normals n: one normal above a face, those of the faces that
/// meet above an edge or corner. Let m be the normalised sum of the normals and n·m ≥ cos α > 0 for all: the same holds
/// for all unit vectors of the cone, so |∇φ - m cos α|² ≤ 1 - 2 cos² α + cos² α = sin² α, and φ - (m cos α)·p has the
/// Lipschitz constant sin α.
double Sampling::slackOf(std::size_t lane) const {
    Vec3 sum = Vec3::Zero();
    cubes_.forEach(lane, [&](std::size_t k) { sum += normals_[k]; });
    const double length = sum.norm();
    if (!(length > 0.0)) return 1.0;
    double least = length;
    cubes_.forEach(lane, [&](std::size_t k) { least = std::min(least, normals_[k].dot(sum)); });
    const double cosine = least / length;
    if (!(cosine > 0.0)) return 1.0;
    return std::min(1.0, std::sqrt(1.0 - cosine * cosine) + kSlackRounding);
}

}  // namespace

MeshBlockSampler::MeshBlockSampler(std::shared_ptr<const geometry::TriangleTree> tree, bool closed, bool uncrossed)
    : tree_(std::move(tree)), closed_(closed), simple_(closed && uncrossed) {
    auto flats = std::make_shared<std::vector<FlatTriangle>>();
    flats->reserve(tree_->corners().size());
    for (const auto& corners : tree_->corners()) flats->emplace_back(corners);
    flats_ = std::move(flats);
    if (!simple_) return;
    std::atomic<bool> all_walls = true;
    geometry::parallelFor(flats_->size(), [&](std::size_t i) {
        const FlatTriangle& t = (*flats_)[i];
        const Vec3 middle = (t.corner[0] + t.corner[1] + t.corner[2]) / 3.0;
        const Vec3 front = middle + kInFront * t.edge[0].norm() * t.normal;
        if (all_walls && std::lround(tree_->windingNumber(front)) != 0) all_walls = false;
    });
    simple_ = all_walls;
}

double MeshBlockSampler::distance(const Vec3& p, std::span<const std::uint32_t> triangles) const {
    double square = std::numeric_limits<double>::infinity();
    for (const std::uint32_t k : triangles) square = std::min(square, (*flats_)[k].squaredDistance(p));
    return std::sqrt(square);
}

void MeshBlockSampler::sample(const Vec3& low, double cell, SurfaceBlock& block) const {
    Sampling(*tree_, *flats_, low, cell, block).run(closed_);
    if (!simple_) block.slack.fill(1.0);
}

}  // namespace passung::field
