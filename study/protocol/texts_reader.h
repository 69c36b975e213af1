#pragma once

#include <functional>
#include <string>

#include "study/plan/study_plan.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {

/// Reads `[text.LANGUAGE]` and `[[instruction]]`. @pre plan has its blocks and its consent. Errors: a text that a
/// language lacks, an instruction without text or with a block that is not there.
void readTexts(const TableReader& root, plan::StudyPlan& plan, Errors& errors);

/// What is wrong with the pictures: not there, or neither PNG nor JPEG by their content.
Errors checkPictures(const plan::StudyPlan& plan,
                     const std::function<Result<std::string>(const std::string& path)>& read);

}  // namespace passung::protocol
