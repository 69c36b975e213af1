#include "study/session/success_rule.h"

#include <cmath>

#include "study/measures/tick_facts.h"

namespace passung::session {

SuccessRule::SuccessRule(const plan::PegInHoleTask& task, const Pose& X_WT)
    : X_TW_(X_WT.inverse()),
      clearance_(task.clearance),
      min_depth_(task.success_fraction * task.insertion_depth),
      max_speed_(task.max_speed),
      hold_periods_(std::llround(task.hold / kTickSeconds)) {}

bool SuccessRule::isRestingInBore(const TickRecord& record, std::int64_t time) const {
    if (known_ < kSpeedTicks) return false;
    const PlaceTime& before = places_[static_cast<std::size_t>(record.tick % kSpeedTicks)];
    const double max_step = max_speed_ * static_cast<double>(time - before.time) * kTickSeconds;
    return measures::tipDepthInBore(record, X_TW_, clearance_) >= min_depth_ && measures::isClearOfWalls(record) &&
           (measures::proxyPosition(record) - before.position).norm() < max_step;
}

bool SuccessRule::fulfilledAt(const TickRecord& record) {
    const std::int64_t time = clock_.at(record);
    if (known_ > 0 && record.tick != last_tick_ + 1) {
        known_ = 0;
        resting_since_.reset();
    }
    if (!isRestingInBore(record, time)) {
        resting_since_.reset();
    } else if (!resting_since_) {
        resting_since_ = time;
    }
    places_[static_cast<std::size_t>(record.tick % kSpeedTicks)] = {measures::proxyPosition(record), time};
    ++known_;
    last_tick_ = record.tick;
    return resting_since_ && time - *resting_since_ >= hold_periods_;
}

}  // namespace passung::session
