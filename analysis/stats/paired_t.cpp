#include "analysis/stats/paired_t.h"

#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "core/base/assert.h"

namespace passung::stats {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kMostPairs = 1e6;

}  // namespace

PairedT pairedT(std::span<const double> differences) {
    PairedT test{differences.size(), kNone, kNone, kNone, kNone};
    if (differences.empty()) return test;
    const auto n = static_cast<double>(differences.size());
    double sum = 0.0;
    for (const double d : differences) sum += d;
    test.mean = sum / n;
    if (differences.size() < 2) return test;
    double squares = 0.0;
    for (const double d : differences) squares += (d - test.mean) * (d - test.mean);
    test.sd = std::sqrt(squares / (n - 1.0));
    if (!std::isfinite(test.sd)) return test;
    test.t = test.mean / (test.sd / std::sqrt(n));
    if (std::isinf(test.t)) test.p = 0.0;
    if (!std::isfinite(test.t)) return test;
    const boost::math::students_t student(n - 1.0);
    test.p = 2.0 * boost::math::cdf(boost::math::complement(student, std::abs(test.t)));
    return test;
}

Interval meanInterval(std::size_t n, double mean, double sd, double confidence) {
    PASSUNG_ASSERT(n >= 2 && confidence > 0.0 && confidence < 1.0);
    const auto pairs = static_cast<double>(n);
    const boost::math::students_t student(pairs - 1.0);
    const double t = boost::math::quantile(boost::math::complement(student, (1.0 - confidence) / 2.0));
    return {mean - t * sd / std::sqrt(pairs), mean + t * sd / std::sqrt(pairs)};
}

double pairedPower(double d, double n, double alpha) {
    PASSUNG_ASSERT(n > 1.0 && alpha > 0.0 && alpha < 1.0);
    const double critical = boost::math::quantile(boost::math::complement(boost::math::students_t(n - 1.0), alpha / 2));
    const boost::math::non_central_t shifted(n - 1.0, std::abs(d) * std::sqrt(n));
    return boost::math::cdf(boost::math::complement(shifted, critical)) + boost::math::cdf(shifted, -critical);
}

double pairedSize(double d, double power, double alpha) {
    PASSUNG_ASSERT(alpha < power && power < 1.0);
    double low = 2.0, high = 2.0;
    while (pairedPower(d, high, alpha) < power) {
        if (high > kMostPairs) return std::numeric_limits<double>::infinity();
        low = high;
        high *= 2.0;
    }
    for (int i = 0; i < 60 && high - low > 1e-9 * high; ++i) {
        const double middle = (low + high) / 2.0;
        (pairedPower(d, middle, alpha) < power ? low : high) = middle;
    }
    return high;
}

}  // namespace passung::stats
