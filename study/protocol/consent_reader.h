#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/plan/study_plan.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {

/// Reads every [[consent]] of a study. Adds what is wrong to `errors`, also a text that is missing in one language; to
/// `for_people` what must not be shown to them yet.
std::vector<plan::ConsentClause> readConsent(const TableReader& root, Errors& errors, Errors& for_people);

/// A date that nobody has filled in, such as YYYY-MM-DD or TT.MM.JJJJ: three groups of one capital letter each.
std::optional<std::string> unfilledDate(std::string_view text);

/// True for two lower-case letters, as in ISO 639-1: "en".
bool isLanguage(std::string_view text);

}  // namespace passung::protocol
