#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/store/schema/sqlite.h"

namespace passung::store {

struct StudyViewText {
    std::string name;
    std::string sql;  // CREATE VIEW …
};

/// The views v_trials, v_cells, v_scores, v_events, v_thresholds and column_doc for people who query the database, of
/// what it holds now: v_trials has a column for each factor and measure of its protocols.
std::vector<StudyViewText> studyViewTexts(const Database& database);

/// Makes them. What is there already as it should be stays, as does somebody's table of such a name.
/// @pre in a transaction
void makeStudyViews(const Database& database);

/// Tells whether such a view has this name.
bool isStudyView(const std::string& name);
/// Tells whether the statement is as a program wrote it, an older one too, by a digest in it.
bool isAsWritten(const StudyViewText& view);
/// The view that the statement makes, by its beginning; none: another one.
std::optional<std::string> markedName(const std::string& sql);

}  // namespace passung::store
