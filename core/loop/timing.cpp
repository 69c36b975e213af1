#include "core/loop/timing.h"

#include <algorithm>
#include <cmath>

namespace passung::loop {

namespace {
constexpr double kFirstNanoseconds = 100.0;
}

void TimingHistogram::add(std::int64_t nanoseconds) noexcept {
    const double octave = std::log2(std::max(1.0, static_cast<double>(nanoseconds) / kFirstNanoseconds));
    const int bucket = std::clamp(static_cast<int>(octave * kPerOctave), 0, kOctaves * kPerOctave - 1);
    ++buckets_[static_cast<std::size_t>(bucket)];
    ++count_;
    max_ = std::max(max_, nanoseconds);
    sum_ += static_cast<double>(nanoseconds);
    sum_of_squares_ += static_cast<double>(nanoseconds) * static_cast<double>(nanoseconds);
}

double TimingHistogram::meanMicroseconds() const {
    return count_ > 0 ? sum_ / static_cast<double>(count_) * 1e-3 : 0.0;
}

double TimingHistogram::deviationMicroseconds() const {
    if (count_ < 2) return 0.0;
    const double n = static_cast<double>(count_);
    return std::sqrt(std::max(0.0, (sum_of_squares_ - sum_ * sum_ / n) / (n - 1.0))) * 1e-3;
}

double TimingHistogram::quantileMicroseconds(double q) const {
    const double wanted = q * static_cast<double>(count_);
    std::int64_t below = 0;
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
        below += buckets_[i];
        if (below > 0 && static_cast<double>(below) >= wanted) {
            const double edge = kFirstNanoseconds * std::exp2(static_cast<double>(i + 1) / kPerOctave) * 1e-3;
            return std::min(edge, maxMicroseconds());
        }
    }
    return 0.0;
}

std::vector<std::int64_t> TimingHistogram::octaves() const {
    std::vector<std::int64_t> sums(kOctaves, 0);
    for (std::size_t i = 0; i < buckets_.size(); ++i) sums[i / kPerOctave] += buckets_[i];
    return sums;
}

}  // namespace passung::loop
