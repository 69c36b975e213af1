#pragma once

#include "analysis/export/export.h"
#include "core/base/result.h"

namespace passung::report {

/// Recorded ticks of the trials that count, thinned for pictures: one each 25 ms or, of long trials and large studies,
/// more rarely, and each at which contact begins. Of two hands the first's. Nothing is computed. No columns: no trial
/// counts.
Result<exporter::ExportedFile> courseFile(const store::StoreReader& reader, const exporter::StudyData& study);

}  // namespace passung::report
