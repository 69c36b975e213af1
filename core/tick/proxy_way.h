#pragma once

#include <array>

#include "core/motion/constrained_motion.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy.h"

namespace passung::tick {

inline constexpr double kBent = 0.25;  // of a fast way in one tick, per cell
inline constexpr int kPlaces = 7;

/// The way of a proxy within one tick, straight from joint to joint, in a metric in which no point of the held part
/// moves farther than √2 times it.
///
/// What others see of it is the straight line between its ends, which knows nothing of what the way goes round. No
/// place of that line is farther from the way than the joint that is farthest from it: the way's foot on it comes past
/// every place, and the distance from a line is greatest at a joint. So round a bend of more than the margin `relieve`
/// a proxy goes on in the next tick; but where it has more than half a cell to go, because the hand is fast, in this
/// one, up to a bend of kBent, if the line does not overlap at kPlaces places.
class ProxyWay {
public:
    ProxyWay(const HandModel& model, const motion::Metric& metric) noexcept;

    void add(const motion::Motion& u) noexcept;
    double length() const noexcept { return length_; }
    /// How far from the way the straight line would lie if the way ended after `next`.
    double bentBy(const motion::Motion& next) const noexcept;
    /// Whether it may go on with `next`, the beginning of a motion of `length`.
    bool goesOn(const HandModel& model, const motion::Motion& next, double length) const noexcept;

private:
    static constexpr std::size_t kMostJoints = 16;
    motion::Motion scaled(const motion::Motion& u) const noexcept;

    double turn_scale_, length_ = 0.0;
    std::array<motion::Motion, kMostJoints> joint_;
    std::size_t joints_ = 0;
};

/// True if the straight line from `X_from`, where the tick began, to `X_to` overlaps by more than `accepted` at one of
/// kPlaces places between its ends; for ways that bend and yet go on. rt-safe.
bool cutsCorner(const ProxyView& view, const Pose& X_from, const Pose& X_to, double accepted) noexcept;

}  // namespace passung::tick
