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
        .viscosity = {.damping = 2.0, .rotational_damping = 1e-3},
        .guidance = {.share = 0.5,
                     .X_WG = {{rotationFromVector(Vec3(0.2, 0, 0)), Vec3(0.004, 0, 0.008)},
                              {Quat::Identity(), Vec3(-0.004, 0.002, 0.012)}},
                     .lead = 0.003},
        .snap = {.stiffness = 200.0, .range = 0.02, .X_WG = {{Quat::Identity(), Vec3(0.002, 0.003, 0.012)}}},
        .inertia = {.scale = 1.0},
        .keep_apart = {.stiffness = 100.0, .range = 0.03},
        .pick = {},  // no stage: it changes what a hand holds (pick_test.cpp)
        .navigation = {.clutch = {.button = 2},
                       .second_scale = {.button = 3, .scale = 0.5},
                       .drift = {.share = 0.1, .radius = 0.05}},
        .record = true,
    };
    [[maybe_unused]] const auto& [passivity_damping, transients, weight, viscosity, guidance, snap, inertia, keep_apart,
                                  pick, navigation, record] = effects;
    return effects;
}

/// The same in a scene, whose held parts weigh, but for what it cannot have.
inline void addEveryEffect(scene::SceneSpec& spec) {
    spec.effects = everyEffect();
    if (spec.contact.method == scene::ContactMethod::Penalty) spec.effects.inertia = {};
    if (spec.handCount() < 2) spec.effects.keep_apart = {};
    for (scene::PartSpec& part : spec.parts)
        if (part.held) part.density = 7850.0;
}

}  // namespace passung::test
