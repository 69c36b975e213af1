#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <vector>

#include "core/base/types.h"
#include "core/shape/shape.h"

namespace passung::simulated {

/// A 20 mm peg against a plate with a bore, by closed forms only: circles of sample points on the peg against the exact
/// distance of the plate. Small and slow; shares nothing with core/tick, so it also serves as a second opinion.
class PegBoreEnvironment {
public:
    enum class Method { Penalty, GodObject };
    friend void PrintTo(Method method, std::ostream* out) {
        *out << (method == Method::Penalty ? "penalty" : "god object");
    }

    struct Setup {
        double bore_diameter = 0.021;
        Method method = Method::GodObject;
        double stiffness = 2000.0, rotational_stiffness = 1.0;
        double damping = 5.0, rotational_damping = 2e-3;
        Pose X_WP;  // where the bore's mouth really is
        Pose X_WStart;
    };

    explicit PegBoreEnvironment(const Setup& setup)
        : setup_(setup),
          plate_{shape::BorePlate{0.08, 0.08, 0.03, setup.bore_diameter, 0.03, 1e-3}},
          X_WG_(setup.X_WStart),
          X_WH_last_(setup.X_WStart) {
        // radius, height: tip face, chamfer, side
        for (const auto& [r, z] : {std::array{4e-3, 0.0},
                                   {9e-3, 0.0},
                                   {9.5e-3, 0.5e-3},
                                   {10e-3, 1e-3},
                                   {10e-3, 3e-3},
                                   {10e-3, 6e-3},
                                   {10e-3, 10e-3},
                                   {10e-3, 15e-3},
                                   {10e-3, 20e-3},
                                   {10e-3, 25e-3}}) {
            constexpr int kPoints = 40;
            for (int i = 0; i < kPoints; ++i) {
                const double angle = 2 * std::numbers::pi * i / kPoints;
                points_.push_back({r * std::cos(angle), r * std::sin(angle), z});
            }
        }
    }

    /// Wrench on the hand about the part's origin, world axes, for the part asked to be at X_WH.
    Wrench render(const Pose& X_WH) {
        const Wrench wrench = setup_.method == Method::Penalty ? penalty(X_WH) : coupling(X_WH);
        X_WH_last_ = X_WH;
        return wrench;
    }

    const Pose& proxy() const { return X_WG_; }
    bool touching() const { return touching_; }
    /// Depth of the tip of `X_WS` below the true mouth.
    double depth(const Pose& X_WS) const { return -(setup_.X_WP.inverse() * X_WS.p).z(); }

private:
    struct Contact {
        double phi;
        Vec3 position, normal;  // world
    };

    double distance(const Vec3& p_P) const { return shape::signedDistance(plate_, p_P); }

    void collect(const Pose& X_WS, double below) {
        contacts_.clear();
        const Pose X_PW = setup_.X_WP.inverse();
        for (const Vec3& point : points_) {
            const Vec3 p_W = X_WS * point;
            const Vec3 p = X_PW * p_W;
            if (p.z() > below) continue;
            const double phi = distance(p);
            if (phi > below) continue;
            constexpr double h = 1e-7;
            Vec3 g;
            for (int i = 0; i < 3; ++i) g[i] = distance(p + h * Vec3::Unit(i)) - distance(p - h * Vec3::Unit(i));
            if (g.norm() < 0.1 * h) continue;
            contacts_.push_back({phi, p_W, setup_.X_WP.q * g.normalized()});
        }
    }

    Wrench damped(Wrench wrench, const Pose& X_WH) const {
        const Vec3 v = (X_WH.p - X_WH_last_.p) / 1e-3;
        const Vec3 w = rotationVector(X_WH.q * X_WH_last_.q.conjugate()) / 1e-3;
        wrench.force -= setup_.damping * v;
        wrench.torque -= setup_.rotational_damping * w;
        return wrench;
    }

    Wrench penalty(const Pose& X_WH) {
        X_WG_ = X_WH;
        collect(X_WH, 0.0);
        touching_ = !contacts_.empty();
        if (!touching_) return {};
        Wrench sum;
        double deepest = 0, depths = 0;
        for (const Contact& c : contacts_) {
            sum.force -= c.phi * c.normal;
            sum.torque -= (c.position - X_WH.p).cross(c.phi * c.normal);
            deepest = std::max(deepest, -c.phi);
            depths -= c.phi;
        }
        const double scale = setup_.stiffness * deepest / std::max(sum.force.norm(), 0.05 * depths);
        return damped({scale * sum.force, scale * sum.torque}, X_WH);
    }

    Wrench coupling(const Pose& X_WH) {
        moveProxy(X_WH);
        if (!touching_) return {};
        return damped({setup_.stiffness * (X_WG_.p - X_WH.p),
                       setup_.rotational_stiffness * rotationVector(X_WG_.q * X_WH.q.conjugate())},
                      X_WH);
    }

    // The proxy's next pose is the one nearest to the hand's that keeps every sample outside, to first order; lengths
    // and angles are compared through a radius. Gauss-Seidel on the contact rows, steps short against the sampled band.
    void moveProxy(const Pose& X_WH) {
        constexpr double kBand = 0.4e-3, kRadius = 0.012;
        collect(X_WG_, kBand);
        Eigen::Matrix<double, 6, 1> u;
        u << X_WH.p - X_WG_.p, kRadius * rotationVector(X_WH.q * X_WG_.q.conjugate());
        const double size = std::max(u.head<3>().norm(), u.tail<3>().norm());
        if (size > 0.3e-3) u *= 0.3e-3 / size;
        rows_.clear();
        for (const Contact& c : contacts_) {
            Eigen::Matrix<double, 6, 1> row;
            row << c.normal, (c.position - X_WG_.p).cross(c.normal) / kRadius;
            rows_.push_back({row, -std::max(c.phi, -0.1e-3), 1.0 / row.squaredNorm(), 0.0});
        }
        for (int sweep = 0; sweep < 30; ++sweep) {
            double change = 0;
            for (Row& r : rows_) {
                const double old = r.multiplier;
                r.multiplier = std::max(0.0, old + (r.bound - r.direction.dot(u)) * r.inverse);
                u += (r.multiplier - old) * r.direction;
                change = std::max(change, std::abs(r.multiplier - old));
            }
            if (change < 1e-9) break;
        }
        touching_ = std::any_of(rows_.begin(), rows_.end(), [](const Row& r) { return r.multiplier > 0; });
        X_WG_.p += u.head<3>();
        X_WG_.q = (rotationFromVector(u.tail<3>() / kRadius) * X_WG_.q).normalized();
    }

    struct Row {
        Eigen::Matrix<double, 6, 1> direction;
        double bound, inverse, multiplier;
    };

    Setup setup_;
    shape::Shape plate_;
    std::vector<Vec3> points_;
    std::vector<Contact> contacts_;
    std::vector<Row> rows_;
    Pose X_WG_, X_WH_last_;
    bool touching_ = false;
};

}  // namespace passung::simulated
