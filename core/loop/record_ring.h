#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/tick_record.h"

namespace passung::loop {

/// Lock-free ring of tick records from one producer (the loop) to one consumer. A full ring drops the new record and
/// counts it: the producer never waits.
class RecordRing {
public:
    /// Room for `capacity` records, rounded up to a power of two.
    explicit RecordRing(std::size_t capacity);

    /// Producer only; rt-safe. False (and one more drop) if full.
    bool tryPush(const TickRecord& record) noexcept;

    /// Consumer only: the oldest records, as many as there are and fit; returns how many.
    std::size_t take(std::span<TickRecord> into) noexcept;

    std::int64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

private:
    std::vector<TickRecord> slots_;
    std::size_t mask_;
    alignas(64) std::atomic<std::size_t> head_{0};  // next to write
    alignas(64) std::atomic<std::size_t> tail_{0};  // next to read
    std::atomic<std::int64_t> dropped_{0};
};

}  // namespace passung::loop
