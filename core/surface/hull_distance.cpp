#include "core/surface/hull_distance.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/field/instructions.h"

namespace passung::surface {

namespace {

using geometry::kLanes;

constexpr int kMostLooks = 32;
constexpr double kExact = 1e-4;      // of the distance: left between what is proven and what is reached
constexpr double kResolved = 1e-11;  // [m], the same
constexpr double kMost = 0.7;        // of the distance: enough where all of it would not do

using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
using LanePlaces = std::int64_t __attribute__((vector_size(kLanes * sizeof(double))));

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
    int best = 0;
    for (int k = 1; k < static_cast<int>(kLanes); ++k)
        if (least[k] < least[best] || (least[k] == least[best] && places[k] < places[best])) best = k;
    return {least[best], cluster.first + static_cast<std::uint32_t>(places[best])};
}

/// A difference of corners.
struct CornerDifference {
    Vec3 w;         // held less obstacle, world
    Vec3 held;      // part frame
    Vec3 obstacle;  // world
    std::uint32_t a = 0, b = 0;
    bool second = false;  // of the second pose
};

/// Up to four differences, and the point nearest to the origin of their hull as weights.
struct Simplex {
    std::array<CornerDifference, 4> at;
    std::array<double, 4> weight{};
    int count = 0;
    Vec3 v = Vec3::Zero();

    bool has(const CornerDifference& d) const noexcept {
        for (int i = 0; i < count; ++i) {
            const CornerDifference& mine = at[static_cast<std::size_t>(i)];
            if (mine.a == d.a && mine.b == d.b && mine.second == d.second) return true;
        }
        return false;
    }
};

struct Weights {
    std::array<double, 4> of{};
    double square = 1e300;  // of the nearest point's distance
};

PASSUNG_INLINE void tryPoint(const Simplex& s, std::size_t i, Weights& best) noexcept {
    const double square = s.at[i].w.squaredNorm();
    if (!(square < best.square)) return;
    best = {};
    best.of[i] = 1.0;
    best.square = square;
}

PASSUNG_INLINE void trySegment(const Simplex& s, std::size_t i, std::size_t k, Weights& best) noexcept {
    const Vec3 &p = s.at[i].w, e = s.at[k].w - p;
    const double length2 = e.squaredNorm();
    if (!(length2 > 0.0)) return;
    const double t = -p.dot(e) / length2;
    if (!(t > 0.0 && t < 1.0)) return;
    const double square = (p + t * e).squaredNorm();
    if (!(square < best.square)) return;
    best = {};
    best.of[i] = 1.0 - t;
    best.of[k] = t;
    best.square = square;
}

PASSUNG_INLINE void tryTriangle(const Simplex& s, std::size_t i, std::size_t k, std::size_t l, Weights& best) noexcept {
    const Vec3 &a = s.at[i].w, &b = s.at[k].w, &c = s.at[l].w;
    const Vec3 n = (b - a).cross(c - a);
    const double area2 = n.squaredNorm();
    if (!(area2 > 1e-20 * (b - a).squaredNorm() * (c - a).squaredNorm())) return;
    const double u = b.cross(c).dot(n), v = c.cross(a).dot(n), w = a.cross(b).dot(n);
    if (!(u > 0.0 && v > 0.0 && w > 0.0)) return;
    const double along = a.dot(n), square = along * along / area2;
    if (!(square < best.square)) return;
    const double total = u + v + w;
    best = {};
    best.of[i] = u / total;
    best.of[k] = v / total;
    best.of[l] = w / total;
    best.square = square;
}

/// True if the origin lies in the tetrahedron.
PASSUNG_INLINE bool holdsOrigin(const Simplex& s) noexcept {
    const Vec3 &a = s.at[0].w, &b = s.at[1].w, &c = s.at[2].w, &d = s.at[3].w;
    const double all = (b - a).cross(c - a).dot(d - a);
    const double scale = std::max({(b - a).norm(), (c - a).norm(), (d - a).norm()});
    if (!(std::abs(all) > 1e-14 * scale * scale * scale)) return false;
    const double oa = b.cross(c).dot(d), ob = -a.cross(c).dot(d), oc = a.cross(b).dot(d), od = -a.cross(b).dot(c);
    return all > 0.0 ? oa >= 0.0 && ob >= 0.0 && oc >= 0.0 && od >= 0.0
                     : oa <= 0.0 && ob <= 0.0 && oc <= 0.0 && od <= 0.0;
}

enum class Reduced { Nearer, Stalled, Inside };

/// Finds v and forgets what it does not need. The point nearest to the origin lies on a face of the last difference.
PASSUNG_INLINE Reduced reduce(Simplex& s) noexcept {
    Weights best;
    const auto n = static_cast<std::size_t>(s.count);
    if (n == 4 && holdsOrigin(s)) return Reduced::Inside;
    const std::size_t last = n - 1;
    tryPoint(s, last, best);
    for (std::size_t i = 0; i < last; ++i) trySegment(s, i, last, best);
    for (std::size_t i = 0; i < last; ++i)
        for (std::size_t k = i + 1; k < last; ++k) tryTriangle(s, i, k, last, best);
    if (n > 1 && !(best.square < s.v.squaredNorm())) return Reduced::Stalled;
    int kept = 0;
    s.v.setZero();
    for (std::size_t i = 0; i < n; ++i) {
        if (best.of[i] == 0.0) continue;
        const auto to = static_cast<std::size_t>(kept++);
        if (to != i) s.at[to] = s.at[i];
        s.weight[to] = best.of[i];
        s.v += best.of[i] * s.at[to].w;
    }
    s.count = kept;
    return Reduced::Nearer;
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

void describe(const Simplex& s, NearestHulls& result) noexcept {
    result.on_held.setZero();
    result.on_obstacle.setZero();
    result.held_at_corner = result.obstacle_at_corner = s.count > 0;
    for (int i = 0; i < s.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        result.on_held += s.weight[k] * s.at[k].held;
        result.on_obstacle += s.weight[k] * s.at[k].obstacle;
        result.held_at_corner = result.held_at_corner && s.at[k].a == s.at[0].a;
        result.obstacle_at_corner = result.obstacle_at_corner && s.at[k].b == s.at[0].b;
    }
    result.corner_held = s.at[0].a;
    result.corner_obstacle = s.at[0].b;
}

PASSUNG_INLINE NearestHulls iterateIn(const HullPair& pair, const Placement& X0, const Placement* X1, const Vec3& from,
                                      double enough, double hopeless) noexcept {
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
    for (result.looks = 1; result.looks <= kMostLooks; ++result.looks) {
        const Vec3 n = v / norm;
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
        }
        if (result.separation >= enough) break;
        if (s.count > 0) {
            if (norm - result.separation <= kExact * norm + kResolved) break;
            if (norm < hopeless) break;  // no plane can do
            if (norm < enough && hopeless > 0.0 && result.separation > std::max(hopeless, kMost * norm)) break;
        }
        CornerDifference d;
        d.a = held.corner;
        d.b = obstacle.corner;
        d.second = held.second;
        if (s.has(d)) break;
        d.held = pair.held.corner(d.a);
        d.obstacle = pair.obstacle.corner(d.b);
        d.w = (d.second ? *X1 : X0) * d.held - d.obstacle;
        s.at[static_cast<std::size_t>(s.count++)] = d;
        const Reduced reduced = reduce(s);
        if (reduced == Reduced::Stalled) {
            --s.count;
            break;
        }
        if (reduced == Reduced::Inside) {
            result.meets = true;
            break;
        }
        v = s.v;
        norm = v.norm();
        if (!(norm > 1e-13)) {
            result.meets = true;
            break;
        }
    }
    result.distance = result.meets ? 0.0 : std::max(norm, result.separation);
    if (!result.meets && s.count > 0) describe(s, result);
    return result;
}

PASSUNG_V3 NearestHulls iterateV3(const HullPair& pair, const Placement& X0, const Placement* X1, const Vec3& from,
                                  double enough, double hopeless) noexcept {
    const NearestHulls result = iterateIn(pair, X0, X1, from, enough, hopeless);
    PASSUNG_CLEAR_UPPER();
    return result;
}
NearestHulls iterateBaseline(const HullPair& pair, const Placement& X0, const Placement* X1, const Vec3& from,
                             double enough, double hopeless) noexcept {
    return iterateIn(pair, X0, X1, from, enough, hopeless);
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

NearestHulls iterate(const HullPair& pair, const Placement& X0, const Placement* X1, const Vec3& from, double enough,
                     double hopeless) noexcept {
    return kHasV3 ? iterateV3(pair, X0, X1, from, enough, hopeless)
                  : iterateBaseline(pair, X0, X1, from, enough, hopeless);
}

}  // namespace

double leastReachOf(const ClusterTree& tree, const Cluster& cluster, const Vec3& way) noexcept {
    return kHasV3 ? leastReachV3(tree, cluster, way) : leastReachBaseline(tree, cluster, way);
}

double separationAlong(const HullPair& pair, const Placement& X, const Vec3& n) noexcept {
    return leastReachOf(pair.held, pair.of_held, X.R.transpose() * n) + n.dot(X.p) +
           leastReachOf(pair.obstacle, pair.of_obstacle, -n);
}

NearestHulls nearestHulls(const HullPair& pair, const Placement& X, const Vec3& from, double enough,
                          double hopeless) noexcept {
    return iterate(pair, X, nullptr, from, enough, hopeless);
}

NearestHulls nearestHulls(const HullPair& pair, const Placement& X0, const Placement& X1, const Vec3& from,
                          double enough, double hopeless) noexcept {
    return iterate(pair, X0, &X1, from, enough, hopeless);
}

NearestHulls nearestPoints(const HullPair& pair, const Placement& X, const Vec3& from) noexcept {
    return iterate(pair, X, nullptr, from, 1e300, 0.0);
}

}  // namespace passung::surface
