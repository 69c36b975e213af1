#include "core/geometry/triangle_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace passung::geometry {

Vec3 closestOnSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 e = b - a;
    const double length2 = e.squaredNorm();
    return length2 > 0.0 ? Vec3(a + std::clamp((p - a).dot(e) / length2, 0.0, 1.0) * e) : a;
}

/// Closest point of a triangle by the Voronoi regions of its corners, edges and face
/// (C. Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
Vec3 closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0.0 && d2 <= 0.0) return a;
    const Vec3 bp = p - b;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0.0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3) return a + d1 / (d1 - d3) * ab;
    const Vec3 cp = p - c;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0.0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6) return a + d2 / (d2 - d6) * ac;
    const double va = d3 * d6 - d5 * d4;
    const double along_bc = d4 - d3, against_bc = d5 - d6;
    if (va <= 0.0 && along_bc >= 0.0 && against_bc >= 0.0 && along_bc + against_bc > 0.0)
        return b + along_bc / (along_bc + against_bc) * (c - b);
    const double total = va + vb + vc;
    return a + vb / total * ab + vc / total * ac;
}

namespace {

/// The nearest points of two segments (Ericson 2005, section 5.1.9).
void closestOfSegments(const Vec3& p1, const Vec3& q1, const Vec3& p2, const Vec3& q2, Vec3& c1, Vec3& c2) {
    const Vec3 d1 = q1 - p1, d2 = q2 - p2, r = p1 - p2;
    const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r), c = d1.dot(r), b = d1.dot(d2);
    const double denominator = a * e - b * b;
    double s = denominator > 0.0 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
    double t = e > 0.0 ? (b * s + f) / e : 0.0;
    if (!(t >= 0.0 && t <= 1.0)) {
        t = std::clamp(t, 0.0, 1.0);
        s = a > 0.0 ? std::clamp((b * t - c) / a, 0.0, 1.0) : 0.0;
    }
    c1 = p1 + s * d1;
    c2 = p2 + t * d2;
}

/// Signed distances of the corners of a triangle from the plane of another, times the length of that one's `normal`.
struct Sides {
    Vec3 normal;
    std::array<double, 3> of;

    Sides(const TriangleCorners& plane, const TriangleCorners& corners)
        : normal((plane[1] - plane[0]).cross(plane[2] - plane[0])) {
        for (std::size_t i = 0; i < 3; ++i) of[i] = normal.dot(corners[i] - plane[0]);
    }
    bool fartherThan(double limit) const {
        const double far = limit * normal.norm();
        return (of[0] > far && of[1] > far && of[2] > far) || (of[0] < -far && of[1] < -far && of[2] < -far);
    }
};

}  // namespace

namespace {

constexpr int kProjections = 8;

}  // namespace

bool findWay(const TriangleCorners& first, const TriangleCorners& second, double limit, Vec3& way) {
    Vec3 p = (first[0] + first[1] + first[2]) / 3.0;
    for (int i = 0; i < kProjections; ++i) {
        const Vec3 q = closestOnTriangle(p, second[0], second[1], second[2]);
        p = closestOnTriangle(q, first[0], first[1], first[2]);
        const double length = (p - q).norm();
        if (!(length > limit)) return false;
        way = (p - q) / length;
        const double from = std::min({way.dot(first[0]), way.dot(first[1]), way.dot(first[2])});
        const double to = std::max({way.dot(second[0]), way.dot(second[1]), way.dot(second[2])});
        if (from - to > limit) return true;
    }
    return false;
}

TrianglePair closestPair(const TriangleCorners& first, const TriangleCorners& second, double limit) {
    const Sides of_first(second, first), of_second(first, second);
    TrianglePair best{std::numeric_limits<double>::infinity(), first[0], second[0]};
    // Rounding may name the wrong side only by far less than this.
    const double sure = limit * (1.0 + 1e-9);
    if (of_first.fartherThan(sure) || of_second.fartherThan(sure)) return best;
    if (Vec3 way; findWay(first, second, sure, way)) return best;
    double squared = std::numeric_limits<double>::infinity();
    const auto take = [&](const Vec3& a, const Vec3& b) {
        const double d = (a - b).squaredNorm();
        if (!(d < squared)) return;
        squared = d;
        best.on_first = a;
        best.on_second = b;
    };
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        take(first[i], closestOnTriangle(first[i], second[0], second[1], second[2]));
        take(closestOnTriangle(second[i], first[0], first[1], first[2]), second[i]);
        for (std::size_t j = 0; j < 3; ++j) {
            Vec3 a, b;
            closestOfSegments(first[i], first[next], second[j], second[(j + 1) % 3], a, b);
            take(a, b);
        }
        // An edge that passes through the other's plane: the place, and the other's point next to it.
        if (of_first.of[i] * of_first.of[next] < 0.0) {
            const Vec3 p = first[i] + of_first.of[i] / (of_first.of[i] - of_first.of[next]) * (first[next] - first[i]);
            take(p, closestOnTriangle(p, second[0], second[1], second[2]));
        }
        if (of_second.of[i] * of_second.of[next] < 0.0) {
            const Vec3 p =
                second[i] + of_second.of[i] / (of_second.of[i] - of_second.of[next]) * (second[next] - second[i]);
            take(closestOnTriangle(p, first[0], first[1], first[2]), p);
        }
    }
    best.distance = std::sqrt(squared);
    return best;
}

namespace {

constexpr double kFlat = 1e-6;  // a triangle of less than this share of the area that its sides could span
constexpr double kRootRounding = 1e-10;

}  // namespace

double leastDistance(const TriangleCorners& t, const std::array<double, 3>& l, double enough) {
    const std::array<double, 3> L{l[0] * l[0], l[1] * l[1], l[2] * l[2]};
    const Vec3 e1 = t[1] - t[0], e2 = t[2] - t[0];
    const double E1 = e1.squaredNorm(), E2 = e2.squaredNorm(), E3 = (e2 - e1).squaredNorm();
    const double longest = std::max({E1, E2, E3});
    double least = std::min({L[0], L[1], L[2]}) - longest / 3.0;
    if (least > enough && least > 0.0) return std::sqrt(least) * (1.0 - kRootRounding);
    const double g = e1.dot(e2), area2 = E1 * E2 - g * g;
    if (area2 > kFlat * E1 * E2) {
        const auto onEdge = [](double from, double to, double E) {
            const double rise = to - from;
            if (!(std::abs(rise) < E)) return std::min(from, to);
            const double s = 0.5 - 0.5 * rise / E;
            return from + s * rise - s * (1.0 - s) * E;
        };
        least = std::min({onEdge(L[0], L[1], E1), onEdge(L[0], L[2], E2), onEdge(L[1], L[2], E3)});
        const double b1 = 0.5 * (E1 - (L[1] - L[0])), b2 = 0.5 * (E2 - (L[2] - L[0]));
        const double s = (b1 * E2 - b2 * g) / area2, r = (b2 * E1 - b1 * g) / area2;
        if (s > 0.0 && r > 0.0 && s + r < 1.0) least = std::min(least, L[0] - s * b1 - r * b2);
    }
    least -= kRootRounding * (longest + std::max({L[0], L[1], L[2]}));
    return least > 0.0 ? std::sqrt(least) : -std::numeric_limits<double>::infinity();
}

}  // namespace passung::geometry
