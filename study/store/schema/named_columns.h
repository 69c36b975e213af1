#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/store/schema/sqlite.h"

namespace passung::store {

// Columns of statements, each named where its value stands, so that a list and its values cannot fall apart. For this
// room only: the functions throw.

/// A value of a new row.
template <class Value>
struct Named {
    const char* column;
    const Value& value;
};
template <class Value>
Named(const char*, const Value&) -> Named<Value>;

/// "INSERT INTO table(a, b) VALUES(?, ?)"; `verb`: "INSERT" or "INSERT OR IGNORE".
std::string insertText(const char* verb, const char* table, std::initializer_list<const char*> columns);

/// Adds one of several rows of a table; `kept` is the statement of all, which the first prepares.
template <class... Values>
void insertRow(std::optional<Statement>& kept, const Database& database, const char* table,
               const Named<Values>&... values) {
    if (!kept) kept.emplace(database.prepare(insertText("INSERT", table, {values.column...})));
    kept->bind(values.value...).run();
}

/// Adds a row.
template <class... Values>
void insertRow(const Database& database, const char* table, const Named<Values>&... values) {
    std::optional<Statement> once;
    insertRow(once, database, table, values...);
}

/// Adds a row unless its key is there.
template <class... Values>
void insertRowIfNew(const Database& database, const char* table, const Named<Values>&... values) {
    database.prepare(insertText("INSERT OR IGNORE", table, {values.column...})).bind(values.value...).run();
}

inline void readValue(const Statement& row, int column, std::string& value) { value = row.text(column); }
inline void readValue(const Statement& row, int column, std::int64_t& value) { value = row.integer(column); }
inline void readValue(const Statement& row, int column, double& value) { value = row.real(column); }
inline void readValue(const Statement& row, int column, bool& value) { value = row.integer(column) != 0; }
inline void readValue(const Statement& row, int column, std::uint64_t& value) {
    value = static_cast<std::uint64_t>(row.integer(column));
}
template <class Value>
void readValue(const Statement& row, int column, std::optional<Value>& value) {
    value.reset();
    if (!row.isNull(column)) readValue(row, column, value.emplace());
}

/// What a SELECT asks for and where in a `Row` each answer goes.
template <class Row>
class Selection {
public:
    struct Column {
        std::string sql;  // a column or an expression
        std::function<void(const Statement&, int column, Row&)> read;

        template <class Value>
        Column(std::string text, Value Row::*member)
            : sql(std::move(text)),
              read([member](const Statement& row, int column, Row& to) { readValue(row, column, to.*member); }) {}
        /// `function`: reads what no member takes as it is.
        template <class Read>
        requires std::invocable<const Read&, const Statement&, int, Row&> Column(std::string text, Read function)
            : sql(std::move(text)), read(std::move(function)) {}
    };

    Selection(std::initializer_list<Column> columns) : columns_(columns) {}

    /// "a, b, c"
    std::string text() const {
        std::string all;
        for (const Column& column : columns_) all += (all.empty() ? "" : ", ") + column.sql;
        return all;
    }
    int size() const { return static_cast<int>(columns_.size()); }
    /// `first`: number of the selection's first column in the statement.
    Row read(const Statement& row, int first = 0) const {
        Row result;
        for (int i = 0; i < size(); ++i) columns_[static_cast<std::size_t>(i)].read(row, first + i, result);
        return result;
    }
    /// "SELECT a, b, c" and `rest`: "FROM …" with all that comes after.
    std::vector<Row> all(const Database& database, const std::string& rest) const {
        Statement statement = database.prepare("SELECT " + text() + " " + rest);
        return allOf(statement);
    }
    /// The same rows, one after the other.
    void each(const Database& database, const std::string& rest, const std::function<void(const Row&)>& take) const {
        Statement statement = database.prepare("SELECT " + text() + " " + rest);
        while (statement.step()) take(read(statement));
    }
    /// The rows of a statement that begins with "SELECT " + text().
    std::vector<Row> allOf(Statement& statement) const {
        std::vector<Row> rows;
        while (statement.step()) rows.push_back(read(statement));
        return rows;
    }

private:
    std::vector<Column> columns_;
};

}  // namespace passung::store
