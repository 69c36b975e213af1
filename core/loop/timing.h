#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace passung::loop {

/// Distribution of tick durations in fixed memory: eight buckets per octave above 100 ns.
class TimingHistogram {
public:
    static constexpr int kOctaves = 24;
    static constexpr int kPerOctave = 8;

    /// rt-safe.
    void add(std::int64_t nanoseconds) noexcept;

    std::int64_t count() const { return count_; }
    double meanMicroseconds() const;
    double deviationMicroseconds() const;
    double maxMicroseconds() const { return static_cast<double>(max_) * 1e-3; }
    /// Upper edge of the bucket that holds the quantile `q` in [0, 1]: at most 9 % above the true value.
    double quantileMicroseconds(double q) const;
    /// Ticks per octave: entry i counts durations in [2^i, 2^(i+1)) × 0.1 µs, the first also everything below.
    std::vector<std::int64_t> octaves() const;

private:
    std::array<std::int64_t, std::size_t{kOctaves} * kPerOctave> buckets_{};
    std::int64_t count_ = 0, max_ = 0;
    double sum_ = 0.0, sum_of_squares_ = 0.0;  // [ns], [ns²]
};

}  // namespace passung::loop
