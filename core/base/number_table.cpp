#include "core/base/number_table.h"

#include <charconv>
#include <fstream>
#include <string_view>

namespace passung {

namespace {

std::vector<std::string_view> cells(std::string_view line) {
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    std::vector<std::string_view> result;
    for (;;) {
        const std::size_t comma = line.find(',');
        result.push_back(line.substr(0, comma));
        if (comma == std::string_view::npos) return result;
        line.remove_prefix(comma + 1);
    }
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '+')) text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

}  // namespace

Result<NumberTable> readNumbers(const std::string& path, const std::vector<std::string>& required) {
    std::ifstream file(path);
    if (!file) return Error{.message = "cannot be read", .file = path};
    std::string line;
    if (!std::getline(file, line)) return Error{.message = "is empty; a header row is required", .file = path};
    NumberTable table;
    for (const auto name : cells(line)) table.columns.emplace_back(trimmed(name));
    for (std::size_t i = 0; i < required.size(); ++i) {
        if (i < table.columns.size() && table.columns[i] == required[i]) continue;
        return Error{.message = "the header's column " + std::to_string(i + 1) + " must be " + required[i],
                     .file = path,
                     .line = 1,
                     .column = 1,
                     .value = i < table.columns.size() ? table.columns[i] : "missing"};
    }
    Errors errors;
    for (int number = 2; std::getline(file, line); ++number) {
        if (trimmed(line).empty() || trimmed(line) == "\r") continue;
        const auto row = cells(line);
        if (row.size() != table.columns.size()) {
            errors.push_back({.message = "a row needs " + std::to_string(table.columns.size()) + " values",
                              .file = path,
                              .line = number,
                              .column = 1,
                              .value = std::to_string(row.size())});
            continue;
        }
        std::vector<double> values;
        for (const auto cell : row) {
            const std::string_view text = trimmed(cell);
            double value = 0.0;
            const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
            if (problem != std::errc() || end != text.data() + text.size()) {
                errors.push_back({.message = "must be a number",
                                  .file = path,
                                  .line = number,
                                  .column = static_cast<int>(cell.data() - line.data()) + 1,
                                  .key = table.columns[values.size()],
                                  .value = std::string(text)});
            }
            values.push_back(value);
        }
        table.rows.push_back(std::move(values));
    }
    if (!errors.empty()) return errors;
    if (table.rows.empty()) return Error{.message = "has no rows", .file = path};
    return table;
}

}  // namespace passung
