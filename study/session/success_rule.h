#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/base/tick_record.h"
#include "study/measures/period_clock.h"
#include "study/plan/task.h"

namespace passung::session {

/// Rule by which a peg-in-hole trial has succeeded. All of this must hold in every tick for `hold` seconds:
/// - the proxy's origin (the peg's tip) is at least success_fraction × insertion_depth below the bore's mouth and
///   in the bore (measures::tipDepthInBore);
/// - the held part at the proxy's pose overlaps nothing by more than measures::kWallGive: a part that a soft contact
///   lets into the material has not been inserted;
/// - its speed is below max_speed, as the mean over the last kSpeedTicks: the distance between two positions so far
///   apart in time, because the difference of neighbouring ticks is mostly the encoder's quantum and tremor.
/// Time counts missed cycles too (measures::PeriodClock).
/// A missing tick starts the hold anew: what was not recorded is not counted as held.
class SuccessRule {
public:
    static constexpr std::int64_t kSpeedTicks = 50;

    /// `X_WT`: the target in the world, its bore along -z from the origin.
    SuccessRule(const plan::PegInHoleTask& task, const Pose& X_WT);

    /// Takes the next record of the trial; true if the rule is fulfilled at its tick.
    bool fulfilledAt(const TickRecord& record);

private:
    bool isRestingInBore(const TickRecord& record, std::int64_t time) const;

    Pose X_TW_;
    double clearance_;  // [m]
    double min_depth_;  // [m]
    double max_speed_;  // [m/s]
    std::int64_t hold_periods_;
    struct PlaceTime {
        Vec3 position;
        std::int64_t time;  // [periods]
    };
    std::array<PlaceTime, kSpeedTicks> places_;  // the proxy at tick k stands at k modulo kSpeedTicks
    measures::PeriodClock clock_;
    std::int64_t known_ = 0;  // consecutive ticks seen
    std::int64_t last_tick_ = 0;
    std::optional<std::int64_t> resting_since_;  // [periods]
};

}  // namespace passung::session
