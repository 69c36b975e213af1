#pragma once

#include <map>
#include <string>

#include "study/store/schema/session_tables.h"

namespace passung::store {

/// What a row says, as one text that no other row has: its values by their columns' names, those that are their
/// column's default left out. For this room only.
class RowText {
public:
    explicit RowText(const std::string& table) : table_(table) {}

    void add(const std::string& column, const std::string& value);
    /// The value as it is stored; numbers in full. Nothing for the column's default, and for samples.
    void add(const TableColumn& column, const Statement& row, int at);

    std::string sha256() const;

private:
    std::string table_;
    std::map<std::string, std::string> values_;  // by column
};

}  // namespace passung::store
