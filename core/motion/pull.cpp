#include "core/motion/pull.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <span>

namespace passung::motion {

Metric Pull::movingMetric() const noexcept {
    const auto hands = std::span(springs).first(static_cast<std::size_t>(count));
    Metric metric;
    metric.p_GC = momentum.mass * p_GM;
    for (const Spring& own : hands) metric.p_GC += spring * own.p_GC;
    metric.p_GC /= stiffness();
    const auto around = [&metric](double weight, const Vec3& p_G) -> Mat3 {
        const Vec3 d = p_G - metric.p_GC;
        return weight * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
    };
    Mat3 turning = momentum.inertia_G + around(momentum.mass, p_GM);
    for (const Spring& own : hands) turning += turn * Mat3::Identity() + around(spring, own.p_GC);
    const Eigen::SelfAdjointEigenSolver<Mat3> square(turning / stiffness());
    metric.whole = true;
    metric.S_G = square.operatorSqrt();
    metric.S_G_inverse = square.operatorInverseSqrt();
    metric.radius = std::sqrt(square.eigenvalues()[0]);
    return metric;
}

Pose Pull::restFrom(const Metric& metric, Pose X) const noexcept {
    for (int i = 0; i < kMostSteps; ++i) {
        const Motion w = wantedAt(metric, X);
        X = metric.moved(X, w);
        if (!(w.norm() > kSettled)) break;
    }
    return X;
}

}  // namespace passung::motion
