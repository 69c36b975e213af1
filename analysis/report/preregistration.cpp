#include "analysis/report/preregistration.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/stats/paired_t.h"
#include "core/base/digest.h"
#include "study/measures/measures.h"
#include "study/questionnaire/scoring.h"

namespace passung::report {
namespace {

constexpr double kPower = 0.8, kLevel = 0.05;
constexpr const char* kYours = "*To be written by you.*\n\n";

/// "3 conditions", "1 condition".
std::string several(std::size_t count, const char* noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string measuresText(const plan::StudyPlan& plan) {
    std::size_t hands = 1;
    for (const plan::Condition& condition : plan.conditions) hands = std::max(hands, condition.scene.handCount());
    std::string text;
    for (const measures::MeasureDefinition& measure : measures::definitions())
        if (std::find(plan.measures.begin(), plan.measures.end(), measure.name) != plan.measures.end() &&
            !measures::countsTicks(measure.name))
            text +=
                fmt::format("- `{}`: {}{}: {}.\n", measure.name, measure.label,
                            measure.unit == "1" ? "" : " [" + measure.unit + "]", measures::formulaOf(measure, hands));
    for (const plan::PlannedQuestionnaire& planned : plan.questionnaires)
        for (const questionnaire::Scale& scale : planned.definition.scales)
            text += fmt::format("- `{}.{}`: {}: {}; asked at {}{}.\n", planned.definition.key, scale.name, scale.label,
                                questionnaire::formulaText(planned.definition, scale), plan::momentName(planned.moment),
                                planned.block.empty() ? "" : " of block " + planned.block);
    for (const plan::Staircase& staircase : plan.staircases)
        text += fmt::format("- thresholds of staircase `{}`: `{}`{}, settling at {:.3g} % positive answers.\n",
                            staircase.name, staircase.key, staircase.unit.empty() ? "" : " [" + staircase.unit + "]",
                            100.0 * staircase.tracks.front().params.target());
    return text + "\n";
}

std::string conditionsText(const plan::StudyPlan& plan) {
    std::string text;
    for (const plan::Factor& factor : plan.factors) {
        std::vector<std::string> labels;
        for (const plan::Level& level : factor.levels)
            labels.push_back(level.label + (level.catch_trial ? " (catch)" : ""));
        text += fmt::format("- factor `{}` ({}): {}{}\n", factor.name, plan::factorKindName(factor.kind),
                            fmt::join(labels, ", "), factor.unit.empty() ? "" : " " + factor.unit);
    }
    text += fmt::format("- {}\n", several(plan::plannedConditions(plan), "condition"));
    for (const plan::Block& block : plan.blocks)
        text += fmt::format("- block `{}` ({}): order {}, {}\n", block.name, plan::phaseName(block.phase),
                            plan::blockOrderName(block.order),
                            several(static_cast<std::size_t>(block.repetitions), "repetition"));
    return text + "\n";
}

std::string analysisText(const plan::Analysis& analysis, std::size_t number) {
    std::string text = fmt::format("{}. {}{}{}{}: test `{}`", number, analysis.role.empty() ? "" : analysis.role + ": ",
                                   analysis.transform.empty() ? "" : "logarithm of ",
                                   analysis.outcome.empty() ? "thresholds of staircase `" + analysis.staircase + "`"
                                                            : "`" + analysis.outcome + "`",
                                   analysis.block.empty() ? "" : " in block `" + analysis.block + "`", analysis.test);
    if (!analysis.factors.empty()) text += fmt::format(" by `{}`", fmt::join(analysis.factors, "`, `"));
    if (!analysis.covariates.empty()) text += fmt::format(", covariates `{}`", fmt::join(analysis.covariates, "`, `"));
    for (const plan::Contrast& contrast : analysis.contrasts)
        text += fmt::format("; contrast {}: {} - {}", contrast.factor, contrast.level, contrast.against);
    if (analysis.equivalence_bounds)
        text += fmt::format("; equal means from {} to {}", analysis.equivalence_bounds->first,
                            analysis.equivalence_bounds->second);
    if (!analysis.family.empty()) text += fmt::format("; family `{}`, adjusted by Holm", analysis.family);
    return text + "\n";
}

/// Those of a role, or of all others.
std::string analysesText(const plan::StudyPlan& plan, bool exploratory) {
    std::string text;
    for (std::size_t i = 0; i < plan.analyses.size(); ++i)
        if ((plan.analyses[i].role == "exploratory") == exploratory) text += analysisText(plan.analyses[i], i + 1);
    return text.empty() ? "None is planned.\n\n" : text + "\n";
}

std::string rulesText(const plan::StudyPlan& plan) {
    std::string text = fmt::format(
        "- Practice, catch trials and attempts that were aborted enter no analysis. An attempt that missed more than "
        "{:.3g} % of the loop's cycles, or that the experimenter marks, is not valid.\n"
        "- A time-out is no missing value: `time_s` enters cells as its restricted mean.\n",
        100.0 * plan.max_missed_share);
    for (const plan::DataRule& rule : plan.data_rules) {
        text += fmt::format("- Left out: {} whose {}`{}` is", rule.of_participants ? "participants" : "trials",
                            rule.of_participants ? "mean " : "", rule.value);
        if (rule.below) text += fmt::format(" below {}", *rule.below);
        if (rule.above) text += fmt::format("{} above {}", rule.below ? " or" : "", *rule.above);
        text += rule.reason.empty() ? ".\n" : ": " + rule.reason + ".\n";
    }
    if (plan.data_rules.empty()) text += "- No rule on values: nothing that counts is left out for what it is.\n";
    return text + "- Whoever lacks a value at a combination of an analysis' factors is left out of it, by code.\n\n";
}

/// The standardised difference that a paired t-test of so many finds with kPower.
double detectable(double participants) {
    double low = 0.0, high = 100.0;
    for (int i = 0; i < 100; ++i)
        (stats::pairedPower((low + high) / 2.0, participants, kLevel) < kPower ? low : high) = (low + high) / 2.0;
    return high;
}

std::string sizeText(const plan::StudyPlan& plan) {
    std::string text = several(static_cast<std::size_t>(plan.participants), "participant");
    const std::vector<std::string> groups = plan::groupNames(plan);
    if (groups.size() > 1) text += fmt::format(" in the groups {}", fmt::join(groups, ", "));
    text += fmt::format(", {}.\n", several(static_cast<std::size_t>(plan::sessionsOf(plan)), "session"));
    if (plan.participants > 1)
        text += fmt::format(
            "Between two conditions that all meet, a t-test at {:.0f} % finds a difference of {:.2f} "
            "standard deviations of the differences in {:.0f} % of studies; of the planned tests "
            "`passung power` tells the power by simulation.\n",
            100.0 * kLevel, detectable(plan.participants), 100.0 * kPower);
    return text + "\n";
}

}  // namespace

std::string preregistrationOf(const plan::StudyPlan& plan) {
    return fmt::format(
               "# {}\n\nStudy `{}`, version {}, seed {}; SHA-256 of the protocol `{}`.\nThe questions are those "
               "of AsPredicted.\n\n",
               plan.title.empty() ? plan.name : plan.title, plan.name, plan.version, plan.seed,
               sha256Hex(plan.source_text)) +
           "## 1. Have any data been collected for this study already?\n\n" + kYours +
           "## 2. What is the main question being asked or hypothesis being tested?\n\n" + kYours +
           "## 3. Key dependent variables, and how they will be measured\n\n" + measuresText(plan) +
           "## 4. How many and which conditions will participants be assigned to?\n\n" + conditionsText(plan) +
           "## 5. Which analyses will be conducted to examine the main question?\n\n" + analysesText(plan, false) +
           "## 6. How will outliers be defined and handled, and what excludes observations?\n\n" + rulesText(plan) +
           "## 7. How many observations will be collected, or what determines the sample size?\n\n" + sizeText(plan) +
           "## 8. Anything else: exploratory analyses\n\n" + analysesText(plan, true);
}

}  // namespace passung::report
