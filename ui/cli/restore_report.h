#pragma once

#include <string>

#include "study/store/transfer/restore.h"

namespace passung::cli {

/// Prints what became of a database that was restored, a line each; returns the exit code.
int tellRestore(const std::string& database, const std::string& from, const store::RestoreReport& report);

}  // namespace passung::cli
