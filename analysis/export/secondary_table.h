#pragma once

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// secondary.csv: a row for each stimulus of a secondary task and for each press that answers none.
Table makeSecondary(const StudyData& study);

}  // namespace passung::exporter
