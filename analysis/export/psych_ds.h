#pragma once

#include <set>
#include <span>
#include <string>

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

// Psych-DS (psych-ds.github.io): data files in data/ whose names are made of keywords and end in _data.csv, and
// dataset_description.json, which says what every column of them is.

/// Where the table stands in such an export: data/study-…_description-…_data.csv. `taken`: names that there are
/// already, to which it is added.
std::string psychDsFile(const StudyData& study, const Table& table, std::set<std::string>& taken);

/// dataset_description.json of these tables. A variable of several tables is told once, with each label that it has.
std::string psychDsDescription(const StudyData& study, std::span<const Table> tables);

}  // namespace passung::exporter
