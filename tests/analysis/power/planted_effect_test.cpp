#include "analysis/power/planted_effect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "analysis/power/model_study.h"
#include "tests/analysis/power/small_plan.h"

namespace passung::power {
namespace {

using test::smallPlan;

constexpr const char* kTime = "completion_time_s";

PlantedEffect effectOf(const std::string& text, const std::string& against = "") {
    const auto effect = readEffect(text, against, kTime, smallPlan());
    if (!effect) throw std::runtime_error(toString(effect.errors().front()));
    return *effect;
}

TEST(PlantedEffect, IsReadAsWritten) {
    // Truth: invariant
    const PlantedEffect added = effectOf("method:b=c=-0.25");
    ASSERT_EQ(added.at.size(), 1u);
    EXPECT_EQ(added.at[0].factor, "method");
    EXPECT_EQ(added.at[0].level, "b=c");
    EXPECT_EQ(added.at[0].against, "a");
    EXPECT_EQ(added.scale, 1.0);
    EXPECT_EQ(added.shift, -0.25);
    const PlantedEffect scaled = effectOf("size:1=x1.5");
    EXPECT_EQ(scaled.at[0].against, "2");
    EXPECT_EQ(scaled.scale, 1.5);
    EXPECT_EQ(scaled.shift, 0.0);
    EXPECT_EQ(effectOf("method:a=+0", "d").at[0].against, "d");
    EXPECT_EQ(addedBy("method:b=c=-0.25"), -0.25);
    EXPECT_EQ(addedBy("method:a=+0"), 0.0);
    EXPECT_FALSE(addedBy("method:a=x1.5"));
    const PlantedEffect spread = effectOf("method:b=c=-0.25~0.2");
    EXPECT_EQ(spread.at[0].level, "b=c");
    EXPECT_EQ(spread.shift, -0.25);
    EXPECT_EQ(spread.shift_spread, 0.2);
    EXPECT_EQ(spread.log_scale_spread, 0.0);
    EXPECT_EQ(effectOf("size:1=x1.5~0.1").log_scale_spread, 0.1);
    EXPECT_EQ(effectOf("size:1=x1.5~0.1").shift_spread, 0.0);
    EXPECT_EQ(addedBy("method:b=c=-0.25~0.2"), -0.25);
    EXPECT_FALSE(addedBy("method:a=x1.5~0.1"));
    EXPECT_TRUE(saysSpread("method:a=+1~0"));
    EXPECT_FALSE(saysSpread("a~b:a=+1"));
    const PlantedEffect interaction = effectOf("method:b=c*size:1=+0.2~0.1", "d");
    ASSERT_EQ(interaction.at.size(), 2u);
    EXPECT_EQ(interaction.at[0].level, "b=c");
    EXPECT_EQ(interaction.at[0].against, "d");
    EXPECT_EQ(interaction.at[1].level, "1");
    EXPECT_EQ(interaction.at[1].against, "2");
    EXPECT_EQ(interaction.shift, 0.2);
}

TEST(PlantedEffect, OfAnInteractionIsWhereBothLevelsMeet) {
    // Truth: closed form
    const exporter::StudyData before = *modelStudy(smallPlan(), 2);
    exporter::StudyData after = before;
    plant(effectOf("method:d*size:2=+1"), 1, after);
    for (std::size_t i = 0; i < after.attempts.size(); ++i)
        EXPECT_DOUBLE_EQ(after.attempts[i].measures.at(kTime) - before.attempts[i].measures.at(kTime),
                         after.attempts[i].condition == "d/2" ? 1.0 : 0.0);
}

TEST(PlantedEffect, LetsTimesAboveTheTimeOutTimeOut) {
    // Truth: closed form: what is above 4 s after the effect has no completion time, and 4 s as its censored one; what
    // had timed out before stays so, shorter though the effect makes times.
    plan::StudyPlan plan = smallPlan();
    plan.measures.push_back("time_s");
    for (plan::Condition& condition : plan.conditions) condition.task.timeout = 4.0;
    const auto planted = [&](const char* text) {
        const auto effect = readEffect(text, "", "time_s", plan);
        exporter::StudyData study = *modelStudy(plan, 30);
        plant(*effect, 1, study);
        return study;
    };
    const exporter::StudyData before = *modelStudy(plan, 30), after = planted("method:d=+0.5");
    int cut = 0;
    for (std::size_t i = 0; i < after.attempts.size(); ++i) {
        const auto& attempt = after.attempts[i];
        const double time =
            before.attempts[i].measures.at("time_s") + (attempt.condition.starts_with("d/") ? 0.5 : 0.0);
        EXPECT_DOUBLE_EQ(attempt.measures.at("time_s"), std::min(time, 4.0));
        EXPECT_EQ(attempt.outcome, time > 4.0 ? "timeout" : "success");
        EXPECT_EQ(attempt.measures.count(kTime), time > 4.0 ? 0u : 1u);
        cut += time > 4.0 ? 1 : 0;
    }
    EXPECT_GT(cut, 20);
    exporter::StudyData again = after;
    plant(*readEffect("method:d=x0.5", "", "time_s", plan), 1, again);
    for (std::size_t i = 0; i < again.attempts.size(); ++i) {
        if (after.attempts[i].outcome != "timeout") continue;
        EXPECT_EQ(again.attempts[i].measures.at("time_s"), 4.0);
    }
}

TEST(PlantedEffect, NamesWhatThePlanDoesNotHave) {
    // Truth: invariant: key, value and requirement of each planted fault
    const auto message = [](const std::string& text, const std::string& against = "",
                            const std::string& measure = kTime) {
        const auto effect = readEffect(text, against, measure, smallPlan());
        return effect ? std::string("accepted") : toString(effect.errors().front());
    };
    EXPECT_EQ(message("method"), "error: --effect: method: must be FACTOR:LEVEL=DELTA");
    EXPECT_EQ(message("speed:a=+1"), "error: --effect: speed: must be a factor: method, size");
    EXPECT_EQ(message("method:e=+1"), "error: --effect: e: must be a level of method: a, b=c, d");
    EXPECT_EQ(message("method:a=+1", "e"), "error: --against: e: must be a level of method: a, b=c, d");
    EXPECT_EQ(message("method:a=+1", "a"), "error: --against: a: must be another level than the effect's");
    EXPECT_EQ(message("method:a*size:3=+1"), "error: --effect: a*size:3: must be a level of method: a, b=c, d");
    EXPECT_NE(message("method:a*method:d=+1").find("an interaction must be of two factors"), std::string::npos);
    EXPECT_EQ(message("method:a=+1", "", "tip"),
              "error: --measure: tip: must be a measure of the protocol: completion_time_s, peak_force_N");
    for (const char* delta : {"1", "x0", "x-2", "+", "x", "+inf", "+1s", ""})
        EXPECT_NE(message(std::string("method:a=") + delta).find("DELTA must be"), std::string::npos) << delta;
    for (const char* spread : {"", "-0.1", "x", "inf", "0.1~0.1"})
        EXPECT_NE(message(std::string("method:a=+1~") + spread).find("SPREAD behind ~ must be"), std::string::npos)
            << spread;
}

TEST(PlantedEffect, ChangesTheMeasureAtItsLevelOnly) {
    // Truth: closed form
    const exporter::StudyData before = *modelStudy(smallPlan(), 2);
    exporter::StudyData after = before;
    PlantedEffect effect = effectOf("method:d=x2");
    effect.shift = 0.5;
    plant(effect, 1, after);
    ASSERT_EQ(after.attempts.size(), 2u * 13u);
    int changed = 0;
    for (std::size_t i = 0; i < after.attempts.size(); ++i) {
        const double was = before.attempts[i].measures.at(kTime), is = after.attempts[i].measures.at(kTime);
        const bool there = after.attempts[i].condition.starts_with("d/");
        EXPECT_DOUBLE_EQ(is, there ? 2.0 * was + 0.5 : was);
        changed += there ? 1 : 0;
    }
    EXPECT_GE(changed, 8);
}

/// What a planted effect adds to (or, multiplied, the logarithm of what it multiplies by) each person's attempts.
std::map<std::string, std::set<double>> givenTo(int people, const PlantedEffect& effect, std::uint64_t seed) {
    const exporter::StudyData before = *modelStudy(smallPlan(), people);
    exporter::StudyData after = before;
    plant(effect, seed, after);
    std::map<std::string, std::set<double>> given;
    for (std::size_t i = 0; i < after.attempts.size(); ++i) {
        const double was = before.attempts[i].measures.at(kTime), is = after.attempts[i].measures.at(kTime);
        if (!after.attempts[i].condition.starts_with("d/")) continue;
        // Rounded to what the difference of two times of some seconds holds.
        given[after.attempts[i].participant_id].insert(
            std::round(1e9 * (effect.log_scale_spread > 0.0 ? std::log(is / was) : is - was)) / 1e9);
    }
    return given;
}

TEST(PlantedEffect, DiffersBetweenPersonsByItsSpreadAndNotWithinThem) {
    // Truth: closed form: mean and standard deviation of 2000 normal draws, each within four standard errors.
    for (const auto& [text, mean] : {std::pair("method:d=+0.3~0.2", 0.3), std::pair("method:d=x1.5~0.2", std::log(1.5)),
                                     std::pair("method:d=x1~0.2", 0.0)}) {
        const auto given = givenTo(2000, effectOf(text), 5);
        ASSERT_EQ(given.size(), 2000u);
        double sum = 0.0, squares = 0.0;
        for (const auto& [code, values] : given) {
            EXPECT_EQ(values.size(), 1u) << code << " has an effect of each attempt";
            sum += *values.begin();
            squares += (*values.begin() - mean) * (*values.begin() - mean);
        }
        EXPECT_NEAR(sum / 2000.0, mean, 4.0 * 0.2 / std::sqrt(2000.0));
        EXPECT_NEAR(std::sqrt(squares / 2000.0), 0.2, 4.0 * 0.2 / std::sqrt(4000.0));
    }
    EXPECT_EQ(givenTo(3, effectOf("method:d=+0.3~0.2"), 5), givenTo(3, effectOf("method:d=+0.3~0.2"), 5));
    EXPECT_NE(givenTo(3, effectOf("method:d=+0.3~0.2"), 5), givenTo(3, effectOf("method:d=+0.3~0.2"), 6));
}

std::vector<double> timesOf(const exporter::StudyData& study) {
    std::vector<double> times;
    for (const auto& attempt : study.attempts) times.push_back(attempt.measures.at(kModelMeasure));
    return times;
}

TEST(ModelStudy, IsTheSameForTheSamePlanAndDiffersBetweenPeople) {
    // Truth: invariant
    const std::vector<double> times = timesOf(*modelStudy(smallPlan(), 3));
    EXPECT_EQ(times, timesOf(*modelStudy(smallPlan(), 3)));
    plan::StudyPlan other = smallPlan();
    other.seed = 12;
    EXPECT_NE(times, timesOf(*modelStudy(other, 3)));
    for (std::size_t i = 0; i < 13; ++i) EXPECT_NE(times[i], times[13 + i]);
}

TEST(ModelStudy, ASecondSessionIsDrawnAnew) {
    // Truth: invariant; the same block again, trial by trial.
    plan::StudyPlan plan = smallPlan();
    plan.blocks.erase(plan.blocks.begin());
    plan.blocks.push_back(plan.blocks.front());
    plan.blocks.back().name = "again";
    plan.blocks.back().session = 2;
    const exporter::StudyData study = *modelStudy(plan, 1);
    const std::vector<double> times = timesOf(study);
    ASSERT_EQ(times.size(), 24u);
    EXPECT_EQ(study.sessions.size(), 2u);
    for (std::size_t i = 0; i < 12; ++i) EXPECT_NE(times[i], times[12 + i]);
}

}  // namespace
}  // namespace passung::power
