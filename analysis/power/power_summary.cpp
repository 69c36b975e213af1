#include "analysis/power/power_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/power/planted_effect.h"
#include "analysis/stats/paired_t.h"
#include "analysis/stats/proportion.h"
#include "core/base/assert.h"

namespace passung::power {
namespace {

constexpr double kConfidence = 0.95;
constexpr double kAskedPower = 0.8;

}  // namespace

PowerSummary summarise(const PowerResult& result) {
    PASSUNG_ASSERT(!result.tests.empty());
    PowerSummary summary;
    summary.studies = result.tests.size();
    const auto added = result.job.simulation == "model" ? addedBy(result.job.effect) : std::nullopt;
    const bool paired_t = result.job.test == "paired_t";
    std::vector<double> means;
    double variances = 0.0, people = 0.0;
    std::size_t held = 0;
    for (const StudyTest& study : result.tests) {
        if (study.test.p < result.job.alpha) ++summary.significant;
        if (std::isnan(study.test.p) && !(study.test.sd == 0.0)) {
            ++summary.untested;
            continue;
        }
        means.push_back(study.test.mean);
        people += static_cast<double>(study.test.n);
        variances += study.test.sd * study.test.sd;
        if (!paired_t) continue;
        const auto interval = stats::meanInterval(study.test.n, study.test.mean, study.test.sd, kConfidence);
        if (added && interval.holds(*added)) ++held;
    }
    const auto tested = static_cast<double>(means.size());
    const stats::PairedT over_studies = stats::pairedT(means);
    summary.power = static_cast<double>(summary.significant) / static_cast<double>(summary.studies);
    summary.power_interval = stats::clopperPearson(summary.significant, summary.studies, kConfidence);
    summary.difference = over_studies.mean;
    summary.difference_interval = {over_studies.mean, over_studies.mean};
    if (means.size() >= 2)
        summary.difference_interval =
            stats::meanInterval(over_studies.n, over_studies.mean, over_studies.sd, kConfidence);
    summary.sd = std::sqrt(variances / tested);
    if (added && paired_t) summary.coverage = static_cast<double>(held) / tested;
    const double d = summary.difference / summary.sd;
    const double n = std::round(people / tested);
    if (paired_t && std::isfinite(d) && n >= 2.0) {
        summary.closed_form = stats::pairedPower(d, n, result.job.alpha);
        summary.size_for_80 = stats::pairedSize(d, kAskedPower, result.job.alpha);
    }
    return summary;
}

namespace {

/// How many persons the tests had; less than planned where values are missing.
std::string testedText(const PowerResult& result) {
    const auto [least, most] =
        std::minmax_element(result.tests.begin(), result.tests.end(),
                            [](const StudyTest& a, const StudyTest& b) { return a.test.n < b.test.n; });
    if (least->test.n == most->test.n) return fmt::format("tested: {} persons in each study\n", most->test.n);
    return fmt::format("tested: {} to {} persons\n", least->test.n, most->test.n);
}

}  // namespace

std::string summaryText(const PowerResult& result) {
    const PowerJob& job = result.job;
    const PowerSummary s = summarise(result);
    std::string text = fmt::format(
        "{}: {} virtual studies of {} simulated participants, {}\n", job.study, s.studies, job.participants,
        job.simulation == "model" ? "times drawn from a model, no haptic simulation" : "every trial simulated");
    if (result.shard.of > 1)
        text += fmt::format("shard {} of {} alone, of {} studies in all\n", result.shard.index, result.shard.of,
                            job.repeats);
    const bool survival = job.test == "survival";
    text += fmt::format("planted in {}: {}, compared with {} by {} on {}\n", job.measure, job.effect, job.against,
                        job.test, survival ? "trials" : "means of cells");
    if (job.drop_out > 0.0)
        text += fmt::format("of the participants {:.4g} % leave before the end\n", 100.0 * job.drop_out);
    text += testedText(result);
    if (addedBy(job.effect) != 0.0 && !saysSpread(job.effect))
        text +=
            "the effect is the same for everybody: where persons differ in it the power is lower; say DELTA~SPREAD\n";
    text += fmt::format("{} at {}: {} of {}: power {:.4f}, 95 % interval {:.4f} to {:.4f}\n",
                        job.test == "equivalence" ? "shown to lie within the bounds" : "significant", job.alpha,
                        s.significant, s.studies, s.power, s.power_interval.low, s.power_interval.high);
    if (s.untested > 0) text += fmt::format("{} studies had too few values for a test\n", s.untested);
    if (s.untested == s.studies) return text;
    text += fmt::format(
        "{} found: mean {:.4g}, 95 % interval {:.4g} to {:.4g}{}\n",
        survival ? "logarithm of the ratio of hazards" : "difference", s.difference, s.difference_interval.low,
        s.difference_interval.high,
        std::isnan(s.sd) ? ""
                         : fmt::format("; a participant's deviates by {:.4g} (d = {:.3f})", s.sd, s.difference / s.sd));
    if (s.coverage)
        text += fmt::format("of the studies' 95 % intervals {:.1f} % hold what was added\n", 100.0 * *s.coverage);
    if (job.test == "paired_t") {
        text += fmt::format("closed form for normal differences of that d: power {:.4f}", s.closed_form);
        const bool found = !s.difference_interval.holds(0.0);
        if (found && std::isfinite(s.size_for_80))
            text += fmt::format("; 80 % with {:.1f} tested persons", s.size_for_80);
        text += '\n';
    }
    return text + "Simulated participants show what design and analysis can find, never how people behave.\n";
}

}  // namespace passung::power
