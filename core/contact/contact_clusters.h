#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.h"
#include "core/contact/contact_query.h"

namespace passung::contact {

/// A patch of contact: points inside the obstacle that hang together; world frame.
struct ContactCluster {
    Vec3 deepest = Vec3::Zero();         // position of its deepest point
    double phi = 0.0;                    // there [m], < 0
    Vec3 normal = Vec3::Zero();          // unit, out of the obstacle: the mean of the shell's normals, reversed
    Vec3 pressure_point = Vec3::Zero();  // where `push` acts: the mean of the points, weighted with area times depth
    Vec3 push = Vec3::Zero();  // Σ area · depth · (- normal of the point) [m³]; times κ the penalty force
    double area = 0.0;         // [m²]
    double volume = 0.0;       // Σ area · depth [m³]
    std::uint32_t points = 0;
};

/// Parts a manifold into patches (the thesis's segmented manifold; the rule is ours).
///   Two points with an area belong together if they are no farther apart than `link` and their normals differ by less
/// than 60°, and so do all that are joined by such pairs: the two walls of a slot are two patches, a ring is one. With
/// `link` twice the shell's cover radius, points of neighbouring pieces of surface are always joined; patches that come
/// closer than that may be one. Points without area (on edges and corners) would join what meets there: each goes to
/// the nearest patch that faces its way, or makes a patch with others of its kind. Spheres and points with φ ≥ 0 are
/// left out.
///   A patch's area is that of its points' pieces of surface. Along its border, of length l, pieces are counted whole
/// or not at all: it is off by at most l times the cover radius, by far less in the mean.
/// Memory is sized once. rt-safe; of the number n of points n log n steps, but n² if all are closer than `link`.
class ClusterFinder {
public:
    static constexpr std::size_t kMostClusters = 128;

    /// `capacity`: of the largest manifold.
    explicit ClusterFinder(std::size_t capacity = 0);

    /// The deepest patches first, at most kMostClusters; valid until the next call. Points beyond the capacity are left
    /// out. @pre `link` > 0.
    std::span<const ContactCluster> find(const ContactManifold& manifold, double link) noexcept;

    /// How many there were in the last manifold.
    std::size_t found() const noexcept { return found_; }

private:
    struct Point {
        Vec3 position, normal;
        double area = 0.0, phi = 0.0;
        std::uint32_t next = 0;   // in the same bucket
        std::uint32_t group = 0;  // a point of the same patch, in the end the first
        bool joins = true;        // others to its patch
    };
    std::size_t bucketOf(const Vec3& position, double link, int x, int y, int z) const noexcept;
    std::uint32_t firstOf(std::uint32_t i) noexcept;
    void collect(const ContactManifold& manifold, double link) noexcept;
    void joinFaces(double link) noexcept;
    void joinEdges(double link) noexcept;
    void sum() noexcept;
    template <class Visit>
    void visitNear(std::uint32_t i, double link, Visit visit) noexcept;

    std::vector<Point> points_;
    std::size_t count_ = 0;
    std::vector<std::uint32_t> buckets_;  // first point; a power of two many
    std::vector<std::uint32_t> cluster_;  // of the first point of each patch
    std::vector<ContactCluster> clusters_;
    std::size_t found_ = 0;
};

}  // namespace passung::contact
