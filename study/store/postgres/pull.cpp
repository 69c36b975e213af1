#include "study/store/postgres/pull.h"

#include <cstdlib>
#include <map>
#include <optional>
#include <pqxx/pqxx>
#include <stdexcept>

#include "study/store/postgres/postgres_message.h"
#include "study/store/schema/revisions.h"
#include "study/store/schema/row_hash.h"

namespace passung::store {
namespace {

/// Copies tables from PostgreSQL into a database of this program's schema.
class SessionPull {
public:
    SessionPull(pqxx::work& work, const Database& here) : work_(work), here_(here), tables_(sessionTables(here)) {}

    void study() {
        for (const SessionTable& table : studyTables(here_)) {
            std::vector<TableColumn> columns;
            for (const TableColumn& column : table.columns)
                if (&column != table.number() && isThere(table.name, column.name)) columns.push_back(column);
            if (!columns.empty()) rows(table, columns, "", "");
        }
    }

    void session(const std::string& id) {
        offsets_.clear();
        for (const SessionTable& table : tables_) {
            if (table.number() == nullptr || !isThere(table.name, table.number()->name)) continue;
            const std::string number = table.number()->name;
            const auto least = work_.exec_params(
                "SELECT coalesce(min(" + number + "), 0) FROM " + work_.quote_name(table.name) + " WHERE session_id=$1",
                id);
            offsets_[table.name] = here_.integer("SELECT coalesce(max(" + number + "), 0) + 1 FROM " + table.name) -
                                   least[0][0].as<std::int64_t>();
        }
        for (const SessionTable& table : tables_) {
            std::vector<TableColumn> columns;
            for (const TableColumn& column : table.columns)
                if (isThere(table.name, column.name)) columns.push_back(column);
            if (!columns.empty()) rows(table, columns, " WHERE session_id=$1", id);
        }
    }

private:
    bool isThere(const std::string& table, const std::string& column) {
        return !work_
                    .exec_params(
                        "SELECT 1 FROM information_schema.columns WHERE table_schema=current_schema() AND "
                        "table_name=$1 AND column_name=$2",
                        table, column)
                    .empty();
    }

    void rows(const SessionTable& table, const std::vector<TableColumn>& columns, const std::string& where,
              const std::string& id) {
        std::string there, here, values;
        for (const TableColumn& column : columns) {
            const bool condition = column.parent == "condition" && !id.empty();
            std::string name = work_.quote_name(condition ? "condition" : column.name);
            if (column.type == "BLOB") name.insert(0, "encode(").append(", 'hex')");
            there += (there.empty() ? "" : ", ") + name;
            here += (here.empty() ? "" : ", ") + column.name;
            values += values.empty() ? "" : ", ";
            // The numbers of conditions there are those of the file that they came from.
            values += condition ? "(SELECT condition_id FROM condition JOIN session USING(protocol_sha256) WHERE "
                                  "condition=? AND session_id='" +
                                      id + "')"
                                : "?";
        }
        const std::string select = "SELECT " + there + " FROM " + work_.quote_name(table.name) + where;
        const auto found = id.empty() ? work_.exec(select) : work_.exec_params(select, id);
        Statement insert =
            here_.prepare("INSERT OR IGNORE INTO " + table.name + "(" + here + ") VALUES(" + values + ")");
        for (const auto& row : found) {
            insert.reset();
            for (int i = 0; i < static_cast<int>(columns.size()); ++i)
                bind(insert, i + 1, table, columns[static_cast<std::size_t>(i)], row[i]);
            insert.run();
        }
    }

    void bind(Statement& insert, int index, const SessionTable& table, const TableColumn& column,
              const pqxx::field& field) {
        if (field.is_null()) return insert.bindAt(index, nullptr);
        const std::string text = field.c_str();
        const SessionTable* numbered = numberedBy(tables_, table, column);
        if (column.type == "INTEGER" && column.parent != "condition") {
            const auto offset = numbered == nullptr ? offsets_.end() : offsets_.find(numbered->name);
            insert.bindAt(index, field.as<std::int64_t>() + (offset == offsets_.end() ? 0 : offset->second));
        } else if (column.type == "REAL") {
            insert.bindAt(index, std::strtod(text.c_str(), nullptr));
        } else if (column.type == "BLOB") {
            bytes_.clear();
            for (std::size_t at = 0; at + 1 < text.size(); at += 2)
                bytes_.push_back(static_cast<std::byte>(std::stoi(text.substr(at, 2), nullptr, 16)));
            insert.bindAt(index, std::span<const std::byte>(bytes_));
        } else {
            insert.bindAt(index, texts_[index] = text);
        }
    }

    pqxx::work& work_;
    const Database& here_;
    std::vector<SessionTable> tables_;
    std::map<std::string, std::int64_t> offsets_;
    // Bound by reference, so they last until the row is inserted.
    std::vector<std::byte> bytes_;
    std::map<int, std::string> texts_;
};

}  // namespace

void pullSessions(const std::string& from, const std::string& like, const std::string& to, const std::string& now_utc) {
    const Database own(like, OpenMode::ReadOnly), here(to, OpenMode::Create);
    upgradeSchema(here, now_utc);
    const std::string name = own.text("SELECT name FROM protocol_version LIMIT 1");
    try {
        pqxx::connection there(from);
        pqxx::work work(there);
        work.exec("SET search_path TO " + work.quote_name(name));
        if (work.exec("SELECT 1 FROM information_schema.tables WHERE table_schema=current_schema() AND "
                      "table_name='pushed_session'")
                .empty())
            throw std::runtime_error("PostgreSQL holds no study " + name);
        here.execute("PRAGMA foreign_keys=OFF");
        Transaction transaction(here);
        SessionPull pull(work, here);
        pull.study();
        Statement sessions = own.prepare("SELECT session_id FROM session");
        while (sessions.step()) pull.session(sessions.text(0));
        transaction.commit();
    } catch (const pqxx::failure& error) {
        throw std::runtime_error(postgresMessage(error));
    }
}

}  // namespace passung::store
