#include "analysis/power/effect_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "analysis/export/cells.h"
#include "analysis/power/planned_analysis.h"
#include "analysis/power/r_tests.h"
#include "analysis/stats/anova.h"
#include "analysis/stats/paired_t.h"
#include "analysis/stats/rank_tests.h"

namespace passung::power {
namespace {

using plan::FactorKind;

struct Known {
    const char* name;
    bool within, between;      // factors that it tests
    bool interaction = false;  // of two of these, of both kinds if it tests both
};
constexpr std::array kTests{Known{"paired_t", true, false},         Known{"wilcoxon", true, false},
                            Known{"rm_anova", true, false, true},   Known{"friedman", true, false},
                            Known{"welch_t", false, true},          Known{"mann_whitney", false, true},
                            Known{"mixed_anova", true, true, true}, Known{"lmm", true, true, true},
                            Known{"survival", true, true},          Known{"equivalence", true, true}};

/// Labels of the levels that are compared.
std::vector<std::string> comparedLevels(const plan::Factor& factor) {
    std::vector<std::string> labels;
    for (const plan::Level& level : factor.levels)
        if (!level.catch_trial) labels.push_back(level.label);
    return labels;
}

struct Person {
    std::string group;                                 // levels of all between factors
    std::map<std::string, std::vector<double>> means;  // of the cells, by level
    bool logarithm = false;                            // what is compared, as the planned analysis has it

    double at(const std::string& level) const {
        const auto found = means.find(level);
        const double mean = found == means.end() ? EffectTest::kNothing : exporter::meanOf(found->second);
        return logarithm ? std::log(mean) : mean;
    }
    /// A value for each level; nothing if one is missing.
    std::vector<double> atAll(const std::vector<std::string>& levels) const {
        std::vector<double> values;
        for (const std::string& level : levels) {
            if (!std::isfinite(at(level))) return {};
            values.push_back(at(level));
        }
        return values;
    }
};

std::vector<Person> peopleOf(const PlantedEffect& effect, const plan::StudyPlan& plan,
                             const exporter::StudyData& study) {
    std::map<std::string, Person> people;
    const std::string block = plannedBlock(effect, plan);
    const bool logarithm = plansLogarithm(effect, plan);
    for (const exporter::Cell& cell : exporter::cellsOf(study)) {
        if (!block.empty() && cell.block != block) continue;
        const auto& levels = cell.condition->levels;
        Person& person = people[cell.participant_id];
        person.logarithm = logarithm;
        person.group.clear();
        for (const plan::Factor& factor : plan.factors)
            if (factor.kind == FactorKind::Between) person.group += exporter::levelOf(levels, factor.name) + '\n';
        const double value = exporter::valueOf(cell, effect.measure);
        // Of several blocks those count that have the measure.
        if (std::isfinite(value) || exporter::canHave(*cell.condition, effect.measure))
            person.means[exporter::levelOf(levels, effect.at.front().factor)].push_back(value);
    }
    std::vector<Person> list;
    for (auto& [code, person] : people) list.push_back(std::move(person));
    return list;
}

/// Values of the people at a level of a between factor.
std::vector<double> sampleAt(const std::vector<Person>& people, const std::string& level) {
    std::vector<double> sample;
    for (const Person& person : people)
        if (std::isfinite(person.at(level))) sample.push_back(person.at(level));
    return sample;
}

EffectTest testBetween(const LevelPair& pair, const std::string& test, const std::vector<std::string>& levels,
                       const std::vector<Person>& people) {
    const auto one = sampleAt(people, pair.level), other = sampleAt(people, pair.against);
    EffectTest result;
    result.n = one.size() + other.size();
    result.mean = exporter::meanOf(one) - exporter::meanOf(other);
    stats::TestResult found;
    if (test == "welch_t") found = stats::welchT(one, other);
    if (test == "mann_whitney") found = stats::mannWhitney(one, other);
    if (test == "mixed_anova") {
        std::vector<std::vector<double>> groups;
        result.n = 0;
        for (const std::string& level : levels) {
            groups.push_back(sampleAt(people, level));
            result.n += groups.back().size();
        }
        found = stats::oneWayAnova(groups);
    }
    result.statistic = found.statistic;
    result.p = found.p;
    return result;
}

EffectTest testWithin(const LevelPair& pair, const std::string& test, const std::vector<std::string>& levels,
                      const std::vector<Person>& people) {
    const bool two = test == "paired_t" || test == "wilcoxon";
    const std::vector<std::string> needed = two ? std::vector{pair.level, pair.against} : levels;
    std::vector<double> differences;
    std::vector<std::vector<double>> rows;
    std::map<std::string, std::vector<std::vector<double>>> groups;
    for (const Person& person : people) {
        auto row = person.atAll(needed);
        if (row.empty()) continue;
        differences.push_back(person.at(pair.level) - person.at(pair.against));
        groups[test == "mixed_anova" ? person.group : ""].push_back(row);
        rows.push_back(std::move(row));
    }
    const stats::PairedT paired = stats::pairedT(differences);
    stats::TestResult found{paired.t, paired.p};
    if (test == "wilcoxon") found = stats::wilcoxonSignedRank(differences);
    if (test == "friedman") found = stats::friedman(rows);
    if (test == "rm_anova" || test == "mixed_anova") {
        std::vector<std::vector<std::vector<double>>> each;
        for (auto& [name, members] : groups) each.push_back(std::move(members));
        found = stats::withinAnova(each);
    }
    return {paired.n, paired.mean, paired.sd, found.statistic, found.p};
}

EffectTest testStudy(const PlantedEffect& effect, const std::string& test, const plan::StudyPlan& plan,
                     const exporter::StudyData& study) {
    const plan::Factor& factor = factorOf(effect.at.front(), plan);
    const auto people = peopleOf(effect, plan, study);
    return factor.kind == FactorKind::Between ? testBetween(effect.at.front(), test, comparedLevels(factor), people)
                                              : testWithin(effect.at.front(), test, comparedLevels(factor), people);
}

/// Why the test is not one of these factors; empty: it is.
std::string misfit(const Known& test, const std::vector<const plan::Factor*>& factors, const plan::StudyPlan& plan) {
    const auto isBetween = [](const plan::Factor* factor) { return factor->kind == FactorKind::Between; };
    const auto between = std::count_if(factors.begin(), factors.end(), isBetween);
    if (factors.size() == 2) {
        if (!test.interaction) return "does not test an interaction";
        if (between == 2) return "is not for the interaction of two between factors";
        const std::string name = test.name;
        if (name == "rm_anova" && between > 0) return "is for two within factors";
        if (name == "mixed_anova" && between == 0) return "is for a within and a between factor";
        return {};
    }
    const plan::Factor& factor = *factors.front();
    if (!(between == 1 ? test.between : test.within))
        return fmt::format("is for a {} factor, and {} is a {} one", between == 1 ? "within" : "between", factor.name,
                           between == 1 ? "between" : "within");
    const auto others = std::count_if(plan.factors.begin(), plan.factors.end(),
                                      [](const plan::Factor& f) { return f.kind == FactorKind::Between; });
    if (between == 1 && std::string(test.name) == "mixed_anova" && others > 1)
        return "the main effect of one of several between factors is not tested here";
    return {};
}

}  // namespace

std::vector<std::string> testNames() {
    std::vector<std::string> names;
    for (const Known& test : kTests) names.emplace_back(test.name);
    return names;
}

Result<std::string> chooseTest(const std::string& asked, const PlantedEffect& effect, const plan::StudyPlan& plan) {
    std::vector<const plan::Factor*> factors;
    bool has_between = false;
    for (const LevelPair& pair : effect.at) {
        factors.push_back(&factorOf(pair, plan));
        has_between = has_between || factors.back()->kind == FactorKind::Between;
    }
    std::string test = asked;
    if (const plan::Analysis* analysis = plannedAnalysis(effect, plan); test.empty() && analysis != nullptr)
        test = analysis->test;
    if (test.empty() && factors.size() == 2) test = has_between ? "mixed_anova" : "rm_anova";
    if (test.empty()) test = has_between ? "welch_t" : "paired_t";
    const auto wrong = [&](const std::string& requirement) {
        return Error{
            .message = requirement + (asked.empty() ? "; the protocol plans it: name another with --test" : ""),
            .key = "--test",
            .value = test};
    };
    const auto known = std::find_if(kTests.begin(), kTests.end(), [&](const Known& k) { return test == k.name; });
    if (known == kTests.end()) return wrong("is not computed here");
    if (const std::string why = misfit(*known, factors, plan); !why.empty()) return wrong(why);
    if (testedInR(effect, test))
        if (const std::string why = whyNotInR(effect, test, plan); !why.empty()) return wrong(why);
    return test;
}

Result<std::vector<EffectTest>> testEffect(const PlantedEffect& effect, const std::string& test,
                                           const plan::StudyPlan& plan, std::span<const exporter::StudyData> studies) {
    if (testedInR(effect, test)) return testInR(effect, test, plan, studies);
    std::vector<EffectTest> tests;
    for (const exporter::StudyData& study : studies) tests.push_back(testStudy(effect, test, plan, study));
    return tests;
}

std::size_t studiesAtOnce(const PlantedEffect& effect, const std::string& test) {
    return testedInR(effect, test) ? 50 : 1;
}

}  // namespace passung::power
