#pragma once

namespace passung::stats {

/// Of confidence; both ends included.
struct Interval {
    double low = 0.0;
    double high = 0.0;
    bool holds(double value) const { return low <= value && value <= high; }
};

}  // namespace passung::stats
