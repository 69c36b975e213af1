#pragma once

#include <optional>
#include <string>

#include "analysis/power/power_file.h"
#include "analysis/stats/interval.h"

namespace passung::power {

/// What the virtual studies of a result come to. All intervals have a confidence of 95 %.
struct PowerSummary {
    std::size_t studies = 0;
    std::size_t untested = 0;     // too few participants had values; they count as not significant
    std::size_t significant = 0;  // p < alpha
    double power = 0.0;
    stats::Interval power_interval;  // Clopper-Pearson
    double difference = 0.0;         // mean over the tested studies
    stats::Interval difference_interval;
    double sd = 0.0;                 // of a participant's difference: root of the mean variance; NaN between groups
    std::optional<double> coverage;  // share of studies whose interval of the mean difference holds what was added;
                                     // only where the simulation itself is alike in all conditions
    // Of paired_t alone:
    double closed_form =
        0.0;  // power with normal differences of that mean and sd, of as many as were tested on average
    double size_for_80 = 0.0;  // tested participants for which that is 80 %
};
/// @pre there is a test in the result
PowerSummary summarise(const PowerResult& result);

/// For people: some lines, the last one ends with a line feed.
std::string summaryText(const PowerResult& result);

}  // namespace passung::power
