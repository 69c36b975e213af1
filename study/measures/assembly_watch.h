#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/tick_record.h"
#include "core/scene/assembly.h"
#include "core/scene/scene_spec.h"
#include "study/measures/measures.h"
#include "study/measures/parts_watch.h"

namespace passung::measures {

/// How far a step is. From Picked to Inserted the part is in a hand.
enum class StepState {
    Idle,      // nobody holds the part, or it lies where it does not belong
    Picked,    // in a hand, where it was taken
    Carried,   // farther than kCarried from there
    Near,      // within kNear position tolerances of its goal
    Inserted,  // within both tolerances of its goal
    Locked     // done
};
const char* stepStateName(StepState state);  // as stored

inline constexpr double kCarried = 0.005;  // [m]
inline constexpr double kNear = 10.0;      // position tolerances

/// The state of a step whose part is in a hand that has moved it this far from where it took it [m], from Picked to
/// Inserted. `X_WP`: of all parts.
StepState stateInHand(const scene::AssemblyStep& step, std::span<const Pose> X_WP, double moved);

/// Something that happened to a step.
struct StepChange {
    std::size_t step = 0;
    enum class What { State, LetGo, OrderError, Undone, Hint } what = What::State;
    StepState state = StepState::Idle;  // that it is in now
    std::size_t hand = 0;               // that did it; 0 where none did
};

/// An assembly, tick by tick, from the records of all hands alone. Within one hold a step goes on from state to state
/// and not back.
class AssemblyWatch {
public:
    /// Of the steps of this scene.
    explicit AssemblyWatch(const scene::SceneSpec& spec);

    /// `hands`: each hand's record of a tick, in the order of the scene; of a hand that is not told nullptr. `time`: of
    /// the tick [haptic periods, from any origin]. Appends what happened.
    void follow(std::span<const TickRecord* const> hands, std::int64_t time, std::vector<StepChange>& changes);

    /// The steps that are done.
    scene::StepSet done() const { return done_; }
    bool allDone() const { return done_ == ~std::uint64_t{0} >> (64 - steps_.size()); }
    /// Of each step, times from `start` [periods, as told to follow()].
    std::vector<StepResult> results(std::int64_t start) const;

private:
    std::optional<std::size_t> stepOf(std::size_t part) const;
    bool isAtGoal(std::size_t step) const { return scene::isAtGoal(steps_[step], parts_.poses()); }
    scene::GoalError errorOf(std::size_t step) const;
    void take(std::size_t step, std::size_t hand, const Vec3& from, std::int64_t time,
              std::vector<StepChange>& changes);
    void carry(std::size_t step, std::size_t hand, const Vec3& from, std::int64_t periods,
               std::vector<StepChange>& changes);
    void layDown(std::size_t step, std::size_t hand, std::vector<StepChange>& changes);
    void settle(std::uint64_t done, std::int64_t time, std::vector<StepChange>& changes);
    void enter(std::size_t step, StepState state, std::size_t hand, std::vector<StepChange>& changes);

    std::vector<scene::AssemblyStep> steps_;
    PartsWatch parts_, before_;  // after the newest tick and the one before
    std::vector<StepState> states_;
    std::vector<Vec3> taken_at_;  // of each step's part
    std::vector<StepResult> results_;
    std::uint64_t done_ = 0;
    std::optional<std::int64_t> time_;  // of the newest tick
};

}  // namespace passung::measures
