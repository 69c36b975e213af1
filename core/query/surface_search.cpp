#include "core/query/surface_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/field/distance_field.h"
#include "core/query/neighbour_list.h"
#include "core/query/overlap_search.h"
#include "core/query/search_progress.h"

namespace passung::query {

namespace {

using geometry::centroid;
using geometry::farthestCorner;
using geometry::TriangleCorners;

constexpr std::size_t kBlock = 64;           // points that the field is asked for at once
constexpr std::size_t kFewTriangles = 4;     // for which neighbours need not be collected
constexpr std::size_t kMostPerTriangle = 3;  // steps
// Of a sphere's radius: what the field may leave open before exact distances are asked.
constexpr double kLooseShare = 0.5;
constexpr double kArithmetic = 1e-12;  // rounding of what is computed here, per metre of the numbers it comes from

}  // namespace

/// A node of B's tree, or a triangle of B.
struct SurfaceSearch::Waiting {
    double lower;  // of φ_A on it [m]
    std::uint32_t index;
};

/// Memory that searches use one after the other.
struct SurfaceSearch::Scratch {
    std::vector<Waiting> wave, next, triangles;
    std::vector<std::uint32_t> corners;
    NeighbourList neighbours;
};

SurfaceSearch::SurfaceSearch(const scene::Part& a, const scene::Part& b)
    : a_(a), triangles_(a.mesh), spheres_(b.mesh), scratch_(std::make_unique<Scratch>()) {}

SurfaceSearch::~SurfaceSearch() = default;

/// One search; A's frame, but for what says B.
struct SurfaceSearch::Search : SearchProgress {
    /// Points of B at which the field is asked at once; B's frame.
    struct Points {
        std::array<float, kBlock> x, y, z, bound;
        std::size_t count = 0;
        void add(const Vec3& p) {
            x[count] = static_cast<float>(p.x());
            y[count] = static_cast<float>(p.y());
            z[count] = static_cast<float>(p.z());
            ++count;
        }
    };

    SurfaceSearch& of;
    const field::DistanceField& field;
    const field::DistanceField::Placement B;  // in the field
    const Mat3 R_AB;
    const Vec3 p_AB;
    const double rounding;  // of what is computed here [m]
    const double slack;     // of the field's bounds [m]
    const double offset;
    const MeshSolid solid;
    bool far = false;  // the field says little around the point where the search begins
    std::vector<Waiting>& triangles;
    std::vector<std::uint32_t>& corners;  // of them
    OverlapSearch overlap;
    NeighbourList& neighbours;  // all of A that may be nearer to `triangles` than found.upper
    Points points;

    Search(SurfaceSearch& search, const Pose& X_AB, double tolerance_, int most)
        : of(search),
          field(*search.a_.field),
          B(field.place(X_AB)),
          R_AB(X_AB.q.toRotationMatrix()),
          p_AB(X_AB.p),
          rounding(kArithmetic * (1.0 + X_AB.p.norm())),
          slack(search.a_.chord_error + rounding),
          offset(field.sheetOffset()),
          solid{search.triangles_, field, slack, rounding},
          triangles(search.scratch_->triangles),
          corners(search.scratch_->corners),
          overlap(solid, *this),
          neighbours(search.scratch_->neighbours) {
        tolerance = std::max(0.0, tolerance_ - 4.0 * rounding);
        most_steps = most;
        triangles.clear();
        neighbours.begin(search.triangles_, rounding);
        found.upper = std::numeric_limits<double>::infinity();
    }

    const TriangleSpheres::Vertex& vertex(const Waiting& triangle, std::size_t i) const {
        return of.spheres_.vertices[of.spheres_.faces[triangle.index][i]];
    }

    bool canBeInside() const { return offset == 0.0; }
    void askBounds() {
        const std::size_t n = points.count;
        field.lowerBounds(B, {points.x.data(), n}, {points.y.data(), n}, {points.z.data(), n},
                          {points.bound.data(), n});
        found.steps += static_cast<int>(n);
    }
    /// Of φ_A at a point that was asked for.
    double boundAt(std::size_t i) const { return static_cast<double>(points.bound[i]) + offset - slack; }

    void begin(const Vec3& p, double off) {
        solid.look(p, *this);
        found.upper += off;
        far = saysLittle(p, field.lowerBound(p) + offset, of.spheres_.leaf_radius);
    }

    bool saysLittle(const Vec3& p, double bound, double radius) const {
        return field.sample(p, field::FieldMode::Trilinear).phi + offset - bound > kLooseShare * radius;
    }

    /// The spheres of some nodes; the children of those that cannot be left out are `next`.
    void lookAtNodes(std::span<const Waiting> nodes, std::vector<Waiting>& next) {
        points.count = 0;
        for (const Waiting& node : nodes) points.add(of.spheres_.nodes[node.index].centre);
        askBounds();
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const TriangleSpheres::Node& node = of.spheres_.nodes[nodes[i].index];
            const double bound = boundAt(i);
            double lower = std::max(nodes[i].lower, bound - node.radius);
            if (leave(lower)) continue;
            // Far away and deep inside the field says little.
            const Vec3 c = R_AB * node.centre + p_AB;
            if ((far || found.upper < 0.0) && saysLittle(c, bound, node.radius)) {
                const double d = of.triangles_.closest(c).distance;
                ++found.steps;
                lower = std::max(lower, (solid.isInside(c) ? -d : d) - node.radius - rounding);
                if (leave(lower)) continue;
            }
            for (std::uint32_t k = 0; k < node.count; ++k) triangles.push_back({lower, node.first + k});
            if (node.count == 0) {
                next.push_back({lower, node.first});
                next.push_back({lower, node.first + 1});
            }
        }
    }

    /// Finds the triangles that matter, level by level; false if the steps end.
    bool findTriangles() {
        std::vector<Waiting>&wave = of.scratch_->wave, &next = of.scratch_->next;
        wave.clear();
        triangles.clear();
        wave.push_back({-std::numeric_limits<double>::infinity(), 0});
        while (!wave.empty()) {
            next.clear();
            for (std::size_t begin = 0; begin < wave.size(); begin += kBlock) {
                const std::size_t count = std::min(kBlock, wave.size() - begin);
                if (!maySpend(2 * count)) {
                    for (const auto& rest : {std::span<const Waiting>(wave).subspan(begin),
                                             std::span<const Waiting>(next), std::span<const Waiting>(triangles)})
                        for (const Waiting& w : rest) left = std::min(left, w.lower);
                    return false;
                }
                lookAtNodes(std::span<const Waiting>(wave).subspan(begin, count), next);
            }
            std::swap(wave, next);
        }
        return true;
    }

    double distanceAt(std::size_t i) const { return std::max(0.0, boundAt(i) - of.spheres_.float_rounding); }

    /// What is left of `triangles`, all outside or nearly so, by the distances of their corners.
    void narrowOutside() {
        corners.clear();  // each once
        ++of.round_;
        for (const Waiting& triangle : triangles)
            for (const std::uint32_t v : of.spheres_.faces[triangle.index]) {
                if (of.spheres_.vertices[v].round == of.round_) continue;
                of.spheres_.vertices[v].round = of.round_;
                corners.push_back(v);
            }
        for (std::size_t begin = 0; begin < corners.size(); begin += kBlock) {
            const std::size_t count = std::min(kBlock, corners.size() - begin);
            points.count = 0;
            for (std::size_t i = 0; i < count; ++i) points.add(of.spheres_.vertices[corners[begin + i]].p);
            askBounds();
            for (std::size_t i = 0; i < count; ++i) of.spheres_.vertices[corners[begin + i]].distance = distanceAt(i);
        }
        std::size_t kept = 0, nearest = 0;
        for (const Waiting& triangle : triangles) {
            const TriangleSpheres::Vertex &a = vertex(triangle, 0), &b = vertex(triangle, 1), &c = vertex(triangle, 2);
            const double lower =
                geometry::leastDistance({a.p, b.p, c.p}, {a.distance, b.distance, c.distance}, enough());
            if (leave(std::max(triangle.lower, lower))) continue;
            triangles[kept] = {std::max(triangle.lower, lower), triangle.index};
            if (triangles[kept].lower < triangles[nearest].lower) nearest = kept;
            ++kept;
        }
        triangles.resize(kept);
        if (kept == 0) return;
        lookAtTriangle(triangles[nearest], found.upper);
        triangles.erase(triangles.begin() + static_cast<std::ptrdiff_t>(nearest));
        std::erase_if(triangles, [&](const Waiting& triangle) { return leave(triangle.lower); });
        if (found.upper > 0.0) findNeighbours();
    }

    TriangleCorners cornersInA(const Waiting& triangle) const {
        return {Vec3(R_AB * vertex(triangle, 0).p + p_AB), Vec3(R_AB * vertex(triangle, 1).p + p_AB),
                Vec3(R_AB * vertex(triangle, 2).p + p_AB)};
    }

    void findNeighbours() {
        if (triangles.size() < kFewTriangles) return;
        const Vec3 way = found.normal;
        geometry::Bounds box;
        double begin = std::numeric_limits<double>::infinity();
        for (const Waiting& triangle : triangles)
            for (const Vec3& corner : cornersInA(triangle)) {
                box.extend(corner);
                begin = std::min(begin, way.dot(corner));
            }
        neighbours.collect(box, way, begin, found.upper);
    }

    /// The distance of a triangle of B that is nearer than `limit`, exactly.
    void lookAtTriangle(const Waiting& triangle, double limit) {
        const TriangleCorners t = cornersInA(triangle);
        const geometry::TrianglePair pair = neighbours.closestTo(t, limit);
        ++found.steps;
        const bool outside = triangle.lower > 0.0;
        const bool whole = outside || pair.distance > rounding;  // on one side
        // A point of B that is known to be as near to A's surface as this.
        if (pair.distance < limit && (outside || !whole || !solid.isInside(pair.on_first)))
            offer(pair.distance, pair.on_first, pair.on_second);
        left = std::min(left, std::max(triangle.lower, pair.distance - rounding));
        if (outside || !canBeInside() || (whole && !solid.isInside(centroid(t)))) return;
        overlap.add(t, triangle.lower);
    }

    /// What is left of `triangles` by spheres around each.
    void narrowBySpheres() {
        std::size_t kept = 0;
        for (std::size_t begin = 0; begin < triangles.size(); begin += kBlock) {
            const std::size_t end = std::min(begin + kBlock, triangles.size());
            std::array<double, kBlock> reach;
            points.count = 0;
            for (std::size_t i = begin; i < end; ++i) {
                const TriangleCorners t{vertex(triangles[i], 0).p, vertex(triangles[i], 1).p,
                                        vertex(triangles[i], 2).p};
                const Vec3 middle = centroid(t);
                reach[i - begin] = farthestCorner(middle, t) + of.spheres_.float_rounding;
                points.add(middle);
            }
            askBounds();
            for (std::size_t i = begin; i < end; ++i) {
                Waiting triangle = triangles[i];
                triangle.lower = std::max(triangle.lower, boundAt(i - begin) - reach[i - begin]);
                if (!leave(triangle.lower)) triangles[kept++] = triangle;
            }
        }
        triangles.resize(kept);
    }

    void lookAtTriangles() {
        if (found.upper > 0.0 && maySpend(3 * triangles.size())) narrowOutside();
        if (found.upper <= 0.0 && maySpend(triangles.size())) narrowBySpheres();
        std::sort(triangles.begin(), triangles.end(), [](const Waiting& a, const Waiting& b) {
            return std::pair(a.lower, a.index) < std::pair(b.lower, b.index);
        });
        for (const Waiting& triangle : triangles) {
            if (leave(triangle.lower)) continue;
            if (found.upper <= 0.0 && canBeInside()) {
                overlap.add(cornersInA(triangle), triangle.lower);
                continue;
            }
            if (!maySpend(kMostPerTriangle)) {
                left = std::min(left, triangle.lower);
                break;
            }
            // Where something is inside, what is outside matters no more: only whether this triangle is.
            lookAtTriangle(triangle, std::max(goal(), 2.0 * rounding));
        }
    }

    void run() {
        if (findTriangles()) {
            lookAtTriangles();
            overlap.run();
        }
        found.lower = std::min(found.upper, left) - rounding;
    }
};

SurfaceBounds SurfaceSearch::bounds(const Pose& X_AB, const Vec3& p_BP, double rounding, double tolerance,
                                    int most_steps) {
    Search search(*this, X_AB, tolerance, most_steps);
    search.begin(X_AB * p_BP, rounding);
    search.run();
    return search.found;
}

}  // namespace passung::query
