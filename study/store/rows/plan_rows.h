#pragma once

#include <vector>

#include "study/store/rows/rows.h"

namespace passung::store {

class Database;

// What protocols plan, as rows. For this room only: whatever touches the database throws.

/// Main blocks of the plan without a staircase.
std::vector<std::string> readMainBlocks(const Database& database, const std::string& expanded_json);
std::vector<ConditionRow> readConditions(const Database& database);      // those that sessions plan
std::vector<PlannedCellRow> readPlannedCells(const Database& database);  // by participant, session, block, condition
std::vector<AnalysisRow> readAnalyses(const Database& database);
std::vector<DataRuleRow> readDataRules(const Database& database);
std::vector<NamedFileRow> readNamedFiles(const Database& database);
std::vector<QuestionnaireRow> readQuestionnaires(const Database& database);

}  // namespace passung::store
