#pragma once

#include "core/scene/scene_spec.h"

namespace passung::test {

/// Every effect, so that hands of a few centimetres a second reach it.
/// The names of all stand here: a new one in scene::Effects stops the build.
inline scene::Effects everyEffect() {
    const scene::Effects effects{
        .passivity_damping = 5.0,
        .transients = {.amplitude = 5.0, .frequency = 150.0, .decay = 0.01},
        .weight = {.gravity = Vec3(0.0, 0.0, -scene::kStandardGravity)},
        .pick = {},  // no stage: it changes what a hand holds (pick_test.cpp)
        .navigation = {.clutch = {.button = 2},
                       .second_scale = {.button = 3, .scale = 0.5},
                       .drift = {.share = 0.1, .radius = 0.05}},
    };
    [[maybe_unused]] const auto& [passivity_damping, transients, weight, pick, navigation] = effects;
    return effects;
}

/// The same in a scene, whose held parts weigh.
inline void addEveryEffect(scene::SceneSpec& spec) {
    spec.effects = everyEffect();
    for (scene::PartSpec& part : spec.parts)
        if (part.held) part.density = 7850.0;
}

}  // namespace passung::test
