#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace passung::closed_form {

/// At most `most` items, in memory of its own. rt-safe.
template <class Item, std::size_t most>
class FixedList {
public:
    static constexpr std::size_t kMost = most;

    void add(const Item& item) noexcept {
        if (count_ < kMost)
            all_[count_++] = item;
        else
            full_ = true;
    }
    void clear() noexcept {
        count_ = 0;
        full_ = false;
    }
    /// One more was to be added than there is room for.
    bool full() const noexcept { return full_; }
    void setFull() noexcept { full_ = true; }
    std::span<const Item> all() const noexcept { return {all_.data(), count_}; }

private:
    std::array<Item, kMost> all_;  // the first `count_`
    std::size_t count_ = 0;
    bool full_ = false;
};

}  // namespace passung::closed_form
