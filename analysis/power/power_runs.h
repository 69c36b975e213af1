#pragma once

#include <functional>

#include "analysis/export/study_data.h"
#include "analysis/power/planted_effect.h"
#include "analysis/power/power_file.h"
#include "core/base/result.h"
#include "study/plan/study_plan.h"

namespace passung::power {

/// Performs a study with so many simulated participants; its data depends on the plan alone. Called by several threads
/// at once.
using Perform = std::function<Result<exporter::StudyData>(const plan::StudyPlan& plan, int participants)>;

/// The job for a plan, its seed included. `test`: see chooseTest().
PowerJob describeJob(const plan::StudyPlan& plan, const PlantedEffect& effect, const std::string& test);

/// The seed of a virtual study: its people, orders and everything else random.
std::uint64_t runSeed(const plan::StudyPlan& plan, std::int64_t run);

/// Every virtual study of the shard on all cores: performed with a seed of its own, given the effect, tested. The first
/// error ends it. `progress` gets the share that is done, from one thread at a time; it may be empty.
Result<PowerResult> runShard(const PowerJob& job, const Shard& shard, const PlantedEffect& effect,
                             const plan::StudyPlan& plan, const Perform& perform,
                             const std::function<void(double)>& progress);

}  // namespace passung::power
