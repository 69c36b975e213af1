#pragma once

#include <string>
#include <vector>

#include "study/plan/study_plan.h"
#include "study/store/rows/rows.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

// For this room only: they throw.

void insertConsentClauses(const Database& database, const std::string& protocol_sha256,
                          const std::vector<plan::ConsentClause>& clauses);

/// Every clause of every protocol in the order in which they are asked.
std::vector<ConsentClauseRow> readConsentClauses(const Database& database);

/// The latest decision of every participant on every text, by participant, then in the order of deciding.
std::vector<ConsentRow> readConsents(const Database& database);

}  // namespace passung::store
