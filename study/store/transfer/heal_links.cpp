#include "study/store/transfer/heal_links.h"

#include <map>

#include "study/store/schema/open_database.h"
#include "study/store/schema/row_hash.h"
#include "study/store/schema/session_tables.h"

namespace passung::store {
namespace {

/// Heals one column that refers to a parent; returns how many rows.
std::int64_t healColumn(const Database& database, const std::string& source, const SessionTable& table,
                        const TableColumn& column) {
    std::string same, equal;
    for (const TableColumn& other : table.columns) {
        if (&other != &column) same += " AND s." + other.name + " IS t." + other.name;
        equal += (equal.empty() ? "s." : " AND s.") + other.name + " IS m." + other.name;
    }
    const auto has_parent = [&](const std::string& row) {
        return "EXISTS(SELECT 1 FROM main." + column.parent + " p WHERE p." + column.parent_column + "=" + row + "." +
               column.name + ")";
    };
    const std::string there = " FROM " + source + "." + table.name + " s WHERE " + has_parent("s") + same +
                              " AND NOT EXISTS(SELECT 1 FROM main." + table.name + " m WHERE " + equal + ")";
    database.execute("UPDATE OR IGNORE main." + table.name + " AS t SET " + column.name + "=(SELECT s." + column.name +
                     there + ") WHERE t." + column.name + " IS NOT NULL AND NOT " + has_parent("t") +
                     " AND (SELECT count(*)" + there + ")=1");
    return database.changes();
}

}  // namespace

std::vector<std::string> healReferences(const Database& database, const std::string& source) {
    std::vector<std::string> healed;
    for (const BrokenReference& broken : brokenReferences(database)) {
        const SessionTable table = describeTable(database, broken.table);
        for (const TableColumn& column : table.columns) {
            if (column.parent != broken.parent) continue;
            if (const std::int64_t rows = healColumn(database, source, table, column); rows > 0)
                healed.push_back(std::to_string(rows) + (rows == 1 ? " row of " : " rows of ") + table.name +
                                 " without their " + column.parent);
        }
    }
    return healed;
}

std::vector<std::string> healHashNames(const Database& database) {
    std::vector<std::string> healed;
    // A hash is over the name too: nothing but the row itself fits it.
    struct Named {
        std::string table;
        StudyRow row;
    };
    std::map<std::string, Named> nameless;  // rows without a kept hash, by the hash that they have
    for (const SessionTable& table : studyTables(database)) {
        Statement kept = database.prepare("SELECT 1 FROM main.row_hash WHERE +table_name=? AND +row_key=?");
        for (const StudyRow& row : studyRows(database, "main", table))
            if (!kept.bind(table.name, row.key).step()) nameless.emplace(row.sha256, Named{table.name, row});
    }
    if (nameless.empty()) return healed;
    for (const RowFault& fault : rowFaults(database, "main")) {
        if (!fault.missing) continue;
        Statement kept = database.prepare("SELECT sha256 FROM main.row_hash WHERE +table_name=? AND +row_key=?");
        if (!kept.bind(fault.table, fault.key).step()) continue;
        const auto found = nameless.find(kept.text(0));
        if (found == nameless.end()) continue;
        const auto& [table, row] = found->second;
        database
            .prepare(
                "UPDATE main.row_hash SET table_name=?3, row_key=?4, participant_id=?5 WHERE +table_name=?1 AND "
                "+row_key=?2")
            .bind(fault.table, fault.key, table, row.key, nullIfEmpty(row.participant_id))
            .run();
        healed.push_back("the hash of " + table + " " + row.key);
    }
    return healed;
}

}  // namespace passung::store
