#include "study/session/success_rule.h"

#include <cmath>

#include "study/measures/tick_facts.h"

namespace passung::session {

SuccessRule::SuccessRule(const protocol::PegInHoleTask& task, const Pose& X_WT)
    : X_TW_(X_WT.inverse()),
      clearance_(task.clearance),
      min_depth_(task.success_fraction * task.insertion_depth),
      max_step_(task.max_speed * static_cast<double>(kSpeedTicks) * kTickSeconds),
      hold_ticks_(std::llround(task.hold / kTickSeconds)) {}

bool SuccessRule::isRestingInBore(const TickRecord& record) const {
    if (known_ < kSpeedTicks) return false;
    const Vec3& before = positions_[static_cast<std::size_t>(record.tick % kSpeedTicks)];
    return measures::tipDepthInBore(record, X_TW_, clearance_) >= min_depth_ && measures::isClearOfWalls(record) &&
           (measures::proxyPosition(record) - before).norm() < max_step_;
}

bool SuccessRule::fulfilledAt(const TickRecord& record) {
    if (known_ > 0 && record.tick != last_tick_ + 1) {
        known_ = 0;
        resting_since_.reset();
    }
    if (!isRestingInBore(record)) {
        resting_since_.reset();
    } else if (!resting_since_) {
        resting_since_ = record.tick;
    }
    positions_[static_cast<std::size_t>(record.tick % kSpeedTicks)] = measures::proxyPosition(record);
    ++known_;
    last_tick_ = record.tick;
    return resting_since_ && record.tick - *resting_since_ >= hold_ticks_;
}

}  // namespace passung::session
