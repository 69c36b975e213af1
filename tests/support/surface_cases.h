#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/base/types.h"
#include "core/geometry/mesh.h"

/// Pairs of meshes that sampled methods miss, each with a hand's path; made here, by code of their own.
namespace passung::test {

using Profile2 = std::vector<Eigen::Vector2d>;

inline void append(geometry::TriangleMesh& mesh, const geometry::TriangleMesh& more) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
    for (const auto& t : more.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

inline geometry::TriangleMesh placed(geometry::TriangleMesh mesh, const Pose& X) {
    for (Vec3& v : mesh.vertices) v = X * v;
    return mesh;
}

inline geometry::TriangleMesh boxMesh(const Vec3& low, const Vec3& high) {
    geometry::TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.vertices.emplace_back(i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]);
    const auto quad = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    };
    quad(0, 2, 3, 1);
    quad(4, 5, 7, 6);
    quad(0, 1, 5, 4);
    quad(2, 6, 7, 3);
    quad(0, 4, 6, 2);
    quad(1, 3, 7, 5);
    return mesh;
}

/// The wall over a closed line between two heights; facing out if the line runs counter-clockwise.
inline geometry::TriangleMesh wallMesh(const Profile2& line, double low, double high) {
    geometry::TriangleMesh mesh;
    const auto n = static_cast<std::uint32_t>(line.size());
    for (const double z : {low, high})
        for (const auto& p : line) mesh.vertices.emplace_back(p.x(), p.y(), z);
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t j = (i + 1) % n;
        mesh.triangles.push_back({i, j, n + j});
        mesh.triangles.push_back({i, n + j, n + i});
    }
    return mesh;
}

/// A flat face that all its corners see from `centre`.
inline geometry::TriangleMesh fanMesh(const Profile2& line, const Eigen::Vector2d& centre, double z, bool up) {
    geometry::TriangleMesh mesh;
    for (const auto& p : line) mesh.vertices.emplace_back(p.x(), p.y(), z);
    mesh.vertices.emplace_back(centre.x(), centre.y(), z);
    const auto n = static_cast<std::uint32_t>(line.size());
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t j = (i + 1) % n;
        if (up)
            mesh.triangles.push_back({n, i, j});
        else
            mesh.triangles.push_back({n, j, i});
    }
    return mesh;
}

/// A flat face between two lines of as many corners.
inline geometry::TriangleMesh rimMesh(const Profile2& inner, const Profile2& outer, double z) {
    geometry::TriangleMesh mesh;
    const auto n = static_cast<std::uint32_t>(inner.size());
    for (const Profile2* line : {&inner, &outer})
        for (const auto& p : *line) mesh.vertices.emplace_back(p.x(), p.y(), z);
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t j = (i + 1) % n;
        mesh.triangles.push_back({i, n + i, n + j});
        mesh.triangles.push_back({i, n + j, j});
    }
    return mesh;
}

inline Profile2 circleLine(double radius, int n, double turn = 0.0) {
    Profile2 line;
    for (int i = 0; i < n; ++i) {
        const double a = 2.0 * std::numbers::pi * i / n + turn;
        line.emplace_back(radius * std::cos(a), radius * std::sin(a));
    }
    return line;
}

/// Teeth with straight flanks; `wider` moves every side outward [m].
inline Profile2 gearLine(double radius, double height, int teeth, double wider) {
    Profile2 line;
    const double step = 2.0 * std::numbers::pi / teeth;
    for (int i = 0; i < teeth; ++i)
        for (int k = 0; k < 16; ++k) {
            const double s = k / 16.0, a = step * (i + s);
            const double ramp = std::clamp(2.5 * std::sin(2.0 * std::numbers::pi * s), -1.0, 1.0);
            const double r = radius + 0.5 * height * ramp + wider;
            line.emplace_back(r * std::cos(a), r * std::sin(a));
        }
    return line;
}

inline geometry::TriangleMesh solidMesh(const Profile2& line, const Eigen::Vector2d& centre, double low, double high) {
    geometry::TriangleMesh mesh = wallMesh(line, low, high);
    append(mesh, fanMesh(line, centre, low, false));
    append(mesh, fanMesh(line, centre, high, true));
    return mesh;
}

inline geometry::TriangleMesh tubeMesh(const Profile2& inner, const Profile2& outer, double low, double high) {
    geometry::TriangleMesh mesh = wallMesh(outer, low, high);
    append(mesh, wallMesh(Profile2(inner.rbegin(), inner.rend()), low, high));
    append(mesh, rimMesh(inner, outer, low));
    append(mesh, rimMesh(inner, outer, high));
    return mesh;
}

/// A ball with bumps like a scan's, of 4 · n² triangles.
inline geometry::TriangleMesh bumpyMesh(double diameter, int n, double phase) {
    geometry::TriangleMesh mesh;
    const int around = 2 * n;
    for (int i = 0; i <= n; ++i)
        for (int k = 0; k < around; ++k) {
            const double a = std::numbers::pi * i / n, b = 2.0 * std::numbers::pi * k / around;
            const Vec3 d(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
            const double bump = std::sin(7 * d.x() + phase) + std::cos(5 * d.y() - 2 * d.z() + phase) +
                                0.3 * std::sin(31 * d.z() + 23 * d.x()) + 0.1 * std::sin(90 * d.y() + 70 * d.z());
            mesh.vertices.push_back(diameter * (0.5 + 0.03 * bump) * d);
        }
    const auto at = [around](int i, int k) { return static_cast<std::uint32_t>(i * around + k % around); };
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < around; ++k) {
            mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    return mesh;
}

/// An open sheet with waves.
inline geometry::TriangleMesh sheetMesh(double side, int n, double wave) {
    geometry::TriangleMesh mesh;
    for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= n; ++k) {
            const double x = side * (i / double(n) - 0.5), y = side * (k / double(n) - 0.5);
            mesh.vertices.emplace_back(x, y, wave * std::sin(300.0 * x) * std::cos(250.0 * y));
        }
    const auto at = [n](int i, int k) { return static_cast<std::uint32_t>(i * (n + 1) + k); };
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    return mesh;
}

/// A block whose upper face is cut finer than its sides: its edges have T-junctions, and some seams gape by 1e-15 m.
inline geometry::TriangleMesh seamedMesh(const Vec3& low, const Vec3& high, int n) {
    geometry::TriangleMesh mesh = boxMesh(low, high);
    std::erase_if(mesh.triangles, [](const geometry::Triangle& t) { return t[0] >= 4 && t[1] >= 4 && t[2] >= 4; });
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
            for (int c = 0; c < 4; ++c) {
                const double x = low.x() + (high.x() - low.x()) * (i + (c & 1)) / n;
                const double y = low.y() + (high.y() - low.y()) * (k + (c >> 1)) / n;
                mesh.vertices.emplace_back(x + 1e-15 * (c - 2), y, high.z());
            }
            mesh.triangles.push_back({base, base + 1, base + 3});
            mesh.triangles.push_back({base, base + 3, base + 2});
        }
    return mesh;
}

/// A hand that moves smoothly and at random around a place, from rest there.
struct RandomPath {
    Pose start;
    Vec3 drift = Vec3::Zero();      // of the middle, reached after a second [m]
    Vec3 amplitude = Vec3::Zero();  // [m]
    double tilt = 0.0;              // [rad]
    double fastest = 1.0;           // [Hz]
    std::array<double, 12> phase{}, rate{};

    RandomPath(const Pose& at, const Vec3& to, const Vec3& by, double turn, std::uint64_t seed, double hertz = 1.0)
        : start(at), drift(to), amplitude(by), tilt(turn), fastest(hertz) {
        Random random(seed);
        for (std::size_t i = 0; i < 12; ++i) {
            phase[i] = random.uniform(0.0, 2.0 * std::numbers::pi);
            rate[i] = random.uniform(0.3, 1.0) * fastest;
        }
    }

    Pose operator()(double t) const {
        const double s = std::min(1.0, t), ramp = s * s * (3.0 - 2.0 * s);
        Vec3 p = start.p + ramp * drift, turn;
        for (int i = 0; i < 3; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const auto wave = [&](std::size_t j) {
                return std::sin(2.0 * std::numbers::pi * rate[j] * t + phase[j]) - std::sin(phase[j]);
            };
            p[i] += ramp * amplitude[i] * (0.6 * wave(k) + 0.4 * wave(k + 6));
            turn[i] = ramp * tilt * (0.6 * wave(k + 3) + 0.4 * wave(k + 9));
        }
        return {rotationFromVector(turn) * start.q, p};
    }
};

struct SurfaceCase {
    std::string name;
    geometry::TriangleMesh held, obstacle;
    std::function<Pose(double)> hand;  // of the time [s]
    int ticks = 2000;
};

inline Pose turned(double angle, const Vec3& axis, const Vec3& p) {
    return {Quat(Eigen::AngleAxisd(angle, axis.normalized())), p};
}

inline SurfaceCase blockOnPin(std::uint64_t seed = 1, double diameter = 0.001) {
    auto pin = solidMesh(circleLine(0.5 * diameter, 256), {0, 0}, -0.01, 0.0);
    return {"block on pin", boxMesh({-.01, -.01, 0}, {.01, .01, .004}), pin,
            RandomPath({Quat::Identity(), {0, 0, .0005}}, {0, 0, -.003}, {.004, .004, .002}, 0.1, seed)};
}
inline SurfaceCase blockOnFin(std::uint64_t seed = 2) {
    return {"block on fin", boxMesh({-.01, -.01, 0}, {.01, .01, .004}),
            boxMesh({-.00025, -.02, -.01}, {.00025, .02, 0}),
            RandomPath({Quat::Identity(), {0, 0, .0005}}, {0, 0, -.003}, {.006, .004, .002}, 0.2, seed)};
}
inline SurfaceCase cubeOnCorner(std::uint64_t seed = 3) {
    const Pose up{rotationBetween(Vec3(1, 1, 1), Vec3::UnitZ()), {0, 0, -.01 * std::sqrt(3.0)}};
    return {"block on a cube's corner", boxMesh({-.01, -.01, 0}, {.01, .01, .004}),
            placed(boxMesh({-.01, -.01, -.01}, {.01, .01, .01}), up),
            RandomPath({Quat::Identity(), {0, 0, .0005}}, {0, 0, -.003}, {.006, .006, .002}, 0.2, seed)};
}
inline SurfaceCase needleInSlit(std::uint64_t seed = 4) {
    auto slit = boxMesh({-.02, -.01, -.02}, {-.00055, .01, 0});
    append(slit, boxMesh({.00055, -.01, -.02}, {.02, .01, 0}));
    auto needle = solidMesh(circleLine(0.0005, 128), {0, 0}, 0, .03);
    return {"needle in slit", needle, slit,
            RandomPath({Quat::Identity(), {0, 0, -.002}}, {0, 0, -.006}, {.002, .004, .003}, 0.15, seed)};
}
inline SurfaceCase ringInRing(std::uint64_t seed = 5) {
    return {"ring in ring", tubeMesh(circleLine(.007, 180), circleLine(.0099, 180), -.004, .004),
            tubeMesh(circleLine(.01, 144), circleLine(.013, 144), -.003, .003),
            RandomPath({Quat::Identity(), {0, 0, 0}}, {0, 0, 0}, {.002, .002, .003}, 0.15, seed), 1500};
}
inline SurfaceCase gearInGear(std::uint64_t seed = 6) {
    const auto outer = circleLine(.016, 16 * 20);
    return {"gear in gear", solidMesh(gearLine(.01, .002, 20, -5e-5), {0, 0}, -.002, .006),
            tubeMesh(gearLine(.01, .002, 20, 5e-5), outer, -.004, .004),
            RandomPath({Quat::Identity(), {0, 0, 0}}, {0, 0, 0}, {.001, .001, .004}, 0.1, seed)};
}
inline SurfaceCase dovetail(std::uint64_t seed = 7) {
    const double play = 5e-5;
    auto rail = placed(solidMesh({{-.006, -.003}, {.006, -.003}, {.004, .003}, {-.004, .003}}, {0, 0}, -.015, .015),
                       turned(std::numbers::pi / 2, {1, 0, 0}, {0, 0, 0}));
    // Walls around the rail: undercut flanks, a floor.
    geometry::TriangleMesh slot;
    const double p = play;
    const auto wall = [&slot](const Profile2& line) {
        append(slot, placed(solidMesh(line, line[0], -.02, .02), turned(std::numbers::pi / 2, {1, 0, 0}, {0, 0, 0})));
    };
    wall({{-.02, -.003 - p}, {-.02, -.01}, {.02, -.01}, {.02, -.003 - p}});
    wall({{-.02, -.003 - p}, {-.006 - p, -.003 - p}, {-.004 - p, .003}, {-.02, .003}});
    wall({{.02, -.003 - p}, {.02, .003}, {.004 + p, .003}, {.006 + p, -.003 - p}});
    return {"dovetail", rail, slot, RandomPath({}, {0, 0, .001}, {.002, .006, .003}, 0.1, seed)};
}
inline SurfaceCase spinningBar() {
    return {"spinning bar", boxMesh({-.03, -.003, -.003}, {.03, .003, .003}),
            boxMesh({.02, -.002, -.02}, {.03, .002, .02}),
            [](double t) -> Pose {
                return {Quat(Eigen::AngleAxisd(100.0 * t + 0.6, Vec3::UnitZ())), Vec3(0, 0, .0)};
            },
            1000};
}
inline SurfaceCase ballOnSheet(std::uint64_t seed = 8) {
    return {"bumpy ball on open sheet", bumpyMesh(.01, 40, 0.3), sheetMesh(.04, 40, .0005),
            RandomPath({Quat::Identity(), {0, 0, .0075}}, {0, 0, -.004}, {.008, .008, .003}, 0.3, seed)};
}
inline SurfaceCase blockOnSeams(std::uint64_t seed = 9) {
    return {"block on a mesh with T-junctions", boxMesh({-.004, -.004, 0}, {.004, .004, .008}),
            seamedMesh({-.01, -.01, -.01}, {.01, .01, 0}, 12),
            RandomPath({Quat::Identity(), {0, 0, .0003}}, {0, 0, -.002}, {.008, .008, .002}, 0.2, seed)};
}
inline SurfaceCase scanOnScan(double size, int n, std::uint64_t seed = 10) {
    return {"scan on scan " + std::to_string(int(1e3 * size)) + " mm", bumpyMesh(size, n, 0.3), bumpyMesh(size, n, 1.7),
            RandomPath({Quat::Identity(), {0, 0, 1.25 * size}}, {0, 0, -.35 * size}, {.3 * size, .3 * size, .2 * size},
                       0.4, seed, std::min(1.0, .03 / size))};
}
inline SurfaceCase keyedShaft(std::uint64_t seed = 11) {
    const double play = 8e-6;  // each side
    const auto line = [](double r, double deep) {
        Profile2 profile;
        const double half = .2;
        for (int i = 0; i <= 96; ++i) {
            const double a = half + (2.0 * std::numbers::pi - 2.0 * half) * i / 96.0;
            profile.emplace_back(r * std::cos(a), r * std::sin(a));
        }
        const double w = r * std::sin(half);
        profile.emplace_back(r + deep, -w);
        profile.emplace_back(r + deep, w);
        return profile;
    };
    Profile2 outer;
    for (const auto& p : line(.01, .002)) outer.push_back(2.0 * p);
    return {"keyed shaft", solidMesh(line(.01 - play, .002), {0, 0}, -.01, .02),
            tubeMesh(line(.01, .002), outer, -.008, .008),
            RandomPath({Quat::Identity(), {0, 0, 0}}, {0, 0, 0}, {.0008, .0008, .008}, 0.05, seed), 2000};
}
inline SurfaceCase dShaft(std::uint64_t seed = 12) {
    const auto line = [](double wider) {
        Profile2 profile;
        for (int i = 0; i <= 64; ++i) {
            const double a = .6 + (2.0 * std::numbers::pi - 1.2) * i / 64.0;
            profile.emplace_back((.005 + wider) * std::cos(a), (.005 + wider) * std::sin(a));
        }
        return profile;
    };
    Profile2 outer;
    for (const auto& p : line(0)) outer.push_back(2.0 * p);
    return {"D-shaped peg", solidMesh(line(-5e-5), {0, 0}, -.01, .01), tubeMesh(line(0), outer, -.006, .006),
            RandomPath({Quat::Identity(), {0, 0, 0}}, {0, 0, 0}, {.001, .001, .004}, 0.08, seed)};
}

inline std::vector<SurfaceCase> surfaceCases() {
    return {blockOnPin(), blockOnFin(), cubeOnCorner(),      needleInSlit(),     ringInRing(),
            gearInGear(), dovetail(),   spinningBar(),       ballOnSheet(),      blockOnSeams(),
            keyedShaft(), dShaft(),     scanOnScan(.01, 60), scanOnScan(.1, 110)};
}

}  // namespace passung::test
