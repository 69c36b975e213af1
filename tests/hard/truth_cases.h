#pragma once

#include <vector>

#include "tests/hard/case.h"

namespace passung::hard {

/// Scenes whose force or pose has a closed form (A1-A11, A13), and the order in which errors fall (A12).
std::vector<Case> truthCases();

}  // namespace passung::hard
