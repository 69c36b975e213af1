#pragma once

#include <vector>

#include "core/base/types.h"
#include "core/scene/scene.h"
#include "core/tick/scene_sequence.h"

namespace passung::tick {

/// What the tick's query says at one pose.
struct QueryReading {
    double depth = 0.0;  // [m], ≥ 0
    Wrench wrench;       // area-weighted penalty on the held part about its origin, world axes
};

/// The query of a tick, by the tick's own stages, to measure its errors and its time; under a budget of nodes as far as
/// that lets it come, though a god object's look goes on in the next tick. Memory is sized once.
class TickQuery {
public:
    /// `area_stiffness`: κ of the wrench [N/m³]. @pre `scene` has Geometry::Field; its parts outlive this
    TickQuery(const scene::Scene& scene, double area_stiffness);
    ~TickQuery();
    TickQuery(const TickQuery&) = delete;
    TickQuery& operator=(const TickQuery&) = delete;

    /// With the held part at `X_WS`. rt-safe.
    QueryReading at(const Pose& X_WS) noexcept;

    /// How far the nearest point is, wherever it is [m]. rt-safe.
    double distanceAt(const Pose& X_WS) noexcept;

private:
    SceneModels models_;             // of the one scene
    std::vector<TickState> states_;  // its one
    scene::ContactSpec weighted_;
};

}  // namespace passung::tick
