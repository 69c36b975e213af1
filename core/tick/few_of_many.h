#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace passung::tick {

/// A value for each of many, of which few are other than T{}: those that were asked for to be written, the held ones.
/// What goes over all of them takes no longer than these few. Memory is sized once.
template <class T>
class FewOfMany {
public:
    explicit FewOfMany(std::size_t size = 0) { resize(size); }

    /// All are T{} then. Allocates.
    void resize(std::size_t size) {
        values_.assign(size, T{});
        is_held_.assign(size, 0);
        held_.assign(size, 0);
        count_ = 0;
    }
    std::size_t size() const noexcept { return values_.size(); }

    // rt-safe from here on.
    const T& operator[](std::size_t i) const noexcept { return values_[i]; }
    /// To write to: it is held from now on.
    T& operator[](std::size_t i) noexcept {
        if (is_held_[i] == 0) hold(i);
        return values_[i];
    }
    const T& back() const noexcept { return values_.back(); }
    T& back() noexcept { return (*this)[values_.size() - 1]; }

    /// Their places, ascending.
    std::span<const std::uint32_t> held() const noexcept { return {held_.data(), count_}; }
    /// All are T{}, and none is held.
    void clear() noexcept {
        for (const std::uint32_t i : held()) values_[i] = T{};
        letGo();
    }
    /// None is held; the values stay.
    void letGo() noexcept {
        for (const std::uint32_t i : held()) is_held_[i] = 0;
        count_ = 0;
    }

    auto begin() const noexcept { return values_.begin(); }
    auto end() const noexcept { return values_.end(); }

private:
    void hold(std::size_t i) noexcept {
        is_held_[i] = 1;
        std::size_t at = count_++;
        for (; at > 0 && held_[at - 1] > i; --at) held_[at] = held_[at - 1];
        held_[at] = static_cast<std::uint32_t>(i);
    }

    std::vector<T> values_;
    std::vector<std::uint32_t> held_;  // the first `count_`
    std::vector<std::uint8_t> is_held_;
    std::size_t count_ = 0;
};

}  // namespace passung::tick
