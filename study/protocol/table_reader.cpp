#include "study/protocol/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/assert.h"

namespace passung::protocol {
namespace {

constexpr std::size_t kMostMeant = 100;  // bytes of an unknown key that may be a known one, misspelt

bool isNumber(const Node& node) { return node.kind == Node::Kind::Number || node.kind == Node::Kind::Integer; }

/// What is wrong with a number; empty if nothing. Finite first: every comparison with NaN is false.
std::string numberFault(const Range& range, double value) {
    if (!std::isfinite(value)) return "must be a finite number";
    const bool fits = (range.low_excluded ? value > range.low : value >= range.low) && value <= range.high;
    return fits ? "" : requirement(range);
}

std::string vectorFault(const Node& value) {
    const bool three = value.items.size() == 3 && std::all_of(value.items.begin(), value.items.end(), isNumber);
    if (!three) return "must be a list of three numbers";
    const bool finite = std::all_of(value.items.begin(), value.items.end(),
                                    [](const Node& item) { return std::isfinite(item.number); });
    return finite ? "" : "must be finite numbers";
}

std::string choiceFault(const Key& key, const Node& value) {
    const auto choices = key.choiceList();
    if (std::find(choices.begin(), choices.end(), value.text) != choices.end()) return "";
    std::string text = "must be ";
    for (std::size_t i = 0; i < choices.size(); ++i)
        text += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ", choices[i]);
    return text;
}

std::string stiffnessFault(const Key& key, const Node& value) {
    if (isNumber(value)) return numberFault(key.range, value.number);
    return stiffnessFraction(value.text) ? ""
                                         : "must be a number, \"max\" or a fraction from 0 to 1 such as \"0.7 max\"";
}

bool isListOf(const Node& node, Node::Kind kind) {
    return node.kind == Node::Kind::List &&
           std::all_of(node.items.begin(), node.items.end(), [&](const Node& item) { return item.kind == kind; });
}

/// What the type asks for, if `value` is not of it; empty if it is.
std::string expectedKind(KeyType type, const Node& value) {
    using Kind = Node::Kind;
    const auto unless = [](bool fits, const char* expected) { return fits ? "" : expected; };
    switch (type) {
        case KeyType::Boolean:
            return unless(value.kind == Kind::Boolean, "true or false");
        case KeyType::Integer:
            return unless(value.kind == Kind::Integer, "an integer");
        case KeyType::Number:
        case KeyType::Length:
            return unless(isNumber(value), "a number");
        case KeyType::Text:
        case KeyType::Name:
        case KeyType::Choice:
            return unless(value.kind == Kind::Text, "a string");
        case KeyType::Depth:
            return unless(isNumber(value) || value.kind == Kind::Text, "a number or \"through\"");
        case KeyType::Stiffness:
            return unless(isNumber(value) || value.kind == Kind::Text, "a number or a string");
        case KeyType::Vector:
        case KeyType::LengthVector:
            return unless(value.kind == Kind::List, "a list of three numbers");
        case KeyType::Table:
            return unless(value.kind == Kind::Table, "a table");
        case KeyType::Tables:
            return unless(isListOf(value, Kind::Table), "a list of tables");
        case KeyType::Texts:
            return unless(isListOf(value, Kind::Text), "a list of strings");
        case KeyType::Levels:
            return unless(value.kind == Kind::List, "a list");
        case KeyType::Any:
            return "";
    }
    return "";
}

/// What is wrong with a value of the right kind; empty if nothing.
std::string valueFault(const Key& key, const Node& value) {
    switch (key.type) {
        case KeyType::Integer:
        case KeyType::Number:
        case KeyType::Length:
            return numberFault(key.range, value.number);
        case KeyType::Depth:
            if (value.kind == Node::Kind::Text) return value.text == "through" ? "" : "must be a number or \"through\"";
            return numberFault(key.range, value.number);
        case KeyType::Text:
            return value.text.empty() ? "must not be empty" : "";
        case KeyType::Name:
            return isName(value.text) ? "" : "must be lower-case letters, digits and _, beginning with a letter";
        case KeyType::Choice:
            return choiceFault(key, value);
        case KeyType::Stiffness:
            return stiffnessFault(key, value);
        case KeyType::Vector:
        case KeyType::LengthVector:
            return vectorFault(value);
        default:
            return "";
    }
}

}  // namespace

TableReader::TableReader(const Node& table, std::vector<std::string_view> tables, std::string path, Errors& errors)
    : table_(table), tables_(std::move(tables)), path_(std::move(path)), errors_(errors) {
    for (const Entry& entry : table.entries) {
        const Key* known = findKey(tables_, entry.key);
        if (known == nullptr)
            reportUnknown(entry);
        else if (check(*known, entry.value))
            sound_.push_back(&entry);
    }
    for (const Key& row : keys()) {
        const bool here = std::find(tables_.begin(), tables_.end(), row.table) != tables_.end();
        const bool meant = std::find(meant_.begin(), meant_.end(), row.name) != meant_.end();
        if (here && row.required() && !meant && table.find(row.name) == nullptr) fail(row.name, "required");
    }
}

void TableReader::reportUnknown(const Entry& entry) {
    std::vector<std::string_view> names;
    for (const Key& row : keys())
        if (std::find(tables_.begin(), tables_.end(), row.table) != tables_.end()) names.push_back(row.name);
    std::string message = "unknown key";
    const auto close = entry.key.size() <= kMostMeant ? closestWord(entry.key, names) : std::nullopt;
    if (close) meant_.push_back(*close);
    if (close)
        message += fmt::format("; did you mean \"{}\"?", *close);
    else
        message += names.empty() ? "; no key is known here" : fmt::format("; known keys: {}", fmt::join(names, ", "));
    errors_.push_back(errorAt(entry.place, pathOf(entry.key), "", message));
}

bool TableReader::check(const Key& key, const Node& value) const {
    const auto report = [&](std::string message) {
        errors_.push_back(errorAt(value.place, pathOf(key.name), valueText(value), std::move(message)));
        return false;
    };
    const auto expected = expectedKind(key.type, value);
    if (!expected.empty()) {
        const bool items = key.type == KeyType::Tables || key.type == KeyType::Texts;
        if (items && value.kind == Node::Kind::List) return report(fmt::format("must be {}", expected));
        return report(fmt::format("must be {}, not {}", expected, kindText(value)));
    }
    auto fault = valueFault(key, value);
    return fault.empty() || report(std::move(fault));
}

const Key& TableReader::key(std::string_view name) const {
    const Key* row = findKey(tables_, name);
    PASSUNG_ASSERT(row != nullptr);
    return *row;
}

const Node* TableReader::node(std::string_view name) const {
    for (const Entry* entry : sound_)
        if (entry->key == name) return &entry->value;
    return nullptr;
}

std::string TableReader::fallbackText(std::string_view name) const {
    const auto& row = key(name);
    return row.required() || row.fallback.starts_with('(') ? "" : std::string(row.fallback);
}

bool TableReader::boolean(std::string_view name) const {
    const Node* value = node(name);
    return value != nullptr ? value->boolean : fallbackText(name) == "true";
}

std::int64_t TableReader::integer(std::string_view name) const {
    const Node* value = node(name);
    return value != nullptr ? value->integer : static_cast<std::int64_t>(key(name).fallbackNumber().value_or(0.0));
}

double TableReader::number(std::string_view name) const {
    return numberOr(name, key(name).fallbackNumber().value_or(0.0) / unitsPerSi(name));
}

double TableReader::numberOr(std::string_view name, double absent) const {
    const Node* value = node(name);
    return value != nullptr ? value->number / unitsPerSi(name) : absent;
}

std::string TableReader::text(std::string_view name) const {
    const Node* value = node(name);
    return value != nullptr ? value->text : fallbackText(name);
}

Vec3 TableReader::vector(std::string_view name) const {
    const Node* value = node(name);
    if (value == nullptr) return Vec3::Zero();
    return {value->items[0].number, value->items[1].number, value->items[2].number};
}

const std::vector<Node>& TableReader::items(std::string_view name) const {
    static const std::vector<Node> none;
    const Node* value = node(name);
    return value != nullptr ? value->items : none;
}

void TableReader::fail(std::string_view name, std::string message) const {
    const Node* value = table_.find(name);
    const auto fallback = fallbackText(name);
    errors_.push_back(value == nullptr ? errorAt(table_.place, pathOf(name),
                                                 fallback.empty() ? "" : fallback + " (default)", std::move(message))
                                       : errorAt(value->place, pathOf(name), valueText(*value), std::move(message)));
}

std::string TableReader::pathOf(std::string_view name) const {
    return path_.empty() ? std::string(name) : fmt::format("{}.{}", path_, name);
}

bool isName(std::string_view text) {
    const auto letter = [](char c) { return c >= 'a' && c <= 'z'; };
    return !text.empty() && letter(text[0]) && std::all_of(text.begin(), text.end(), [&](char c) {
        return letter(c) || (c >= '0' && c <= '9') || c == '_';
    });
}

std::optional<double> stiffnessFraction(std::string_view text) {
    if (text == "max") return 1.0;
    double fraction = 0.0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), fraction);
    const std::string_view word(rest, static_cast<std::size_t>(text.data() + text.size() - rest));
    if (error != std::errc{} || word != " max" || !(fraction > 0.0 && fraction <= 1.0)) return std::nullopt;
    return fraction;
}

}  // namespace passung::protocol
