#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace passung::cli {

/// A program of ours that only some commands need, beside this one or where ./dev build puts both; empty if there is
/// none.
std::filesystem::path findOtherProgram(const char* name);

/// This process becomes `program`, with these words: its exit code is ours. Returns only if it cannot be started.
Errors becomeProgram(const std::filesystem::path& program, const std::vector<std::string>& words);

}  // namespace passung::cli
