#pragma once

#include <string>
#include <vector>

#include "study/protocol/document.h"

namespace passung::protocol {

/// A line of TOML with the line of the table that it stands for, from 1.
struct ListedLine {
    std::string text;
    int line = 1;
};

/// What `conditions = "TABLE.csv"` stands for: the list with a table of levels for each row of the CSV file, whose
/// header names factors. RFC 4180 with commas; levels are labels. Errors, placed in the file: no row, a row with more
/// or fewer cells than the header, a quote that does not end.
Result<std::vector<ListedLine>> conditionLines(const std::string& csv, const std::string& path,
                                               const std::string& name);

}  // namespace passung::protocol
