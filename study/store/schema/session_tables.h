#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/store/schema/sqlite.h"

namespace passung::store {

// Which tables hang on a session, found by the schema's own foreign keys, so that what later revisions add is copied,
// merged and pushed without further ado. For this room only: the functions throw.

struct TableColumn {
    std::string name;
    std::string type;     // INTEGER, REAL, TEXT, BLOB
    int key = 0;          // place in the primary key from 1; 0: none
    bool filled = false;  // never NULL
    std::string parent;   // table that it refers to; empty: none
    std::string parent_column;
    std::optional<std::string> fallback = {};  // its default as text; empty: NULL
};

struct SessionTable {
    std::string name;
    std::vector<TableColumn> columns;

    const TableColumn* find(const std::string& column) const;
    /// The column that numbers the rows, if one does: an integer primary key that refers to nothing.
    const TableColumn* number() const;
};

SessionTable describeTable(const Database& database, const std::string& name);

/// "a, b, c": all columns, as they stand in a statement.
std::string columnNames(const SessionTable& table);

/// Names of all tables of the file, in the order in which the schema made them.
std::vector<std::string> tableNames(const Database& database);

/// The table `session` and every table whose rows belong to one session; parents come before their children.
std::vector<SessionTable> sessionTables(const Database& database);

/// Condition on the rows of `table` that belong to the session ?1, in the attached database `schema`.
std::string rowsOfSession(const std::vector<SessionTable>& tables, const SessionTable& table,
                          const std::string& schema);

/// The table of `tables` that this column takes its numbers from: its own, or that which it refers to; nullptr: it is
/// no number of a row.
const SessionTable* numberedBy(const std::vector<SessionTable>& tables, const SessionTable& table,
                               const TableColumn& column);

/// SHA-256 over everything that a session is, whatever numbers its rows have in this file.
std::string sessionDigest(const Database& database, const std::vector<SessionTable>& tables, const std::string& schema,
                          const std::string& session_id);

}  // namespace passung::store
