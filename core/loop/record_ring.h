#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/tick_record.h"
#include "core/scene/scene_spec.h"
#include "core/tick/scene_sequence.h"

namespace passung::loop {

/// Lock-free ring from one producer (the loop) to one consumer. A full ring drops the new value and counts it: the
/// producer never waits.
template <class T>
class Ring {
public:
    /// Room for `capacity` values, rounded up to a power of two.
    explicit Ring(std::size_t capacity) : slots_(std::bit_ceil(capacity)), mask_(slots_.size() - 1) {}

    /// Producer only; rt-safe. False (and one more drop) if full.
    bool tryPush(const T& value) noexcept {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        if (head - tail_.load(std::memory_order_acquire) == slots_.size()) {
            dropped_.fetch_add(1, std::memory_order_relaxed);
            return false;
        }
        slots_[head & mask_] = value;
        head_.store(head + 1, std::memory_order_release);
        return true;
    }

    /// Consumer only: the oldest values, as many as there are and fit; returns how many.
    std::size_t take(std::span<T> into) noexcept {
        const std::size_t tail = tail_.load(std::memory_order_relaxed);
        const std::size_t count = std::min(into.size(), head_.load(std::memory_order_acquire) - tail);
        for (std::size_t i = 0; i < count; ++i) into[i] = slots_[(tail + i) & mask_];
        tail_.store(tail + count, std::memory_order_release);
        return count;
    }

    std::int64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

private:
    std::vector<T> slots_;
    std::size_t mask_;
    alignas(64) std::atomic<std::size_t> head_{0};  // next to write
    alignas(64) std::atomic<std::size_t> tail_{0};  // next to read
    std::atomic<std::int64_t> dropped_{0};
};

using RecordRing = Ring<TickRecord>;

using tick::PartAtRest;

/// Where a hand's part is in a tick.
struct HeldPart {
    Pose X_WH, X_WG;              // where the device asks it to be, and its proxy
    std::int32_t part = kNoPart;  // which one, in the order of the scene
};

/// What a screen learns of a tick.
struct ScreenTick {
    TickRecord record;                                        // of the first hand
    std::int64_t began_ns = 0;                                // when the devices had been read, on the steady clock
    std::array<HeldPart, scene::kMostHands - 1> others = {};  // the other hands' parts, in the order of the scene
    bool engaged = false;                                     // all hands are
    PartAtRest at_rest = {};  // of the parts that can be picked up one in turn, tick by tick: so a screen that misses
                              // ticks finds them all
};
using ScreenRing = Ring<ScreenTick>;

}  // namespace passung::loop
