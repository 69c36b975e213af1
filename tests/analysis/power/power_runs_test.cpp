#include "analysis/power/power_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "analysis/power/model_study.h"
#include "analysis/power/power_summary.h"
#include "core/base/random.h"
#include "tests/analysis/power/small_plan.h"

namespace passung::power {
namespace {

PlantedEffect effectOf(const std::string& text, const plan::StudyPlan& plan) {
    const auto effect = readEffect(text, "", kModelMeasure, plan);
    if (!effect) throw std::runtime_error(toString(effect.errors().front()));
    return *effect;
}

PowerJob jobOf(const plan::StudyPlan& plan, const std::string& text, int repeats, const std::string& test) {
    PowerJob job = describeJob(plan, effectOf(text, plan), test);
    job.simulation = "model";
    job.participants = plan.participants;
    job.repeats = repeats;
    job.effect = text;
    return job;
}

PowerResult run(const plan::StudyPlan& plan, const std::string& text, int repeats, const Shard& shard = {},
                const std::string& test = "paired_t") {
    const PowerJob job = jobOf(plan, text, repeats, test);
    const auto result = runShard(job, shard, effectOf(text, plan), plan, modelStudy, {});
    if (!result) throw std::runtime_error(toString(result.errors().front()));
    return *result;
}

TEST(PowerRuns, ShardsRunWhatTheWholeRuns) {
    // Truth: invariant, byte for byte, whatever thread did what
    const plan::StudyPlan plan = test::smallPlan();
    const std::string whole = powerText(run(plan, "method:d=+0.3", 30));
    EXPECT_EQ(powerText(run(plan, "method:d=+0.3", 30)), whole);
    std::vector<PowerResult> shards;
    for (int i = 1; i <= 4; ++i) shards.push_back(run(plan, "method:d=+0.3", 30, {i, 4}));
    const auto merged = merge(shards, {"a", "b", "c", "d"});
    ASSERT_TRUE(merged);
    EXPECT_EQ(powerText(*merged), whole);
}

TEST(PowerRuns, EveryVirtualStudyHasASeedOfItsOwn) {
    // Truth: invariant
    std::set<std::uint64_t> seeds;
    for (std::int64_t i = 0; i < 1000; ++i) seeds.insert(runSeed(test::smallPlan(), i));
    EXPECT_EQ(seeds.size(), 1000u);
    const PowerResult result = run(test::smallPlan(), "method:d=+0", 20);
    std::set<double> means;
    for (const StudyTest& study : result.tests) means.insert(study.test.mean);
    EXPECT_EQ(means.size(), 20u);
}

TEST(PowerRuns, WithoutAnEffectOneStudyInTwentyIsSignificant) {
    // Truth: closed form: the level of significance. 2000 studies at 5 % have a standard deviation of 0.5 %.
    const PowerSummary summary = summarise(run(test::smallPlan(), "method:d=+0", 2000));
    EXPECT_NEAR(summary.power, 0.05, 0.01);
    EXPECT_EQ(summary.untested, 0u);
    EXPECT_NEAR(summary.difference, 0.0, summary.difference_interval.high - summary.difference_interval.low);
}

TEST(PowerRuns, EveryTestFindsOneFalsePositiveInTwenty) {
    // Truth: closed form: the level of significance. 4000 studies at 5 % have a standard deviation of 0.34 %, and seven
    // tests are asked. Rank tests of few people can only come close from
    // below: 24 people. Orders are drawn for each person: a balanced square takes learning out of the levels' means but
    // not out of the error that tests compare them with, and would make them conservative (mixed_anova: 3.5 %).
    plan::StudyPlan within = test::smallPlan(), between = test::smallPlan();
    between.factors[1].kind = plan::FactorKind::Between;
    within.participants = between.participants = 24;
    within.blocks[1].order = between.blocks[1].order = plan::BlockOrder::Random;
    struct Case {
        const plan::StudyPlan& plan;
        const char* effect;
        const char* test;
    };
    for (const Case& each : {Case{within, "method:d=+0", "wilcoxon"}, Case{within, "method:d=+0", "rm_anova"},
                             Case{within, "method:d=+0", "friedman"}, Case{between, "method:d=+0", "mixed_anova"},
                             Case{between, "size:1=+0", "mixed_anova"}, Case{between, "size:1=+0", "welch_t"},
                             Case{between, "size:1=+0", "mann_whitney"}}) {
        const PowerSummary summary = summarise(run(each.plan, each.effect, 4000, {}, each.test));
        std::printf("%s of %s: %.2f %%\n", each.test, each.effect, 100.0 * summary.power);
        EXPECT_NEAR(summary.power, 0.05, 0.01) << each.test;
        EXPECT_EQ(summary.untested, 0u) << each.test;
    }
}

TEST(PowerRuns, EveryTestFindsALargeEffect) {
    // Truth: invariant: of one standard deviation between persons or more, few of 200 studies of 24 people miss it.
    plan::StudyPlan plan = test::smallPlan();
    plan.factors[1].kind = plan::FactorKind::Between;
    plan.participants = 24;
    for (const char* test : {"paired_t", "wilcoxon", "rm_anova", "friedman", "mixed_anova"})
        EXPECT_GT(summarise(run(plan, "method:d=x2", 200, {}, test)).power, 0.95) << test;
    for (const char* test : {"welch_t", "mann_whitney", "mixed_anova"})
        EXPECT_GT(summarise(run(plan, "size:1=x2", 200, {}, test)).power, 0.95) << test;
}

TEST(PowerRuns, APlantedEffectIsRecovered) {
    // Truth: closed form: what was added, how often a 95 % interval holds it, and the power of the paired t test at the
    // found d. The interval of the mean over all studies is 4 standard errors wide; shares of 2000 have standard errors
    // of at most 0.5 % (coverage) and 1.1 % (power), of which 4 are allowed.
    for (const double added : {0.3, -0.5}) {
        const PowerSummary summary =
            summarise(run(test::smallPlan(), (added > 0 ? "method:d=+" : "method:d=") + std::to_string(added), 2000));
        EXPECT_NEAR(summary.difference, added, summary.difference_interval.high - summary.difference_interval.low);
        ASSERT_TRUE(summary.coverage);
        EXPECT_NEAR(*summary.coverage, 0.95, 0.02);
        EXPECT_NEAR(summary.power, summary.closed_form, 0.045);
        EXPECT_GT(summary.power, 0.3);
        EXPECT_LT(summary.power, 0.95);
    }
}

/// The small plan's study with normal measures: a person's difference of the levels d and a deviates by 0.8, as each
/// level's mean is one of four trials.
Result<exporter::StudyData> normalStudy(const plan::StudyPlan& plan, int participants) {
    auto study = modelStudy(plan, participants);
    Random random(plan.seed);
    for (auto& attempt : study->attempts) attempt.measures[kModelMeasure] = 0.8 * std::sqrt(2.0) * random.normal();
    return study;
}

TEST(PowerRuns, ASpreadBetweenPersonsCostsThePowerThatRSays) {
    // Truth: independent program (R 4.2.2): power.t.test(n = 12, delta = 0.5, sd = sqrt(0.8^2 + spread^2), type =
    // "paired", strict = TRUE). Within the 99 % interval of 4000 studies.
    const plan::StudyPlan plan = test::smallPlan();
    for (const auto& [spread, power] :
         {std::pair("0", 0.506031), std::pair("0.3", 0.456241), std::pair("0.6", 0.352824)}) {
        const PowerJob job = jobOf(plan, std::string("method:d=+0.5~") + spread, 4000, "paired_t");
        const auto result = runShard(job, {}, effectOf(job.effect, plan), plan, normalStudy, {});
        ASSERT_TRUE(result);
        EXPECT_NEAR(summarise(*result).power, power, 2.576 * std::sqrt(power * (1.0 - power) / 4000.0)) << spread;
    }
}

TEST(PowerRuns, SayWhomTheyTestedAndThatPersonsDiffer) {
    // Truth: invariant
    const auto said = [](const char* effect) { return summaryText(run(test::smallPlan(), effect, 2)); };
    EXPECT_NE(said("method:d=+0.3").find("the effect is the same for everybody"), std::string::npos);
    for (const char* effect : {"method:d=+0.3~0.1", "method:d=+0.3~0", "method:d=+0"})
        EXPECT_EQ(said(effect).find("the same for everybody"), std::string::npos) << effect;
    EXPECT_NE(said("method:d=+0").find("tested: 12 persons in each study\n"), std::string::npos);
}

TEST(PowerRuns, TheFirstErrorEndsIt) {
    // Truth: invariant
    const plan::StudyPlan plan = test::smallPlan();
    const auto effect = readEffect("method:d=+0", "", kModelMeasure, plan);
    PowerJob job = describeJob(plan, *effect, "paired_t");
    job.repeats = 50;
    const auto result = runShard(
        job, {}, *effect, plan,
        [](const plan::StudyPlan&, int) -> Result<exporter::StudyData> { return Error{.message = "no device"}; }, {});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.errors().front().message, "no device");
}

}  // namespace
}  // namespace passung::power
