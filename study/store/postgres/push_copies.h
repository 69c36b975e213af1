#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/store/schema/session_tables.h"

namespace passung::store {

// The tables as PostgreSQL gets them. For push.cpp only: the functions throw.

using Values = std::vector<std::optional<std::string>>;

/// A table as PostgreSQL gets it, and the query that reads its rows here.
struct Copy {
    std::string name;
    std::vector<TableColumn> columns;
    std::vector<std::string> keys;
    std::string reference;  // clause of a foreign key; may be empty
    std::string query;      // columns in their order; of a session: ?1 is its id
};

template <class Items, class Text>
std::string joined(const Items& items, Text text) {
    std::string all;
    for (const auto& item : items) all += (all.empty() ? "" : ", ") + text(item);
    return all;
}

inline std::string nameOf(const TableColumn& column) { return column.name; }

std::string typeThere(const std::string& type);

/// Values as texts that PostgreSQL reads.
Values valuesOf(const Statement& row, const std::vector<TableColumn>& columns);

/// Rows that do not belong to a session. Their numbers mean nothing outside this file and stay here.
std::vector<Copy> studyCopies(const Database& database);

std::vector<Copy> sessionCopies(const std::vector<SessionTable>& tables);

}  // namespace passung::store
