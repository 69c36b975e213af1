#include "analysis/export/codebook.h"

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

}  // namespace

const char* const kCodebookStart = "{\n  \"producer\": \"passung\",";

Table makeCodebook(std::span<const Table> tables) {
    Table book{"codebook.csv",
               "What every column of every file means.",
               {{"file", "File of the export", "", "text", "", 1, {}},
                {"column", "Column of the file", "", "text", "", 1, {}},
                {"label", "What it is", "", "text", "", 1, {}},
                {"unit", "Unit; empty if there is none", "", "text", "", 1, {}},
                {"type", "Kind of value", "", "text", "", 1, {"text", "number", "integer", "0/1", "time"}},
                {"levels", "All values it can take, parted by ;, if they are a fixed set", "", "text", "", 1, {}},
                {"formula", "How it is computed; empty: as recorded", "", "text", "", 1, {}},
                {"formula_version", "Counts changes of the formula", "", "integer", "", 1, {}},
                {"missing", "What stands for a missing value", "", "text", "", 1, {}}},
               {}};
    const auto describe = [&book](const Table& table) {
        for (const Column& c : table.columns) {
            book.rows.push_back({table.file, c.name, c.label, c.unit, c.type, joined(c.levels, "; "), c.formula,
                                 cell(c.formula_version), kMissing});
        }
    };
    for (const Table& table : tables) describe(table);
    const Table itself{book.file, {}, book.columns, {}};
    describe(itself);
    return book;
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
