#pragma once

#include "core/scene/scene_spec.h"

namespace passung::test {

/// Every effect, so that hands of a few centimetres a second reach it. The names of all stand here: a new one in
/// scene::Effects stops the build.
inline scene::Effects everyEffect() {
    const scene::Effects effects{
        .passivity_damping = 5.0,
        .transients = {.amplitude = 5.0, .frequency = 150.0, .decay = 0.01},
    };
    [[maybe_unused]] const auto& [passivity_damping, transients] = effects;
    return effects;
}

}  // namespace passung::test
