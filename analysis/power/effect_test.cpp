#include "analysis/power/effect_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "analysis/export/cells.h"
#include "analysis/stats/anova.h"
#include "analysis/stats/paired_t.h"
#include "analysis/stats/rank_tests.h"

namespace passung::power {
namespace {

using plan::FactorKind;

struct Known {
    const char* name;
    bool within, between;  // factors that it tests
};
constexpr std::array kTests{Known{"paired_t", true, false},  Known{"wilcoxon", true, false},
                            Known{"rm_anova", true, false},  Known{"friedman", true, false},
                            Known{"welch_t", false, true},   Known{"mann_whitney", false, true},
                            Known{"mixed_anova", true, true}};

const plan::Factor& factorOf(const PlantedEffect& effect, const plan::StudyPlan& plan) {
    return *std::find_if(plan.factors.begin(), plan.factors.end(),
                         [&](const plan::Factor& factor) { return factor.name == effect.factor; });
}

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

    double at(const std::string& level) const {
        const auto found = means.find(level);
        return found == means.end() ? EffectTest::kNothing : exporter::meanOf(found->second);
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

/// The plan's first analysis of the measure by the factor.
const plan::Analysis* plannedAnalysis(const PlantedEffect& effect, const plan::StudyPlan& plan) {
    const auto found = std::find_if(plan.analyses.begin(), plan.analyses.end(), [&](const plan::Analysis& analysis) {
        return analysis.outcome == effect.measure &&
               std::find(analysis.factors.begin(), analysis.factors.end(), effect.factor) != analysis.factors.end();
    });
    return found == plan.analyses.end() ? nullptr : &*found;
}

/// The block whose trials that analysis takes; empty: all.
std::string plannedBlock(const PlantedEffect& effect, const plan::StudyPlan& plan) {
    const plan::Analysis* analysis = plannedAnalysis(effect, plan);
    return analysis != nullptr ? analysis->block : "";
}

std::vector<Person> peopleOf(const PlantedEffect& effect, const plan::StudyPlan& plan,
                             const exporter::StudyData& study) {
    std::map<std::string, Person> people;
    const std::string block = plannedBlock(effect, plan);
    for (const exporter::Cell& cell : exporter::cellsOf(study)) {
        if (!block.empty() && cell.block != block) continue;
        const auto& levels = cell.condition->levels;
        Person& person = people[cell.participant_id];
        person.group.clear();
        for (const plan::Factor& factor : plan.factors)
            if (factor.kind == FactorKind::Between) person.group += exporter::levelOf(levels, factor.name) + '\n';
        const double value = exporter::valueOf(cell, effect.measure);
        // Of several blocks those count that have the measure.
        if (std::isfinite(value) || exporter::canHave(*cell.condition, effect.measure))
            person.means[exporter::levelOf(levels, effect.factor)].push_back(value);
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

EffectTest testBetween(const PlantedEffect& effect, const std::string& test, const std::vector<std::string>& levels,
                       const std::vector<Person>& people) {
    const auto one = sampleAt(people, effect.level), other = sampleAt(people, effect.against);
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

EffectTest testWithin(const PlantedEffect& effect, const std::string& test, const std::vector<std::string>& levels,
                      const std::vector<Person>& people) {
    const bool two = test == "paired_t" || test == "wilcoxon";
    const std::vector<std::string> needed = two ? std::vector{effect.level, effect.against} : levels;
    std::vector<double> differences;
    std::vector<std::vector<double>> rows;
    std::map<std::string, std::vector<std::vector<double>>> groups;
    for (const Person& person : people) {
        auto row = person.atAll(needed);
        if (row.empty()) continue;
        differences.push_back(person.at(effect.level) - person.at(effect.against));
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

}  // namespace

std::vector<std::string> testNames() {
    std::vector<std::string> names;
    for (const Known& test : kTests) names.emplace_back(test.name);
    names.emplace_back("lmm");
    return names;
}

Result<std::string> chooseTest(const std::string& asked, const PlantedEffect& effect, const plan::StudyPlan& plan) {
    const plan::Factor& factor = factorOf(effect, plan);
    const bool between = factor.kind == FactorKind::Between;
    std::string test = asked;
    if (const plan::Analysis* analysis = plannedAnalysis(effect, plan); test.empty() && analysis != nullptr)
        test = analysis->test;
    if (test.empty()) test = between ? "welch_t" : "paired_t";
    const auto wrong = [&](const std::string& requirement) {
        return Error{
            .message = requirement + (asked.empty() ? "; the protocol plans it: name another with --test" : ""),
            .key = "--test",
            .value = test};
    };
    const auto known = std::find_if(kTests.begin(), kTests.end(), [&](const Known& k) { return test == k.name; });
    if (known == kTests.end()) return wrong("a mixed model is not fitted here");
    if (!(between ? known->between : known->within))
        return wrong(fmt::format("is for a {} factor, and {} is a {} one", between ? "within" : "between", factor.name,
                                 between ? "between" : "within"));
    const auto others = std::count_if(plan.factors.begin(), plan.factors.end(),
                                      [](const plan::Factor& f) { return f.kind == FactorKind::Between; });
    if (between && test == "mixed_anova" && others > 1)
        return wrong("the main effect of one of several between factors is not tested here");
    return test;
}

EffectTest testEffect(const PlantedEffect& effect, const std::string& test, const plan::StudyPlan& plan,
                      const exporter::StudyData& study) {
    const plan::Factor& factor = factorOf(effect, plan);
    const auto people = peopleOf(effect, plan, study);
    return factor.kind == FactorKind::Between ? testBetween(effect, test, comparedLevels(factor), people)
                                              : testWithin(effect, test, comparedLevels(factor), people);
}

}  // namespace passung::power
