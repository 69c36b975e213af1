#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace passung {

/// Numbers in named columns.
struct NumberTable {
    std::vector<std::string> columns;
    std::vector<std::vector<double>> rows;  // each as long as `columns`
};

/// Reads a CSV file of numbers with a header row; "nan", "inf" and empty lines at the end are understood. The columns
/// of `required` must be there in this order, further ones are kept. Errors name file, line, column and value.
Result<NumberTable> readNumbers(const std::string& path, const std::vector<std::string>& required);

}  // namespace passung
