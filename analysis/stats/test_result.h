#pragma once

#include <limits>

namespace passung::stats {

/// Of a test of no difference. NaN where it is not defined.
struct TestResult {
    double statistic = std::numeric_limits<double>::quiet_NaN();
    double p = std::numeric_limits<double>::quiet_NaN();  // two-sided where there are two sides
};

}  // namespace passung::stats
