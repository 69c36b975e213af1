#pragma once

#include <span>
#include <string>

#include "core/base/device_description.h"
#include "core/loop/stability.h"
#include "core/scene/scene_spec.h"
#include "study/plan/study_plan.h"

namespace passung::run {

/// How stiff a wall a device bears by the model of its mechanism: translation [N/m] or rotation [N·m/rad]; 0: none.
struct WallBounds {
    double border = 0.0;            // exact, of the linear model
    double linear = 0.0;            // rule of thumb
    double passive = 0.0;           // never gives out energy, with the device's encoder steps and dry friction
    double passive_undamped = 0.0;  // the same for a wall without damping
};

/// Bounds of a wall with `damping` felt on the device, `delay_ticks` in all.
WallBounds translationBounds(const DeviceMechanism& mechanism, double damping, int delay_ticks);
WallBounds rotationBounds(const DeviceMechanism& mechanism, double damping, int delay_ticks);

/// A scene's wall as its device feels it, and the bounds for it.
struct SceneWall {
    double stiffness = 0.0;  // scale included: lengths of the scene are longer by it, forces are not
    WallBounds bounds;
};
/// A coupled penalty: translation's border is then the exact one through the tool, over all contacts that the scene can
/// make: up to `penalty_stiffness`, or, with variants whose stiffness depends on how many points touch, up to a rigid
/// one. Of a scene with inertia both are those with a mass in the air too, whichever it is.
bool feltThroughTool(const scene::ContactSpec& contact);
SceneWall translationWall(const DeviceDescription& device, const scene::SceneSpec& scene);
SceneWall rotationWall(const DeviceDescription& device, const scene::SceneSpec& scene);

/// Conditions whose coupling is stiffer than that, one for each stiffness and border, unless their protocol takes
/// responsibility for it.
Errors beyondBorder(const plan::StudyPlan& plan, std::span<const DeviceDescription> devices);

/// Null: there is none of this name.
const DeviceDescription* deviceNamed(const std::string& name, std::span<const DeviceDescription> devices);

}  // namespace passung::run
