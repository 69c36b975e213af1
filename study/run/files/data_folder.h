#pragma once

#include <filesystem>

namespace passung::run {

/// Folder of this user's data: $XDG_DATA_HOME/passung, or ~/.local/share/passung; empty if neither variable names a
/// folder.
std::filesystem::path dataFolder();

}  // namespace passung::run
