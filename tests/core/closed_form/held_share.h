#pragma once

#include <Eigen/QR>
#include <algorithm>
#include <vector>

#include "core/base/types.h"

namespace passung::closed_form {

using MotionRowOfReference = Eigen::Matrix<double, 6, 1>;  // (force, torque / ρ)

/// min |Σ λ_i a_i - b|, λ ≥ 0: what contacts with these rows cannot push; by non-negative least squares (Lawson and
/// Hanson 1974).
inline double residualOf(const std::vector<MotionRowOfReference>& rows, const MotionRowOfReference& b) {
    std::vector<std::size_t> held;
    std::vector<double> lambda;
    MotionRowOfReference rest = b;
    for (int round = 0; round < 200; ++round) {
        std::size_t best = rows.size();
        double most = 1e-12;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const double along = rows[i].dot(rest);
            if (along <= most || std::find(held.begin(), held.end(), i) != held.end()) continue;
            most = along;
            best = i;
        }
        if (best == rows.size()) break;
        held.push_back(best);
        lambda.push_back(0.0);
        for (;;) {
            Eigen::MatrixXd A(6, static_cast<Eigen::Index>(held.size()));
            for (std::size_t k = 0; k < held.size(); ++k) A.col(static_cast<Eigen::Index>(k)) = rows[held[k]];
            const Eigen::VectorXd x = A.completeOrthogonalDecomposition().solve(b);
            double share = 1.0;
            std::size_t out = held.size();
            for (std::size_t k = 0; k < held.size(); ++k) {
                const double to = x[static_cast<Eigen::Index>(k)];
                if (to > 0.0 || lambda[k] - to <= 0.0) continue;
                if (const double s = lambda[k] / (lambda[k] - to); s < share || out == held.size()) {
                    share = std::min(share, s);
                    out = k;
                }
            }
            for (std::size_t k = 0; k < held.size(); ++k)
                lambda[k] += share * (x[static_cast<Eigen::Index>(k)] - lambda[k]);
            if (out == held.size()) {
                rest = b - A * x;
                break;
            }
            held.erase(held.begin() + static_cast<std::ptrdiff_t>(out));
            lambda.erase(lambda.begin() + static_cast<std::ptrdiff_t>(out));
        }
    }
    return rest.norm();
}

}  // namespace passung::closed_form
