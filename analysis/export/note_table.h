#pragma once

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// One row per note and per experimenter's command.
Table makeNotes(const StudyData& study);

}  // namespace passung::exporter
