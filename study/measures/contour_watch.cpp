#include "study/measures/contour_watch.h"

#include <algorithm>
#include <limits>

#include "study/measures/tick_facts.h"

namespace passung::measures {

ContourWatch::ContourWatch(const ContourFacts& facts, const Pose& X_WT) : facts_(facts), X_TW_(X_WT.inverse()) {
    for (std::size_t i = 1; i < facts_.points.size(); ++i) {
        starts_.push_back(length_);
        length_ += (facts_.points[i] - facts_.points[i - 1]).norm();
    }
}

void ContourWatch::follow(const TickRecord& record) {
    const Vec3 p = X_TW_ * proxyPosition(record);
    const double last = std::min(place_ + facts_.reach, length_);
    double nearest = place_;
    deviation_ = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < starts_.size(); ++i) {
        const Vec3& from = facts_.points[i];
        const Vec3 along = facts_.points[i + 1] - from;
        const double size = along.norm();
        if (starts_[i] + size < place_ || starts_[i] > last) continue;
        const double free = starts_[i] + along.dot(p - from) / size;
        const double s = std::clamp(free, std::max(starts_[i], place_), std::min(starts_[i] + size, last));
        const double distance = (from + along * ((s - starts_[i]) / size) - p).norm();
        if (!(distance < deviation_)) continue;
        deviation_ = distance;
        nearest = s;
    }
    following_ = deviation_ <= facts_.reach;
    if (following_) place_ = nearest;
}

}  // namespace passung::measures
