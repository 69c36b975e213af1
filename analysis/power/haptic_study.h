#pragma once

#include "analysis/export/study_data.h"
#include "core/base/result.h"
#include "study/plan/study_plan.h"

namespace passung::power {

/// Performs the study with so many simulated participants, every trial simulated tick by tick, in a database of its own
/// in the folder for temporary files (about half a megabyte a trial), and returns what its export would be made of; the
/// database is gone afterwards.
/// An error for contact.accuracy = "auto", which would measure this machine's speed anew every time.
Result<exporter::StudyData> hapticStudy(const plan::StudyPlan& plan, int participants);

}  // namespace passung::power
