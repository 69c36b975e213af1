#pragma once

#include <string>

namespace passung::store {

/// Before the copy `fresh` takes the place of the backup at `path`: an earlier one there that has a session which the
/// fresh one lacks, or that is sound while the fresh one is damaged, gets the first free name `path`.1, `path`.2 …
/// Returns that name; empty if there is nothing to keep. Throws what the file system says.
std::string keepEarlierBackup(const std::string& path, const std::string& fresh);

}  // namespace passung::store
