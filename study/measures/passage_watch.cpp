#include "study/measures/passage_watch.h"

#include <cmath>

#include "study/measures/tick_facts.h"

namespace passung::measures {

namespace {

/// Below the mouth's plane a tilted part's origin is still at the mouth: it rests on the rim beside it, and slides in.
constexpr double kAtMouth = 0.2e-3;  // [m]

}  // namespace

void PassageWatch::follow(const TickRecord& record) {
    if (through_) return;
    const Vec3 p = X_TW_ * proxyPosition(record);
    const bool near_axis = std::hypot(p.x(), p.y()) <= 0.5 * facts_.width;
    const bool entered = !inside_ && above_ && p.z() <= 0.0 && near_axis;
    if (entered) ++entries_;
    const bool was_inside = inside_ || entered;
    through_ = was_inside && near_axis && p.z() < -facts_.length;
    inside_ = was_inside && near_axis && p.z() <= 0.0 && !through_;
    above_ = p.z() > -kAtMouth;
}

}  // namespace passung::measures
