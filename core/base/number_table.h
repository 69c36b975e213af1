#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace passung {

/// Numbers in named columns, and how the file writes them.
struct NumberTable {
    std::vector<std::string> columns;             // all of the header
    std::vector<std::vector<double>> rows;        // the numbers of the required columns, which are the first ones
    std::vector<std::vector<std::string>> texts;  // of all columns, as in the file (quotes kept); as many as rows
    std::vector<int> lines;                       // where each row stands in the file, from 1

    /// The header, or a row, as a line of CSV, without its end.
    std::string headerLine() const;
    std::string rowLine(std::size_t row) const;
};

/// Reads a CSV file with a header row. The columns of `required` must be there first and in this order, and hold
/// numbers ("nan" and "inf" too); further ones are kept as text. Cells may be quoted as RFC 4180 says, but hold no line
/// breaks. A byte order mark and empty lines are passed over. Errors name file, line, column and value.
Result<NumberTable> readNumbers(const std::string& path, const std::vector<std::string>& required);

/// First five of a table's faults; the fifth then says how many more there are.
Errors firstFaults(Errors errors);

}  // namespace passung
