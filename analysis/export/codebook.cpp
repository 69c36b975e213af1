#include "analysis/export/codebook.h"

#include "analysis/export/columns.h"
#include "core/base/json.h"

namespace passung::exporter {
namespace {

std::string columnJson(const Column& column) {
    std::string json = "{\"label\": " + jsonText(column.label) + ", \"unit\": " + jsonText(column.unit) +
                       ", \"type\": " + jsonText(column.type) + ", \"levels\": [";
    for (std::size_t i = 0; i < column.levels.size(); ++i) json += (i > 0 ? ", " : "") + jsonText(column.levels[i]);
    return json + "], \"formula\": " + jsonText(column.formula) +
           ", \"formula_version\": " + std::to_string(column.formula_version) + ", \"missing\": " + jsonText(kMissing) +
           "}";
}

/// A column of a file.
struct Described {
    const std::string* file;
    const Column* column;
};

ColumnsOf<Described> codebookColumns() {
    ColumnsOf<Described> columns = {
        {"file", "File of the export", "text", [](const Described& row) { return *row.file; }}};
    const ColumnsOf<Column> more = {
        {"column", "Column of the file", "text", &Column::name},
        {"label", "What it is", "text", &Column::label},
        {"unit", "Unit; empty if there is none", "text", &Column::unit},
        {"type", "Kind of value", "text", &Column::type, {.levels = {"text", "number", "integer", "0/1", "time"}}},
        {"levels", "All values it can take, parted by ;, if they are a fixed set", "text",
         [](const Column& column) { return joined(column.levels, "; "); }},
        {"formula", "How it is computed; empty: as recorded", "text", &Column::formula},
        {"formula_version", "Counts changes of the formula", "integer", &Column::formula_version},
        {"missing", "What stands for a missing value", "text", [](const Column&) { return kMissing; }}};
    append(columns, more, [](const Described& row) -> const Column& { return *row.column; });
    return columns;
}

}  // namespace

const char* const kCodebookStart = "{\n  \"producer\": \"passung\",";

Table makeCodebook(std::span<const Table> tables) {
    const std::string file = "codebook.csv";
    const ColumnsOf<Described> columns = codebookColumns();
    const std::vector<Column> itself = descriptions(columns);
    std::vector<Described> rows;
    for (const Table& table : tables)
        for (const Column& column : table.columns) rows.push_back({&table.file, &column});
    for (const Column& column : itself) rows.push_back({&file, &column});
    return makeTable(file, "What every column of every file means.", columns, rows);
}

std::string codebookJson(std::span<const Table> tables) {
    std::string json = std::string(kCodebookStart) + "\n  \"files\": {";
    for (std::size_t i = 0; i < tables.size(); ++i) {
        json += (i > 0 ? ",\n    " : "\n    ") + jsonText(tables[i].file) + ": {";
        for (std::size_t k = 0; k < tables[i].columns.size(); ++k) {
            const Column& column = tables[i].columns[k];
            json += (k > 0 ? ",\n      " : "\n      ") + jsonText(column.name) + ": " + columnJson(column);
        }
        json += "\n    }";
    }
    return json + "\n  }\n}\n";
}

}  // namespace passung::exporter
