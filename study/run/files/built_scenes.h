#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "core/tick/scene_sequence.h"
#include "study/session/rendered_scenes.h"

namespace passung::run {

/// The parts of a scene as built, in its order.
using BuiltParts = std::span<const std::shared_ptr<const scene::Part>>;

/// The scenes of an attempt, built, with their tick models. Models borrow from scenes, turns from models: moving it is
/// fine, copying is not.
struct BuiltScenes {
    std::vector<scene::Scene> scenes;
    tick::SceneModels models;
    std::vector<tick::SceneTurn> turns;

    BuiltScenes() = default;
    BuiltScenes(BuiltScenes&&) = default;
    BuiltScenes& operator=(BuiltScenes&&) = default;
};

Result<BuiltScenes> buildScenes(const std::vector<session::RenderedScene>& rendered, scene::PartCache& parts);

}  // namespace passung::run
