#include "analysis/stats/anova.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace passung::stats {
namespace {

struct Moments {
    double n = 0.0, mean = 0.0, squares = 0.0;  // squares: of deviations from the mean
};

Moments momentsOf(std::span<const double> values) {
    Moments m;
    for (const double value : values) m.mean += value;
    m.n = static_cast<double>(values.size());
    m.mean /= m.n;
    for (const double value : values) m.squares += (value - m.mean) * (value - m.mean);
    return m;
}

/// Upper tail of F. Equal values everywhere but between the levels have an infinite F and p = 0.
TestResult fTest(double between, double df1, double within, double df2, double epsilon = 1.0) {
    if (!(df1 > 0.0 && df2 > 0.0) || !(within > 0.0 || between > 0.0)) return {};
    const double f = (between / df1) / (within / df2);
    if (!std::isfinite(f)) return {f, 0.0};
    const boost::math::fisher_f distribution(epsilon * df1, epsilon * df2);
    return {f, boost::math::cdf(boost::math::complement(distribution, f))};
}

/// Rows: orthonormal contrasts of `levels` values, orthogonal to their mean (Helmert).
Eigen::MatrixXd contrastsOf(Eigen::Index levels) {
    Eigen::MatrixXd contrasts = Eigen::MatrixXd::Zero(levels - 1, levels);
    for (Eigen::Index row = 0; row < levels - 1; ++row) {
        const double k = static_cast<double>(row + 1);
        contrasts.row(row).head(row + 1).setConstant(1.0 / std::sqrt(k * (k + 1.0)));
        contrasts(row, row + 1) = -k / std::sqrt(k * (k + 1.0));
    }
    return contrasts;
}

}  // namespace

TestResult welchT(std::span<const double> a, std::span<const double> b) {
    if (a.size() < 2 || b.size() < 2) return {};
    const Moments one = momentsOf(a), other = momentsOf(b);
    const double va = one.squares / (one.n - 1.0) / one.n, vb = other.squares / (other.n - 1.0) / other.n;
    const double t = (one.mean - other.mean) / std::sqrt(va + vb);
    if (std::isinf(t)) return {t, 0.0};
    if (!std::isfinite(t)) return {};
    const double df = (va + vb) * (va + vb) / (va * va / (one.n - 1.0) + vb * vb / (other.n - 1.0));
    return {t, 2.0 * boost::math::cdf(boost::math::complement(boost::math::students_t(df), std::abs(t)))};
}

TestResult oneWayAnova(const std::vector<std::vector<double>>& groups) {
    std::vector<double> all;
    double within = 0.0, count = 0.0;
    for (const std::vector<double>& group : groups) {
        if (group.empty()) continue;
        within += momentsOf(group).squares;
        count += 1.0;
        all.insert(all.end(), group.begin(), group.end());
    }
    if (count < 2.0) return {};
    const Moments total = momentsOf(all);
    return fTest(total.squares - within, count - 1.0, within, total.n - count);
}

TestResult withinAnova(const std::vector<std::vector<std::vector<double>>>& groups) {
    if (groups.empty() || groups.front().empty() || groups.front().front().size() < 2) return {};
    const auto levels = static_cast<Eigen::Index>(groups.front().front().size());
    const Eigen::MatrixXd contrasts = contrastsOf(levels);
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(levels - 1);  // of the groups' means
    Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(levels - 1, levels - 1);
    double persons = 0.0, reciprocals = 0.0;
    for (const auto& group : groups) {
        if (group.empty()) return {};
        const auto n = static_cast<Eigen::Index>(group.size());
        Eigen::MatrixXd z(levels - 1, n);
        for (Eigen::Index i = 0; i < n; ++i)
            z.col(i) = contrasts * Eigen::Map<const Eigen::VectorXd>(group[static_cast<std::size_t>(i)].data(), levels);
        const Eigen::VectorXd own = z.rowwise().mean();
        z.colwise() -= own;
        scatter += z * z.transpose();
        mean += own / static_cast<double>(groups.size());
        persons += static_cast<double>(n);
        reciprocals += 1.0 / static_cast<double>(n);
    }
    // Every component of the unweighted mean has the variance of one contrast times this.
    const double share = reciprocals / static_cast<double>(groups.size() * groups.size());
    const double df = static_cast<double>(levels - 1), free = persons - static_cast<double>(groups.size());
    const double error = scatter.trace();
    const double epsilon = error * error / (df * scatter.squaredNorm());
    if (!(error > 0.0)) return fTest(mean.squaredNorm() / share, df, 0.0, df * free);
    return fTest(mean.squaredNorm() / share, df, error, df * free, epsilon);
}

}  // namespace passung::stats
