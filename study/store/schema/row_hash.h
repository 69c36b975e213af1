#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "study/store/schema/session_tables.h"

namespace passung::store {

// SHA-256 of every row that belongs to no session: protocols, conditions, people, slots … kept by what
// names the row, whatever its number. For this room only: the functions throw.

/// From now on every transaction of this connection keeps the hashes of the study's rows that it adds or changes. A row
/// that does not fit its hash now keeps that hash, whatever changes in it, and so stays known as damaged.
void watchStudyRows(Database& database);

/// The row fits its hash again: its changes are kept from here on.
void trustRow(const Database& database, const std::string& table, const std::string& key);

/// Keeps the hashes of rows that have none yet.
void sealNewRows(const Database& database);

/// A row that is not as it was written.
struct RowFault {
    std::string table, key;      // what names the row
    std::string participant_id;  // whose row it is; empty: nobody's
    bool missing = false;        // there is no such row any more
};
/// What else a look at the rows found.
struct RowsSeen {
    std::int64_t hashed = 0, not_hashed = 0;  // rows with and without a kept hash
    std::vector<std::string> unreadable;      // tables
};
/// Of the attached database `schema`. Rows without a kept hash are none. Without `seen` it throws at a table that
/// cannot be read.
std::vector<RowFault> rowFaults(const Database& database, const std::string& schema, RowsSeen* seen = nullptr);

/// "participant P001"
std::string titleOf(const RowFault& fault);

/// The tables in question.
std::vector<SessionTable> studyTables(const Database& database);

/// An expression of the row's name (StudyRow::key) in SQL.
std::string keyExpression(const Database& database, const SessionTable& table);

/// A row's name and hash, to be found in every copy of the file.
struct StudyRow {
    std::string key, participant_id, sha256;
    std::int64_t rowid = 0;  // 0: the table has none
};
std::vector<StudyRow> studyRows(const Database& database, const std::string& schema, const SessionTable& table);

}  // namespace passung::store
