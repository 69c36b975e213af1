#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "study/plan/study_plan.h"
#include "study/session/questionnaire_source.h"
#include "study/store/rows/rows.h"

namespace passung::store {

class Database;

/// The instruments that a plan names, each once per language; known ones stay.
void insertQuestionnaires(const Database& database, const plan::StudyPlan& plan);

/// Throws if the plan's questionnaires are not those with which the protocol was imported: its text names their files,
/// and answers to two wordings must not mix.
void requireQuestionnaires(const Database& database, const std::string& protocol_sha256, const plan::StudyPlan& plan);

/// Times at which a questionnaire was filled.
struct FormUtc {
    std::string started;  // unless an event of the segment says when the form was shown
    std::string completed;
    bool measured = false;  // by the wall clock
};

/// One filled questionnaire with its answers, scores and event. @pre in a transaction
void insertQuestionnaireRun(const Database& database, const std::string& session_id, std::int64_t segment_id,
                            const session::QuestionnaireRun& run, const FormUtc& utc);

/// Reads by participant and session, then as asked; answers as presented, scores by name.
std::vector<QuestionnaireRunRow> readQuestionnaireRuns(const Database& database);

}  // namespace passung::store
