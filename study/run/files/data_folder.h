#pragma once

#include <filesystem>

namespace passung::run {

/// Where this user's data lies: $XDG_DATA_HOME/passung, or ~/.local/share/passung; empty if neither variable names a
/// folder.
std::filesystem::path dataFolder();

}  // namespace passung::run
