#include "analysis/truth/force_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace passung::truth {

namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Vec7 = Eigen::Matrix<double, 7, 1>;

constexpr double kUnit = 1e-3;      // length that the dual problem counts in [m]: its numbers are near 1
constexpr int kMostTurns = 300;     // of the dual problem
constexpr int kMostSteps = 80;      // towards the pose of least energy
constexpr double kStep = 1e-3;      // most of one step [m]
constexpr double kAtRest = 2e-9;    // of a step [m]
constexpr double kNearHand = 1e-9;  // [m]
constexpr int kPoints = 720;        // of a circle

/// min |E y - f|, y ≥ 0; E by columns. Returns E y - f.
Vec7 nonNegativeRest(const std::vector<Vec7>& columns, const Vec7& f) {
    std::vector<std::size_t> used;
    Eigen::VectorXd y(0);
    Vec7 rest = f;
    for (int turn = 0; turn < kMostTurns; ++turn) {
        std::size_t best = columns.size();
        double most = 1e-13;
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const double along = columns[i].dot(rest);
            if (along <= most || std::find(used.begin(), used.end(), i) != used.end()) continue;
            most = along;
            best = i;
        }
        if (best == columns.size()) break;
        used.push_back(best);
        y.conservativeResize(static_cast<Eigen::Index>(used.size()));
        y[y.size() - 1] = 0.0;
        for (;;) {
            Eigen::MatrixXd E(7, y.size());
            for (std::size_t k = 0; k < used.size(); ++k) E.col(static_cast<Eigen::Index>(k)) = columns[used[k]];
            const Eigen::VectorXd to = E.completeOrthogonalDecomposition().solve(f);
            double share = 1.0;
            Eigen::Index out = -1;
            for (Eigen::Index k = 0; k < y.size(); ++k) {
                if (to[k] > 0.0) continue;
                const double s = y[k] > 0.0 ? y[k] / (y[k] - to[k]) : 0.0;
                if (out < 0 || s < share) {
                    share = s;
                    out = k;
                }
            }
            y += (out < 0 ? 1.0 : share) * (to - y);
            if (out < 0) {
                rest = f - E * y;
                break;
            }
            for (Eigen::Index k = out; k + 1 < y.size(); ++k) y[k] = y[k + 1];
            y.conservativeResize(y.size() - 1);
            used.erase(used.begin() + out);
            if (used.empty()) return -f;
        }
    }
    return -rest;
}

bool isWithoutHollows(const shape::Shape& shape) {
    return std::holds_alternative<shape::Sphere>(shape) || std::holds_alternative<shape::Box>(shape) ||
           std::holds_alternative<shape::Cylinder>(shape) || std::holds_alternative<shape::Peg>(shape) ||
           std::holds_alternative<shape::SquarePeg>(shape);
}

/// Of the exact signed distance, by differences: outside a solid without hollows it is smooth.
Vec3 gradientAt(const shape::Shape& shape, const Vec3& p) {
    constexpr double h = 1e-6;  // [m]
    Vec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 e = Vec3::Zero();
        e[axis] = h;
        gradient[axis] = shape::signedDistance(shape, p + e) - shape::signedDistance(shape, p - e);
    }
    return gradient.normalized();
}

Vec6 pullOf(const Pose& X, const Pose& hand, double rho) {
    Vec6 pull;
    pull << hand.p - X.p, rho * rotationVector(hand.q * X.q.conjugate());
    return pull;
}

Pose moved(const Pose& X, const Vec6& u, double rho) {
    const Vec3 turn = rho > 0.0 ? Vec3(u.tail<3>() / rho) : Vec3::Zero();
    return {(rotationFromVector(turn) * X.q).normalized(), X.p + u.head<3>()};
}

}  // namespace

std::optional<Vec6> leastMotion(const std::vector<FreedomRow>& rows, const Vec6& pull) {
    // x = u - w: min |x| s.t. A x ≥ h, h = -g - A w. Dual: E = [Aᵀ; hᵀ], f = (0 … 0, 1), r = E y - f,
    // x = -r_1…6 / r_7.
    std::vector<Vec7> columns;
    columns.reserve(rows.size());
    for (const FreedomRow& row : rows) {
        Vec7 column;
        column << row.along, (-row.gap - row.along.dot(pull)) / kUnit;
        columns.push_back(column);
    }
    const Vec7 r = nonNegativeRest(columns, Vec7::Unit(6));
    if (!(r.squaredNorm() > 1e-16) || !(std::abs(r[6]) > 1e-12)) return std::nullopt;
    return pull - kUnit * r.head<6>() / r[6];
}

/// The peg's and the bore's circles, each a row of the part that it belongs to.
struct ForceReference::Peg {
    shape::Peg peg;
    shape::BorePlate plate;
    Pose X_WP;  // of the plate

    static constexpr double kInfinity = std::numeric_limits<double>::infinity();

    /// Calls f(gap, point, normal away from the plate) in the plate's frame, where `X` is the peg's pose. False: the
    /// peg is not in the bore as far as the case asks.
    template <class F>
    bool eachPoint(const Pose& X, F f) const {
        const double R = 0.5 * peg.diameter, bore = 0.5 * plate.bore_diameter, c = peg.chamfer, cb = plate.chamfer;
        double highest = -kInfinity, lowest_end = kInfinity;
        for (const auto& [radius, height] : {std::pair(R - c, 0.0), std::pair(R, c)})
            circle(radius, height, [&](const Vec3& q) {
                const Vec3 p = X * q, away = Vec3(p.x(), p.y(), 0).normalized();
                highest = std::max(highest, p.z());
                const double r = std::hypot(p.x(), p.y());
                // Free is who is above the plate, in its mouth's cone or in its bore: the largest of the three counts.
                const double above = p.z(), cone = (p.z() + bore + cb - r) / std::numbers::sqrt2, wall = bore - r;
                if (above >= cone && above >= wall)
                    f(above, p, Vec3::UnitZ());
                else if (cone >= wall)
                    f(cone, p, (Vec3::UnitZ() - away) / std::numbers::sqrt2);
                else
                    f(wall, p, -away);
                if (plate.bore_depth < plate.height) f(p.z() + plate.bore_depth, p, Vec3::UnitZ());
            });
        circle(R, peg.length, [&](const Vec3& q) { lowest_end = std::min(lowest_end, (X * q).z()); });
        for (const auto& [radius, height] : {std::pair(bore, -cb), std::pair(bore + cb, 0.0)})
            circle(radius, height, [&](const Vec3& p) {
                const Vec3 q = X.inverse() * p, away = Vec3(q.x(), q.y(), 0).normalized();
                const double r = std::hypot(q.x(), q.y());
                const double below = -q.z(), cone = (r - (R - c) - q.z()) / std::numbers::sqrt2, wall = r - R;
                if (below >= cone && below >= wall)
                    f(below, p, X.q * Vec3::UnitZ());
                else if (cone >= wall)
                    f(cone, p, X.q * ((Vec3::UnitZ() - away) / std::numbers::sqrt2));
                else
                    f(wall, p, -(X.q * away));
            });
        return highest < -cb && lowest_end > 0.0;
    }

private:
    template <class F>
    static void circle(double radius, double z, F f) {
        for (int i = 0; i < kPoints; ++i) {
            const double t = 2.0 * std::numbers::pi * i / kPoints;
            f(Vec3(radius * std::cos(t), radius * std::sin(t), z));
        }
    }
};

ForceReference::ForceReference(const scene::SceneSpec& scene) {
    const scene::ContactSpec& contact = scene.contact;
    stiffness_ = contact.stiffness;
    rho_ = std::sqrt(contact.rotational_stiffness / contact.stiffness);
    const auto held = std::find_if(scene.parts.begin(), scene.parts.end(), [](const auto& part) { return part.held; });
    const auto* shape = held == scene.parts.end() ? nullptr : std::get_if<shape::Shape>(&held->geometry);
    for (const scene::PartSpec& part : scene.parts) {
        if (part.held) continue;
        if (part.friction > 0.0 && held->friction > 0.0) {
            missing_ = "parts that rub have no pose of least energy";
            return;
        }
        const auto* other = std::get_if<shape::Shape>(&part.geometry);
        if (shape == nullptr || other == nullptr) {
            missing_ = "a part is a mesh";
            return;
        }
        solids_.push_back({*other, part.X_WP});
    }
    if (shape == nullptr || solids_.empty()) {
        missing_ = "the scene has no obstacle";
        return;
    }
    const auto* ball = std::get_if<shape::Sphere>(shape);
    if (ball != nullptr &&
        std::all_of(solids_.begin(), solids_.end(), [](const Solid& solid) { return isWithoutHollows(solid.shape); })) {
        radius_ = 0.5 * ball->diameter;
        return;
    }
    const auto* peg = std::get_if<shape::Peg>(shape);
    const auto* plate = std::get_if<shape::BorePlate>(&solids_.front().shape);
    if (peg == nullptr || plate == nullptr || solids_.size() != 1) {
        missing_ = "the pair is neither a ball among solids without hollows nor a round peg in a bore";
        return;
    }
    if (!(rho_ > 0.0)) {
        missing_ = "without rotational stiffness the peg's turn is not determined";
        return;
    }
    peg_ = std::make_shared<const Peg>(Peg{*peg, *plate, solids_.front().X_WS});
    uncertainty_ = stiffness_ * (0.5 * plate->bore_diameter) * (1.0 - std::cos(std::numbers::pi / kPoints));
}

bool ForceReference::rowsAt(const Pose& X_WG, std::vector<FreedomRow>& rows) const {
    rows.clear();
    if (peg_ == nullptr) {
        for (const Solid& solid : solids_) {
            const Vec3 p = solid.X_WS.inverse() * X_WG.p;
            FreedomRow row{Vec6::Zero(), shape::signedDistance(solid.shape, p) - radius_};
            row.along.head<3>() = solid.X_WS.q * gradientAt(solid.shape, p);
            rows.push_back(row);
        }
        return true;
    }
    const Pose X_PG = peg_->X_WP.inverse() * X_WG;
    return peg_->eachPoint(X_PG, [&](double gap, const Vec3& p, const Vec3& n) {
        FreedomRow row;
        row.along << peg_->X_WP.q * n, peg_->X_WP.q * (p - X_PG.p).cross(n) / rho_;
        row.gap = gap;
        rows.push_back(row);
    });
}

std::optional<Vec3> ForceReference::at(const Pose& X_WG, const Pose& X_WH) const {
    std::vector<FreedomRow> rows;
    if (!rowsAt(X_WH, rows) && peg_ != nullptr) return std::nullopt;
    const auto free = [&] {
        return std::all_of(rows.begin(), rows.end(), [](const FreedomRow& row) { return row.gap >= 0.0; });
    };
    // Of a hand that is free itself and was not cut off from there.
    if (free() && pullOf(X_WG, X_WH, rho_).norm() < kNearHand) return Vec3::Zero().eval();
    Pose X = X_WG;
    for (int step = 0; step < kMostSteps; ++step) {
        if (!rowsAt(X, rows)) return std::nullopt;
        auto u = leastMotion(rows, pullOf(X, X_WH, rho_));
        if (!u) return std::nullopt;
        if (peg_ == nullptr) u->tail<3>().setZero();  // a ball's turn changes nothing
        if (u->norm() < kAtRest) return Vec3(stiffness_ * (X.p - X_WH.p));
        X = moved(X, std::min(1.0, kStep / u->norm()) * *u, rho_);
    }
    return std::nullopt;
}

}  // namespace passung::truth
