#pragma once

#include "core/base/device_description.h"
#include "study/plan/study_plan.h"
#include "study/protocol/factors.h"
#include "study/protocol/part_surface.h"

namespace passung::protocol {

/// Adds an error where the held part's body, not its origin alone, has no room: along a line, through a passage, or on
/// the way from its start to the goal. Judged by balls within the part, of any turn if the handle of `device` turns, on
/// a coarse grid that takes a place for free unless none near it is: so what can be done is never refused, and what
/// only a corner of the part forbids may pass. Not judged where nothing stops the hand's part: a penalty gives way, no
/// force is displayed, or real parts are handled. @pre the scene and task were read without errors.
///   A ball of radius ρ about c is free of obstacles if φ(c) ≥ ρ. φ changes by no more than a way is long: of cells
///   with edge h one that holds any free c has φ(middle) ≥ ρ - √3/2 h.
void checkBody(const StudyTables& tables, const plan::Condition& condition, const DeviceDescription& device,
               PartGeometries& geometries, Errors& errors);

}  // namespace passung::protocol
