#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/plan/study_plan.h"

namespace passung::plan {

/// Languages that a participant of the study may be spoken to in: those of its texts, else of its clauses of consent,
/// else of its questionnaires; a study without any of these is in English.
std::vector<std::string> languagesOf(const StudyPlan& plan);

/// `asked`, or (empty) the first of languagesOf(). Errors: it is none of them.
Result<std::string> chooseLanguage(const StudyPlan& plan, const std::string& asked);

/// Tells whether the study is in several languages of which this is one.
bool speaks(const StudyPlan& plan, const std::string& language);

/// Languages that a questionnaire is asked in, each session in its own: all of a study with several of which its own
/// is one. A template's texts are in one.
std::vector<std::string> languagesAsked(const StudyPlan& plan, const PlannedQuestionnaire& planned);

}  // namespace passung::plan
