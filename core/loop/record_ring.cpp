#include "core/loop/record_ring.h"

#include <algorithm>
#include <bit>

namespace passung::loop {

RecordRing::RecordRing(std::size_t capacity) : slots_(std::bit_ceil(capacity)), mask_(slots_.size() - 1) {}

bool RecordRing::tryPush(const TickRecord& record) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == slots_.size()) {
        dropped_.fetch_add(1, std::memory_order_relaxed);
        return false;
    }
    slots_[head & mask_] = record;
    head_.store(head + 1, std::memory_order_release);
    return true;
}

std::size_t RecordRing::take(std::span<TickRecord> into) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    const std::size_t count = std::min(into.size(), head_.load(std::memory_order_acquire) - tail);
    for (std::size_t i = 0; i < count; ++i) into[i] = slots_[(tail + i) & mask_];
    tail_.store(tail + count, std::memory_order_release);
    return count;
}

}  // namespace passung::loop
