#include <algorithm>

#include "study/store/transfer/heal.h"

namespace passung::store {

std::vector<std::string> Healer::healRows() {
    std::vector<std::string> healed;
    const std::vector<SessionTable> tables = studyTables(database_);
    for (const RowFault& fault : rowFaults(database_, "main")) {
        const auto table =
            std::find_if(tables.begin(), tables.end(), [&](const SessionTable& t) { return t.name == fault.table; });
        if (table == tables.end() || !healRow(*table, fault, studyRows(database_, "main", *table))) continue;
        trustRow(database_, fault.table, fault.key);
        healed.push_back(titleOf(fault));
    }
    return healed;
}

/// The row there that has the hash which was kept here takes the damaged one's place. Where the name itself is damaged,
/// that is the one row that nobody knows.
bool Healer::healRow(const SessionTable& table, const RowFault& fault, const std::vector<StudyRow>& rows_here) {
    Statement find = database_.prepare("SELECT sha256 FROM main.row_hash WHERE table_name=? AND row_key=?");
    if (!find.bind(table.name, fault.key).step()) return false;
    const std::string kept = find.text(0);
    const auto rows_there = studyRows(database_, source_, table);
    const auto there =
        std::find_if(rows_there.begin(), rows_there.end(), [&](const StudyRow& row) { return row.key == fault.key; });
    if (there == rows_there.end()) return false;
    const auto here =
        std::find_if(rows_here.begin(), rows_here.end(), [&](const StudyRow& row) { return row.key == fault.key; });
    if (there->sha256 != kept) {
        // Is it the kept hash that is damaged?
        Statement other =
            database_.prepare("SELECT sha256 FROM " + source_ + ".row_hash WHERE table_name=? AND row_key=?");
        const bool same = here != rows_here.end() && here->sha256 == there->sha256 &&
                          other.bind(table.name, fault.key).step() && other.text(0) == here->sha256;
        if (!same) return false;
        database_.prepare("UPDATE main.row_hash SET sha256=?3 WHERE table_name=?1 AND row_key=?2")
            .bind(table.name, fault.key, here->sha256)
            .run();
        return true;
    }
    std::string columns;
    for (const TableColumn& column : table.columns)
        if (&column != table.number()) columns += (columns.empty() ? "" : ", ") + column.name;
    const std::string key = keyExpression(database_, table);
    const std::string row_there = "SELECT " + columns + " FROM " + source_ + "." + table.name + " WHERE " + key + "=?1";
    std::string old = fault.key;
    if (here == rows_here.end()) {
        std::vector<std::string> unknown;
        Statement known = database_.prepare("SELECT 1 FROM main.row_hash WHERE table_name=? AND row_key=?");
        for (const StudyRow& row : rows_here)
            if (!known.bind(table.name, row.key).step()) unknown.push_back(row.key);
        old = unknown.size() == 1 ? unknown.front() : std::string();
    }
    if (!old.empty())
        database_
            .prepare("UPDATE main." + table.name + " SET (" + columns + ")=(" + row_there + ") WHERE " + key + "=?2")
            .bind(fault.key, old)
            .run();
    else
        database_.prepare("INSERT INTO main." + table.name + "(" + columns + ") " + row_there).bind(fault.key).run();
    return true;
}

}  // namespace passung::store
