#pragma once

#include <cstdint>
#include <vector>

namespace passung::presenter {

/// The last seconds of a signal: the smallest and the largest value of every stretch of kStretch, so that a peak of one
/// tick is seen however coarse the picture is.
class Trace {
public:
    static constexpr double kSeconds = 10.0;
    static constexpr double kStretch = 0.02;  // [s]
    struct Span {
        float low = 0.0f, high = 0.0f;
    };

    /// A value at `time` [s], which does not fall; a time before the last one begins anew.
    void add(double time, double value);
    void clear();

    /// Oldest first; the last one ends now.
    std::vector<Span> spans() const;
    /// The largest magnitude of them.
    double peak() const;

private:
    static constexpr std::size_t kCount = static_cast<std::size_t>(kSeconds / kStretch);

    std::vector<Span> ring_ = std::vector<Span>(kCount);
    std::size_t used_ = 0;
    std::int64_t newest_ = -1;  // number of the stretch, from time 0
};

}  // namespace passung::presenter
