#include "study/protocol/block_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "study/design/trial_order.h"
#include "study/protocol/analysis_reader.h"
#include "study/protocol/session_rules.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {
namespace {

std::string blockPath(const Node& table) {
    const Node* name = table.find("name");
    const bool named = name != nullptr && name->kind == Node::Kind::Text && isName(name->text);
    return named ? "block." + name->text : "block";
}

plan::BlockOrder orderNamed(const std::string& name) {
    for (const plan::BlockOrder order : {plan::BlockOrder::Permutations, plan::BlockOrder::Random,
                                         plan::BlockOrder::Shuffled, plan::BlockOrder::Listed})
        if (name == plan::blockOrderName(order)) return order;
    return plan::BlockOrder::Williams;
}

plan::RestEnds restEndsNamed(const std::string& name) {
    for (const plan::RestEnds ends : {plan::RestEnds::ByParticipant, plan::RestEnds::ByExperimenter})
        if (name == plan::restEndsName(ends)) return ends;
    return plan::RestEnds::ByTime;
}

std::string unknownWord(const char* what, const std::string& word, const std::vector<std::string_view>& known) {
    if (const auto close = closestWord(word, known))
        return fmt::format("unknown {}; did you mean \"{}\"?", what, *close);
    return fmt::format("unknown {}; known: {}", what, fmt::join(known, ", "));
}

/// The factor of this name, or what is wrong with the name.
std::optional<std::size_t> findFactor(const std::vector<plan::Factor>& factors, const std::string& name,
                                      std::string& fault) {
    std::vector<std::string_view> known;
    for (std::size_t f = 0; f < factors.size(); ++f) {
        if (factors[f].name == name) return f;
        known.push_back(factors[f].name);
    }
    fault = unknownWord("factor", name, known);
    return std::nullopt;
}

std::optional<std::size_t> findLevel(const plan::Factor& factor, const std::string& label, std::string& fault) {
    std::vector<std::string_view> known;
    for (std::size_t i = 0; i < factor.levels.size(); ++i) {
        if (factor.levels[i].label == label) return i;
        known.push_back(factor.levels[i].label);
    }
    fault = unknownWord("level", label, known);
    return std::nullopt;
}

/// Reads one rule for orders.
class ConstraintReader {
public:
    ConstraintReader(const Node& table, const TableReader& read, const std::vector<plan::Factor>& factors)
        : table_(table), read_(read), factors_(factors) {}

    design::Constraint constraint() {
        using design::Rule;
        const std::string rule = read_.text("rule");
        const bool by_level = rule == "first_not" || rule == "position_window";
        const bool counted = rule == "max_run" || rule == "min_distance";
        allow("count", counted, rule);
        allow("level", by_level, rule);
        for (const char* key : {"from", "to"}) allow(key, rule == "position_window", rule);
        design::Constraint result;
        result.rule = rule == "min_distance"      ? Rule::MinDistance
                      : rule == "first_not"       ? Rule::FirstNot
                      : rule == "position_window" ? Rule::PositionWindow
                                                  : Rule::MaxRun;
        result.count = counted ? static_cast<std::size_t>(read_.integer("count")) : 1;
        result.from = static_cast<std::size_t>(read_.integer("from"));
        result.to = static_cast<std::size_t>(read_.integer("to"));
        if (rule == "position_window" && result.to < result.from && read_.has("to"))
            read_.fail("to", "must be at least from");
        readClass(rule, by_level, result);
        return result;
    }

private:
    /// The key is there if and only if the rule has it; `from` alone may be left out.
    void allow(const char* key, bool wanted, const std::string& rule) {
        if (read_.has(key) && !wanted) read_.fail(key, fmt::format("is not for the rule {}", rule));
        if (table_.find(key) == nullptr && wanted && std::string_view(key) != "from")
            read_.fail(key, fmt::format("required by the rule {}", rule));
    }

    void readClass(const std::string& rule, bool by_level, design::Constraint& result) {
        if (rule == "no_repeat") return allow("factor", false, rule);
        if (!read_.has("factor")) return read_.fail("factor", fmt::format("required by the rule {}", rule));
        std::string fault;
        result.factor = findFactor(factors_, read_.text("factor"), fault);
        if (!result.factor) return read_.fail("factor", fault);
        if (!by_level || !read_.has("level")) return;
        if (const auto level = findLevel(factors_[*result.factor], read_.text("level"), fault))
            result.chosen = *level;
        else
            read_.fail("level", fault);
    }

    const Node& table_;
    const TableReader& read_;
    const std::vector<plan::Factor>& factors_;
};

void readBlocked(const TableReader& read, const std::vector<plan::Factor>& factors, plan::Block& block) {
    block.blocked_order = orderNamed(read.text("blocked_order"));
    if (!read.has("blocked")) {
        if (read.has("blocked_order")) read.fail("blocked_order", "is for blocks with blocked");
        return;
    }
    std::string fault;
    block.blocked = findFactor(factors, read.text("blocked"), fault);
    if (!block.blocked) return read.fail("blocked", fault);
    const plan::Factor& factor = factors[*block.blocked];
    if (factor.kind != plan::FactorKind::Within) read.fail("blocked", "must be a within factor");
    if (std::any_of(factor.levels.begin(), factor.levels.end(), [](const plan::Level& l) { return l.catch_trial; }))
        read.fail("blocked", "must not have levels with catch = true");
}

void readCatches(const TableReader& read, plan::Block& block) {
    block.catches.trials = static_cast<std::size_t>(read.integer("catch_trials"));
    block.catches.from = static_cast<std::size_t>(read.integer("catch_from"));
    block.catches.to = static_cast<std::size_t>(read.integer("catch_to"));
    for (const char* key : {"catch_from", "catch_to"})
        if (block.catches.trials == 0 && read.has(key)) read.fail(key, "is for blocks with catch_trials");
}

}  // namespace

std::vector<plan::Block> readBlocks(const std::vector<Node>& tables, const std::vector<plan::Factor>& factors,
                                    Errors& errors) {
    std::vector<plan::Block> blocks;
    std::set<std::string> names;
    for (const Node& table : tables) {
        const std::string path = blockPath(table);
        const TableReader read(table, {"block"}, path, errors);
        plan::Block block;
        block.name = read.text("name");
        block.phase = read.text("phase") == "practice" ? plan::Phase::Practice : plan::Phase::Main;
        block.repetitions = static_cast<int>(read.integer("repetitions"));
        block.order = orderNamed(read.text("order"));
        block.trials = static_cast<int>(read.integer("trials"));
        block.session = static_cast<int>(read.integer("session"));
        block.rest = read.number("rest_s");
        block.rest_ends = restEndsNamed(read.text("rest_ends"));
        if (read.has("rest_ends") && !(block.rest > 0.0)) read.fail("rest_ends", "is for blocks with rest_s");
        if (read.has("name") && !names.insert(block.name).second) read.fail("name", "two blocks have this name");
        readBlocked(read, factors, block);
        readCatches(read, block);
        for (const Node& item : read.items("constraints")) {
            const TableReader constraint(item, {"constraint"}, path + ".constraints", errors);
            if (constraint.has("rule"))
                block.constraints.push_back(ConstraintReader(item, constraint, factors).constraint());
        }
        const int last = blocks.empty() ? 1 : blocks.back().session;
        if (block.session != last && block.session != last + (blocks.empty() ? 0 : 1))
            read.fail("session", blocks.empty()
                                     ? "the first block belongs to session 1"
                                     : fmt::format("must be {} or {}: sessions follow one another", last, last + 1));
        readRepeats(read, block);
        blocks.push_back(std::move(block));
    }
    const auto is_main = [](const plan::Block& block) { return block.phase == plan::Phase::Main; };
    if (!tables.empty() && std::none_of(blocks.begin(), blocks.end(), is_main))
        errors.push_back(errorAt(tables.front().place, "block", "",
                                 "a study needs a block with phase = \"main\": analyses leave practice out"));
    return blocks;
}

void checkBlocks(const std::vector<Node>& tables, const plan::StudyPlan& plan, Errors& errors) {
    for (const design::Problem& problem : design::problemsOf(plan::designOf(plan))) {
        const Node& table = tables[problem.block];
        const std::string path = blockPath(table);
        const TableReader read(table, {"block"}, path, errors);
        if (std::string_view(problem.key) != "constraints") {
            read.fail(problem.key, problem.message);
            continue;
        }
        const Node& item = read.items("constraints")[problem.item];
        const Node* rule = item.find("rule");
        errors.push_back(errorAt(item.place, path + ".constraints", rule->text, problem.message));
    }
}

LevelPattern readPattern(const Node& table, const std::string& path, const std::vector<plan::Factor>& factors,
                         Errors& errors) {
    LevelPattern pattern(factors.size());
    if (table.entries.empty()) errors.push_back(errorAt(table.place, path, "", "names no factor"));
    for (const Entry& entry : table.entries) {
        const auto report = [&](const TextPosition& place, std::string value, std::string message) {
            errors.push_back(errorAt(place, path + "." + entry.key, std::move(value), std::move(message)));
        };
        std::string fault;
        const auto factor = findFactor(factors, entry.key, fault);
        if (!factor) {
            report(entry.place, "", fault);
            continue;
        }
        if (factors[*factor].kind == plan::FactorKind::Nuisance)
            report(entry.place, "", "a nuisance factor's levels are assigned to every condition");
        pattern[*factor] = findLevel(factors[*factor], labelText(entry.value), fault);
        if (!pattern[*factor]) report(entry.value.place, valueText(entry.value), fault);
    }
    return pattern;
}

bool matches(const LevelPattern& pattern, const std::vector<std::size_t>& levels) {
    for (std::size_t f = 0; f < levels.size(); ++f)
        if (pattern[f] && *pattern[f] != levels[f]) return false;
    return true;
}

std::vector<LevelPattern> readExclusions(const std::vector<Node>& tables, const std::vector<plan::Factor>& factors,
                                         Errors& errors) {
    std::vector<LevelPattern> exclusions;
    for (const Node& table : tables)
        if (!isDataRule(table)) exclusions.push_back(readPattern(table, "exclude", factors, errors));
    return exclusions;
}

bool isExcluded(const std::vector<LevelPattern>& exclusions, const std::vector<std::size_t>& levels) {
    return std::any_of(exclusions.begin(), exclusions.end(),
                       [&](const LevelPattern& exclusion) { return matches(exclusion, levels); });
}

}  // namespace passung::protocol
