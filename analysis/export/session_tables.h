#pragma once

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// @pre `reader` outlives the table, as `study` below
Table makeEvents(const store::StoreReader& reader);
Table makeSessions(const StudyData& study);
Table makeParticipants(const StudyData& study);
Table makeTiming(const StudyData& study);

/// One row per setting that was measured for contact.accuracy = "auto".
Table makeAccuracy(const StudyData& study);

}  // namespace passung::exporter
