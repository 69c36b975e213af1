#pragma once

#include <array>

#include "core/tick/constrained_motion.h"
#include "core/tick/tick_model.h"

namespace passung::tick {

/// The way of a proxy within one tick, straight from joint to joint, in a metric in which no point of the held part
/// moves farther than √2 times it.
///
/// What others see of it is the straight line between its ends, which knows nothing of what the way goes round. No
/// place of that line is farther from the way than the joint that is farthest from it: the way's foot on it comes past
/// every place, and the distance from a line is greatest at a joint.
class ProxyWay {
public:
    explicit ProxyWay(const TickModel& model) noexcept;

    void add(const Motion& u) noexcept;
    double length() const noexcept { return length_; }
    /// How far from the way the straight line would lie if the way ended after `next`.
    double bentBy(const Motion& next) const noexcept;

private:
    static constexpr std::size_t kMostJoints = 16;
    Motion scaled(const Motion& u) const noexcept;

    double turn_scale_, length_ = 0.0;
    std::array<Motion, kMostJoints> joint_;
    std::size_t joints_ = 0;
};

}  // namespace passung::tick
