#include "analysis/stats/proportion.h"

#include <boost/math/distributions/binomial.hpp>

#include "core/base/assert.h"

namespace passung::stats {

Interval clopperPearson(std::size_t successes, std::size_t trials, double confidence) {
    PASSUNG_ASSERT(trials > 0 && successes <= trials && confidence > 0.0 && confidence < 1.0);
    using Binomial = boost::math::binomial;
    const auto n = static_cast<double>(trials), k = static_cast<double>(successes);
    const double tail = (1.0 - confidence) / 2.0;
    return {Binomial::find_lower_bound_on_p(n, k, tail), Binomial::find_upper_bound_on_p(n, k, tail)};
}

}  // namespace passung::stats
