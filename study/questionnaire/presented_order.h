#pragma once

#include <cstdint>
#include <vector>

#include "study/questionnaire/definition.h"

namespace passung::questionnaire {

/// Order in which the items are shown: indices of items. As the file lists them, or, if the definition is shuffled,
/// neighbours of one kind of answer shuffled among themselves (so that ratings stay before the pairs about them).
/// `seed`: of the named stream "item_order".
std::vector<std::size_t> presentedOrder(const Definition& definition, std::uint64_t seed);

}  // namespace passung::questionnaire
