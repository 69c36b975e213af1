#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "core/base/random.h"
#include "tests/hard/run.h"

namespace passung::hard {

constexpr double kDegree = std::numbers::pi / 180.0;

/// A path from pose to pose, a reading a tick; all poses in the frame of `X_WO` until readings() puts them there.
class Walk {
public:
    explicit Walk(const Pose& start) : poses_{start} {}

    /// Straight and by slerp at `speed` [m/s] or `spin` [rad/s], whatever takes longer.
    Walk& to(const Pose& target, double speed, double spin = 20.0);
    Walk& rest(int ticks);
    /// Turns about `axis` through the origin of the moving frame, farther than half a turn if asked [rad].
    Walk& turn(const Vec3& axis, double angle, double spin);

    const Pose& last() const { return poses_.back(); }
    const std::vector<Pose>& poses() const { return poses_; }
    /// From the last pose on it rests.
    Drive drive(const Pose& X_WO) const;

private:
    std::vector<Pose> poses_;
};

/// A smooth random function of time in [-1, 1]: three sines of random frequency and phase.
class Wander {
public:
    Wander(Random& random, double lowest_hz, double highest_hz);
    double at(double seconds) const;

private:
    double frequency_[3], phase_[3];
};

/// A random pose about `base`: every coordinate wanders as far as asked [m], [rad].
class RandomPush {
public:
    RandomPush(std::uint64_t seed, const Vec3& lateral, const Vec3& tilt, double highest_hz = 3.0);
    Pose at(double seconds) const;

private:
    std::vector<Wander> wander_;
    Vec3 lateral_, tilt_;
};

Pose at(double x_mm, double y_mm, double z_mm, const Vec3& rotation = Vec3::Zero());

}  // namespace passung::hard
