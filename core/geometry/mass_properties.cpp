#include "core/geometry/mass_properties.h"

namespace passung::geometry {

MassProperties massOf(const TriangleMesh& mesh, double density) {
    const Bounds bounds = boundsOf(mesh);
    const Vec3 o = 0.5 * (bounds.low + bounds.high);
    double volume = 0.0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]] - o, b = mesh.vertices[t[1]] - o, c = mesh.vertices[t[2]] - o;
        const Vec3 s = a + b + c;
        const double D = a.dot(b.cross(c));
        volume += D / 6.0;
        first += D / 24.0 * s;
        second += D / 120.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
    }
    if (!(volume != 0.0)) return {};
    const Vec3 r = first / volume;
    const Mat3 C = density * (second - volume * r * r.transpose());
    return {density * volume, o + r, C.trace() * Mat3::Identity() - C};
}

Mat3 inertiaAbout(const MassProperties& body, const Vec3& point) {
    const Vec3 d = point - body.centre;
    return body.inertia + body.mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
}

MassProperties together(const MassProperties& a, const MassProperties& b) {
    MassProperties both;
    both.mass = a.mass + b.mass;
    both.centre = (a.mass * a.centre + b.mass * b.centre) / both.mass;
    both.inertia = inertiaAbout(a, both.centre) + inertiaAbout(b, both.centre);
    return both;
}

}  // namespace passung::geometry
