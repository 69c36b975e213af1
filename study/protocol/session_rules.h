#pragma once

#include "study/plan/study_plan.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {

/// What a [[block]] says of trials that are repeated, into `block`.
void readRepeats(const TableReader& read, plan::Block& block);

/// [resume] of the study `root`.
plan::ResumePolicy readResume(const TableReader& root, Errors& errors);

}  // namespace passung::protocol
