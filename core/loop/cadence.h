#pragma once

#include <cstdint>

#include "core/base/tick_record.h"

namespace passung::loop {

/// Times at which the cycles of the haptic loop are due: one a period from `first_due` on. A cycle that takes longer
/// than its period lets the following ones pass: they are missed, not made up for, and the next is due at the next
/// whole period. Pure arithmetic on a clock's nanoseconds; rt-safe.
class Cadence {
public:
    explicit Cadence(std::int64_t first_due) noexcept : due_(first_due) {}

    /// Time at which the next cycle is due [ns].
    std::int64_t due() const noexcept { return due_; }

    /// The cycle that was due has ended at `end` [ns]. Returns how many cycles after it are missed, mostly 0.
    std::int64_t finish(std::int64_t end) noexcept {
        due_ += kTickNanoseconds;
        if (end <= due_) return 0;
        const std::int64_t missed = (end - due_ - 1) / kTickNanoseconds + 1;
        due_ += missed * kTickNanoseconds;
        return missed;
    }

private:
    std::int64_t due_;
};

}  // namespace passung::loop
