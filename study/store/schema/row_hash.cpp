#include "study/store/schema/row_hash.h"

#include <algorithm>
#include <array>
#include <map>

#include "study/store/schema/row_text.h"

namespace passung::store {
namespace {

/// Of no session, and not of the study either. The audit has hashes of its own.
constexpr std::array<const char*, 3> kApart = {"schema_revision", "audit", "row_hash"};

/// Columns that name a row in every file: the primary key, or what else is unique where that only numbers.
std::vector<std::string> namingColumns(const Database& database, const SessionTable& table) {
    std::vector<std::string> names;
    if (table.number() == nullptr) {
        for (const TableColumn& column : table.columns)
            if (column.key > 0) names.push_back(column.name);
        return names;
    }
    Statement unique = database.prepare(
        "SELECT i.name FROM pragma_index_list(?) i WHERE i.origin='u' ORDER BY (SELECT count(*) FROM "
        "pragma_index_info(i.name)) DESC LIMIT 1");
    if (unique.bind(table.name).step()) {
        const std::string index = unique.text(0);
        Statement columns = database.prepare("SELECT name FROM pragma_index_info(?)");
        columns.bind(index);
        while (columns.step()) names.push_back(columns.text(0));
        return names;
    }
    for (const TableColumn& column : table.columns)  // rows that are added and never change
        if (&column != table.number()) names.push_back(column.name);
    return names;
}

/// By the statement that made the table: SQLite's list of tables would compile every view.
bool hasRowId(const Database& database, const SessionTable& table) {
    return database.integer("SELECT sql LIKE '%WITHOUT ROWID' FROM main.sqlite_schema WHERE type='table' AND name='" +
                            table.name + "'") == 0;
}

/// Reads rows of one table.
class Rows {
public:
    Rows(const Database& database, const SessionTable& table)
        : table_(table), names_(namingColumns(database, table)), numbered_(hasRowId(database, table)) {
        const TableColumn* who = table.find("participant_id");
        of_person_ = who != nullptr && who->filled;
    }

    std::string query(const std::string& schema) const {
        std::string columns;
        for (const TableColumn& column : table_.columns) columns += column.name + ", ";
        return "SELECT " + columns + (numbered_ ? "rowid" : "0") + " FROM " + schema + "." + table_.name;
    }

    StudyRow read(const Statement& row) const {
        StudyRow study_row;
        RowText text(table_.name);
        for (std::size_t i = 0; i < table_.columns.size(); ++i) {
            const TableColumn& column = table_.columns[i];
            const int at = static_cast<int>(i);
            if (std::find(names_.begin(), names_.end(), column.name) != names_.end())
                study_row.key += (study_row.key.empty() ? "" : ", ") + row.text(at);
            if (column.name == "participant_id" && of_person_) study_row.participant_id = row.text(at);
            if (&column != table_.number()) text.add(column, row, at);
        }
        study_row.sha256 = text.sha256();
        study_row.rowid = row.integer(static_cast<int>(table_.columns.size()));
        return study_row;
    }

private:
    const SessionTable& table_;
    std::vector<std::string> names_;
    bool numbered_, of_person_ = false;
};

constexpr const char* kMakeDamaged =
    "CREATE TEMP TABLE IF NOT EXISTS damaged_row(table_name TEXT, row_key TEXT, PRIMARY KEY(table_name, row_key))";

void keep(const Database& database, const SessionTable& table, const StudyRow& row, const char* how) {
    database
        .prepare(std::string("INSERT OR ") + how +
                 " INTO main.row_hash(table_name, row_key, participant_id, sha256) SELECT ?1, ?2, ?3, ?4 WHERE NOT "
                 "EXISTS(SELECT 1 FROM temp.damaged_row WHERE table_name=?1 AND row_key=?2)")
        .bind(table.name, row.key, nullIfEmpty(row.participant_id), row.sha256)
        .run();
}

}  // namespace

std::vector<SessionTable> studyTables(const Database& database) {
    std::set<std::string> apart(kApart.begin(), kApart.end());
    for (const SessionTable& table : sessionTables(database)) apart.insert(table.name);
    std::vector<SessionTable> tables;
    for (const std::string& name : tableNames(database))
        if (apart.count(name) == 0) tables.push_back(describeTable(database, name));
    return tables;
}

std::string keyExpression(const Database& database, const SessionTable& table) {
    const std::vector<std::string> names = namingColumns(database, table);
    std::string key;
    for (const TableColumn& column : table.columns)
        if (std::find(names.begin(), names.end(), column.name) != names.end())
            key += (key.empty() ? "" : " || ', ' || ") + ("coalesce(CAST(" + column.name) + " AS TEXT), '')";
    return key;
}

std::vector<StudyRow> studyRows(const Database& database, const std::string& schema, const SessionTable& table) {
    const Rows reader(database, table);
    std::vector<StudyRow> all;
    Statement rows = database.prepare(reader.query(schema));
    while (rows.step()) all.push_back(reader.read(rows));
    return all;
}

void trustRow(const Database& database, const std::string& table, const std::string& key) {
    database.execute(kMakeDamaged);
    database.prepare("DELETE FROM temp.damaged_row WHERE table_name=? AND row_key=?").bind(table, key).run();
}

void watchStudyRows(Database& database) {
    database.execute(kMakeDamaged);
    Statement damaged = database.prepare("INSERT OR IGNORE INTO temp.damaged_row(table_name, row_key) VALUES(?, ?)");
    for (const RowFault& fault : rowFaults(database, "main"))
        if (!fault.missing) damaged.bind(fault.table, fault.key).run();
    std::map<std::string, SessionTable> tables;
    for (SessionTable& table : studyTables(database)) tables.emplace(table.name, std::move(table));
    std::set<std::string> names;
    for (const auto& [name, table] : tables) names.insert(name);
    database.watch(names, [tables](const Database& changed_database, const Database::ChangedRows& changed) {
        for (const auto& [name, rowid] : changed) {
            const SessionTable& table = tables.at(name);
            const Rows reader(changed_database, table);
            Statement row = changed_database.prepare(reader.query("main") + " WHERE rowid=?");
            if (row.bind(rowid).step()) keep(changed_database, table, reader.read(row), "REPLACE");
        }
        // What belongs to a new protocol has no number in part, and so is not watched.
        if (std::any_of(changed.begin(), changed.end(),
                        [](const auto& row) { return row.first == "protocol_version"; }))
            sealNewRows(changed_database);
    });
}

void sealNewRows(const Database& database) {
    database.execute(kMakeDamaged);
    for (const SessionTable& table : studyTables(database))
        for (const StudyRow& row : studyRows(database, "main", table)) keep(database, table, row, "IGNORE");
}

std::vector<RowFault> rowFaults(const Database& database, const std::string& schema, RowsSeen* seen) {
    std::map<std::string, std::map<std::string, std::pair<std::string, std::string>>> kept;  // hash, participant
    Statement hashes = database.prepare("SELECT table_name, row_key, sha256, coalesce(participant_id, '') FROM " +
                                        schema + ".row_hash");
    while (hashes.step()) kept[hashes.text(0)][hashes.text(1)] = {hashes.text(2), hashes.text(3)};
    std::vector<RowFault> faults;
    for (const SessionTable& table : studyTables(database)) {
        auto& of_table = kept[table.name];
        std::vector<StudyRow> rows;
        try {
            rows = studyRows(database, schema, table);
        } catch (const SqliteError& error) {
            if (seen == nullptr || isOfTheDisk(error)) throw;
            seen->unreadable.push_back(table.name);
            kept.erase(table.name);
            continue;
        }
        for (const StudyRow& row : rows) {
            const auto found = of_table.find(row.key);
            if (seen != nullptr) ++(found == of_table.end() ? seen->not_hashed : seen->hashed);
            if (found == of_table.end()) continue;
            if (found->second.first != row.sha256) faults.push_back({table.name, row.key, row.participant_id});
            of_table.erase(found);
        }
        for (const auto& [key, hash] : of_table) faults.push_back({table.name, key, hash.second, true});
        kept.erase(table.name);
    }
    for (const auto& [table, rows] : kept)  // a name of a table that is none
        for (const auto& [key, hash] : rows) faults.push_back({table, key, hash.second, true});
    return faults;
}

std::string titleOf(const RowFault& fault) { return fault.table + " " + fault.key; }

}  // namespace passung::store
