#include "tests/hard/paths.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace passung::hard {

Walk& Walk::to(const Pose& target, double speed, double spin) {
    const Pose from = last();
    const double seconds =
        std::max((target.p - from.p).norm() / speed, rotationVector(target.q * from.q.conjugate()).norm() / spin);
    const int n = std::max(1, static_cast<int>(std::ceil(seconds / kTickSeconds)));
    for (int i = 1; i <= n; ++i) {
        const double share = static_cast<double>(i) / n;
        poses_.push_back({from.q.slerp(share, target.q), from.p + share * (target.p - from.p)});
    }
    return *this;
}

Walk& Walk::rest(int ticks) {
    const Pose here = last();
    poses_.insert(poses_.end(), static_cast<std::size_t>(ticks), here);
    return *this;
}

Walk& Walk::turn(const Vec3& axis, double angle, double spin) {
    const Pose from = last();
    const int n = std::max(1, static_cast<int>(std::ceil(std::abs(angle) / spin / kTickSeconds)));
    for (int i = 1; i <= n; ++i)
        poses_.push_back({from.q * Quat(Eigen::AngleAxisd(angle * i / n, axis.normalized())), from.p});
    return *this;
}

Drive Walk::drive(const Pose& X_WO) const {
    return [poses = poses_, X_WO](std::int64_t tick, const tick::TickOutput*) {
        const auto i = std::min(static_cast<std::size_t>(tick), poses.size() - 1);
        return DeviceReading{X_WO * poses[i]};
    };
}

Wander::Wander(Random& random, double lowest_hz, double highest_hz) {
    for (int i = 0; i < 3; ++i) {
        frequency_[i] = random.uniform(lowest_hz, highest_hz);
        phase_[i] = random.uniform(0.0, 2.0 * std::numbers::pi);
    }
}

double Wander::at(double seconds) const {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += std::sin(2.0 * std::numbers::pi * frequency_[i] * seconds + phase_[i]);
    return sum / 3.0;
}

RandomPush::RandomPush(std::uint64_t seed, const Vec3& lateral, const Vec3& tilt, double highest_hz)
    : lateral_(lateral), tilt_(tilt) {
    Random random(seed);
    for (int i = 0; i < 6; ++i) wander_.emplace_back(random, 0.2, highest_hz);
}

Pose RandomPush::at(double seconds) const {
    Vec3 p, v;
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        p[i] = lateral_[i] * wander_[k].at(seconds);
        v[i] = tilt_[i] * wander_[k + 3].at(seconds);
    }
    return {rotationFromVector(v), p};
}

Pose at(double x_mm, double y_mm, double z_mm, const Vec3& rotation) {
    return {rotationFromVector(rotation), 1e-3 * Vec3(x_mm, y_mm, z_mm)};
}

}  // namespace passung::hard
