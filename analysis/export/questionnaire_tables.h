#pragma once

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// One row per item of every filled questionnaire.
Table makeQuestionnaireItems(const StudyData& study);

/// One row per scale of every filled questionnaire.
Table makeQuestionnaireScores(const StudyData& study);

/// One row per participant, protocol and session, one column per scale and occasion: means of the counted forms'
/// scores.
Table makeScoresWide(const StudyData& study);

/// One row per item of every questionnaire and language, filled or planned: texts, answers, polarity, scales.
Table makeQuestionnaireKeys(const StudyData& study);

/// One row per scale of at least two items and occasion, and of repeated ones between and within persons: Cronbach's
/// alpha over the counted forms.
Table makeReliability(const StudyData& study);

}  // namespace passung::exporter
