#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/base/types.h"
#include "core/shape/shape.h"
#include "tests/core/closed_form/held_share.h"

namespace passung::closed_form {

/// A peg in a bore as dense points of four circles against the other part's faces, and what their contacts can push:
/// written apart from the core. Inside the bore only: where edges cross, points hold with the normals of both faces,
/// where geometry has one.
class PegReference {
public:
    using Row = MotionRowOfReference;

    PegReference(const shape::Peg& peg, const shape::BorePlate& plate, double rho, int points)
        : peg_(peg), plate_(plate), rho_(rho), points_(points) {}

    /// Least gap of any point [m], < 0: overlap.
    double least(const Pose& X) const {
        double least = std::numeric_limits<double>::infinity();
        eachPoint(X, [&](double gap, const Vec3&, const Vec3&) { least = std::min(least, gap); });
        return least;
    }

    /// The part of the pull (Δx, ρ Δφ) that no contact within `near` can hold, by non-negative least squares (Lawson
    /// and Hanson 1974): zero where the pose has the least energy.
    double unheld(const Pose& X, const Row& pull, double near) const {
        std::vector<Row> rows;
        eachPoint(X, [&](double gap, const Vec3& p, const Vec3& n) {
            if (gap > near) return;
            Row row;
            row << n, (p - X.p).cross(n) / rho_;
            rows.push_back(row);
        });
        return residualOf(rows, -pull);
    }

private:
    /// Calls f(gap, point, normal away from the plate), world.
    template <class F>
    void eachPoint(const Pose& X, F f) const {
        const double R = 0.5 * peg_.diameter, Rb = 0.5 * plate_.bore_diameter, c = peg_.chamfer, cb = plate_.chamfer;
        for (const auto& [radius, height] : {std::pair(R - c, 0.0), std::pair(R, c)})
            circle(radius, height, [&](const Vec3& q) {
                const Vec3 p = X * q, away = Vec3(p.x(), p.y(), 0).normalized();
                const double r = std::hypot(p.x(), p.y());
                const std::array gaps{p.z(), (p.z() + Rb + cb - r) / std::numbers::sqrt2, Rb - r};
                const std::array<Vec3, 3> normals{Vec3::UnitZ(), (Vec3::UnitZ() - away) / std::numbers::sqrt2, -away};
                const auto at = std::max_element(gaps.begin(), gaps.end()) - gaps.begin();
                f(gaps[static_cast<std::size_t>(at)], p, normals[static_cast<std::size_t>(at)]);
                f(p.z() + plate_.bore_depth, p, Vec3::UnitZ());
            });
        for (const auto& [radius, height] : {std::pair(Rb, -cb), std::pair(Rb + cb, 0.0)})
            circle(radius, height, [&](const Vec3& p) {
                const Vec3 q = X.inverse() * p, away = Vec3(q.x(), q.y(), 0).normalized();
                const double r = std::hypot(q.x(), q.y());
                const std::array gaps{-q.z(), (r - (R - c) - q.z()) / std::numbers::sqrt2, r - R};
                const std::array<Vec3, 3> normals{-Vec3::UnitZ(), (away - Vec3::UnitZ()) / std::numbers::sqrt2, away};
                const auto at = std::max_element(gaps.begin(), gaps.end()) - gaps.begin();
                f(gaps[static_cast<std::size_t>(at)], p, -(X.q * normals[static_cast<std::size_t>(at)]));
            });
    }

    template <class F>
    void circle(double radius, double z, F f) const {
        for (int i = 0; i < points_; ++i) {
            const double t = 2.0 * std::numbers::pi * i / points_;
            f(Vec3(radius * std::cos(t), radius * std::sin(t), z));
        }
    }

    shape::Peg peg_;
    shape::BorePlate plate_;
    double rho_;
    int points_;
};

}  // namespace passung::closed_form
