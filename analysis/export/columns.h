#pragma once

#include <concepts>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "analysis/export/table.h"
#include "study/store/schema/view_columns.h"

namespace passung::exporter {

/// Makes the text of a column's cell from a `Row`: of a member of it, or of what a function says of it.
template <class Row>
class Getter {
public:
    template <class Get>
    requires std::invocable<const Get&, const Row&> Getter(Get get)
        : text_([get](const Row& row) { return cell(std::invoke(get, row)); }) {}

    std::string operator()(const Row& row) const { return text_(row); }

private:
    std::function<std::string(const Row&)> text_;
};

/// A column of a table whose rows are each made from a `Row`: what the codebook says of it, and where its cells come
/// from. The only place that knows both.
template <class Row>
struct ColumnOf {
    ColumnOf(std::string_view name, std::string_view label, std::string_view type, Getter<Row> get,
             const ColumnDetails& details = {})
        : description(describe(name, label, type, details)), text(std::move(get)) {}
    /// What a view of the database has too.
    ColumnOf(const store::ViewColumn& column, std::string_view type, Getter<Row> get, const ColumnLevels& levels = {})
        : ColumnOf(column.name, column.label, type, std::move(get),
                   {column.unit, levels, column.formula, column.formula_version, column.typed}) {}
    ColumnOf(Column column, Getter<Row> get) : description(std::move(column)), text(std::move(get)) {}

    Column description;
    Getter<Row> text;
};

template <class Row>
using ColumnsOf = std::vector<ColumnOf<Row>>;

template <class Row>
void append(ColumnsOf<Row>& columns, const std::type_identity_t<ColumnsOf<Row>>& more) {
    columns.insert(columns.end(), more.begin(), more.end());
}

/// Appends columns of a part of the row: `part` gives a reference to it.
template <class Row, class Part, class GetPart>
void append(ColumnsOf<Row>& columns, const ColumnsOf<Part>& more, GetPart part) {
    for (const ColumnOf<Part>& column : more)
        columns.push_back({column.description, [text = column.text, part](const Row& row) { return text(part(row)); }});
}

template <class Row>
std::vector<Column> descriptions(const ColumnsOf<Row>& columns) {
    std::vector<Column> all;
    for (const ColumnOf<Row>& column : columns) all.push_back(column.description);
    return all;
}

template <class Row>
TableRow cellsIn(const ColumnsOf<Row>& columns, const Row& row) {
    TableRow cells;
    cells.reserve(columns.size());
    for (const ColumnOf<Row>& column : columns) cells.push_back(column.text(row));
    return cells;
}

/// A row of the table for each of `rows`.
template <class Row, class Rows>
Table makeTable(std::string file, std::string about, const ColumnsOf<Row>& columns, const Rows& rows) {
    Table table{std::move(file), std::move(about), descriptions(columns), {}};
    for (const Row& row : rows) table.rows.push_back(cellsIn(columns, row));
    return table;
}

/// The same of rows that are made one by one when they are written: `each` calls its argument with every `Row` and
/// tells what failed. @pre what `each` and the columns refer to outlives the table
template <class Row>
Table makeLongTable(std::string file, std::string about, ColumnsOf<Row> columns,
                    std::function<Result<Done>(const std::function<void(const Row&)>&)> each) {
    Table table{std::move(file), std::move(about), descriptions(columns), {}};
    table.more = [columns = std::move(columns), each = std::move(each)](const TakeRow& take) {
        return each([&](const Row& row) { take(cellsIn(columns, row)); });
    };
    return table;
}

}  // namespace passung::exporter
