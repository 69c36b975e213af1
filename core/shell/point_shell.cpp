#include "core/shell/point_shell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "core/base/random.h"
#include "core/base/single_precision.h"
#include "core/geometry/mesh_edges.h"
#include "core/geometry/parallel.h"
#include "core/geometry/triangle_distance.h"
#include "core/shell/disk_subset.h"

namespace passung::shell {

namespace {

constexpr double kDiskShare = 0.72;  // disk radius per spacing: then neighbours are about one spacing apart
constexpr double kCandidateShare = 0.7;
constexpr int kRelaxations = 2;
constexpr std::uint64_t kSeed = 20260101;  // of the order in which candidates are tried; any value serves
// Candidates are tried in a random order among so many that lie next to each other, so that memory is used in order.
constexpr std::size_t kShuffled = 2048;
constexpr std::size_t kCandidatesAtOnce = 16384;  // candidates that one thread assigns at a time

/// A piece of a triangle, cut by halving.
struct Candidate {
    float x, y, z;           // its centroid
    float share;             // of the triangle's area, a power of two
    std::uint32_t triangle;  // in the mesh
    Vec3 position() const { return {x, y, z}; }
};

struct Sample {
    Vec3 position;
    std::uint32_t triangle;  // that it lies on
};

/// Calls `visit(a, b, c, share)` for the pieces of a triangle, none with an edge longer than `longest`.
template <class Visit>
void cutTriangle(const Vec3& a, const Vec3& b, const Vec3& c, float share, double longest, const Visit& visit) {
    const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
    if (std::max({ab, bc, ca}) > longest * longest) {
        // Halve the longest edge: the pieces stay as round as the triangle allows.
        if (ab >= bc && ab >= ca) {
            const Vec3 m = 0.5 * (a + b);
            cutTriangle(a, m, c, 0.5f * share, longest, visit);
            cutTriangle(m, b, c, 0.5f * share, longest, visit);
        } else if (bc >= ca) {
            const Vec3 m = 0.5 * (b + c);
            cutTriangle(a, b, m, 0.5f * share, longest, visit);
            cutTriangle(a, m, c, 0.5f * share, longest, visit);
        } else {
            const Vec3 m = 0.5 * (c + a);
            cutTriangle(a, b, m, 0.5f * share, longest, visit);
            cutTriangle(m, b, c, 0.5f * share, longest, visit);
        }
        return;
    }
    visit(a, b, c, share);
}

Vec3 areaVector(const geometry::TriangleMesh& mesh, const geometry::Triangle& t) {
    const Vec3& a = mesh.vertices[t[0]];
    return 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

/// The samples of the faces while they are found.
class FaceSampler {
public:
    FaceSampler(const geometry::TriangleMesh& mesh, double spacing)
        : mesh_(mesh), longest_(kCandidateShare * spacing), radius_(kDiskShare * spacing) {
        for (const auto& t : mesh.triangles) {
            const Vec3 area = areaVector(mesh, t);
            areas_.push_back(area.norm());
            normals_.push_back(areas_.back() > 0.0 ? Vec3(area / areas_.back()) : Vec3(Vec3::Zero()));
        }
        visitPieces([&](std::uint32_t t, const Vec3& a, const Vec3& b, const Vec3& c, float share) {
            const Eigen::Vector3f p = ((a + b + c) / 3.0).cast<float>();
            candidates_.push_back({p.x(), p.y(), p.z(), share, t});
            bounds_.extend(p.cast<double>());
        });
    }

    void run(PointShell& shell) {
        choose();
        assign(radius_);
        for (int i = 0; i < kRelaxations; ++i) {
            relax();
            // A relaxed sample may have moved away from a candidate by up to a patch: search twice as far.
            assign(2.0 * radius_);
        }
        centre();
        append(shell);
    }

private:
    /// Calls `visit(triangle, a, b, c, share)` for every candidate's piece, in their order.
    template <class Visit>
    void visitPieces(const Visit& visit) const {
        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
            if (!(areas_[t] > 0.0)) continue;
            const auto& v = mesh_.triangles[t];
            cutTriangle(mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]], 1.0f, longest_,
                        [&](const Vec3& a, const Vec3& b, const Vec3& c, float share) { visit(t, a, b, c, share); });
        }
    }

    double areaOf(const Candidate& c) const { return static_cast<double>(c.share) * areas_[c.triangle]; }

    void addSamples(const std::vector<std::uint32_t>& order) {
        const auto position = [&](std::uint32_t i) { return candidates_[i].position(); };
        const auto normal = [&](std::uint32_t i) { return normals_[candidates_[i].triangle]; };
        for (const std::uint32_t i : diskSubset(bounds_, position, normal, radius_, order))
            samples_.push_back({candidates_[i].position(), candidates_[i].triangle});
    }

    void choose() {
        std::vector<std::uint32_t> order(candidates_.size());
        std::iota(order.begin(), order.end(), 0u);
        Random random(kSeed);
        for (std::size_t begin = 0; begin < order.size(); begin += kShuffled) {
            const std::size_t count = std::min(kShuffled, order.size() - begin);
            for (std::size_t i = count; i-- > 1;) std::swap(order[begin + i], order[begin + random.below(i + 1)]);
        }
        addSamples(order);
    }

    void assignAll(double radius) {
        std::vector<Vec3> positions, normals;
        for (const Sample& s : samples_) {
            positions.push_back(s.position);
            normals.push_back(normals_[s.triangle]);
        }
        const NearestAlike nearest(bounds_, positions, normals, radius_);
        patch_.resize(candidates_.size(), kNoPoint);
        geometry::parallelFor((candidates_.size() + kCandidatesAtOnce - 1) / kCandidatesAtOnce, [&](std::size_t batch) {
            const std::size_t end = std::min(candidates_.size(), (batch + 1) * kCandidatesAtOnce);
            // Where the last sample was, or that of the candidate before, is a good place to begin.
            std::uint32_t before = kNoPoint;
            for (std::size_t i = batch * kCandidatesAtOnce; i < end; ++i) {
                const std::uint32_t hint = patch_[i] != kNoPoint ? patch_[i] : before;
                before = patch_[i] =
                    nearest.at(candidates_[i].position(), normals_[candidates_[i].triangle], radius, hint);
            }
        });
    }

    /// The patch of each candidate. Where a sample has moved away, or has turned by moving, candidates may be left
    /// without one that faces them: then some of them become samples too.
    void assign(double radius) {
        assignAll(radius);
        std::vector<std::uint32_t> left;
        for (std::uint32_t i = 0; i < patch_.size(); ++i)
            if (patch_[i] == kNoPoint) left.push_back(i);
        if (left.empty()) return;
        addSamples(left);
        assignAll(radius);
    }

    std::vector<Vec3> centroids() const {
        std::vector<Vec3> centroid(samples_.size(), Vec3::Zero());
        std::vector<double> weight(samples_.size(), 0.0);
        for (std::size_t i = 0; i < patch_.size(); ++i) {
            const double area = areaOf(candidates_[i]);
            centroid[patch_[i]] += area * candidates_[i].position();
            weight[patch_[i]] += area;
        }
        for (std::size_t k = 0; k < samples_.size(); ++k)
            if (weight[k] > 0.0) centroid[k] /= weight[k];
        return centroid;
    }

    /// For each patch its candidate nearest to the centroid.
    std::vector<std::uint32_t> middles(const std::vector<Vec3>& centroid) const {
        std::vector<std::uint32_t> middle(samples_.size(), kNoPoint);
        std::vector<double> best(samples_.size(), std::numeric_limits<double>::infinity());
        for (std::size_t i = 0; i < patch_.size(); ++i) {
            const std::uint32_t k = patch_[i];
            const double d = (candidates_[i].position() - centroid[k]).squaredNorm();
            if (!(d < best[k])) continue;
            best[k] = d;
            middle[k] = static_cast<std::uint32_t>(i);
        }
        return middle;
    }

    /// Moves each sample to the candidate of its patch that is nearest to the patch's centroid.
    void relax() {
        const auto middle = middles(centroids());
        for (std::size_t k = 0; k < samples_.size(); ++k) {
            if (middle[k] == kNoPoint) continue;  // another sample lies where this one does
            samples_[k] = {candidates_[middle[k]].position(), candidates_[middle[k]].triangle};
        }
    }

    /// Moves each sample to the surface next to its patch's centroid, where that faces the whole patch.
    void centre() {
        const auto centroid = centroids();
        const auto middle = middles(centroid);
        std::vector<bool> facing(samples_.size(), true);
        for (std::size_t i = 0; i < patch_.size(); ++i) {
            const std::uint32_t m = candidates_[middle[patch_[i]]].triangle;
            if (!facesAlike(normals_[m], normals_[candidates_[i].triangle])) facing[patch_[i]] = false;
        }
        for (std::size_t k = 0; k < samples_.size(); ++k) {
            if (middle[k] == kNoPoint || !facing[k]) continue;
            const std::uint32_t t = candidates_[middle[k]].triangle;
            const auto& v = mesh_.triangles[t];
            samples_[k] = {geometry::closestOnTriangle(centroid[k], mesh_.vertices[v[0]], mesh_.vertices[v[1]],
                                                       mesh_.vertices[v[2]]),
                           t};
        }
    }

    void append(PointShell& shell) const {
        std::vector<Vec3> area_vector(samples_.size(), Vec3::Zero());
        std::vector<SurfacePoint> points;
        for (const Sample& s : samples_)
            points.push_back({roundedToFloat(s.position), normals_[s.triangle], 0.0, s.triangle});
        std::size_t i = 0;
        double cover = 0.0;  // squared
        visitPieces([&](std::uint32_t t, const Vec3& a, const Vec3& b, const Vec3& c, float share) {
            const std::uint32_t k = patch_[i++];
            const double area = static_cast<double>(share) * areas_[t];
            points[k].area += area;
            area_vector[k] += area * normals_[t];
            shell.total_area += area;
            // The farthest point of a triangle is a corner.
            for (const Vec3* corner : {&a, &b, &c})
                cover = std::max(cover, (*corner - points[k].position).squaredNorm());
        });
        shell.cover_radius = std::sqrt(cover) * (1.0 + 1e-12);
        for (std::size_t k = 0; k < points.size(); ++k) {
            if (!(points[k].area > 0.0)) continue;
            points[k].normal = area_vector[k].normalized();
            shell.points.push_back(points[k]);
        }
    }

    const geometry::TriangleMesh& mesh_;
    const double longest_, radius_;
    std::vector<double> areas_;  // of the triangles
    std::vector<Vec3> normals_;
    std::vector<Candidate> candidates_;
    geometry::Bounds bounds_;
    std::vector<Sample> samples_;
    std::vector<std::uint32_t> patch_;  // sample of each candidate
};

/// Samples on sharp edges and boundaries, corners first so that they are kept.
class EdgeSampler {
public:
    explicit EdgeSampler(const geometry::TriangleMesh& mesh) : mesh_(mesh) {
        for (const geometry::SharpEdge& sharp : geometry::sharpEdges(mesh)) addSharp(sharp.edge, sharp.normal);
    }

    void append(double spacing, PointShell& shell) {
        for (const auto& [v, corner] : corners_) {
            const auto& d = corner.directions;
            const bool passes_straight = d.size() == 2 && d[0].dot(d[1]) < -geometry::kSharpCosine;
            if (!passes_straight) add(mesh_.vertices[v], corner.normal, corner.triangle);
        }
        for (const auto& [edge, normal] : sharp_) {
            const Vec3 a = mesh_.vertices[edge.low], b = mesh_.vertices[edge.high];
            const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / (kEdgeShare * spacing))));
            for (int i = 0; i < pieces; ++i) add(a + (b - a) * ((i + 0.5) / pieces), normal, edge.triangle);
        }
        std::vector<std::uint32_t> order(points_.size());
        std::iota(order.begin(), order.end(), 0u);
        for (const std::uint32_t i : diskSubset(points_, facing_, kDiskShare * kEdgeShare * spacing, order))
            shell.points.push_back({roundedToFloat(points_[i]), facing_[i], 0.0, triangles_[i]});
    }

private:
    struct Corner {
        std::vector<Vec3> directions;  // of its sharp edges
        Vec3 normal = Vec3::Zero();
        std::uint32_t triangle = 0;
    };

    void addSharp(const geometry::HalfEdge& edge, const Vec3& normal) {
        sharp_.push_back({edge, normal});
        const Vec3 direction = (mesh_.vertices[edge.high] - mesh_.vertices[edge.low]).normalized();
        corners_[edge.low].directions.push_back(direction);
        corners_[edge.high].directions.push_back(-direction);
        for (const std::uint32_t v : {edge.low, edge.high}) {
            corners_[v].normal += normal;
            corners_[v].triangle = edge.triangle;
        }
    }
    void add(const Vec3& p, const Vec3& n, std::uint32_t triangle) {
        points_.push_back(p);
        triangles_.push_back(triangle);
        facing_.push_back(n.norm() > 1e-9 ? n.normalized() : n);
    }

    const geometry::TriangleMesh& mesh_;
    std::vector<std::pair<geometry::HalfEdge, Vec3>> sharp_;
    std::map<std::uint32_t, Corner> corners_;
    std::vector<Vec3> points_, facing_;
    std::vector<std::uint32_t> triangles_;  // of points_
};

}  // namespace

PointShell samplePoints(const geometry::TriangleMesh& mesh, double spacing) {
    PointShell shell;
    FaceSampler(mesh, spacing).run(shell);
    EdgeSampler(mesh).append(spacing, shell);
    // Half a unit in the last place of a float is at most 2^-24 of the number.
    const geometry::Bounds bounds = geometry::boundsOf(mesh);
    shell.rounding = 0x1p-24 * bounds.low.cwiseAbs().cwiseMax(bounds.high.cwiseAbs()).norm();
    return shell;
}

}  // namespace passung::shell
