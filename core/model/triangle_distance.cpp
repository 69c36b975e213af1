#include "core/model/triangle_distance.h"

#include <algorithm>

namespace passung::model {

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

}  // namespace passung::model
