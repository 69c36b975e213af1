#include "study/store/schema/row_text.h"

#include <bit>

#include "core/base/digest.h"

namespace passung::store {

void RowText::add(const std::string& column, const std::string& value) { values_[column] = value; }

void RowText::add(const TableColumn& column, const Statement& row, int at) {
    if (column.type == "BLOB") return;
    if (row.isNull(at)) {
        if (column.fallback) values_[column.name] = "NULL";
        return;
    }
    const std::string value =
        column.type == "REAL" ? std::to_string(std::bit_cast<std::uint64_t>(row.real(at))) : row.text(at);
    if (column.fallback && column.type != "REAL" && value == *column.fallback) return;
    values_[column.name] = value;
}

std::string RowText::sha256() const {
    std::string text = table_ + ";";
    for (const auto& [column, value] : values_) text += column + "=" + std::to_string(value.size()) + ":" + value + ";";
    return sha256Hex(text);
}

}  // namespace passung::store
