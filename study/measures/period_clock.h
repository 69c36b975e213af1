#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/tick_record.h"

namespace passung::measures {

/// Time of ticks in haptic periods of 1 ms. In virtual time tick k is k periods after tick 0; in real time cycles may
/// have been missed, and the record after them says by its `periods` how many periods lie before it.
class PeriodClock {
public:
    PeriodClock() = default;
    /// Counts from tick `origin` on instead of tick 0.
    explicit PeriodClock(std::int64_t origin) : tick_(origin) {}

    /// Moves on to `record` and returns its time [periods after the origin]. Records come in ascending order; ticks
    /// before the origin stand at 0. A tick whose record is missing counts as one period.
    std::int64_t at(const TickRecord& record) {
        if (record.tick <= tick_) return periods_;
        periods_ += record.tick - tick_ - 1 + record.periods;
        missed_ += record.periods - std::int64_t{1};
        tick_ = record.tick;
        return periods_;
    }

    /// Time of `tick`, at or after the last record, as if no cycle were missed after it.
    std::int64_t until(std::int64_t tick) const { return periods_ + std::max<std::int64_t>(0, tick - tick_); }

    std::int64_t periods() const { return periods_; }
    /// Periods without a tick up to the last record.
    std::int64_t missed() const { return missed_; }

private:
    std::int64_t tick_ = 0;
    std::int64_t periods_ = 0;
    std::int64_t missed_ = 0;
};

}  // namespace passung::measures
