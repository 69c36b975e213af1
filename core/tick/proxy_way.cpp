#include "core/tick/proxy_way.h"

#include <algorithm>
#include <cassert>

namespace passung::tick {

ProxyWay::ProxyWay(const HandModel& model, const motion::Metric& metric) noexcept
    : turn_scale_((model.shell->reach() + metric.distance()) / metric.radius) {}

motion::Motion ProxyWay::scaled(const motion::Motion& u) const noexcept {
    motion::Motion v = u;
    v.tail<3>() *= turn_scale_;
    return v;
}

void ProxyWay::add(const motion::Motion& u) noexcept {
    assert(joints_ < kMostJoints);
    const motion::Motion v = scaled(u);
    length_ += v.norm();
    joint_[joints_] = joints_ > 0 ? motion::Motion(joint_[joints_ - 1] + v) : v;
    ++joints_;
}

double ProxyWay::bentBy(const motion::Motion& next) const noexcept {
    if (joints_ == 0) return 0.0;
    const motion::Motion line = joint_[joints_ - 1] + scaled(next);
    const double squared = line.squaredNorm();
    double farthest = 0.0;
    for (std::size_t i = 0; i < joints_; ++i) {
        const double share = squared > 0.0 ? joint_[i].dot(line) / squared : 0.0;
        farthest = std::max(farthest, (joint_[i] - share * line).norm());
    }
    return farthest;
}

bool ProxyWay::goesOn(const HandModel& model, const motion::Motion& next, double length) const noexcept {
    const double bend = bentBy(next), s = model.finest_cell;
    return bend <= model.margins.relieve || (length > kLongestStep * s && bend <= kBent * s);
}

bool cutsCorner(const ProxyView& view, const Pose& X_from, const Pose& X_to, double accepted) noexcept {
    for (int place = 1; place <= kPlaces; ++place) {
        const double share = static_cast<double>(place) / (kPlaces + 1);
        if (overlapsBetween(view, X_from, X_to, share, accepted)) return true;
    }
    return false;
}

}  // namespace passung::tick
