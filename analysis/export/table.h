#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace passung::exporter {

/// What a missing value looks like in every file.
inline constexpr const char* kMissing = "NA";

/// A column and what the codebook says of it.
struct Column {
    std::string name;
    std::string label;
    std::string unit;     // empty: none
    std::string type;     // "text", "number", "integer", "0/1", "time" (ISO 8601, UTC)
    std::string formula;  // empty: as recorded
    std::int64_t formula_version = 1;
    std::vector<std::string> levels;  // empty: not a fixed set
    bool typed = false;               // texts that somebody typed: they may name a person
};

/// The values that a column takes. Made from texts outside of the lists of columns, which compile at length otherwise.
struct ColumnLevels {
    ColumnLevels() = default;
    ColumnLevels(std::initializer_list<std::string_view> texts);
    ColumnLevels(std::vector<std::string> texts) : names(std::move(texts)) {}

    std::vector<std::string> names;
};

/// What some columns have; meanings as in Column.
struct ColumnDetails {
    std::string_view unit = {};
    ColumnLevels levels = {};
    std::string_view formula = {};
    std::int64_t formula_version = 1;
    bool typed = false;
};

Column describe(std::string_view name, std::string_view label, std::string_view type, const ColumnDetails& details);

/// The cells of a row, in the order of the columns.
using TableRow = std::vector<std::string>;
using TakeRow = std::function<void(TableRow)>;

/// One CSV file: its columns' meaning and its cells as text.
struct Table {
    std::string file;   // path inside the export, e.g. "trials.csv"
    std::string about;  // one sentence for the README
    std::vector<Column> columns;
    std::vector<TableRow> rows;
    /// Hands out the rows after those, one after the other: of tables that grow with the number of trials, whose rows
    /// are larger than what they are made of. Nothing: there are none.
    std::function<Result<Done>(const TakeRow&)> more = {};
};

/// All rows, in order.
Result<Done> forEachRow(const Table& table, const TakeRow& take);

std::string cell(std::int64_t value);
/// The shortest decimal that reads back to the same number; NA if it is not finite.
std::string cell(double value);
std::string cell(float value);  // as the double of the same value
std::string cell(bool value);
std::string cell(const std::string& value);
std::string cell(const char* value);
std::string cell(const std::optional<std::string>& value);
std::string cell(const std::optional<std::int64_t>& value);
std::string cell(const std::optional<double>& value);

/// All of them with `between` between them; empty for none.
std::string joined(const std::vector<std::string>& texts, std::string_view between);

/// Nanoseconds as seconds.
std::string secondsCell(const std::optional<std::int64_t>& nanoseconds);

/// Appends one field, quoted as RFC 4180 asks if it holds a comma, a quote or a line break.
void appendField(std::string& line, std::string_view text);

using TakeText = std::function<void(std::string_view)>;

/// The whole file in pieces: header, rows, LF after each. `change`, if there is one, is done to each row before.
Result<Done> writeCsv(const Table& table, const std::function<void(TableRow&)>& change, const TakeText& take);

/// The same at once. @pre no `more` that fails
std::string toCsv(const Table& table);

}  // namespace passung::exporter
