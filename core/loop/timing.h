#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace passung::loop {

/// Distribution of durations in fixed memory: eight buckets per octave from 100 ns to 1.7 s.
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
    /// Upper edge of the bucket that holds the quantile `q` in [0, 1], never above the largest duration: at most 9 %
    /// above the true value if that is from 100 ns to 1.6 s. What is shorter shares one bucket and counts as up to
    /// 109 ns; what is longer counts as 1.7 s at least.
    double quantileMicroseconds(double q) const;
    /// Ticks per octave: entry i counts durations in [2^i, 2^(i+1)) × 0.1 µs, the first also everything below.
    std::vector<std::int64_t> octaves() const;

private:
    std::array<std::int64_t, std::size_t{kOctaves} * kPerOctave> buckets_{};
    std::int64_t count_ = 0, max_ = 0;
    double sum_ = 0.0, sum_of_squares_ = 0.0;  // [ns], [ns²]
};

}  // namespace passung::loop
