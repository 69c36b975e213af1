#pragma once

#include "study/store/write/store.h"
#include "ui/cli/commands.h"

namespace passung::cli {

/// The station that two options name. Errors: a letter that so many stations do not have.
Result<store::Station> stationOf(const StationArguments& options);

}  // namespace passung::cli
