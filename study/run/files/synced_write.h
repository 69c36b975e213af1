#pragma once

#include <filesystem>
#include <string_view>

namespace passung::run {

/// Writes to an open file until the disk has all of it. False: see errno.
bool writeSynced(int file, std::string_view bytes);

/// A name that is new in a folder reaches the disk with it.
void syncFolder(const std::filesystem::path& folder);

}  // namespace passung::run
