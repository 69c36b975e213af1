#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/base/device_description.h"
#include "study/plan/study_plan.h"

namespace passung::plan {

/// The mesh files that conditions of the plan name, each once; names are relative to `study`, the plan's own file.
std::vector<NamedMesh> meshesOf(const StudyPlan& plan, const std::string& study);

/// What the devices that conditions of the plan name display stably, by name; of `devices` those that are known.
std::vector<StableStiffness> stableStiffnessOf(const StudyPlan& plan, std::span<const DeviceDescription> devices);

/// Most hands of any condition's scene.
std::size_t mostHands(const StudyPlan& plan);

}  // namespace passung::plan
