#pragma once

#include <cstdlib>

namespace passung::test {

/// Whether tests walk all of their cases (PASSUNG_LONG=1, which ./dev check-all sets), or what is worth its minutes at
/// every commit.
inline bool atFullLength() { return std::getenv("PASSUNG_LONG") != nullptr; }

}  // namespace passung::test
