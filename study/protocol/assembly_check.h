#pragma once

#include <span>

#include "core/base/device_description.h"
#include "study/plan/study_plan.h"
#include "study/protocol/factors.h"
#include "study/protocol/part_surface.h"

namespace passung::protocol {

/// Adds an error for every step whose part cannot be there: its goal is out of the hands' reach, or overlaps a part
/// that rests, or one that a step before it puts where it belongs. @pre the condition's trial is an assembly
void checkAssembly(const StudyTables& tables, const plan::Condition& condition,
                   std::span<const DeviceDescription> devices, PartGeometries& geometries, Errors& errors);

}  // namespace passung::protocol
