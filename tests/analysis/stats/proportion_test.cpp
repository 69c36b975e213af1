#include "analysis/stats/proportion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace passung::stats {
namespace {

double binomial(int n, int k, double p) {
    return std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) + k * std::log(p) +
                    (n - k) * std::log1p(-p));
}

TEST(ClopperPearson, CutsTheTailsOfTheBinomialItself) {
    // Truth: closed form, the definition: as many successes or more have a probability of 2.5 % at the lower end, as
    // many or fewer at the upper end.
    for (const auto& [k, n] : {std::pair{7, 20}, std::pair{1, 8}, std::pair{90, 100}}) {
        const Interval interval = clopperPearson(static_cast<std::size_t>(k), static_cast<std::size_t>(n), 0.95);
        double at_least = 0.0, at_most = 0.0;
        for (int i = k; i <= n; ++i) at_least += binomial(n, i, interval.low);
        for (int i = 0; i <= k; ++i) at_most += binomial(n, i, interval.high);
        EXPECT_NEAR(at_least, 0.025, 1e-9) << k << " of " << n;
        EXPECT_NEAR(at_most, 0.025, 1e-9) << k << " of " << n;
    }
}

TEST(ClopperPearson, EndsAtNoneAndAllInTheirClosedForm) {
    // Truth: closed form, (1 - 0.95) / 2 to the power 1 / n
    const double end = std::pow(0.025, 0.1);
    EXPECT_EQ(clopperPearson(0, 10, 0.95).low, 0.0);
    EXPECT_NEAR(clopperPearson(0, 10, 0.95).high, 1.0 - end, 1e-12);
    EXPECT_NEAR(clopperPearson(10, 10, 0.95).low, end, 1e-12);
    EXPECT_EQ(clopperPearson(10, 10, 0.95).high, 1.0);
}

}  // namespace
}  // namespace passung::stats
