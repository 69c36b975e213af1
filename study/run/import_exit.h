#pragma once

namespace passung::run {

/// Exit codes of passung-import, besides 0 (an answer stands on its standard output, a mesh or errors).
inline constexpr int kWrongWords = 2, kOutOfMemory = 3, kNotWritten = 4;

}  // namespace passung::run
