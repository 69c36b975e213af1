#pragma once

#include <vector>

#include "core/scene/scene.h"
#include "core/tick/scene_sequence.h"

namespace passung::tick {

/// Ticks in which the first hand's part of a scene is pressed two millimetres into the nearest obstacle and slides on
/// it, to measure what they cost; other hands rest where they start. The start gates are open, and the registrations
/// have nothing to do. Without obstacles the way leads two centimetres along x.
class PressedRun {
public:
    static constexpr int kApproachTicks = 500;  // until it is pressed

    /// Allocates all that the ticks need. @pre the scene's parts outlive this
    explicit PressedRun(const scene::Scene& scene);
    ~PressedRun();
    PressedRun(const PressedRun&) = delete;
    PressedRun& operator=(const PressedRun&) = delete;

    /// What the first hand's device reads in tick `i`, counted from 0. rt-safe.
    DeviceReading readingAt(int i) const noexcept;
    /// One tick, what it gives the first hand. rt-safe.
    TickOutput step(const DeviceReading& reading, const StageWatch* watch = nullptr) noexcept;

    /// What caps the looks of a tick, as tick_model.h counts them; 0: nothing, closed forms and the penalty look once.
    std::uint32_t mostWork() const noexcept;
    /// Of them, the first hand's in the tick that gave this. rt-safe.
    std::uint32_t workDone(const TickOutput& output) const noexcept;

private:
    SceneModels models_;             // of the one scene
    std::vector<TickState> states_;  // its one
    std::vector<DeviceReading> readings_;
    std::vector<TickOutput> outputs_;
    Pose X_WG_start_;
    Vec3 way_, aside_;  // to the pressed pose [m]; unit, square to it
};

}  // namespace passung::tick
