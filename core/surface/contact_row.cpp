#include "core/surface/contact_row.h"

#include <cmath>

namespace passung::surface {

namespace {

constexpr double kParallel = 1e-7;   // 1 - cosine: a direction is a face's normal
constexpr double kSamePlace = 1e-7;  // [m]
constexpr double kSameTurn = 1e-6;   // of unit normals
constexpr double kFar = 2e-4;        // [m]

/// True if `p` projects into the face of `cluster`, whose corners run around `normal` in some order.
///   A convex face: the nearest point of the hull to a point over it lies straight below.
bool liesOver(const ClusterTree& tree, const Cluster& face, const Vec3& p, const Vec3& normal) noexcept {
    // Corners lie in order; the padding repeats the last.
    bool left = false, right = false;
    for (std::uint32_t i = 0; i < face.count; ++i) {
        const Vec3 a = tree.corner(face.first + i), b = tree.corner(face.first + (i + 1) % face.count);
        const Vec3 side = b - a;
        const double turn = side.cross(p - a).dot(normal), slack = 1e-9 * side.norm();
        left = left || turn > slack;
        right = right || turn < -slack;
    }
    return !(left && right);
}

Vec3 facing(const Vec3& normal, const Vec3& n) noexcept { return normal.dot(n) < 0.0 ? Vec3(-normal) : normal; }

/// The corner of the held face that would go deepest beyond the plane of the obstacle's face, of those over it.
bool takeHeldCorner(const HullPair& pair, const Placement& X, const Placement& X1, ContactRow& row) noexcept {
    double least = 1e300;
    for (std::uint32_t i = 0; i < pair.of_held.count; ++i) {
        const Vec3 corner = pair.held.corner(pair.of_held.first + i);
        const double reach = row.n.dot(X1 * corner);
        if (!(reach < least) || !liesOver(pair.obstacle, pair.of_obstacle, X * corner, pair.of_obstacle.normal))
            continue;
        least = reach;
        row.p_held = corner;
    }
    return least < 1e300;
}

/// The same the other way round.
bool takeObstacleCorner(const HullPair& pair, const Placement& X, const Placement& X1, ContactRow& row) noexcept {
    double most = -1e300;
    const Vec3 n = X1.R * row.n_held;
    for (std::uint32_t i = 0; i < pair.of_obstacle.count; ++i) {
        const Vec3 corner = pair.obstacle.corner(pair.of_obstacle.first + i);
        const double reach = n.dot(corner);
        const Vec3 in_held = X.R.transpose() * (corner - X.p);
        if (!(reach > most) || !liesOver(pair.held, pair.of_held, in_held, pair.of_held.normal)) continue;
        most = reach;
        row.p_obstacle = corner;
    }
    return most > -1e300;
}

void set(ContactRow& row, const Placement& X) noexcept {
    if (row.on_held) row.n = X.R * row.n_held;
    row.s = row.n.dot(X * row.p_held - row.p_obstacle);
}

}  // namespace

bool ContactRow::isLike(const ContactRow& other) const noexcept {
    return body == other.body && held == other.held && obstacle == other.obstacle && on_held == other.on_held &&
           fixed == other.fixed &&
           (!fixed || ((p_held - other.p_held).squaredNorm() < kSamePlace * kSamePlace &&
                       (p_obstacle - other.p_obstacle).squaredNorm() < kSamePlace * kSamePlace &&
                       (n - other.n).squaredNorm() < kSameTurn * kSameTurn));
}

ContactRow rowBetween(const HullPair& pair, const Placement& X0, const Placement& X, const NearestHulls& there,
                      const Placement& X1) noexcept {
    ContactRow row;
    row.p_held = there.on_held;
    row.p_obstacle = there.on_obstacle;
    const Vec3 of_obstacle = facing(pair.of_obstacle.normal, there.n);
    const Vec3 of_held = facing(X.R * pair.of_held.normal, there.n);
    if (1.0 - of_obstacle.dot(there.n) < kParallel) {
        row.n = of_obstacle;
        if (there.held_at_corner || takeHeldCorner(pair, X, X1, row)) {
            // Every corner of a flat face lies in its plane: one that does not move from look to look.
            row.p_obstacle = pair.obstacle.corner(pair.of_obstacle.first);
            set(row, X0);
            return row;
        }
    }
    if (1.0 - of_held.dot(there.n) < kParallel) {
        row.on_held = true;
        row.n_held = X.R.transpose() * of_held;
        if (there.obstacle_at_corner || takeObstacleCorner(pair, X, X1, row)) {
            row.p_held = pair.held.corner(pair.of_held.first);
            set(row, X0);
            return row;
        }
    }
    row.fixed = false;
    row.n = there.n;
    row.n_held = X.R.transpose() * there.n;
    row.p_held = there.on_held;
    row.p_obstacle = there.on_obstacle;
    set(row, X0);
    return row;
}

bool isOverItsFace(const ContactRow& row, const HullPair& pair, const Placement& X) noexcept {
    if (!row.fixed) return true;
    if (!row.on_held) return liesOver(pair.obstacle, pair.of_obstacle, X * row.p_held, pair.of_obstacle.normal);
    return liesOver(pair.held, pair.of_held, X.R.transpose() * (row.p_obstacle - X.p), pair.of_held.normal);
}

bool refresh(ContactRow& row, const HullPair& pair, const Placement& X) noexcept {
    row.bend = 0.0;
    if (!row.fixed) {
        const NearestHulls now = nearestPoints(pair, X, row.n, row.seed);
        if (now.meets || !(now.separation > 0.0) || now.distance > kFar) return false;
        row.n = now.n;
        row.n_held = X.R.transpose() * now.n;
        row.p_held = now.on_held;
        row.p_obstacle = now.on_obstacle;
    }
    set(row, X);
    return row.s > 0.0 && row.s < kFar;
}

}  // namespace passung::surface
