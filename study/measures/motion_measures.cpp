#include "study/measures/motion_measures.h"

#include <algorithm>
#include <cmath>

namespace passung::measures {
namespace {

/// Rotation vector in world axes from `from` to `to`, the shortest way.
Vec3 rotationBetweenTurns(const Quat& from, const Quat& to) {
    const Quat step = to * from.conjugate();
    const double sine = step.vec().norm();
    if (!(sine > 0.0)) return Vec3::Zero();
    const double angle = 2.0 * std::atan2(sine, std::abs(step.w()));
    return step.vec() * ((step.w() < 0.0 ? -angle : angle) / sine);
}

Vec3 vectorOf(const std::array<float, 3>& values) { return {values[0], values[1], values[2]}; }

/// Sum of a quantity of each hand's motion.
template <class Quantity>
Optional sumOfHands(const Trial& trial, Quantity quantity) {
    if (trial.ticks.empty()) return std::nullopt;
    double sum = 0.0;
    for (const SmoothMotion& motion : trial.motions) sum += quantity(motion);
    return sum;
}

/// The same over the steps from period to period.
template <class Quantity>
Optional sumOfSteps(const Trial& trial, Quantity quantity) {
    return sumOfHands(trial, [&](const SmoothMotion& motion) {
        double sum = 0.0;
        for (std::size_t i = 1; i < motion.positions.size(); ++i) sum += quantity(motion, i);
        return sum;
    });
}

double workOf(const HandTicks& hand, const SmoothMotion& motion) {
    double sum = 0.0;
    for (std::size_t i = 1; i < hand.points.size(); ++i) {
        const std::size_t from = motion.at[i - 1], to = motion.at[i];
        const TickRecord& record = hand.points[i - 1];
        sum -= vectorOf(record.force_N).dot(motion.positions[to] - motion.positions[from]);
        sum -= vectorOf(record.torque_Nm).dot(rotationBetweenTurns(motion.turns[from], motion.turns[to]));
    }
    return sum;
}

}  // namespace

Optional pathLength(const Trial& trial) {
    return sumOfSteps(trial, [](const SmoothMotion& motion, std::size_t i) {
        return (motion.positions[i] - motion.positions[i - 1]).norm();
    });
}

Optional straightPathRatio(const Trial& trial) {
    const Optional straight = sumOfHands(trial, [](const SmoothMotion& motion) {
        return motion.positions.empty() ? 0.0 : (motion.positions.back() - motion.positions.front()).norm();
    });
    if (!straight || !(*straight > 0.0)) return std::nullopt;
    return *pathLength(trial) / *straight;
}

Optional rotationPath(const Trial& trial) {
    return sumOfSteps(trial, [](const SmoothMotion& motion, std::size_t i) {
        return rotationBetweenTurns(motion.turns[i - 1], motion.turns[i]).norm();
    });
}

Optional work(const Trial& trial) {
    if (trial.ticks.empty()) return std::nullopt;
    double sum = 0.0;
    for (std::size_t hand = 0; hand < trial.hands.size(); ++hand) sum += workOf(trial.hands[hand], trial.motions[hand]);
    return sum;
}

Optional spectralArcLength(const Trial& trial) {
    double sum = 0.0;
    int moving = 0;
    for (const SmoothMotion& motion : trial.motions) {
        const double length = spectralArcLength(motion.speeds());
        if (!std::isfinite(length)) continue;
        sum += length;
        ++moving;
    }
    if (moving == 0) return std::nullopt;
    return sum / moving;
}

Optional logDimensionlessJerk(const Trial& trial) {
    constexpr double kLeastRatio = 20.0;
    double sum = 0.0;
    for (const SmoothMotion& motion : trial.motions) {
        const std::vector<double> speeds = motion.speeds();
        const double jerk = motion.jerkSquared(), time = motion.duration();
        const double noise = jerkOfNoise(trial.context.motion_bandwidth) * motion.rest_variance * time;
        if (speeds.empty() || !(jerk > 0.0) || !(jerk >= kLeastRatio * noise)) return std::nullopt;
        const double peak = *std::max_element(speeds.begin(), speeds.end());
        sum -= std::log(time * time * time / (peak * peak) * jerk);
    }
    return sum / static_cast<double>(trial.motions.size());
}

}  // namespace passung::measures
