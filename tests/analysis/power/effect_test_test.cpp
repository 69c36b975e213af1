#include "analysis/power/effect_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "analysis/export/cells.h"
#include "analysis/power/model_study.h"
#include "analysis/stats/anova.h"
#include "analysis/stats/rank_tests.h"
#include "tests/analysis/power/small_plan.h"

namespace passung::power {
namespace {

using plan::FactorKind;
using test::smallPlan;

constexpr const char* kTime = "completion_time_s";

PlantedEffect effectOf(const std::string& text, const std::string& against = "",
                       const plan::StudyPlan& plan = smallPlan()) {
    const auto effect = readEffect(text, against, kTime, plan);
    if (!effect) throw std::runtime_error(toString(effect.errors().front()));
    return *effect;
}

EffectTest testOf(const PlantedEffect& effect, const std::string& test, const plan::StudyPlan& plan,
                  const exporter::StudyData& study) {
    const auto tests = testEffect(effect, test, plan, {&study, 1});
    if (!tests) throw std::runtime_error(toString(tests.errors().front()));
    return tests->front();
}

/// The small plan with its second factor between participants.
plan::StudyPlan groupedPlan() {
    plan::StudyPlan plan = smallPlan();
    plan.factors[1].kind = FactorKind::Between;
    return plan;
}

/// One participant's values in the conditions of the small plan, twice each.
void append(exporter::StudyData& study, const std::string& code, const std::vector<double>& values) {
    for (std::size_t c = 0; c < values.size(); ++c) {
        for (const double deviation : {-0.5, 0.5}) {
            store::AttemptRow row;
            row.participant_id = row.session_id = code;
            row.phase = "main";
            row.valid = true;
            row.outcome = "success";
            row.condition = study.conditions[c].condition;
            row.levels = study.conditions[c].levels;
            if (std::isfinite(values[c])) row.measures[kTime] = values[c] + deviation;
            study.attempts.push_back(row);
        }
    }
    store::SessionRow session;
    session.participant_id = session.session_id = code;
    session.counted = true;
    study.sessions.push_back(session);
}

TEST(TestEffect, ComparesMeansOfCellMeans) {
    // Truth: closed form. Levels a and d of three people: means over the sizes 1 and 2; the fourth lacks a cell.
    exporter::StudyData study = *modelStudy(smallPlan(), 0);
    append(study, "S001", {1, 3, 9, 9, 4, 4});  // a 2, d 4
    append(study, "S002", {1, 1, 9, 9, 1, 5});  // a 1, d 3
    append(study, "S003", {2, 4, 9, 9, 6, 8});  // a 3, d 7
    append(study, "S004", {2, 4, 9, 9, std::nan(""), 8});
    const EffectTest test = testOf(effectOf("method:d=+0"), "paired_t", smallPlan(), study);
    EXPECT_EQ(test.n, 3u);
    EXPECT_NEAR(test.mean, 8.0 / 3.0, 1e-12);
    EXPECT_NEAR(test.sd, std::sqrt(4.0 / 3.0), 1e-12);
    EXPECT_NEAR(test.statistic, 4.0, 1e-12);
    EXPECT_NEAR(testOf(effectOf("method:a=+0", "d"), "paired_t", smallPlan(), study).mean, -8.0 / 3.0, 1e-12);
}

TEST(TestEffect, TakesEverybodyWhereNobodyMeetsEveryCondition) {
    // Truth: invariant; the sizes are assigned to the methods, a participant meets three of the six conditions.
    plan::StudyPlan plan = smallPlan();
    plan.factors[1].kind = plan::FactorKind::Nuisance;
    const exporter::StudyData study = *modelStudy(plan, 6);
    EXPECT_EQ(study.attempts.size(), 6u * 7u);
    EXPECT_EQ(testOf(effectOf("method:d=+0"), "paired_t", plan, study).n, 6u);
}

/// Every participant's mean over the attempts that count, by method and by size.
using Means = std::map<std::string, std::map<std::string, double>>;
Means meansOf(const exporter::StudyData& study, const std::string& factor) {
    std::map<std::string, std::map<std::string, std::vector<double>>> values;
    for (const auto& attempt : study.attempts)
        if (attempt.phase == "main")
            values[attempt.participant_id][exporter::levelOf(attempt.levels, factor)].push_back(
                attempt.measures.at(kTime));
    Means means;
    for (const auto& [code, levels] : values)
        for (const auto& [level, all] : levels) means[code][level] = exporter::meanOf(all);
    return means;
}

TEST(TestEffect, GroupsAreComparedByTheirPeoplesMeans) {
    // Truth: independent path: means taken straight from the attempts, which are equally many in each cell.
    const plan::StudyPlan plan = groupedPlan();
    const exporter::StudyData study = *modelStudy(plan, 12);
    std::map<std::string, std::vector<double>> groups;
    std::map<std::string, std::vector<std::vector<double>>> rows;
    const Means by_size = meansOf(study, "size"), by_method = meansOf(study, "method");
    for (const auto& [code, sizes] : by_size) {
        ASSERT_EQ(sizes.size(), 1u) << "a between factor has one level a person";
        const auto& [size, mean] = *sizes.begin();
        groups[size].push_back(mean);
        rows[size].push_back({by_method.at(code).at("a"), by_method.at(code).at("b=c"), by_method.at(code).at("d")});
    }
    ASSERT_EQ(groups.size(), 2u);
    const auto& one = groups.at("1");
    const auto& two = groups.at("2");
    const auto expect = [&](const PlantedEffect& effect, const char* test, const stats::TestResult& expected) {
        const EffectTest found = testOf(effect, test, plan, study);
        EXPECT_EQ(found.n, 12u) << test;
        EXPECT_NEAR(found.p, expected.p, 1e-9) << test;
        EXPECT_NEAR(found.statistic, expected.statistic, 1e-9 * std::abs(expected.statistic)) << test;
    };
    const PlantedEffect size = effectOf("size:1=+0", "", plan), method = effectOf("method:d=+0", "", plan);
    expect(size, "welch_t", stats::welchT(one, two));
    expect(size, "mann_whitney", stats::mannWhitney(one, two));
    expect(size, "mixed_anova", stats::oneWayAnova({one, two}));
    expect(method, "mixed_anova", stats::withinAnova({rows.at("1"), rows.at("2")}));
    std::vector<std::vector<double>> all = rows.at("1");
    all.insert(all.end(), rows.at("2").begin(), rows.at("2").end());
    expect(method, "rm_anova", stats::withinAnova({all}));
    expect(method, "friedman", stats::friedman(all));
    std::vector<double> differences;
    for (const auto& row : all) differences.push_back(row[2] - row[0]);
    expect(method, "wilcoxon", stats::wilcoxonSignedRank(differences));
    EXPECT_TRUE(std::isnan(testOf(size, "welch_t", plan, study).sd));
    EXPECT_NEAR(testOf(size, "welch_t", plan, study).mean, exporter::meanOf(one) - exporter::meanOf(two), 1e-9);
}

TEST(ChooseTest, IsThePlannedOneOrWhatSuitsTheFactor) {
    // Truth: closed form
    plan::StudyPlan plan = groupedPlan();
    const PlantedEffect size = effectOf("size:1=+0", "", plan), method = effectOf("method:d=+0", "", plan);
    EXPECT_EQ(*chooseTest("", method, plan), "paired_t");
    EXPECT_EQ(*chooseTest("", size, plan), "welch_t");
    plan.analyses = {{"peak_force_N", {"method"}, "wilcoxon"},
                     {kTime, {"size"}, "mann_whitney"},
                     {kTime, {"size", "method"}, "mixed_anova"}};
    EXPECT_EQ(*chooseTest("", method, plan), "mixed_anova");
    EXPECT_EQ(*chooseTest("", size, plan), "mann_whitney");
    EXPECT_EQ(*chooseTest("friedman", method, plan), "friedman");
    const auto message = [&](const std::string& test, const PlantedEffect& effect) {
        const auto chosen = chooseTest(test, effect, plan);
        return chosen ? *chosen : toString(chosen.errors().front());
    };
    EXPECT_EQ(message("welch_t", method),
              "error: --test: welch_t: is for a between factor, and method is a within one");
    EXPECT_EQ(message("rm_anova", size), "error: --test: rm_anova: is for a within factor, and size is a between one");
    plan.analyses = {{kTime, {"method"}, "ordinal"}};
    EXPECT_EQ(message("", method),
              "error: --test: ordinal: is not computed here; the protocol plans it: name another with --test");
    EXPECT_EQ(message("survival", method), "error: --test: survival: is of time_s");
    EXPECT_NE(message("equivalence", method).find("takes its bounds from the protocol"), std::string::npos);
    const PlantedEffect both = effectOf("method:d*size:1=+0", "", plan);
    EXPECT_EQ(message("paired_t", both), "error: --test: paired_t: does not test an interaction");
    EXPECT_EQ(message("rm_anova", both), "error: --test: rm_anova: is for two within factors");
    EXPECT_EQ(message("mixed_anova", effectOf("method:d*size:1=+0")), "mixed_anova");
}

}  // namespace
}  // namespace passung::power
