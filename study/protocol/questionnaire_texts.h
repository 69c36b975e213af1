#pragma once

#include <string>

#include "core/base/result.h"
#include "study/questionnaire/definition.h"

namespace passung::protocol {

/// Puts a lab's texts into a template. `text` is of the file `file`; it must have a text for each item once, and the
/// limits of the answers as the questionnaire has them. Items are then in the order of that file.
Result<questionnaire::Definition> withTexts(questionnaire::Definition definition, const std::string& text,
                                            const std::string& file);

}  // namespace passung::protocol
