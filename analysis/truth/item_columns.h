#pragma once

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace passung::truth {

// Tables of accuracy: a column says in one place what it means and where its cells come from.

inline std::string cell(double value) { return std::isnan(value) ? "NA" : fmt::format("{:.6g}", value); }

template <class Item>
struct ItemColumn {
    std::string name, unit, meaning;
    std::function<std::string(const Item&)> text;
};

template <class Item>
std::string csv(const std::vector<ItemColumn<Item>>& columns, const std::vector<Item>& items) {
    std::string text;
    for (const auto& column : columns) text += (text.empty() ? "" : ",") + column.name;
    for (const Item& item : items) {
        text += '\n';
        for (std::size_t i = 0; i < columns.size(); ++i) text += (i > 0 ? "," : "") + columns[i].text(item);
    }
    return text + '\n';
}

inline constexpr const char* kCodebookHeader = "file,column,unit,meaning\n";

template <class Item>
std::string codebookOf(const char* file, const std::vector<ItemColumn<Item>>& columns) {
    std::string text;
    for (const auto& column : columns)
        text += fmt::format("{},{},{},\"{}\"\n", file, column.name, column.unit, column.meaning);
    return text;
}

}  // namespace passung::truth
