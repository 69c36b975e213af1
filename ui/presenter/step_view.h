#pragma once

#include <optional>
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
    bool hinted = false;  // a hint leads to it
    friend bool operator==(const StepLine&, const StepLine&) = default;
};

/// A pale image of a part, where it belongs next.
struct StepImage {
    std::size_t part = 0;
    Pose X_W;
};

/// How far each step is, in the order of the scene: its part where it is shown.
std::vector<measures::StepState> stepStates(const DrawnPicking& picking, const PartPoses& poses);

/// In the order of the scene. `done`: the steps that are; `hinted`: the one that a hint leads to.
std::vector<StepLine> stepLines(const DrawnPicking& picking, scene::StepSet done,
                                std::optional<std::size_t> hinted = {});

/// The goals of the steps that may be done next, where the parts now are; if the study does not draw these, that of
/// `hinted` alone.
std::vector<StepImage> stepImages(const DrawnScene& scene, std::span<const Pose> X_WP, scene::StepSet done,
                                  std::optional<std::size_t> hinted = {});

/// Of each part: a step that is done keeps it.
std::vector<bool> partsDone(const DrawnScene& scene, scene::StepSet done);

}  // namespace passung::presenter
