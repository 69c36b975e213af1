#pragma once

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

Table makeEvents(const StudyData& study);
Table makeSessions(const StudyData& study);
Table makeParticipants(const StudyData& study);
Table makeTiming(const StudyData& study);

/// One row per setting that was measured for contact.accuracy = "auto".
Table makeAccuracy(const StudyData& study);

}  // namespace passung::exporter
