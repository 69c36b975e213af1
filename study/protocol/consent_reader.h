#pragma once

#include <vector>

#include "study/protocol/study_plan.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {

/// Reads every [[consent]] of a study. Adds what is wrong to `errors`, also a text that is missing in one language.
std::vector<ConsentClause> readConsent(const TableReader& root, Errors& errors);

/// True for two lower-case letters, as in ISO 639-1: "en".
bool isLanguage(std::string_view text);

}  // namespace passung::protocol
