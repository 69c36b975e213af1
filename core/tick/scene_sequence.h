#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "core/tick/energy_account.h"
#include "core/tick/step.h"

namespace passung::tick {

inline constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();

/// The models (tick_model.h) of scenes, for who need not look into them. A model stays where it is when the whole
/// moves.
class SceneModels {
public:
    SceneModels();
    /// makeModel() of each. @pre the scenes' parts outlive this
    explicit SceneModels(std::span<const scene::Scene> scenes);
    /// Of one scene.
    explicit SceneModels(const scene::Scene& scene) : SceneModels(std::span(&scene, 1)) {}
    SceneModels(SceneModels&&) noexcept;
    SceneModels& operator=(SceneModels&&) noexcept;
    ~SceneModels();

    std::size_t size() const noexcept;
    /// @pre `i` < size()
    const TickModel& operator[](std::size_t i) const noexcept;
    /// Those of the scene number `i`, in the order of the tick; of several hands, and of all that they may hold, each
    /// once. @pre `i` < size()
    std::vector<Stage> stages(std::size_t i) const;
    /// Those that scene number `i` does without, in whichever hand; a stage that one hand has is not among them.
    std::vector<SparedStage> spared(std::size_t i) const;
    /// Of the surfaces and smooth solids that scene number `i` computes contact from [bytes]; fields and points are its
    /// parts'. @pre `i` < size()
    std::size_t memoryBytes(std::size_t i) const noexcept;

private:
    std::vector<TickModel> models_;
};

/// A part that can be picked up and that nobody holds.
struct PartAtRest {
    std::int32_t part = kNoPart;  // in the order of the scene; kNoPart: none
    Pose X_WP;
};

/// One of the scenes that are rendered one after the other in one attempt.
struct SceneTurn {
    const TickModel* model = nullptr;  // outlives the sequence
    std::int64_t periods = kForever;   // haptic periods from its first engaged tick until the next scene's turn, > 0
};

/// Scenes in turn, ticks counted through. Each begins as a trial does, with its start gate closed and no wrench; when
/// it has been engaged for its periods the next one takes over; the last one stays. Which scene a tick belongs to
/// follows from the readings and outputs alone, so that a replay finds it again. Only the tick's number and the hash
/// over all outputs go on from scene to scene; the energy account starts anew.
class SceneSequence {
public:
    /// Allocates all that the ticks need. @pre `turns` is not empty
    explicit SceneSequence(std::span<const SceneTurn> turns);
    ~SceneSequence();
    SceneSequence(const SceneSequence&) = delete;
    SceneSequence& operator=(const SceneSequence&) = delete;

    /// One tick of scenes that have as many hands as there are readings and outputs. The next scene's turn comes when
    /// all of them are engaged for its periods. rt-safe.
    void step(std::span<const DeviceReading> readings, std::span<TickOutput> outputs) noexcept;
    /// The same of scenes with one hand.
    TickOutput step(const DeviceReading& reading) noexcept;

    /// Number of the next tick.
    std::int64_t tick() const noexcept;
    std::uint64_t hash() const noexcept;
    /// Of the parts that can be picked up the one whose turn it is, if it rests after the newest tick. rt-safe.
    PartAtRest atRest(std::uint64_t turn) const noexcept;
    /// Of each scene in turn: energy of its obstacles in the order of the scene, and of what none pushed.
    std::vector<PairAccount> pairs() const;

private:
    std::vector<SceneTurn> turns_;
    std::vector<TickState> states_;  // one per turn
    std::size_t current_ = 0;
    bool engaged_ = false;       // in the current turn
    std::int64_t rendered_ = 0;  // periods since it engaged
};

}  // namespace passung::tick
