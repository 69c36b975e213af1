#pragma once

#include <string>
#include <vector>

#include "core/base/device_description.h"
#include "study/plan/study_plan.h"
#include "study/protocol/factors.h"
#include "study/protocol/part_surface.h"

namespace passung::protocol {

/// Tells whether a hand on this device can do the trial. Adds an error, where the protocol says it, for
///   a start, target or corner of a line that the handle cannot reach: the device's workspace is a ball about the
///   origin of its base, and  p_B = scale⁻¹ · (X_WB⁻¹ X_WH X_DH⁻¹).p  has to lie in it, but for the task's tolerance;
///   a goal or an end where the held part stands in an obstacle, deeper than the tolerances allow;
///   a line that lies in an obstacle; a passage that the held part does not fit through, however it is turned in it;
///   an orientation that the goal asks for on a device whose handle does not turn;
///   a tolerance finer than the device's encoders; a force above the device's; a clock that no way could start; a
///   time-out that leaves less than a metre a second;
/// and to `warnings` a sentence if the held part's size, or the way, looks like a slip in the unit. Parts whose mesh
/// cannot be read are left out. @pre scene and task are sound.
void checkReach(const StudyTables& tables, const plan::Condition& condition, const DeviceDescription& device,
                PartGeometries& geometries, Errors& errors, std::vector<std::string>& warnings);

/// The value of a key of the scene as the protocol writes it, if that is a number.
const Node* numberAt(const Node& scene, const std::string& path);

}  // namespace passung::protocol
