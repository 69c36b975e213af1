#include "study/protocol/analysis_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "study/protocol/table_reader.h"
#include "study/protocol/trial_types.h"

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
                            TestRule{"mixed_anova", 1, kMany, 1, kMany, 2, kMany},
                            TestRule{"ordinal", 1, kMany, 0, 0, 2, kMany},
                            TestRule{"mean", 0, 0, 0, 0, 0, kMany}};

/// QUESTIONNAIRE.SCALE; a measure has no point.
bool isScale(const std::string& outcome) { return outcome.find('.') != std::string::npos; }

std::string countText(std::size_t least, std::size_t most, const char* what) {
    if (most == 0) return fmt::format("no {} factor", what);
    if (least == most) return fmt::format("{} {} factor{}", least, what, least == 1 ? "" : "s");
    return fmt::format("at least {} {} factor{}", least, what, least == 1 ? "" : "s");
}

std::size_t levelsOf(const plan::Factor& factor) {
    return static_cast<std::size_t>(std::count_if(factor.levels.begin(), factor.levels.end(),
                                                  [](const plan::Level& level) { return !level.catch_trial; }));
}

/// What is wrong with a test for these factors; empty if nothing. lmm and survival take any.
std::string testFault(const std::string& test, const std::vector<const plan::Factor*>& factors) {
    if (test == "equivalence")
        return factors.size() == 1 && levelsOf(*factors.front()) == 2 ? "" : "is for one factor of two levels";
    const auto rule = std::find_if(kTests.begin(), kTests.end(), [&](const TestRule& r) { return r.name == test; });
    if (rule == kTests.end()) return "";
    const auto ofKind = [&](plan::FactorKind kind) {
        return static_cast<std::size_t>(
            std::count_if(factors.begin(), factors.end(), [&](const plan::Factor* f) { return f->kind == kind; }));
    };
    const std::size_t within = ofKind(plan::FactorKind::Within), between = ofKind(plan::FactorKind::Between);
    if (rule->most_within + rule->most_between == 0) return factors.empty() ? "" : "is for no factor";
    if (within < rule->least_within || within > rule->most_within || between < rule->least_between ||
        between > rule->most_between || within + between < factors.size())
        return fmt::format("is for {} and {}", countText(rule->least_within, rule->most_within, "within"),
                           countText(rule->least_between, rule->most_between, "between"));
    for (const plan::Factor* factor : factors) {
        const std::size_t levels = levelsOf(*factor);
        if (levels < rule->least_levels || levels > rule->most_levels)
            return fmt::format("is for {} {} levels; factor {} has {}",
                               rule->most_levels == kMany ? "at least" : "exactly", rule->least_levels, factor->name,
                               levels);
    }
    return "";
}

/// Reads one table.
class AnalysisReader {
public:
    AnalysisReader(const Node& table, const plan::StudyPlan& plan, const std::vector<std::string>& staircases,
                   Errors& errors)
        : table_(table), read_(table, {"analysis"}, "analysis", errors), plan_(plan), errors_(errors) {
        before_ = errors.size();
        readOutcome(staircases);
        readBlock();
        readFactors();
        analysis_.test = read_.text("test");
        if (errors.size() > before_ || !read_.has("test")) return;
        if (factors_.empty() && analysis_.test != "mean" && analysis_.test != "lmm")
            read_.fail("factors", fmt::format("required by the test {}", analysis_.test));
        else if (const auto fault = testFault(analysis_.test, factors_); !fault.empty())
            read_.fail("test", fault);
        readModel();
    }

    const plan::Analysis& analysis() const { return analysis_; }

private:
    /// Nothing, or what is wrong with a name that is none of these.
    static std::string unknown(const std::string& name, const std::vector<std::string>& names,
                               const std::string& fault) {
        if (std::find(names.begin(), names.end(), name) != names.end()) return "";
        const std::vector<std::string_view> known(names.begin(), names.end());
        const auto close = closestWord(name, known);
        return close ? fmt::format("{}; did you mean \"{}\"?", fault, *close) : fault;
    }

    void readOutcome(const std::vector<std::string>& staircases) {
        const bool outcome = table_.find("outcome") != nullptr, staircase = table_.find("staircase") != nullptr;
        if (outcome == staircase)
            return read_.fail(outcome ? "staircase" : "outcome",
                              outcome ? "stands beside outcome: one of them is analysed" : "required, or staircase");
        analysis_.outcome = read_.text("outcome");
        analysis_.staircase = read_.text("staircase");
        if (read_.has("outcome") && !isScale(analysis_.outcome)) {
            const auto fault = unknown(analysis_.outcome, plan_.measures, "is no measure of this study");
            if (!fault.empty()) return read_.fail("outcome", fault);
            if (analysis_.outcome.ends_with("_ticks"))
                read_.fail("outcome",
                           "counts ticks of the loop: it is in timing.csv, not among what trials are "
                           "analysed by");
        }
        if (read_.has("staircase"))
            if (const auto fault = unknown(analysis_.staircase, staircases, "the study has no staircase of this name");
                !fault.empty())
                read_.fail("staircase", fault);
    }

    void readBlock() {
        if (!read_.has("block")) return;
        analysis_.block = read_.text("block");
        if (!analysis_.staircase.empty()) return read_.fail("block", "is decided by the staircase");
        std::vector<std::string> names;
        for (const plan::Block& block : plan_.blocks) names.push_back(block.name);
        if (const auto fault = unknown(analysis_.block, names, "the study has no block of this name"); !fault.empty())
            return read_.fail("block", fault);
        const auto block = std::find_if(plan_.blocks.begin(), plan_.blocks.end(),
                                        [&](const plan::Block& b) { return b.name == analysis_.block; });
        if (block->phase != plan::Phase::Main) read_.fail("block", "is practice, which enters no analysis");
        if (!isScale(analysis_.outcome)) checkType(*block);
        if (block->adaptive) read_.fail("block", "has a staircase, whose trials enter no mean: name the staircase");
    }

    /// A measure that no trial of the block has.
    void checkType(const plan::Block& block) const {
        const std::size_t first = block.first_condition > 0  ? block.first_condition
                                  : block.conditions.empty() ? 0
                                                             : block.conditions.front();
        if (!errors_.empty() || first >= plan_.conditions.size()) return;  // else it may follow from another mistake
        const TrialType* type = &typeOf(plan_.conditions[first].task);
        if (measuresOf(std::span(&type, 1), std::span(&analysis_.outcome, 1)).empty())
            read_.fail("outcome",
                       fmt::format("a trial of the type {}, as in block {}, does not have it", type->name, block.name));
    }

    /// Main blocks as a factor, unless the study has a factor of that name.
    bool isBlockFactor(const std::string& name) {
        if (name != plan::kBlockFactor) return false;
        blocks_ = {name, plan::FactorKind::Within, "", {}};
        for (const plan::Block& block : plan_.blocks)
            if (block.phase == plan::Phase::Main && !block.adaptive) blocks_.levels.push_back({block.name});
        if (!analysis_.block.empty()) read_.fail("block", "stands beside the factor block");
        if (!analysis_.staircase.empty()) read_.fail("factors", "block is decided by the staircase");
        return true;
    }

    void readModel() {
        analysis_.role = read_.text("role");
        analysis_.transform = read_.text("transform");
        analysis_.family = read_.text("family");
        if (analysis_.test == "survival" && analysis_.outcome != "time_s")
            read_.fail("test", "is for the outcome time_s");
        if (!analysis_.transform.empty() && (analysis_.test == "survival" || analysis_.test == "ordinal"))
            read_.fail("transform", "changes nothing of the test " + analysis_.test);
        if (!analysis_.family.empty() && analysis_.test == "mean") read_.fail("family", "the test mean has no p value");
        readCovariates();
        readContrasts();
        readBounds();
    }

    void readCovariates() {
        for (const Node& item : read_.items("covariates")) {
            if (item.text != "order_position" && item.text != "session")
                errors_.push_back(
                    errorAt(item.place, "analysis.covariates", valueText(item), "must be order_position or session"));
            analysis_.covariates.push_back(item.text);
        }
        if (!analysis_.covariates.empty() && analysis_.test != "lmm" && analysis_.test != "survival")
            read_.fail("covariates", "the test " + analysis_.test + " has none");
        if (!analysis_.covariates.empty() && (isScale(analysis_.outcome) || !analysis_.staircase.empty()))
            read_.fail("covariates", "are known of trials only");
    }

    void readContrasts() {
        for (const Node& item : read_.items("contrasts")) {
            if (const auto contrast = contrastOf(item.text))
                analysis_.contrasts.push_back(*contrast);
            else
                errors_.push_back(errorAt(item.place, "analysis.contrasts", valueText(item),
                                          "must be \"FACTOR: LEVEL - LEVEL\" of a factor of the analysis"));
        }
        if (!analysis_.contrasts.empty() && analysis_.test != "rm_anova" && analysis_.test != "mixed_anova" &&
            analysis_.test != "lmm")
            read_.fail("contrasts", "are for rm_anova, mixed_anova and lmm");
    }

    std::optional<plan::Contrast> contrastOf(const std::string& text) const {
        for (const plan::Factor* factor : factors_)
            for (const plan::Level& level : factor->levels)
                for (const plan::Level& against : factor->levels)
                    if (&level != &against && text == factor->name + ": " + level.label + " - " + against.label)
                        return plan::Contrast{factor->name, level.label, against.label};
        return std::nullopt;
    }

    void readBounds() {
        const Node* bounds = read_.node("equivalence_bounds");
        if ((bounds != nullptr) != (analysis_.test == "equivalence"))
            return read_.fail("equivalence_bounds",
                              bounds != nullptr ? "are for the test equivalence" : "required by the test equivalence");
        if (bounds == nullptr) return;
        const auto isNumber = [](const Node& item) {
            return item.kind == Node::Kind::Integer || item.kind == Node::Kind::Number;
        };
        if (bounds->kind != Node::Kind::List || bounds->items.size() != 2 ||
            !std::all_of(bounds->items.begin(), bounds->items.end(), isNumber) ||
            !(bounds->items[0].number < bounds->items[1].number))
            return read_.fail("equivalence_bounds", "must be [low, high] with low below high");
        analysis_.equivalence_bounds.emplace(bounds->items[0].number, bounds->items[1].number);
    }

    void readFactors() {
        if (read_.has("factors") && read_.items("factors").empty()) read_.fail("factors", "names no factor");
        for (const Node& item : read_.items("factors")) {
            const auto factor = std::find_if(plan_.factors.begin(), plan_.factors.end(),
                                             [&](const plan::Factor& f) { return f.name == item.text; });
            const bool twice =
                std::find(analysis_.factors.begin(), analysis_.factors.end(), item.text) != analysis_.factors.end();
            if (factor == plan_.factors.end() && !twice && isBlockFactor(item.text))
                factors_.push_back(&blocks_);
            else if (factor == plan_.factors.end() || twice)
                errors_.push_back(errorAt(item.place, "analysis.factors", valueText(item),
                                          twice ? "is listed twice" : "the study has no factor of this name"));
            else
                factors_.push_back(&*factor);
            analysis_.factors.push_back(item.text);
        }
    }

    const Node& table_;
    TableReader read_;
    const plan::StudyPlan& plan_;
    Errors& errors_;
    std::size_t before_ = 0;
    plan::Analysis analysis_;
    plan::Factor blocks_;
    std::vector<const plan::Factor*> factors_;
};

/// Reads one rule.
plan::DataRule readDataRule(const Node& table, const plan::StudyPlan& plan, Errors& errors) {
    const TableReader read(table, {"exclude"}, "exclude", errors);
    plan::DataRule rule;
    rule.of_participants = read.text("data") == "participants";
    rule.value = read.text("value");
    rule.reason = read.text("reason");
    if (read.has("below")) rule.below = read.number("below");
    if (read.has("above")) rule.above = read.number("above");
    if (!rule.below && !rule.above) read.fail("below", "required, or above");
    if (rule.below && rule.above && !(*rule.below < *rule.above))
        read.fail("above", "must be above `below`: what lies between them stays");
    const bool measure = std::find(plan.measures.begin(), plan.measures.end(), rule.value) != plan.measures.end();
    if (read.has("value") && !measure && !(rule.of_participants && isScale(rule.value)))
        read.fail("value",
                  rule.of_participants ? "is no measure or scale of this study" : "is no measure of this study");
    return rule;
}

}  // namespace

std::vector<plan::Analysis> readAnalyses(const std::vector<Node>& tables, const plan::StudyPlan& plan,
                                         const std::vector<std::string>& staircases, Errors& errors) {
    std::vector<plan::Analysis> analyses;
    for (const Node& table : tables) analyses.push_back(AnalysisReader(table, plan, staircases, errors).analysis());
    return analyses;
}

bool isDataRule(const Node& table) { return table.find("data") != nullptr; }

std::vector<plan::DataRule> readDataRules(const std::vector<Node>& tables, const plan::StudyPlan& plan,
                                          Errors& errors) {
    std::vector<plan::DataRule> rules;
    for (const Node& table : tables)
        if (isDataRule(table)) rules.push_back(readDataRule(table, plan, errors));
    return rules;
}

Errors checkScales(const plan::StudyPlan& plan, const std::vector<plan::PlannedQuestionnaire>& questionnaires) {
    Errors errors;
    const auto check = [&](const std::string& key, const std::string& value) {
        if (!isScale(value)) return;
        for (const plan::PlannedQuestionnaire& planned : questionnaires)
            for (const questionnaire::Scale& scale : planned.definition.scales)
                if (value == planned.definition.key + "." + scale.name) return;
        errors.push_back(errorAt({plan.source_path, 0, 0}, key, "\"" + value + "\"",
                                 "the study asks no questionnaire with this scale"));
    };
    for (const plan::Analysis& analysis : plan.analyses) check("analysis.outcome", analysis.outcome);
    for (const plan::DataRule& rule : plan.data_rules)
        if (rule.of_participants) check("exclude.value", rule.value);
    return errors;
}

}  // namespace passung::protocol
