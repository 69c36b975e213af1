#include "core/motion/friction_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace passung::motion {

std::pair<Vec3, Vec3> tangentsOf(const Vec3& n) noexcept {
    const Vec3 t1 = n.cross(std::abs(n.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY()).normalized();
    return {t1, n.cross(t1)};
}

Vec3 turned(const FrictionPatch& patch, const Vec3& normal) noexcept {
    const auto [s1, s2] = tangentsOf(normal);
    const Vec3 along = impulseAlong(patch);
    return {along.dot(s1), along.dot(s2), patch.impulse.z()};
}

Vec3 slipOf(const Surroundings& around, const FrictionPatch& patch, const Motion& motion) noexcept {
    const auto [t1, t2] = tangentsOf(patch.normal);
    const Vec3 turn = around.metric.turnOf(motion);
    const Vec3 way = motion.head<3>() + turn.cross(patch.centre - around.metric.centre);
    return {way.dot(t1), way.dot(t2), patch.radius * turn.dot(patch.normal)};
}

Vec3 impulseAlong(const FrictionPatch& patch) noexcept {
    const auto [t1, t2] = tangentsOf(patch.normal);
    return patch.impulse.x() * t1 + patch.impulse.y() * t2;
}

double effectiveRadius(const Surroundings& around, const FrictionPatch& patch, const Motion& u) noexcept {
    const auto [t1, t2] = tangentsOf(patch.normal);
    const auto isOf = [&](const TouchingPiece& piece) {
        return piece.obstacle == patch.obstacle && piece.normal.dot(patch.normal) > kSameWay;
    };
    const bool in_pieces = std::any_of(around.pieces.begin(), around.pieces.end(), isOf);
    const auto forTouching = [&, t1 = t1, t2 = t2](auto use) {
        for (const TouchingPiece& piece : around.pieces) {
            if (!isOf(piece)) continue;
            const Vec3 r = piece.centre - patch.centre;
            use(piece.area, Eigen::Vector2d(r.dot(t1), r.dot(t2)));
        }
        if (in_pieces) return;
        for (const contact::ContactPoint& c : around.contacts) {
            const double facing = c.gradient.dot(patch.normal);
            if (c.obstacle != patch.obstacle || !(facing > 0.0) ||
                !(facing * facing > kSameWay * kSameWay * c.gradient.squaredNorm()))
                continue;
            const double phi = c.phi + c.gradient.dot(around.wayOf(c.position, u));
            if (!(phi < around.keep_out + std::abs(around.keep_out))) continue;
            const Vec3 r = c.position - patch.centre;
            use(c.area, Eigen::Vector2d(r.dot(t1), r.dot(t2)));
        }
    };
    double area = 0.0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
    forTouching([&](double a, const Eigen::Vector2d& x) {
        area += a;
        mean += a * x;
        second += a * x * x.transpose();
    });
    if (!(area > 0.0)) return 0.0;
    mean /= area;
    second = second / area - mean * mean.transpose();
    // Pressure 1 + k · (x - mean) has its centre at 0 if second · k = -mean; a line of points has no k across.
    const double across = 1e-9 * second.trace() + std::numeric_limits<double>::min();
    const Eigen::Vector2d k = (second + across * Eigen::Matrix2d::Identity()).inverse() * -mean;
    double weight = 0.0, sum = 0.0;
    forTouching([&](double a, const Eigen::Vector2d& x) {
        const double w = std::max(0.0, a * (1.0 + k.dot(x - mean)));
        weight += w;
        sum += w * x.norm();
    });
    return weight > 0.0 ? sum / weight : 0.0;
}

}  // namespace passung::motion
