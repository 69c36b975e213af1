#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/field/instructions.h"
#include "core/geometry/cluster_tree.h"

namespace passung::surface {

using Lanes = double __attribute__((vector_size(geometry::kLanes * sizeof(double))));
using LanePlaces = std::int64_t __attribute__((vector_size(geometry::kLanes * sizeof(double))));

/// Which corners a difference is of.
struct CornerPair {
    std::uint32_t held = 0, obstacle = 0;
    bool second = false;  // of the second pose
    bool operator==(const CornerPair&) const = default;
};

/// Up to three differences of corners, with the point v of their hull that lies nearest to the origin. A fourth one is
/// added and what v does not need is forgotten, as Gilbert, Johnson and Keerthi (1988) ask.
///   The nearest point of the larger hull lies on a face of the new difference a. With e_i = b_i - a:
///     segment   a + t e_i,        t = -a·e_i / e_i²
///     triangle  n (a·n) / n²,     n = e_i x e_k,  inside where (b_i x b_k)·n, (b_k x a)·n, (a x b_i)·n > 0
/// all of one kind in the lanes of a vector, and the least of those that exist.
struct Simplex {
    std::array<Vec3, 3> at{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    std::array<CornerPair, 3> of;
    std::array<double, 3> weight{};  // of v, times their sum
    int count = 0;
    Vec3 v = Vec3::Zero();

    enum class Reduced { Nearer, Stalled, Inside };

    PASSUNG_INLINE bool has(const CornerPair& pair) const noexcept {
        int found = 0;
        for (int i = 0; i < 3; ++i) {
            const CornerPair& known = of[static_cast<std::size_t>(i)];
            const int counts = i < count;
            const int same_held = known.held == pair.held;
            const int same_obstacle = known.obstacle == pair.obstacle;
            const int same_second = known.second == pair.second;
            found |= counts & same_held & same_obstacle & same_second;
        }
        return found != 0;
    }

    PASSUNG_INLINE Reduced add(const Vec3& a, const CornerPair& pair) noexcept;

    /// Begins with three whose triangle's inside has the nearest point; false if it has not.
    PASSUNG_INLINE bool takeTriangle(const std::array<Vec3, 3>& w, const std::array<CornerPair, 3>& pairs) noexcept {
        const Vec3 e = w[1] - w[0], f = w[2] - w[0], n = e.cross(f);
        const double area2 = n.squaredNorm();
        const double a = w[1].cross(w[2]).dot(n), b = w[2].cross(w[0]).dot(n), c = w[0].cross(w[1]).dot(n);
        if (!((area2 > 1e-20 * e.squaredNorm() * f.squaredNorm()) & (a > 0.0) & (b > 0.0) & (c > 0.0))) return false;
        v = (w[0].dot(n) / area2) * n;
        at = w;
        of = pairs;
        weight = {a, b, c};
        count = 3;
        return true;
    }

private:
    PASSUNG_INLINE void keepPoint(const Vec3& a, const CornerPair& pair) noexcept {
        at[0] = v = a;
        of[0] = pair;
        weight[0] = 1.0;
        count = 1;
    }
};

inline constexpr double kNoPoint = 1e300;

inline constexpr std::array<LanePlaces, 4> kSegments{
    LanePlaces{0, 0, 0, 0}, {-1, 0, 0, 0}, {-1, -1, 0, 0}, {-1, -1, -1, 0}};
inline constexpr std::array<LanePlaces, 4> kTriangles{
    LanePlaces{0, 0, 0, 0}, {0, 0, 0, 0}, {-1, 0, 0, 0}, {-1, -1, -1, 0}};

#define PASSUNG_TURNED(lanes) __builtin_shufflevector(lanes, lanes, 1, 2, 0, 3)

PASSUNG_INLINE Simplex::Reduced Simplex::add(const Vec3& a, const CornerPair& pair) noexcept {
    double best = a.squaredNorm();
    if (count == 0) {
        keepPoint(a, pair);
        return Reduced::Nearer;
    }
    const double ax = a.x(), ay = a.y(), az = a.z();
    const Lanes bx{at[0].x(), at[1].x(), at[2].x(), 0.0}, by{at[0].y(), at[1].y(), at[2].y(), 0.0},
        bz{at[0].z(), at[1].z(), at[2].z(), 0.0};
    const Lanes ex = bx - ax, ey = by - ay, ez = bz - az;
    const Lanes length2 = ex * ex + ey * ey + ez * ez;
    const Lanes t = -(ax * ex + ay * ey + az * ez) / length2;
    const Lanes px = ax + t * ex, py = ay + t * ey, pz = az + t * ez;
    const auto places = static_cast<std::size_t>(count);
    const Lanes none{kNoPoint, kNoPoint, kNoPoint, kNoPoint};
    const LanePlaces on_segment = kSegments[places] & (t > 0.0) & (t < 1.0);
    const Lanes segments = on_segment ? px * px + py * py + pz * pz : none;

    Lanes nx{}, ny{}, nz{}, share{}, of_a{}, of_b{}, of_c{}, triangles = none;
    if (count > 1) {
        const Lanes fx = PASSUNG_TURNED(ex), fy = PASSUNG_TURNED(ey), fz = PASSUNG_TURNED(ez);
        nx = ey * fz - ez * fy;
        ny = ez * fx - ex * fz;
        nz = ex * fy - ey * fx;
        const Lanes area2 = nx * nx + ny * ny + nz * nz;
        const Lanes along = ax * nx + ay * ny + az * nz;
        const Lanes cx = PASSUNG_TURNED(bx), cy = PASSUNG_TURNED(by), cz = PASSUNG_TURNED(bz);
        of_a = (by * cz - bz * cy) * nx + (bz * cx - bx * cz) * ny + (bx * cy - by * cx) * nz;
        of_b = (cy * az - cz * ay) * nx + (cz * ax - cx * az) * ny + (cx * ay - cy * ax) * nz;
        of_c = (ay * bz - az * by) * nx + (az * bx - ax * bz) * ny + (ax * by - ay * bx) * nz;
        if (count == 3) {
            const double all = nx[0] * ex[2] + ny[0] * ey[2] + nz[0] * ez[2];
            const double longest2 = std::max(std::max(length2[0], length2[1]), length2[2]);
            const double opposite = at[0].cross(at[1]).dot(at[2]);
            const bool inside = (all * all > 1e-28 * longest2 * longest2 * longest2) & (along[0] * all <= 0.0) &
                                (along[1] * all <= 0.0) & (along[2] * all <= 0.0) & (opposite * all >= 0.0);
            if (inside) return Reduced::Inside;
        }
        share = along / area2;
        const LanePlaces in_triangle = kTriangles[places] & (area2 > 1e-20 * length2 * PASSUNG_TURNED(length2)) &
                                       (of_a > 0.0) & (of_b > 0.0) & (of_c > 0.0);
        triangles = in_triangle ? along * share : none;
    }
    int which = -1;
    for (int i = 0; i < 3; ++i) {
        const bool less = segments[i] < best;
        best = less ? segments[i] : best;
        which = less ? i : which;
    }
    for (int i = 0; i < 3; ++i) {
        const bool less = triangles[i] < best;
        best = less ? triangles[i] : best;
        which = less ? 3 + i : which;
    }
    if (!(best < v.squaredNorm())) return Reduced::Stalled;
    if (which < 0) {
        keepPoint(a, pair);
    } else if (which < 3) {
        const auto i = static_cast<std::size_t>(which);
        v = {px[which], py[which], pz[which]};
        at[0] = at[i];
        of[0] = of[i];
        at[1] = a;
        of[1] = pair;
        weight = {t[which], 1.0 - t[which], 0.0};
        count = 2;
    } else {
        const int lane = which - 3;
        const auto i = static_cast<std::size_t>(lane), k = (i + 1) % 3;
        v = share[lane] * Vec3(nx[lane], ny[lane], nz[lane]);
        const Vec3 b = at[i], c = at[k];
        const CornerPair of_i = of[i], of_k = of[k];
        at = {b, c, a};
        of = {of_i, of_k, pair};
        weight = {of_b[lane], of_c[lane], of_a[lane]};
        count = 3;
    }
    return Reduced::Nearer;
}

#undef PASSUNG_TURNED

}  // namespace passung::surface
