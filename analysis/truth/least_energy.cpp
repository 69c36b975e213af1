#include "analysis/truth/least_energy.h"

#include <algorithm>
#include <cmath>

namespace passung::truth {

namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Vec7 = Eigen::Matrix<double, 7, 1>;

constexpr double kUnit = 1e-3;     // length that the dual problem counts in [m]: its numbers are near 1
constexpr int kMostTurns = 300;    // of the dual problem
constexpr int kMostSteps = 250;    // towards the pose of least energy
constexpr double kStep = 2.5e-4;   // most of one step [m]
constexpr double kReach = 6e-4;    // of rows [m]
constexpr double kAtRest = 2e-9;   // of a step [m]
constexpr double kNearby = 1e-7;   // rows of a pose that is so near hold [m]
constexpr double kHeld = 2e-6;     // of a row's gap after a step [m]
constexpr double kOverlap = 1e-9;  // at rest [m]

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

Pose moved(const Pose& X, const Vec6& u, double rho) {
    return {(rotationFromVector(u.tail<3>() / rho) * X.q).normalized(), X.p + u.head<3>()};
}

/// A row that another pose had.
struct OldRow {
    FreedomRow row;  // its gap moved along
    Vec6 since = Vec6::Zero();
};

double overlapOf(const std::vector<FreedomRow>& rows) {
    double most = 0.0;
    for (const FreedomRow& row : rows) most = std::max(most, -row.gap);
    return most;
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

Vec6 pullTo(const Pose& from, const Pose& to, double rho) {
    Vec6 pull;
    pull << to.p - from.p, rho * rotationVector(to.q * from.q.conjugate());
    return pull;
}

std::optional<LeastEnergy> leastEnergyFrom(const Separation& separation, double rho, const Pose& X_from,
                                           const Pose& X_WH) {
    constexpr double kNear = 4.0;  // steps: as far as an old row holds
    std::vector<FreedomRow> rows;
    std::vector<OldRow> old;
    Pose X = X_from;
    Vec6 last = Vec6::Zero();
    double cap = kStep;
    int quiet = 0;
    for (int step = 0; step < kMostSteps; ++step) {
        rows.clear();
        if (!separation.rowsAt(X, rho, kReach, rows)) return std::nullopt;
        const std::size_t fresh = rows.size();
        const double overlap = overlapOf(rows);
        for (const OldRow& row : old) rows.push_back(row.row);
        const Vec6 pull = pullTo(X, X_WH, rho);
        auto u = leastMotion(rows, pull);
        if (!u) {
            rows.resize(fresh);
            u = leastMotion(rows, pull);
        }
        if (!u) return std::nullopt;
        const double length = u->norm();
        // What seemed to rest was held by rows of a pose too far away: shorter steps find them nearby.
        if (length < kAtRest && overlap < kOverlap)
            ++quiet;
        else if (quiet > 0) {
            cap = std::max(kNearby, 0.25 * std::min(cap, length));
            quiet = 0;
        } else if (u->dot(last) > 0.5 * length * last.norm()) {
            cap = std::min(kStep, 2.0 * cap);
        }
        if (quiet == 2) return LeastEnergy{X, 0.5 * pull.squaredNorm(), overlap, pullTo(X_from, X, rho).norm(), step};
        const Vec6 way = std::min(1.0, cap / std::max(length, 1e-300)) * *u;
        for (std::size_t i = 0; i < fresh; ++i)
            if (rows[i].gap + rows[i].along.dot(way) < kHeld) old.push_back({rows[i], Vec6::Zero()});
        std::erase_if(old, [&](OldRow& row) {
            row.since += way;
            row.row.gap += row.row.along.dot(way);
            return row.since.norm() > kNear * way.norm() + 2.0 * kNearby || row.row.gap > kHeld;
        });
        last = way;
        X = moved(X, way, rho);
    }
    return std::nullopt;
}

}  // namespace passung::truth
