#include "study/protocol/analysis_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "study/protocol/table_reader.h"

namespace passung::protocol {
namespace {

/// What a test asks of its factors.
struct TestRule {
    std::string_view name;
    std::size_t least_within, most_within, least_between, most_between;
    std::size_t least_levels, most_levels;  // of each factor
};

constexpr std::size_t kMany = 100;
constexpr std::array kTests{TestRule{"paired_t", 1, 1, 0, 0, 2, 2},
                            TestRule{"wilcoxon", 1, 1, 0, 0, 2, 2},
                            TestRule{"rm_anova", 1, kMany, 0, 0, 2, kMany},
                            TestRule{"friedman", 1, 1, 0, 0, 3, kMany},
                            TestRule{"welch_t", 0, 0, 1, 1, 2, 2},
                            TestRule{"mann_whitney", 0, 0, 1, 1, 2, 2},
                            TestRule{"mixed_anova", 1, kMany, 1, kMany, 2, kMany}};

std::string countText(std::size_t least, std::size_t most, const char* what) {
    if (most == 0) return fmt::format("no {} factor", what);
    if (least == most) return fmt::format("{} {} factor{}", least, what, least == 1 ? "" : "s");
    return fmt::format("at least {} {} factor{}", least, what, least == 1 ? "" : "s");
}

/// What is wrong with a test for these factors; empty if nothing. A mixed model (lmm) takes any.
std::string testFault(const std::string& test, const std::vector<const Factor*>& factors) {
    const auto rule = std::find_if(kTests.begin(), kTests.end(), [&](const TestRule& r) { return r.name == test; });
    if (rule == kTests.end()) return "";
    const auto ofKind = [&](FactorKind kind) {
        return static_cast<std::size_t>(
            std::count_if(factors.begin(), factors.end(), [&](const Factor* f) { return f->kind == kind; }));
    };
    const std::size_t within = ofKind(FactorKind::Within), between = ofKind(FactorKind::Between);
    if (within < rule->least_within || within > rule->most_within || between < rule->least_between ||
        between > rule->most_between || within + between < factors.size())
        return fmt::format("is for {} and {}", countText(rule->least_within, rule->most_within, "within"),
                           countText(rule->least_between, rule->most_between, "between"));
    for (const Factor* factor : factors) {
        const auto levels = static_cast<std::size_t>(std::count_if(
            factor->levels.begin(), factor->levels.end(), [](const Level& level) { return !level.catch_trial; }));
        if (levels < rule->least_levels || levels > rule->most_levels)
            return fmt::format("is for {} {} levels; factor {} has {}",
                               rule->most_levels == kMany ? "at least" : "exactly", rule->least_levels, factor->name,
                               levels);
    }
    return "";
}

}  // namespace

std::vector<Analysis> readAnalyses(const std::vector<Node>& tables, const StudyPlan& plan, Errors& errors) {
    std::vector<Analysis> analyses;
    for (const Node& table : tables) {
        const std::size_t before = errors.size();
        const TableReader read(table, {"analysis"}, "analysis", errors);
        Analysis analysis{read.text("outcome"), {}, read.text("test")};
        if (read.has("outcome") &&
            std::find(plan.measures.begin(), plan.measures.end(), analysis.outcome) == plan.measures.end()) {
            const std::vector<std::string_view> known(plan.measures.begin(), plan.measures.end());
            const auto close = closestWord(analysis.outcome, known);
            read.fail("outcome", close ? fmt::format("is no measure of this study; did you mean \"{}\"?", *close)
                                       : "is no measure of this study");
        }
        if (read.has("factors") && read.items("factors").empty()) read.fail("factors", "names no factor");
        std::vector<const Factor*> factors;
        for (const Node& item : read.items("factors")) {
            const auto factor = std::find_if(plan.factors.begin(), plan.factors.end(),
                                             [&](const Factor& f) { return f.name == item.text; });
            const bool twice =
                std::find(analysis.factors.begin(), analysis.factors.end(), item.text) != analysis.factors.end();
            if (factor == plan.factors.end() || twice)
                errors.push_back(errorAt(item.place, "analysis.factors", valueText(item),
                                         twice ? "is listed twice" : "the study has no factor of this name"));
            else
                factors.push_back(&*factor);
            analysis.factors.push_back(item.text);
        }
        if (errors.size() == before)
            if (const auto fault = testFault(analysis.test, factors); !fault.empty()) read.fail("test", fault);
        analyses.push_back(std::move(analysis));
    }
    return analyses;
}

}  // namespace passung::protocol
