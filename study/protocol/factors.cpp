#include "study/protocol/factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "study/protocol/table_reader.h"

namespace passung::protocol {
namespace {

/// Columns that every export has; a factor of that name could not be told from them.
constexpr std::array kReservedNames{
    "participant_id",  "kind",           "group",       "session",      "station",        "device",
    "block",           "phase",          "block_index", "trial_index",  "trial_in_block", "attempt_no",
    "attempt_id",      "repetition",     "condition",   "start_s",      "duration_s",     "outcome",
    "valid",           "invalid_reason", "n_ticks",     "overruns",     "app_version",    "protocol_sha256",
    "dropped_samples", "n_trials",       "n_success",   "success_share"};

constexpr std::size_t kMostSegments = 8;  // of a path: each may make a table

constexpr std::string_view kMissing = "NA";

bool isScalar(const Node& node) {
    return node.kind == Node::Kind::Boolean || node.kind == Node::Kind::Integer || node.kind == Node::Kind::Number ||
           node.kind == Node::Kind::Text;
}

bool isLabel(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(),
                                        [](char c) { return c != '/' && static_cast<unsigned char>(c) >= 0x20; });
}

/// Reads the levels of one factor.
class LevelReader {
public:
    LevelReader(const TableReader& factor, FactorContent& content, Errors& errors)
        : factor_(factor), content_(content), errors_(errors) {}

    void read(const Node& level) {
        const bool table = level.kind == Node::Kind::Table;
        std::string label = table ? "" : labelText(level);
        if (table)
            readTable(level, label);
        else if (isScalar(level))
            setKey(level);
        else
            report(level.place, valueText(level), "a level that is a list needs a label: { label = ..., value = ... }");
        if (label == kMissing) {
            report(level.place, fmt::format("\"{}\"", label), "stands for a missing value in exports");
        } else if (isLabel(label)) {
            if (!labels_.insert(label).second)
                report(level.place, fmt::format("\"{}\"", label), "two levels have this label");
        } else if (errors_.size() == before_) {
            report(level.place, fmt::format("\"{}\"", label), "a label must not be empty nor contain \"/\"");
        }
        content_.factor.levels.push_back({label, catch_trial_});
        catch_trial_ = false;
        content_.overrides.push_back(std::move(overrides_));
        overrides_.clear();
        content_.sound.push_back(errors_.size() == before_);
        before_ = errors_.size();
    }

private:
    void readTable(const Node& level, std::string& label) {
        const TableReader read(level, {"level"}, factor_.pathOf("levels"), errors_);
        const Node* value = level.find("value");
        const Node* set = level.find("set");
        label = read.text("label");
        catch_trial_ = read.boolean("catch");
        if (catch_trial_ && content_.factor.kind != plan::FactorKind::Within)
            read.fail("catch", "only levels of a within factor can be catch trials");
        if ((value == nullptr) == (set == nullptr)) {
            report(level.place, "", "a level needs either a value or a set");
        } else if (value != nullptr) {
            if (!read.has("label") && isScalar(*value)) label = labelText(*value);
            setKey(*value);
        } else if (read.has("set")) {
            if (factor_has_key_) report(set->place, "", "set is for factors without a key");
            for (const Entry& entry : set->entries) overrides_.push_back({entry.key, entry.place, &entry.value});
        }
        if (level.find("label") == nullptr && label.empty() && errors_.size() == before_)
            report(level.place, "", "a level with a list or a set needs a label");
    }

    void setKey(const Node& value) {
        if (const Node* key = factor_.node("key"))
            overrides_.push_back({key->text, key->place, &value});
        else
            report(value.place, valueText(value), "a value needs the factor's key; without a key use set");
    }

    void report(const TextPosition& place, std::string value, std::string message) {
        errors_.push_back(errorAt(place, factor_.pathOf("levels"), std::move(value), std::move(message)));
    }

    const TableReader& factor_;
    FactorContent& content_;
    Errors& errors_;
    bool factor_has_key_ = factor_.has("key");
    std::size_t before_ = errors_.size();
    bool catch_trial_ = false;
    std::vector<Override> overrides_;
    std::set<std::string> labels_;
};

/// Two factors that change the same key would undo one another.
void checkOverlaps(const std::vector<FactorContent>& factors, Errors& errors) {
    for (std::size_t i = 0; i < factors.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            for (const auto& level : factors[i].overrides)
                for (const auto& change : level)
                    for (const auto& other_level : factors[j].overrides)
                        for (const auto& other : other_level)
                            if (overlap(change.path, other.path))
                                errors.push_back(
                                    errorAt(change.path_place, "factor." + factors[i].factor.name, change.path,
                                            fmt::format("is also changed by factor {}", factors[j].factor.name)));
}

std::vector<std::string> splitPath(const std::string& path) {
    std::vector<std::string> segments{""};
    for (const char c : path) {
        if (c == '.')
            segments.emplace_back();
        else
            segments.back() += c;
    }
    return segments;
}

/// Tables that a path leads into by their names.
struct NamedTables {
    std::string_view begin;  // of the path
    const char* list;        // in its table
    const char* missing;
    const char* other_name_key = "name";  // of a table that has no name
};
constexpr NamedTables kParts{"part.", "part", "the scene has no part of this name"};
constexpr NamedTables kHands{"hand.", "hand", "the scene has no further hand of this name"};
constexpr NamedTables kSteps{"task.step.", "step", "the task has no step of this name", "part"};

/// The one of this name; nullptr if there is none.
Node* findNamed(Node& table, const NamedTables& tables, const std::string& name) {
    Node* list = table.find(tables.list);
    if (list == nullptr) return nullptr;
    for (Node& one : list->items) {
        const Node* own = one.find("name");
        if (own == nullptr) own = one.find(tables.other_name_key);
        if (own != nullptr && own->text == name) return &one;
    }
    return nullptr;
}

}  // namespace

bool overlap(const std::string& a, const std::string& b) {
    return a == b || a.starts_with(b + ".") || b.starts_with(a + ".");
}

std::vector<FactorContent> readFactors(const std::vector<Node>& tables, std::span<const std::string> taken_names,
                                       Errors& errors) {
    std::vector<FactorContent> factors;
    std::set<std::string> names;
    for (const Node& table : tables) {
        const Node* name = table.find("name");
        const bool named = name != nullptr && name->kind == Node::Kind::Text && isName(name->text);
        const TableReader read(table, {"factor"}, named ? "factor." + name->text : "factor", errors);
        FactorContent content;
        content.factor.name = read.text("name");
        content.factor.unit = read.text("unit");
        const auto kind = read.text("kind");
        content.factor.kind = kind == "between"    ? plan::FactorKind::Between
                              : kind == "nuisance" ? plan::FactorKind::Nuisance
                                                   : plan::FactorKind::Within;
        if (named && !names.insert(name->text).second) read.fail("name", "two factors have this name");
        const auto among = [&](const auto& taken) {
            return named && std::find(taken.begin(), taken.end(), name->text) != taken.end();
        };
        if (among(kReservedNames) || among(taken_names))
            read.fail("name", "is a column of every export; choose another name");
        if (read.has("levels") && read.items("levels").size() < 2) read.fail("levels", "needs at least two levels");
        LevelReader levels(read, content, errors);
        for (const Node& level : read.items("levels")) levels.read(level);
        factors.push_back(std::move(content));
    }
    checkOverlaps(factors, errors);
    return factors;
}

void applyOverride(const Override& change, StudyTables& tables, Errors& errors) {
    const auto report = [&](std::string message) {
        errors.push_back(errorAt(change.path_place, "factor", change.path, std::move(message)));
    };
    const auto segments = splitPath(change.path);
    if (segments[0] == "scene" && segments.size() > 1)
        return report(fmt::format("keys of the scene are written without \"scene.\": did you mean \"{}\"?",
                                  change.path.substr(segments[0].size() + 1)));
    if (std::count(segments.begin(), segments.end(), "") > 0)
        return report("is no path of keys such as contact.method");
    if (segments.size() > kMostSegments) return report(fmt::format("must have at most {} parts", kMostSegments));
    std::size_t next = 0;
    Node* table = &tables.scene;
    if (segments[0] == "task" || segments[0] == "feedback" || segments[0] == "secondary") {
        table = segments[0] == "task" ? &tables.task : segments[0] == "feedback" ? &tables.feedback : &tables.secondary;
        next = 1;
    }
    if (change.path == "part") return report("names all parts, not a key of one");
    for (const NamedTables& named : {kParts, kHands, kSteps}) {
        if (!change.path.starts_with(named.begin)) continue;
        table = findNamed(*table, named, segments[next + 1]);
        if (table == nullptr) return report(named.missing);
        if (named.begin != kParts.begin && segments.back() == "name") return report("is what factors find it by");
        next += 2;
    }
    if (next >= segments.size()) return report("names a table, not a key in it");
    for (; next + 1 < segments.size(); ++next) {
        Node* inner = table->find(segments[next]);
        if (inner == nullptr) {
            table->entries.push_back({segments[next], change.path_place, emptyTable(change.path_place)});
            inner = &table->entries.back().value;
        }
        if (inner->kind != Node::Kind::Table) return report(fmt::format("{} is no table", segments[next]));
        table = inner;
    }
    if (Node* value = table->find(segments[next]))
        *value = *change.value;
    else
        table->entries.push_back({segments[next], change.path_place, *change.value});
}

std::vector<std::vector<std::size_t>> combinations(const std::vector<FactorContent>& factors) {
    std::vector<std::vector<std::size_t>> all{{}};
    for (const auto& factor : factors) {
        std::vector<std::vector<std::size_t>> longer;
        for (const auto& combination : all)
            for (std::size_t level = 0; level < factor.factor.levels.size(); ++level) {
                if (!factor.sound[level]) continue;
                longer.push_back(combination);
                longer.back().push_back(level);
            }
        all = std::move(longer);
    }
    return all;
}

}  // namespace passung::protocol
