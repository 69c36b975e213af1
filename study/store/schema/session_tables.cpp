#include "study/store/schema/session_tables.h"

#include <algorithm>
#include <bit>
#include <map>
#include <stdexcept>

#include "core/base/digest.h"

namespace passung::store {
namespace {

const SessionTable* findTable(const std::vector<SessionTable>& tables, const std::string& name) {
    const auto found =
        std::find_if(tables.begin(), tables.end(), [&](const SessionTable& table) { return table.name == name; });
    return found == tables.end() ? nullptr : &*found;
}

/// The column by which a row belongs to a row of another table of `tables`.
const TableColumn* belongsBy(const std::vector<SessionTable>& tables, const SessionTable& table) {
    for (const TableColumn& column : table.columns)
        if (column.filled && column.parent != table.name && findTable(tables, column.parent) != nullptr) return &column;
    return nullptr;
}

/// One value as bytes that no other value has.
void addValue(Sha256& digest, const Statement& row, int column, const TableColumn& what, std::int64_t base) {
    if (row.isNull(column)) return digest.update("N;");
    std::string bytes;
    if (what.type == "INTEGER") {
        bytes = std::to_string(row.integer(column) - base);
    } else if (what.type == "REAL") {
        bytes = std::to_string(std::bit_cast<std::uint64_t>(row.real(column)));
    } else if (what.type == "BLOB") {
        const auto blob = row.blob(column);
        bytes.assign(reinterpret_cast<const char*>(blob.data()), blob.size());
    } else {
        bytes = row.text(column);
    }
    digest.update(std::to_string(bytes.size()) + ":" + bytes + ";");
}

}  // namespace

const TableColumn* SessionTable::find(const std::string& column) const {
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const TableColumn& c) { return c.name == column; });
    return found == columns.end() ? nullptr : &*found;
}

const TableColumn* SessionTable::number() const {
    const TableColumn* number = nullptr;
    for (const TableColumn& column : columns) {
        if (column.key == 0) continue;
        if (column.key > 1 || column.type != "INTEGER" || !column.parent.empty()) return nullptr;
        number = &column;
    }
    return number;
}

SessionTable describeTable(const Database& database, const std::string& name) {
    SessionTable table{name, {}};
    Statement columns = database.prepare(
        "SELECT name, type, pk, \"notnull\", trim(dflt_value, char(39)) FROM pragma_table_info(?) ORDER BY cid");
    columns.bind(name);
    while (columns.step()) {
        const int key = static_cast<int>(columns.integer(2));
        table.columns.push_back({columns.text(0),
                                 columns.text(1),
                                 key,
                                 key > 0 || columns.integer(3) != 0,
                                 {},
                                 {},
                                 columns.optionalText(4)});
    }
    Statement keys = database.prepare("SELECT \"from\", \"table\", \"to\" FROM pragma_foreign_key_list(?)");
    keys.bind(name);
    while (keys.step()) {
        const std::string from = keys.text(0);
        for (TableColumn& column : table.columns)
            if (column.name == from) {
                column.parent = keys.text(1);
                column.parent_column = keys.isNull(2) ? from : keys.text(2);
            }
    }
    return table;
}

std::string columnNames(const SessionTable& table) {
    std::string names;
    for (const TableColumn& column : table.columns) names += (names.empty() ? "" : ", ") + column.name;
    return names;
}

std::vector<std::string> tableNames(const Database& database) {
    std::vector<std::string> names;
    Statement tables = database.prepare(
        "SELECT name FROM sqlite_master WHERE type='table' AND name NOT LIKE 'sqlite_%' ORDER BY rowid");
    while (tables.step()) names.push_back(tables.text(0));
    return names;
}

std::vector<SessionTable> sessionTables(const Database& database) {
    std::vector<SessionTable> others;
    for (const std::string& name : tableNames(database)) others.push_back(describeTable(database, name));
    std::vector<SessionTable> tables{describeTable(database, "session")};
    std::erase_if(others, [](const SessionTable& table) { return table.name == "session"; });
    for (bool grown = true; grown;) {
        grown = false;
        for (auto table = others.begin(); table != others.end() && !grown; ++table) {
            if (belongsBy(tables, *table) == nullptr) continue;
            tables.push_back(*table);
            others.erase(table);
            grown = true;
            break;
        }
    }
    return tables;
}

std::string rowsOfSession(const std::vector<SessionTable>& tables, const SessionTable& table,
                          const std::string& schema) {
    if (table.name == "session") return "session_id=?1";
    const TableColumn* by = belongsBy(tables, table);
    const SessionTable& parent = *findTable(tables, by->parent);
    return by->name + " IN (SELECT " + by->parent_column + " FROM " + schema + "." + parent.name + " WHERE " +
           rowsOfSession(tables, parent, schema) + ")";
}

const SessionTable* numberedBy(const std::vector<SessionTable>& tables, const SessionTable& table,
                               const TableColumn& column) {
    if (const TableColumn* own = table.number(); own != nullptr && own->name == column.name) return &table;
    const SessionTable* parent = column.parent.empty() ? nullptr : findTable(tables, column.parent);
    if (parent == nullptr) return nullptr;
    const TableColumn* there = parent->find(column.parent_column);
    return there == nullptr ? nullptr : numberedBy(tables, *parent, *there);
}

std::string sessionDigest(const Database& database, const std::vector<SessionTable>& tables, const std::string& schema,
                          const std::string& session_id) {
    Sha256 digest;
    std::map<std::string, std::int64_t> bases;
    for (const SessionTable& table : tables) {
        const TableColumn* number = table.number();
        if (number == nullptr) continue;
        Statement least = database.prepare("SELECT coalesce(min(" + number->name + "), 0) FROM " + schema + "." +
                                           table.name + " WHERE " + rowsOfSession(tables, table, schema));
        least.bind(session_id).step();
        bases[table.name] = least.integer(0);
    }
    for (const SessionTable& table : tables) {
        std::string columns, order;
        for (const TableColumn& column : table.columns) {
            // Numbers of conditions differ between files as well; their names do not.
            columns += (columns.empty() ? "" : ", ") +
                       (column.parent == "condition" ? "(SELECT condition FROM " + schema +
                                                           ".condition c WHERE c.condition_id=t." + column.name + ")"
                                                     : "t." + column.name);
            if (column.key > 0) order += (order.empty() ? "" : ", ") + std::string("t.") + column.name;
        }
        digest.update(table.name + ";");
        Statement rows = database.prepare("SELECT " + columns + " FROM " + schema + "." + table.name + " t WHERE t." +
                                          rowsOfSession(tables, table, schema) + " ORDER BY " + order);
        rows.bind(session_id);
        while (rows.step()) {
            for (std::size_t i = 0; i < table.columns.size(); ++i) {
                TableColumn column = table.columns[i];
                if (column.parent == "condition") column.type = "TEXT";
                const SessionTable* numbered = numberedBy(tables, table, column);
                addValue(digest, rows, static_cast<int>(i), column, numbered ? bases[numbered->name] : 0);
            }
        }
    }
    return digest.hex();
}

}  // namespace passung::store
