#pragma once

#include <string>

#include "core/base/result.h"
#include "study/store/read/store_reader.h"

namespace passung::exporter {

/// Means per condition as a text table for a terminal, one table for each kind of participant and version of
/// the protocol: valid trials of the
/// main phase, share of success, completion time, depths and forces. A mean takes the trials that have the value.
Result<std::string> summaryTable(const store::StoreReader& reader);

}  // namespace passung::exporter
