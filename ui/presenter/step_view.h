#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/measures/assembly_watch.h"
#include "ui/presenter/drawn_scene.h"
#include "ui/presenter/part_poses.h"

namespace passung::presenter {

/// A step of an assembly as its list shows it.
struct StepLine {
    std::string name;
    enum class State { Done, Next, Later } state = State::Later;
    friend bool operator==(const StepLine&, const StepLine&) = default;
};

/// A pale image of a part, where it belongs next.
struct StepImage {
    std::size_t part = 0;
    Pose X_W;
};

/// How far each step is, in the order of the scene: its part where it is shown.
std::vector<measures::StepState> stepStates(const DrawnPicking& picking, const PartPoses& poses);

/// In the order of the scene. `done`: the steps that are.
std::vector<StepLine> stepLines(const DrawnPicking& picking, scene::StepSet done);

/// The step is not done, and all that it is after are.
bool mayBeNext(const scene::AssemblyStep& step, std::size_t index, scene::StepSet done);

/// The goals of the steps that may be done next, where the parts now are; none if the study gives no hints.
std::vector<StepImage> stepImages(const DrawnScene& scene, std::span<const Pose> X_WP, scene::StepSet done);

/// Of each part: a step that is done keeps it.
std::vector<bool> partsDone(const DrawnScene& scene, scene::StepSet done);

}  // namespace passung::presenter
