#include "analysis/power/r_tests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

#include "analysis/power/model_study.h"
#include "analysis/power/planted_effect.h"
#include "analysis/power/power_runs.h"
#include "analysis/power/power_summary.h"
#include "analysis/report/r_program.h"
#include "analysis/stats/anova.h"
#include "analysis/stats/paired_t.h"
#include "core/base/random.h"
#include "tests/analysis/power/small_plan.h"
#include "tests/support/length.h"

namespace passung::power {
namespace {

constexpr const char* kTime = "time_s";

/// Two factors of two levels, one trial of each combination.
plan::StudyPlan squarePlan(plan::FactorKind second) {
    plan::StudyPlan plan = test::smallPlan();
    plan.factors[0].levels = {{"a"}, {"d"}};
    plan.factors[1].kind = second;
    plan.measures = {kTime};
    test::crossLevels(plan);
    plan.blocks[1].repetitions = 1;
    return plan;
}

PlantedEffect effectOf(const std::string& text, const plan::StudyPlan& plan) {
    const auto effect = readEffect(text, "", kTime, plan);
    if (!effect) throw std::runtime_error(toString(effect.errors().front()));
    return *effect;
}

/// Normal times with a spread between persons that no test takes for nothing.
exporter::StudyData normalStudy(const plan::StudyPlan& plan, int participants, std::uint64_t seed) {
    exporter::StudyData study = *modelStudy(plan, participants);
    Random random(seed);
    std::map<std::string, double> person;
    for (auto& attempt : study.attempts) {
        const auto [own, is_new] = person.try_emplace(attempt.participant_id, 0.0);
        if (is_new) own->second = 10.0 + 2.0 * random.normal();
        attempt.measures[kTime] = own->second + random.normal() + (attempt.condition.starts_with("d/2") ? 0.6 : 0.0);
    }
    return study;
}

/// Times by person and condition.
using Times = std::map<std::string, std::map<std::string, double>>;
Times timesOf(const exporter::StudyData& study) {
    Times times;
    for (const auto& attempt : study.attempts)
        if (attempt.phase == "main") times[attempt.participant_id][attempt.condition] = attempt.measures.at(kTime);
    return times;
}

class RTests : public testing::Test {
protected:
    void SetUp() override {
        if (!report::missingPrograms({"afex", "lmerTest", "survival"}).empty())
            GTEST_SKIP() << "R (r-base-core) or a package of it is not installed";
    }

    static std::vector<EffectTest> tested(const PlantedEffect& effect, const char* test, const plan::StudyPlan& plan,
                                          const std::vector<exporter::StudyData>& studies) {
        const auto tests = testInR(effect, test, plan, studies);
        if (!tests) throw std::runtime_error(toString(tests.errors().front()));
        return *tests;
    }
};

TEST_F(RTests, OfAnInteractionAreThoseOfDifferencesOfDifferences) {
    // Truth: closed form: of two by two levels within persons F is the square of the paired t of the difference of two
    // differences; of a within by a between factor that of the two groups' differences. Some persons lack a cell.
    const plan::StudyPlan within = squarePlan(plan::FactorKind::Within), mixed = squarePlan(plan::FactorKind::Between);
    std::vector<exporter::StudyData> studies;
    for (const std::uint64_t seed : {1, 2, 3}) studies.push_back(normalStudy(within, 10, seed));
    studies[1].attempts.pop_back();  // a person's last trial
    for (const char* test : {"rm_anova", "lmm"}) {
        const auto tests = tested(effectOf("method:d*size:2=+0", within), test, within, studies);
        for (std::size_t i = 0; i < studies.size(); ++i) {
            std::vector<double> twice;
            for (const auto& [code, at] : timesOf(studies[i]))
                if (at.size() == 4) twice.push_back(at.at("d/2") - at.at("a/2") - at.at("d/1") + at.at("a/1"));
            const stats::PairedT truth = stats::pairedT(twice);
            EXPECT_EQ(tests[i].n, i == 1 ? 9u : 10u) << test;
            EXPECT_NEAR(tests[i].mean, truth.mean, 1e-9) << test;
            EXPECT_NEAR(tests[i].sd, truth.sd, 1e-9) << test;
            if (std::string(test) == "lmm") continue;  // three terms of error in one
            EXPECT_NEAR(tests[i].statistic, truth.t * truth.t, 1e-8 * truth.t * truth.t);
            EXPECT_NEAR(tests[i].p, truth.p, 1e-9);
        }
    }
    const exporter::StudyData study = normalStudy(mixed, 12, 4);
    const auto tests = tested(effectOf("method:d*size:2=+0", mixed), "mixed_anova", mixed, {study});
    std::map<bool, std::vector<double>> groups;
    for (const auto& [code, at] : timesOf(study)) {
        const bool second = at.count("d/2") > 0;
        groups[second].push_back(second ? at.at("d/2") - at.at("a/2") : at.at("d/1") - at.at("a/1"));
    }
    const stats::TestResult truth = stats::oneWayAnova({groups[false], groups[true]});
    EXPECT_NEAR(tests[0].statistic, truth.statistic, 1e-8 * truth.statistic);
    EXPECT_NEAR(tests[0].p, truth.p, 1e-9);
    EXPECT_TRUE(std::isnan(tests[0].sd));
}

TEST_F(RTests, OfAMixedModelOfTwoLevelsIsThePairedT) {
    // Truth: closed form: two values a person, an intercept for each: F = t^2 with as many degrees of freedom.
    const plan::StudyPlan plan = squarePlan(plan::FactorKind::Within);
    const exporter::StudyData study = normalStudy(plan, 10, 5);
    std::vector<double> differences;
    for (const auto& [code, at] : timesOf(study))
        differences.push_back((at.at("d/1") + at.at("d/2") - at.at("a/1") - at.at("a/2")) / 2.0);
    const stats::PairedT truth = stats::pairedT(differences);
    const auto tests = tested(effectOf("method:d=+0", plan), "lmm", plan, {study});
    EXPECT_EQ(tests[0].n, 10u);
    EXPECT_NEAR(tests[0].mean, truth.mean, 1e-9);
    EXPECT_NEAR(tests[0].statistic, truth.t * truth.t, 1e-4 * truth.t * truth.t);
    EXPECT_NEAR(tests[0].p, truth.p, 1e-4 * truth.p);
}

TEST_F(RTests, OfEquivalenceAreTwoOneSidedTests) {
    // Truth: closed form: half of the two-sided p of the differences less each bound; the larger one counts. The bounds
    // are of the first level less the second (protocols/KEYS.md), wherever an effect is planted.
    plan::StudyPlan plan = squarePlan(plan::FactorKind::Within);
    plan::Analysis planned{kTime, {"method"}, "equivalence"};
    planned.equivalence_bounds = {-1.0, 1.5};
    plan.analyses = {planned};
    const exporter::StudyData study = normalStudy(plan, 20, 6);
    std::vector<double> above, below;
    for (const auto& [code, at] : timesOf(study)) {
        const double d = (at.at("a/1") + at.at("a/2") - at.at("d/1") - at.at("d/2")) / 2.0;
        above.push_back(d + 1.0);
        below.push_back(1.5 - d);
    }
    ASSERT_GT(stats::pairedT(above).t, 0.0);
    ASSERT_GT(stats::pairedT(below).t, 0.0);
    const double truth = std::max(stats::pairedT(above).p, stats::pairedT(below).p) / 2.0;
    const double difference = stats::pairedT(above).mean - 1.0;
    for (const auto& [effect, sign] : {std::pair("method:a=+0", 1.0), std::pair("method:d=+0", -1.0)}) {
        const auto tests = tested(effectOf(effect, plan), "equivalence", plan, {study});
        EXPECT_NEAR(tests[0].p, truth, 1e-9) << effect;
        EXPECT_NEAR(tests[0].mean, sign * difference, 1e-9) << effect;
    }
}

TEST_F(RTests, OfSurvivalCountWhoIsFaster) {
    // Truth: closed form: with one trial a level and none cut off, a person says which came first: of n persons k are
    // faster at d, the logarithm of the ratio of hazards is ln k / (n - k), and 2 (k ln k / n + (n - k) ln (n - k) / n
    // + n ln 2) is the ratio of likelihoods. With both cut off a person says nothing.
    plan::StudyPlan plan = squarePlan(plan::FactorKind::Within);
    plan.factors[1].levels.resize(1);
    test::crossLevels(plan);
    exporter::StudyData study = normalStudy(plan, 16, 7);
    const Times times = timesOf(study);
    double faster = 0.0, n = 0.0;
    for (auto& attempt : study.attempts) {
        if (attempt.participant_id != "S016") continue;
        attempt.outcome = "timeout";
        attempt.measures[kTime] = 30.0;
    }
    for (const auto& [code, at] : times) {
        if (code == "S016") continue;
        n += 1.0;
        faster += at.at("d/1") < at.at("a/1") ? 1.0 : 0.0;
    }
    const double slower = n - faster;
    const double chisq = 2.0 * (faster * std::log(faster / n) + slower * std::log(slower / n) + n * std::log(2.0));
    const auto tests = tested(effectOf("method:d=+0", plan), "survival", plan, {study});
    EXPECT_EQ(tests[0].n, 16u);
    EXPECT_NEAR(tests[0].mean, std::log(faster / slower), 1e-6);
    EXPECT_NEAR(tests[0].statistic, chisq, 1e-6);
    EXPECT_NEAR(tests[0].p, std::erfc(std::sqrt(chisq / 2.0)), 1e-6);
}

/// Times of 24 persons at three levels, four trials each: persons deviate by 0.6, trials by 0.8.
Result<exporter::StudyData> timesOfPersons(const plan::StudyPlan& plan, int participants) {
    auto study = modelStudy(plan, participants);
    Random random(plan.seed);
    std::map<std::string, double> person;
    for (auto& attempt : study->attempts) {
        const auto [own, is_new] = person.try_emplace(attempt.participant_id, 0.0);
        if (is_new) own->second = 6.0 + 0.6 * random.normal();
        attempt.measures[kTime] = own->second + 0.8 * random.normal();
    }
    return study;
}

/// The power that packages alone find, by test.
std::map<std::string, double> powerByPackages(int studies, double effect, double spread) {
    const std::string command = "LC_ALL=C.UTF-8 Rscript --vanilla '" PASSUNG_SOURCE_DIR
                                "/tests/analysis/power/power_by_lme4.R' " +
                                std::to_string(studies) + ' ' + std::to_string(effect) + ' ' + std::to_string(spread);
    std::string said;
    FILE* pipe = popen(command.c_str(), "r");
    for (char buffer[256]; fgets(buffer, sizeof buffer, pipe) != nullptr;) said += buffer;
    EXPECT_EQ(pclose(pipe), 0) << said;
    std::map<std::string, double> power;
    std::istringstream lines(said);
    double share = 0.0;
    for (std::string test; lines >> test >> share;) power[test] = share;
    return power;
}

struct Planted {
    const char* name;
    double effect, spread;  // [s]
};

class PowerOfRTests : public RTests, public testing::WithParamInterface<Planted> {};

TEST_P(PowerOfRTests, IsWhatPackagesFindInStudiesOfTheirOwn) {
    // Truth: independent program (R 4.2.2; studies simulated by lme4, tests of stats, lmerTest and survival): the power
    // of 2000 studies, with the 99 % interval of the difference of two such shares; without an effect 5 +- 1 %.
    if (!passung::test::atFullLength()) GTEST_SKIP() << "but for PASSUNG_LONG=1";
    constexpr int kStudies = 2000;
    const auto truth = powerByPackages(kStudies, GetParam().effect, GetParam().spread);
    ASSERT_EQ(truth.size(), 4u);
    plan::StudyPlan plan = test::smallPlan();
    plan.participants = 24;
    plan.measures = {kTime};
    plan.factors[1].levels.resize(1);
    test::crossLevels(plan);
    plan.blocks[1].repetitions = 4;
    plan.blocks[1].order = plan::BlockOrder::Random;
    for (const auto& [test, power] : truth) {
        // Means of times that were cut off are others: the model of hazards alone has a time-out.
        for (plan::Condition& condition : plan.conditions) condition.task.timeout = test == "survival" ? 7.0 : 1e9;
        const PlantedEffect planted =
            effectOf("method:d=+" + std::to_string(GetParam().effect) + '~' + std::to_string(GetParam().spread), plan);
        PowerJob job = describeJob(plan, planted, test);
        job.participants = plan.participants;
        job.repeats = kStudies;
        const auto result = runShard(job, {}, planted, plan, timesOfPersons, {});
        ASSERT_TRUE(result) << toString(result.errors().front());
        const double found = summarise(*result).power;
        std::printf("%s, %s: power %.4f, by packages %.4f\n", GetParam().name, test.c_str(), found, power);
        EXPECT_NEAR(found, power, 2.576 * std::sqrt(2.0 * power * (1.0 - power) / kStudies)) << test;
        if (GetParam().effect > 0.0) continue;
        EXPECT_NEAR(found, 0.05, 0.01) << test;
    }
}

INSTANTIATE_TEST_SUITE_P(Planted, PowerOfRTests,
                         testing::Values(Planted{"nothing", 0.0, 0.0}, Planted{"alike", 0.3, 0.0},
                                         Planted{"spread_150ms", 0.3, 0.15}, Planted{"spread_300ms", 0.3, 0.3}),
                         [](const auto& planted) { return std::string(planted.param.name); });

}  // namespace
}  // namespace passung::power
