#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/truth/accuracy_sweep.h"
#include "core/base/result.h"
#include "core/scene/build_store.h"
#include "study/plan/study_plan.h"
#include "study/run/files/mesh_importer.h"
#include "study/store/rows/rows.h"

namespace passung::run {

/// True if a condition has contact.accuracy = "auto".
bool asksForAccuracy(const plan::StudyPlan& plan);

/// Measures on this machine what settings cost and err in the plan's scenes, and picks the one of least error for each
/// budget: the same for all conditions that share it, so that accuracy does not vary with their geometry.
/// Errors: see truth::measureCandidates; a budget that no setting fits.
Result<std::vector<store::AccuracyRow>> measureAccuracy(const plan::StudyPlan& plan, const std::string& protocol_sha256,
                                                        const truth::StepReport& report, scene::BuildStore* builds);

/// Writes what was picked into the scenes that ask for it; rows of other protocols do not count. Errors: a budget that
/// nothing was picked for.
Result<Done> applyAccuracy(const std::string& protocol_sha256, std::span<const store::AccuracyRow> rows,
                           plan::StudyPlan& plan, const ImportLimits& limits = {});

/// What picked settings take longer than their budget on this machine, in words, a sentence each.
Result<std::vector<std::string>> tooSlowHere(const plan::StudyPlan& plan, std::span<const store::AccuracyRow> rows,
                                             scene::BuildStore* builds);

/// What was picked for each budget and why, in words, the keys that would fix it in a protocol. `rows`: of one
/// protocol.
std::string describePick(std::span<const store::AccuracyRow> rows);

/// What was picked, in words, with everything that was measured. `rows`: of one protocol.
std::string describeAccuracy(std::span<const store::AccuracyRow> rows);

}  // namespace passung::run
