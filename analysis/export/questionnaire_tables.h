#pragma once

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// One row per item of every filled questionnaire.
Table makeQuestionnaireItems(const StudyData& study);

/// One row per scale of every filled questionnaire.
Table makeQuestionnaireScores(const StudyData& study);

/// One row per participant and protocol, one column per scale and occasion: means of the counted forms' scores.
Table makeScoresWide(const StudyData& study);

/// One row per scale of at least two items: Cronbach's alpha over the counted forms.
Table makeReliability(const StudyData& study);

}  // namespace passung::exporter
