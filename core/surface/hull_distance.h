#pragma once

#include <array>

#include "core/geometry/cluster_tree.h"
#include "core/surface/approach.h"

namespace passung::surface {

using geometry::Cluster;
using geometry::ClusterTree;

/// A pose as a matrix, and a rigid motion's effect on directions.
struct Placement {
    Mat3 R = Mat3::Identity();
    Vec3 p = Vec3::Zero();

    Placement() = default;
    explicit Placement(const Pose& X) : R(X.q.toRotationMatrix()), p(X.p) {}
    Vec3 operator*(const Vec3& point) const noexcept { return R * point + p; }
};

/// Two hulls: one of the held part, one of an obstacle in the world.
struct HullPair {
    const ClusterTree& held;
    const ClusterTree& obstacle;
    const Cluster& of_held;
    const Cluster& of_obstacle;
};

/// How far the plane with unit normal `n` sets the held hull at `X` apart from the obstacle's; < 0: not at all.
/// rt-safe.
double separationAlong(const HullPair& pair, const Placement& X, const Vec3& n) noexcept;
/// How far the hull of a cluster reaches along `way` at least, in the cluster's own frame. rt-safe.
double leastReachOf(const ClusterTree& tree, const Cluster& cluster, const Vec3& way) noexcept;

/// Corners whose differences the point nearest to the origin lay between last: a search that begins with them ends soon
/// where a pose has changed little. None: it begins with a direction.
struct CornerSeed {
    std::array<std::uint16_t, 3> held{}, obstacle{};  // of those of the hull
    std::uint16_t count = 0;
};

/// Where two hulls come nearest.
struct NearestHulls {
    Vec3 n = Vec3::Zero();            // unit, from the obstacle to the held part, world
    double separation = -1e300;       // proven along n: no greater than the distance [m]
    double distance = 0.0;            // no less than the true one [m]
    Vec3 on_held = Vec3::Zero();      // part frame; this and what follows: of nearestPoints() alone
    Vec3 on_obstacle = Vec3::Zero();  // world
    bool held_at_corner = false, obstacle_at_corner = false;
    bool meets = false;
    int looks = 0;
};

/// The distance of the obstacle's hull from the held one's, or from that of two poses of it: hull(X0 a, X1 a).
///   Source: Gilbert, Johnson and Keerthi (1988). v is the point nearest to the origin of a simplex of differences of
/// corners; the corner w of the difference set that lies least far along v either proves that v/|v| separates by
/// v·w/|v|, or joins the simplex. Every plane is judged by the corners themselves: whatever the iteration does,
/// `separation` holds.
/// `from`: a direction to begin with. Ends where `enough` is proven, where a distance of `hopeless` cannot be reached,
/// or where more than that and most of a distance that is less than `enough` is proven. `seed`: to begin with, and what
/// is left at the end. rt-safe, bounded.
/// `enough`: of the plane's class of normals.
NearestHulls nearestHulls(const HullPair& pair, const Placement& X, const Vec3& from, const PerClass& enough,
                          double hopeless) noexcept;
NearestHulls nearestHulls(const HullPair& pair, const Placement& X, const Vec3& from, double enough,
                          double hopeless) noexcept;
NearestHulls nearestHulls(const HullPair& pair, const Placement& X0, const Placement& X1, const Vec3& from,
                          double enough, double hopeless, CornerSeed& seed) noexcept;
/// To the end, with the points.
NearestHulls nearestPoints(const HullPair& pair, const Placement& X, const Vec3& from) noexcept;
NearestHulls nearestPoints(const HullPair& pair, const Placement& X, const Vec3& from, CornerSeed& seed) noexcept;

}  // namespace passung::surface
