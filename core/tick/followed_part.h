#pragma once

#include "core/tick/energy_account.h"
#include "core/tick/few_of_many.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// A part that another hand holds too, whose turn found out where it is. Nobody writes it but step().
struct FollowedPart {
    static constexpr bool kOnlyRead = true;
    Pose X_WShared;
    ContactRecord shared_record;
    FewOfMany<double> shared_pressures{1};  // of each obstacle, ObstaclePush::pressure
};

/// Stage of the second of two hands that hold one part: the part's proxy is one, and the first hand's turn has moved it
/// to where both springs and all contacts balance (motion::Pull). What this hand feels is its own spring. Its
/// share of each obstacle's energy is that of the obstacle's pressure in all. The depth at its own pose is not looked
/// up: not a number.
void followOther(const HandModel& model, const FollowedPart& shared, Proxy& proxy, Pushes& pushes,
                 ContactRecord& record, HandDepth& depth) noexcept;
inline constexpr StageOf kFollowedPart{
    followOther,
    {.name = "followed part",
     .parameters = "effects.pick",
     .cost = "a little for each obstacle that pushes",
     .needs = [](const HandModel& model) { return model.follows; },
     .reason = [](const HandModel&) { return "another hand holds the part too, and its turn moves it"; },
     .spared = [](const HandModel&) { return "no other hand holds the part"; }}};

}  // namespace passung::tick
