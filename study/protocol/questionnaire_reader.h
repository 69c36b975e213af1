#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"
#include "study/questionnaire/definition.h"

namespace passung::protocol {

/// Tells whether this is the text of a questionnaire file. (It has the key `questionnaire` with a name, where a study
/// has tables.)
bool isQuestionnaire(const std::string& text, const std::string& file);

/// Reads the text of a questionnaire file: checks everything, also that all languages have all texts and that the
/// golden vectors come out as written. The texts are those of `language`; of the first one if that is empty or not
/// among the file's languages. All problems are collected, each with its place in `file`.
Result<questionnaire::Definition> readQuestionnaire(const std::string& text, const std::string& file,
                                                    std::string_view language);

}  // namespace passung::protocol
