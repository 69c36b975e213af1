#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/surface_cases.h"

/// A bolt in its nut as triangles that follow the helix; made here, by code of its own.
namespace passung::test {

/// ISO 68-1, about the z axis, right-handed.
struct Thread {
    double pitch = 1.25e-3, crest = 4e-3, root = 3.3235e-3;  // radii [m]: M8
    double wider = 0.0;                                      // added to both radii [m]
};

/// Knots of the profile along a pitch, of a bolt: crest from 0 to 1/8, root from 7/16 to 11/16.
inline double threadRadius(const Thread& thread, double share) {
    const double s = share - std::floor(share);
    const auto between = [&](double from, double to, double a, double b) {
        return a + (b - a) * (s - from) / (to - from);
    };
    const double crest = thread.crest + thread.wider, root = thread.root + thread.wider;
    if (s <= 0.125) return crest;
    if (s <= 0.4375) return between(0.125, 0.4375, crest, root);
    if (s <= 0.6875) return root;
    return between(0.6875, 1.0, root, crest);
}

/// The threaded wall between two heights, as wallMesh: columns of knots that climb by a pitch a turn, clipped.
/// Appends its lower and upper border.
inline geometry::TriangleMesh threadWall(const Thread& thread, int around, double low, double high, Profile2& below,
                                         Profile2& above) {
    constexpr std::array kKnots{0.0, 0.125, 0.4375, 0.6875};
    const int first = static_cast<int>(std::floor(low / thread.pitch)) - 2;
    const int last = static_cast<int>(std::ceil(high / thread.pitch)) + 1;
    const auto rows = static_cast<std::uint32_t>(4 * (last - first));
    geometry::TriangleMesh mesh;
    const auto vertex = [&](int column, std::uint32_t row) -> Vec3 {
        const double a = 2.0 * std::numbers::pi * (column % around) / around;
        const double share = first + static_cast<int>(row / 4) + kKnots[row % 4];
        const double climb = static_cast<double>(column) / around;
        const double z = std::clamp(thread.pitch * (share + climb), low, high);
        const double r = threadRadius(thread, z / thread.pitch - climb);
        return {r * std::cos(a), r * std::sin(a), z};
    };
    for (int i = 0; i <= around; ++i)
        for (std::uint32_t k = 0; k < rows; ++k) mesh.vertices.push_back(vertex(i, k));
    const auto add = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto& v = mesh.vertices;
        if ((v[b] - v[a]).cross(v[c] - v[a]).norm() > 1e-16) mesh.triangles.push_back({a, b, c});
    };
    for (int i = 0; i < around; ++i) {
        below.push_back(vertex(i, 0).head<2>());
        above.push_back(vertex(i, rows - 1).head<2>());
        for (std::uint32_t k = 0; k + 1 < rows; ++k) {
            const std::uint32_t a = static_cast<std::uint32_t>(i) * rows + k, b = a + rows;
            add(a, b, b + 1);
            add(a, b + 1, a + 1);
        }
    }
    return mesh;
}

/// M8 with 50 µm of play on the flanks; the hand turns it to and fro along the thread, and shakes.
inline SurfaceCase boltInNut(std::uint64_t seed = 13, int around = 96) {
    const Thread thread;
    Profile2 below, above, inner_below, inner_above;
    geometry::TriangleMesh bolt = threadWall(thread, around, -4e-3, 4e-3, below, above);
    append(bolt, fanMesh(below, {0, 0}, -4e-3, false));
    append(bolt, fanMesh(above, {0, 0}, 4e-3, true));
    Thread wide = thread;
    wide.wider = 1e-4;
    geometry::TriangleMesh nut = threadWall(wide, around, -2.5e-3, 2.5e-3, inner_below, inner_above);
    for (auto& t : nut.triangles) std::swap(t[1], t[2]);
    const Profile2 outer = circleLine(6.5e-3, around);
    append(nut, wallMesh(outer, -2.5e-3, 2.5e-3));
    append(nut, rimMesh(inner_below, outer, -2.5e-3));
    append(nut, rimMesh(inner_above, outer, 2.5e-3));
    const RandomPath shake({}, {0, 0, 0}, {8e-4, 8e-4, 2e-3}, 0.03, seed);
    return {"bolt in nut", bolt, nut, [shake, pitch = thread.pitch](double t) {
                const double turn = 2.0 * std::sin(1.5 * t);  // [rad]
                Pose X = shake(t);
                X.q = X.q * Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
                X.p.z() += pitch * turn / (2.0 * std::numbers::pi);
                return X;
            }};
}

}  // namespace passung::test
