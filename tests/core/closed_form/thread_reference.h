#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <type_traits>
#include <vector>

#include "core/base/random.h"
#include "core/base/types.h"
#include "core/shape/shape.h"
#include "tests/core/closed_form/held_share.h"

namespace passung::closed_form {

/// A bolt in a nut as points on both surfaces against the other's profile in half planes, straight from ISO 68-1 and
/// what thread_bolt and thread_nut are said to be: written apart from the core.
class ThreadReference {
public:
    using Row = MotionRowOfReference;

    /// `points` of each surface, half of them on crests' edges and ends.
    ThreadReference(const shape::ThreadBolt& bolt, const shape::ThreadNut& nut, int points, std::uint64_t seed)
        : bolt_(bolt), nut_(nut) {
        Random random(seed);
        while (static_cast<int>(of_bolt_.size()) < points) addPoint(random, false);
        while (static_cast<int>(of_nut_.size()) < points) addPoint(random, true);
    }

    /// How deep the deepest of the points lies in the other part, the bolt at X in the nut's frame [m], >= 0; as a way
    /// out within its half plane, which is at most 1 % longer than the shortest.
    double overlap(const Pose& X) const {
        double most = 0.0;
        for (const Vec3& p : of_bolt_) most = std::max(most, depthInNut(X * p));
        const Pose X_BN = X.inverse();
        for (const Vec3& p : of_nut_) most = std::max(most, depthInBolt(X_BN * p));
        return most;
    }

    /// Of the pull (Δx, ρ Δφ) the part that no place of an edge, along a crest or around a sharp end, within `near` of
    /// a flank, crest or root can hold; in the nut's axes. Zero where the pose has the least energy. @pre no chamfers,
    /// and no end near another.
    double unheld(const Pose& X, const Row& pull, double near, double rho) const {
        std::vector<Row> rows;
        const auto add = [&](const Vec3& p, const Vec3& n) {
            Row row;
            row << n, (p - X.p).cross(n) / rho;
            rows.push_back(row);
        };
        constexpr int kATurn = 2048;
        const auto bolts = [&](const Vec3& q) {
            const Vec3 p = X * q;
            if (p.z() > 0.0 || p.z() < -nut_.height) return;
            for (const Wall& wall : wallsOf(nut_, p, true))
                if (wall.gap < near) add(p, wall.normal);
        };
        const auto nuts = [&](const Vec3& p) {
            const Vec3 q = X.inverse() * p;
            if (q.z() < 0.0 || q.z() > bolt_.length) return;
            for (const Wall& wall : wallsOf(bolt_, q, false))
                if (wall.gap < near) add(p, -(X.q * wall.normal));
        };
        for (int i = 0; i < kATurn; ++i) {
            const double phi = 2 * std::numbers::pi * i / kATurn;
            const auto at = [&](double r, double z) { return Vec3(r * std::cos(phi), r * std::sin(phi), z); };
            for (const double z : {0.0, bolt_.length}) bolts(at(radiusAt(bolt_, phi, z), z));
            for (const double z : {0.0, -nut_.height}) nuts(at(radiusAt(nut_, phi, z), z));
        }
        for (const double side : {-1.0, 1.0}) {
            eachOnHelix(outerOf(bolt_), side * halfAt(bolt_, 0.6), 0.0, bolt_.length, bolt_.pitch, kATurn, bolts);
            eachOnHelix(crestOf(nut_), nut_.pitch / 2 + side * (nut_.pitch / 2 - halfAt(nut_, -0.4)), -nut_.height, 0.0,
                        nut_.pitch, kATurn, nuts);
        }
        return residualOf(rows, -pull);
    }

private:
    struct Wall {
        double gap;
        Vec3 normal;  // out of the material
    };

    /// ISO 68-1: basic profile of both, 5/8 of the sharp triangle's height deep.
    template <class Thread>
    static double depthOf(const Thread& thread) {
        return thread.flank_height > 0.0 ? thread.flank_height : 0.625 * std::sqrt(3.0) / 2 * thread.pitch;
    }
    /// Half of a bolt's ridge at its crest, and of a nut's hole at its crest: as wide as the groove at 3/5 of the
    /// height below a bolt's crest. @pre no clearance, but a bolt of one whose flanks keep half of it
    template <class Thread>
    static double halfAt(const Thread& thread, double height) {
        const double lean = thread.flank_angle / 2,
                     of_clearance = thread.clearance * (0.5 - std::sin(lean)) / std::cos(lean);
        return thread.pitch / 4 - height * depthOf(thread) * std::tan(lean) -
               (std::is_same_v<Thread, shape::ThreadBolt> ? of_clearance : -of_clearance);
    }
    static double outerOf(const shape::ThreadBolt& bolt) { return bolt.nominal_diameter / 2 - bolt.clearance; }
    static double outerOf(const shape::ThreadNut& nut) { return nut.nominal_diameter / 2 + nut.clearance; }
    static double crestOf(const shape::ThreadNut& nut) { return outerOf(nut) - depthOf(nut); }

    /// From the middle of the nearest ridge of material, along the axis.
    static double offRidge(double pitch, const Vec3& p, double of_material) {
        const double turns = p.z() / pitch - std::atan2(p.y(), p.x()) / (2 * std::numbers::pi) - of_material;
        return pitch * (turns - std::round(turns));
    }

    /// Flank or crest of the nearest ridge, and the root.
    template <class Thread>
    static std::vector<Wall> wallsOf(const Thread& thread, const Vec3& p, bool is_nut) {
        const double r = std::hypot(p.x(), p.y()), lead = thread.pitch / (2 * std::numbers::pi);
        const double sign = is_nut ? -1.0 : 1.0;
        const double crest = outerOf(thread) - (is_nut ? depthOf(thread) : 0.0);
        const double root = outerOf(thread) - (is_nut ? 0.0 : depthOf(thread));
        const double cosine = std::cos(thread.flank_angle / 2), sine = std::sin(thread.flank_angle / 2);
        const double half = is_nut ? thread.pitch / 2 - halfAt(thread, -0.4) : halfAt(thread, 0.6);
        const double off = offRidge(thread.pitch, p, is_nut ? 0.5 : 0.0);
        const Vec3 out = Vec3(p.x(), p.y(), 0) / r, around(-out.y(), out.x(), 0);
        const double flank = sign * (r - crest) * sine + (std::abs(off) - half) * cosine;
        const Vec3 n = sign * sine * out + (off > 0 ? 1.0 : -1.0) * cosine * (Vec3::UnitZ() - lead / r * around);
        const Wall ridge =
            flank > sign * (r - crest) ? Wall{flank, n.normalized()} : Wall{sign * (r - crest), sign * out};
        return {ridge, {sign * (r - root), sign * out}};
    }

    double depthInBolt(const Vec3& p) const {
        double depth = std::min(p.z(), bolt_.length - p.z());
        if (bolt_.chamfer > 0.0)
            depth =
                std::min(depth, (outerOf(bolt_) - bolt_.chamfer + p.z() - std::hypot(p.x(), p.y())) / std::sqrt(2.0));
        return depth > 0.0 ? std::max(0.0, std::min(depth, depthInThread(bolt_, p, false))) : 0.0;
    }
    double depthInNut(const Vec3& p) const {
        double depth = std::min(-p.z(), nut_.height + p.z());
        if (nut_.chamfer > 0.0)
            depth = std::min(depth, (std::hypot(p.x(), p.y()) - crestOf(nut_) - nut_.chamfer + depth) / std::sqrt(2.0));
        depth = std::min(depth, nut_.outer_diameter / 2 - std::hypot(p.x(), p.y()));
        return depth > 0.0 ? std::max(0.0, std::min(depth, depthInThread(nut_, p, true))) : 0.0;
    }
    template <class Thread>
    static double depthInThread(const Thread& thread, const Vec3& p, bool is_nut) {
        const std::vector<Wall> walls = wallsOf(thread, p, is_nut);
        return std::max(-walls[0].gap, -walls[1].gap);
    }

    /// Where the surface of a thread is at an angle and height.
    template <class Thread>
    static double radiusAt(const Thread& thread, double phi, double z) {
        const double off = std::abs(offRidge(thread.pitch, {std::cos(phi), std::sin(phi), z}, 0.0));
        const double in = (off - halfAt(thread, 0.6)) / std::tan(thread.flank_angle / 2);
        return outerOf(thread) - std::clamp(in, 0.0, depthOf(thread));
    }

    void addPoint(Random& random, bool is_nut) {
        const double low = is_nut ? -nut_.height : 0.0, high = is_nut ? 0.0 : bolt_.length;
        const double pitch = is_nut ? nut_.pitch : bolt_.pitch, phi = random.uniform(0.0, 2 * std::numbers::pi);
        double z = random.uniform(low, high);
        const double draw = random.uniform();
        if (draw < 0.4) {
            const double edge = is_nut ? halfAt(nut_, -0.4) / nut_.pitch : halfAt(bolt_, 0.6) / bolt_.pitch;
            const double from = (draw < 0.2 ? edge : -edge) + phi / (2 * std::numbers::pi);
            z = pitch * (from + std::round(z / pitch - from));
            if (z < low || z > high) return;
        } else if (draw < 0.5) {
            z = draw < 0.45 ? low : high;
        }
        double r = is_nut ? radiusAt(nut_, phi, z) : radiusAt(bolt_, phi, z);
        if (is_nut)
            r = std::max(r, crestOf(nut_) + nut_.chamfer - std::min(high - z, z - low));
        else if (bolt_.chamfer > 0.0)
            r = std::min(r, outerOf(bolt_) - bolt_.chamfer + z);
        (is_nut ? of_nut_ : of_bolt_).emplace_back(r * std::cos(phi), r * std::sin(phi), z);
    }

    template <class F>
    static void eachOnHelix(double r, double offset, double low, double high, double pitch, int a_turn, const F& f) {
        const int turns = static_cast<int>((high - low) / pitch) + 2;
        for (int i = 0; i < turns * a_turn; ++i) {
            const double turn = std::floor(low / pitch) - 1 + static_cast<double>(i) / a_turn;
            const double z = turn * pitch + offset, phi = 2 * std::numbers::pi * turn;
            if (z >= low && z <= high) f(Vec3(r * std::cos(phi), r * std::sin(phi), z));
        }
    }

    shape::ThreadBolt bolt_;
    shape::ThreadNut nut_;
    std::vector<Vec3> of_bolt_, of_nut_;
};

}  // namespace passung::closed_form
