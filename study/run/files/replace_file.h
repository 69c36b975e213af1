#pragma once

#include <string>

#include "core/base/result.h"

namespace passung::run {

/// What became of a file that was to be replaced.
enum class Replaced { Done, Changed, Failed };

/// Puts `text` in the place of a file that holds exactly `expected`, at once: whoever reads it finds the one or the
/// other, also after a failure of the power. Links are followed, its permissions stay. Changed: it holds something else
/// or cannot be read. Failed: `problem` says why; the file is as it was.
Replaced replaceFile(const std::string& path, const std::string& expected, const std::string& text, Error& problem);

}  // namespace passung::run
