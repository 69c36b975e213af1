#include "analysis/export/table.h"

#include <array>
#include <charconv>
#include <cmath>

namespace passung::exporter {
namespace {

template <class Number>
std::string shortest(Number value) {
    if (!std::isfinite(value)) return kMissing;
    std::array<char, 32> digits{};
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return {digits.data(), end};
}

template <class Fields, class Text>
void appendLine(std::string& text, const Fields& fields, Text text_of) {
    bool first = true;
    for (const auto& field : fields) {
        if (!first) text += ',';
        first = false;
        appendField(text, text_of(field));
    }
    text += '\n';
}

}  // namespace

ColumnLevels::ColumnLevels(std::initializer_list<std::string_view> texts) : names(texts.begin(), texts.end()) {}

Column describe(std::string_view name, std::string_view label, std::string_view type, const ColumnDetails& details) {
    return {std::string(name),
            std::string(label),
            std::string(details.unit),
            std::string(type),
            std::string(details.formula),
            details.formula_version,
            details.levels.names,
            details.typed};
}

std::string cell(std::int64_t value) { return std::to_string(value); }
std::string cell(double value) { return shortest(value); }
std::string cell(float value) { return shortest(static_cast<double>(value)); }
std::string cell(bool value) { return value ? "1" : "0"; }
std::string cell(const std::string& value) { return value; }
std::string cell(const char* value) { return value; }
std::string cell(const std::optional<std::string>& value) { return value.value_or(kMissing); }
std::string cell(const std::optional<std::int64_t>& value) { return value ? cell(*value) : kMissing; }
std::string cell(const std::optional<double>& value) { return value ? cell(*value) : kMissing; }

std::string joined(const std::vector<std::string>& texts, std::string_view between) {
    std::string all;
    for (const std::string& text : texts) all.append(all.empty() ? std::string_view() : between).append(text);
    return all;
}

std::string secondsCell(const std::optional<std::int64_t>& nanoseconds) {
    if (!nanoseconds) return kMissing;
    return cell(static_cast<double>(*nanoseconds) / 1e9);
}

void appendField(std::string& line, std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
        line += text;
        return;
    }
    line += '"';
    for (const char c : text) {
        if (c == '"') line += '"';
        line += c;
    }
    line += '"';
}

Result<Done> forEachRow(const Table& table, const TakeRow& take) {
    for (const TableRow& row : table.rows) take(row);
    return table.more ? table.more(take) : Done{};
}

Result<Done> writeCsv(const Table& table, const std::function<void(TableRow&)>& change, const TakeText& take) {
    constexpr std::size_t kPiece = 1 << 16;
    std::string text;
    appendLine(text, table.columns, [](const Column& column) -> std::string_view { return column.name; });
    auto done = forEachRow(table, [&](TableRow row) {
        if (change) change(row);
        appendLine(text, row, [](const std::string& field) -> std::string_view { return field; });
        if (text.size() < kPiece) return;
        take(text);
        text.clear();
    });
    take(text);
    return done;
}

std::string toCsv(const Table& table) {
    std::string text;
    (void)writeCsv(table, {}, [&text](std::string_view piece) { text += piece; });
    return text;
}

}  // namespace passung::exporter
