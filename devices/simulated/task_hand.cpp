#include "devices/simulated/task_hand.h"

#include "devices/simulated/assemble_hand.h"
#include "devices/simulated/compare_hand.h"
#include "devices/simulated/follow_hand.h"
#include "devices/simulated/hand.h"
#include "devices/simulated/hold_hand.h"
#include "devices/simulated/led_hand.h"
#include "devices/simulated/place_hand.h"

namespace passung::simulated {

std::unique_ptr<TaskHand> makeHand(const HandParams& params, const VisibleTask& task,
                                   const HandRegistration& registration, std::uint64_t seed) {
    if (task.blind) return std::make_unique<LedHand>(params, task, registration, seed);
    if (std::holds_alternative<CompareGoal>(task.goal))
        return std::make_unique<CompareHand>(params, task, registration, seed);
    if (std::holds_alternative<PlaceGoal>(task.goal))
        return std::make_unique<PlaceHand>(params, task, registration, seed);
    if (std::holds_alternative<FollowGoal>(task.goal))
        return std::make_unique<FollowHand>(params, task, registration, seed);
    if (std::holds_alternative<HoldGoal>(task.goal))
        return std::make_unique<HoldHand>(params, task, registration, seed);
    if (std::holds_alternative<AssembleGoal>(task.goal))
        return std::make_unique<AssembleHand>(params, task, registration, seed);
    return std::make_unique<Hand>(params, task, registration, seed);
}

}  // namespace passung::simulated
