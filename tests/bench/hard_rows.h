#pragma once

#include "tests/bench/contact_rows.h"

namespace passung::bench {

inline constexpr const char* kHardGroup = "hard cases";

/// A row per hard case and method (tests/hard/case.h): its number beside its mark, and what a tick took; infinite where
/// something else that had to hold did not. All strokes, seeds and minutes if PASSUNG_HARD_FULL is in the environment.
/// Then a row per figure of what was found (tests/hard/found.h), with what it was before.
/// Errors: a scene cannot be read or built.
Result<std::vector<Row>> hardRows(const Extent& extent);

/// Writes the device path of every case with the heuristic, reduced size, as NAME.csv for `passung simulate`; of what
/// was found on meshes also the scene.
/// Errors: as above, or a file cannot be written.
Result<bool> writeHardPaths(const std::string& folder);

}  // namespace passung::bench
