#include "core/surface/hull_distance.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/surface/hull_simplex.h"

namespace passung::surface {

namespace {

using geometry::kLanes;

constexpr int kMostLooks = 32;
constexpr double kExact = 1e-4;         // of the distance: left between what is proven and what is reached
constexpr double kResolved = 1e-11;     // [m], the same
constexpr double kLeastPlanted = 1e-9;  // [m]: nearer to the origin a simplex of before tells no direction
constexpr double kMost = 0.7;           // of the distance: enough where all of it would not do

PASSUNG_INLINE void load(const double* from, Lanes& lanes) noexcept { std::memcpy(&lanes, from, sizeof lanes); }

/// How far the corners at `i` reach.
struct CornerLanes {
    const double *x, *y, *z;
    Vec3 way;

    PASSUNG_INLINE CornerLanes(const ClusterTree& tree, const Cluster& cluster, const Vec3& along) noexcept
        : x(tree.x() + cluster.first), y(tree.y() + cluster.first), z(tree.z() + cluster.first), way(along) {}
    PASSUNG_INLINE void reach(std::uint32_t i, Lanes& result) const noexcept {
        Lanes at_x, at_y, at_z;
        load(x + i, at_x);
        load(y + i, at_y);
        load(z + i, at_z);
        result = way.x() * at_x + way.y() * at_y + way.z() * at_z;
    }
};

/// A corner of a hull that reaches least far along a direction.
struct Extreme {
    double reach = 0.0;  // along the direction [m]
    std::uint32_t corner = 0;
};

/// Only how far.
PASSUNG_INLINE double leastReach(const ClusterTree& tree, const Cluster& cluster, const Vec3& way) noexcept {
    const CornerLanes corners(tree, cluster, way);
    Lanes least, reach;
    corners.reach(0, least);
    for (std::uint32_t i = kLanes; i < cluster.count; i += kLanes) {
        corners.reach(i, reach);
        least = reach < least ? reach : least;
    }
    return std::min(std::min(least[0], least[1]), std::min(least[2], least[3]));
}

/// The first of those that reach least far.
PASSUNG_INLINE Extreme leastAlong(const ClusterTree& tree, const Cluster& cluster, const Vec3& way) noexcept {
    const CornerLanes corners(tree, cluster, way);
    Lanes least, reach;
    corners.reach(0, least);
    LanePlaces places{0, 1, 2, 3}, now = places;
    for (std::uint32_t i = kLanes; i < cluster.count; i += kLanes) {
        corners.reach(i, reach);
        now += kLanes;
        const auto less = reach < least;
        least = less ? reach : least;
        places = less ? now : places;
    }
    Lanes other = __builtin_shufflevector(least, least, 2, 3, 0, 1);
    Lanes all = other < least ? other : least;
    other = __builtin_shufflevector(all, all, 1, 0, 3, 2);
    all = other < all ? other : all;
    constexpr std::int64_t kNowhere = std::numeric_limits<std::int64_t>::max();
    places = least == all ? places : LanePlaces{kNowhere, kNowhere, kNowhere, kNowhere};
    LanePlaces place = __builtin_shufflevector(places, places, 2, 3, 0, 1);
    places = place < places ? place : places;
    place = __builtin_shufflevector(places, places, 1, 0, 3, 2);
    places = place < places ? place : places;
    return {all[0], cluster.first + static_cast<std::uint32_t>(places[0])};
}

/// Corners of the held hull at one or two poses.
struct HeldReach {
    double least;  // along the direction, world [m]
    std::uint32_t corner;
    bool second;
};

PASSUNG_INLINE HeldReach leastOfHeld(const HullPair& pair, const Placement& X, const Vec3& n) noexcept {
    const Extreme e = leastAlong(pair.held, pair.of_held, X.R.transpose() * n);
    return {e.reach + n.dot(X.p), e.corner, false};
}

PASSUNG_INLINE void describe(const HullPair& pair, const Simplex& s, NearestHulls& result) noexcept {
    result.held_at_corner = result.obstacle_at_corner = true;
    double sum = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.count); ++i) {
        sum += s.weight[i];
        result.on_held += s.weight[i] * pair.held.corner(s.of[i].held);
        result.on_obstacle += s.weight[i] * pair.obstacle.corner(s.of[i].obstacle);
        result.held_at_corner = result.held_at_corner && s.of[i].held == s.of[0].held;
        result.obstacle_at_corner = result.obstacle_at_corner && s.of[i].obstacle == s.of[0].obstacle;
    }
    result.on_held /= sum;
    result.on_obstacle /= sum;
    // Exactly there.
    if (result.held_at_corner) result.on_held = pair.held.corner(s.of[0].held);
    if (result.obstacle_at_corner) result.on_obstacle = pair.obstacle.corner(s.of[0].obstacle);
}

/// What is asked for.
struct Aim {
    double enough = 1e300, hopeless = 0.0;
    const PerClass* enough_of = nullptr;  // of classes of normals, instead
    CornerSeed* seed = nullptr;
    bool points = false;  // wanted too
};

/// Begins with corners of before, at the last pose.
PASSUNG_INLINE void plant(const HullPair& pair, const Placement& X, bool second, const CornerSeed& seed,
                          Simplex& s) noexcept {
    std::array<Vec3, 3> at;
    std::array<CornerPair, 3> of;
    const std::size_t count = seed.count;
    for (std::size_t i = 0; i < count; ++i) {
        of[i] = {pair.of_held.first + seed.held[i], pair.of_obstacle.first + seed.obstacle[i], second};
        at[i] = X * pair.held.corner(of[i].held) - pair.obstacle.corner(of[i].obstacle);
    }
    if (count == 3 && s.takeTriangle(at, of)) return;
    for (std::size_t i = 0; i < count; ++i) s.add(at[i], of[i]);
}

PASSUNG_INLINE void keep(const HullPair& pair, const Simplex& s, CornerSeed& seed) noexcept {
    seed.count = static_cast<std::uint16_t>(s.count);
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.count); ++i) {
        seed.held[i] = static_cast<std::uint16_t>(s.of[i].held - pair.of_held.first);
        seed.obstacle[i] = static_cast<std::uint16_t>(s.of[i].obstacle - pair.of_obstacle.first);
    }
}

PASSUNG_INLINE NearestHulls iterateIn(const HullPair& pair, const Placement& X0, const Placement* X1, const Vec3& from,
                                      const Aim& aim) noexcept {
    const double enough = aim.enough, hopeless = aim.hopeless;
    NearestHulls result;
    Simplex s;
    Vec3 v = from;
    double norm = v.norm();
    if (!(norm > 0.0)) {
        v = X0 * pair.of_held.centre - pair.of_obstacle.centre;
        norm = v.norm();
        if (!(norm > 0.0)) {
            v = Vec3::UnitZ();
            norm = 1.0;
        }
    }
    if (aim.seed != nullptr && aim.seed->count > 0) {
        plant(pair, X1 != nullptr ? *X1 : X0, X1 != nullptr, *aim.seed, s);
        const double least = s.v.norm();
        if (least > kLeastPlanted) {
            v = s.v;
            norm = least;
        } else {
            s.count = 0;
        }
    }
    for (result.looks = 1; result.looks <= kMostLooks; ++result.looks) {
        const Vec3 n = v * (1.0 / norm);
        HeldReach held = leastOfHeld(pair, X0, n);
        if (X1 != nullptr) {
            HeldReach then = leastOfHeld(pair, *X1, n);
            then.second = true;
            if (then.least < held.least) held = then;
        }
        const Extreme obstacle = leastAlong(pair.obstacle, pair.of_obstacle, -n);
        const double separation = held.least + obstacle.reach;
        if (separation > result.separation) {
            result.separation = separation;
            result.n = n;
            if (aim.enough_of != nullptr && separation >= (*aim.enough_of)[NormalClass::of(n)]) break;
        }
        if (result.separation >= enough) break;
        if (s.count > 0) {
            if (norm - result.separation <= kExact * norm + kResolved) break;
            if (norm < hopeless) break;  // no plane can do
            if (norm < enough && hopeless > 0.0 && result.separation > std::max(hopeless, kMost * norm)) break;
        }
        const CornerPair corners{held.corner, obstacle.corner, held.second};
        if (s.has(corners)) break;
        const Vec3 difference =
            (held.second ? *X1 : X0) * pair.held.corner(corners.held) - pair.obstacle.corner(corners.obstacle);
        const Simplex::Reduced reduced = s.add(difference, corners);
        if (reduced == Simplex::Reduced::Stalled) break;
        v = s.v;
        norm = v.norm();
        if (reduced == Simplex::Reduced::Inside || !(norm > 1e-13)) {
            result.meets = true;
            break;
        }
    }
    if (aim.seed != nullptr) {
        if (result.meets)
            aim.seed->count = 0;
        else
            keep(pair, s, *aim.seed);
    }
    result.distance = result.meets ? 0.0 : std::max(norm, result.separation);
    if (aim.points && !result.meets && s.count > 0) describe(pair, s, result);
    return result;
}

PASSUNG_V3 NearestHulls iterateV3(const HullPair& pair, const Placement& X0, const Placement* X1, const Vec3& from,
                                  const Aim& aim) noexcept {
    NearestHulls result = iterateIn(pair, X0, X1, from, aim);
    PASSUNG_CLEAR_UPPER();
    return result;
}
NearestHulls iterateBaseline(const HullPair& pair, const Placement& X0, const Placement* X1, const Vec3& from,
                             const Aim& aim) noexcept {
    return iterateIn(pair, X0, X1, from, aim);
}
PASSUNG_V3 double leastReachV3(const ClusterTree& tree, const Cluster& cluster, const Vec3& way) noexcept {
    const double reach = leastReach(tree, cluster, way);
    PASSUNG_CLEAR_UPPER();
    return reach;
}
double leastReachBaseline(const ClusterTree& tree, const Cluster& cluster, const Vec3& way) noexcept {
    return leastReach(tree, cluster, way);
}

const bool kHasV3 = field::bestInstructions() >= field::Instructions::V3;

NearestHulls iterate(const HullPair& pair, const Placement& X0, const Placement* X1, const Vec3& from,
                     const Aim& aim) noexcept {
    return kHasV3 ? iterateV3(pair, X0, X1, from, aim) : iterateBaseline(pair, X0, X1, from, aim);
}

/// Null: more corners than a seed can tell.
CornerSeed* seedFor(const HullPair& pair, CornerSeed& seed) noexcept {
    constexpr std::uint32_t kTold = std::numeric_limits<std::uint16_t>::max();
    return pair.of_held.count <= kTold && pair.of_obstacle.count <= kTold ? &seed : nullptr;
}

}  // namespace

double leastReachOf(const ClusterTree& tree, const Cluster& cluster, const Vec3& way) noexcept {
    return kHasV3 ? leastReachV3(tree, cluster, way) : leastReachBaseline(tree, cluster, way);
}

double separationAlong(const HullPair& pair, const Placement& X, const Vec3& n) noexcept {
    return leastReachOf(pair.held, pair.of_held, X.R.transpose() * n) + n.dot(X.p) +
           leastReachOf(pair.obstacle, pair.of_obstacle, -n);
}

NearestHulls nearestHulls(const HullPair& pair, const Placement& X, const Vec3& from, const PerClass& enough,
                          double hopeless) noexcept {
    return iterate(pair, X, nullptr, from, {.hopeless = hopeless, .enough_of = &enough});
}

NearestHulls nearestHulls(const HullPair& pair, const Placement& X, const Vec3& from, double enough,
                          double hopeless) noexcept {
    return iterate(pair, X, nullptr, from, {.enough = enough, .hopeless = hopeless});
}

NearestHulls nearestHulls(const HullPair& pair, const Placement& X0, const Placement& X1, const Vec3& from,
                          double enough, double hopeless, CornerSeed& seed) noexcept {
    return iterate(pair, X0, &X1, from, {.enough = enough, .hopeless = hopeless, .seed = seedFor(pair, seed)});
}

NearestHulls nearestPoints(const HullPair& pair, const Placement& X, const Vec3& from) noexcept {
    return iterate(pair, X, nullptr, from, {.points = true});
}

NearestHulls nearestPoints(const HullPair& pair, const Placement& X, const Vec3& from, CornerSeed& seed) noexcept {
    return iterate(pair, X, nullptr, from, {.seed = seedFor(pair, seed), .points = true});
}

}  // namespace passung::surface
