#include "analysis/power/drop_out.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "analysis/power/model_study.h"
#include "tests/analysis/power/small_plan.h"

namespace passung::power {
namespace {

std::map<std::string, std::vector<std::int64_t>> trialsOf(const exporter::StudyData& study) {
    std::map<std::string, std::vector<std::int64_t>> trials;
    for (const auto& attempt : study.attempts) trials[attempt.participant_id].push_back(attempt.trial_index);
    return trials;
}

TEST(DropOut, LetsTheShareLeaveAnywhereForGood) {
    // Truth: closed form: of 2000 persons 30 % within four standard errors, leaving before any of 13 trials alike (chi
    // squared of 12 degrees of freedom, 0.1 %); whoever leaves has the first of their trials, the others all.
    const exporter::StudyData before = *modelStudy(test::smallPlan(), 2000);
    exporter::StudyData after = before;
    dropOut(0.3, 1, after);
    const auto all = trialsOf(before), kept = trialsOf(after);
    std::vector<double> leave(13, 0.0);
    for (const auto& [code, trials] : all) {
        const auto found = kept.find(code);
        const std::size_t count = found == kept.end() ? 0 : found->second.size();
        for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(found->second[i], trials[i]) << code;
        if (count < trials.size()) leave[count] += 1.0;
    }
    double left = 0.0, chi = 0.0;
    for (const double count : leave) left += count;
    for (const double count : leave) chi += (count - left / 13.0) * (count - left / 13.0) / (left / 13.0);
    EXPECT_NEAR(left / 2000.0, 0.3, 4.0 * std::sqrt(0.3 * 0.7 / 2000.0));
    EXPECT_LT(chi, 32.9);
    std::size_t aborted = 0;
    for (const auto& session : after.sessions) aborted += session.end_state == "aborted" ? 1u : 0u;
    EXPECT_EQ(static_cast<double>(aborted), left);
    exporter::StudyData again = before, other = before, nobody = before;
    dropOut(0.3, 1, again);
    dropOut(0.3, 2, other);
    dropOut(0.0, 1, nobody);
    EXPECT_EQ(trialsOf(again), kept);
    EXPECT_NE(trialsOf(other), kept);
    EXPECT_EQ(trialsOf(nobody), all);
}

}  // namespace
}  // namespace passung::power
