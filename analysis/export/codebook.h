#pragma once

#include <span>
#include <string>

#include "analysis/export/table.h"

namespace passung::exporter {

/// What every column of every table means, as a table of its own (codebook.csv).
Table makeCodebook(std::span<const Table> tables);

/// The same as JSON: {"producer": "passung", "files": {file: {column: {...}}}}.
std::string codebookJson(std::span<const Table> tables);

/// How codebook.json begins: a folder holding it was made by an export and may be replaced by the next one.
extern const char* const kCodebookStart;

}  // namespace passung::exporter
