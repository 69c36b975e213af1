#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/scene/scene.h"
#include "core/tick/step.h"
#include "core/tick/tick_state.h"

namespace passung::hard {

constexpr unsigned kGods = 0b110;  // both god objects, by ContactMethod

/// A tick of a run as it is judged.
struct Tick {
    Pose device, proxy;  // of the held part: X_WH, X_WG
    Wrench sent;         // on the hand, about the held part's origin, world axes, after the output stage
    Wrench commanded;    // the same to the device, about its handle's origin, in its base's axes
    double energy = 0.0;
    double proxy_depth = 0.0;  // as the program says [m]
    double lag = 0.0;          // likewise; NaN: it does not [m]
    std::uint32_t status = 0, contacts = 0, iterations = 0, nodes = 0, rows = 0, turns = 0;
    float us = 0.0f;  // processor time of the tick
};

/// What a case's scene did on its device path.
struct Run {
    scene::SceneSpec spec;
    scene::SceneSpec solids;  // the same, with the closed shapes that its meshes stand for
    std::vector<DeviceReading> readings;
    std::vector<Tick> ticks;
    std::size_t most_points = 0;  // that a manifold holds
    std::size_t all_nodes = 0;    // of all trees
};

/// The next reading of the device at `tick`; `last`: what the tick before gave back (nullptr at first).
using Drive = std::function<DeviceReading(std::int64_t tick, const tick::TickOutput* last)>;

/// A scene file of tests/hard/scenes, without its ending; registration and start gate as `passung simulate` has them.
Result<scene::SceneSpec> readHardScene(const std::string& name);
std::string hardScenePath(const std::string& name);
std::string hardScenesFile(const std::string& name);  // another file there, with its ending

/// Who looks at more of a tick than a Run keeps; its time does not count.
using Onlooker = std::function<void(const tick::HandModel&, const tick::HandState&, const tick::TickOutput&)>;

/// Errors: as scene::buildScene.
Result<Run> runScene(const scene::SceneSpec& spec, const Drive& drive, std::int64_t ticks, const Onlooker& look = {});

/// The run's device path as `passung simulate --trajectory` reads it.
std::string trajectoryCsv(const Run& run);

}  // namespace passung::hard
