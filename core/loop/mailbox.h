#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace passung::loop {

/// The newest value from one thread to one other. Lock-free: neither side ever waits; what was not taken in time is
/// replaced. Three slots: the writer's, the reader's, and between them the newest that was put.
template <class T>
class Mailbox {
public:
    explicit Mailbox(const T& first) { slots_.fill(first); }

    /// Writer only; rt-safe if copying T is.
    void put(const T& value) {
        slots_[writing_] = value;
        writing_ = between_.exchange(writing_ | kFresh, std::memory_order_acq_rel) & kSlot;
    }

    /// Reader only: the newest value; valid until the next call. rt-safe.
    const T& latest() noexcept {
        if ((between_.load(std::memory_order_relaxed) & kFresh) != 0)
            reading_ = between_.exchange(reading_, std::memory_order_acq_rel) & kSlot;
        return slots_[reading_];
    }

private:
    static constexpr std::uint32_t kSlot = 3, kFresh = 4;

    std::array<T, 3> slots_;
    std::uint32_t writing_ = 0;
    std::uint32_t reading_ = 1;
    alignas(64) std::atomic<std::uint32_t> between_{2};
};

}  // namespace passung::loop
