#include "core/tick/tick_model.h"

#include "core/tick/tick_state.h"

namespace passung::tick {

TickModel makeModel(const scene::Scene& scene) {
    TickModel model;
    model.world = makeWorld(scene);
    for (std::size_t i = 0; i < scene.spec.handCount(); ++i)
        model.hands.push_back(makeHandModel(model.world, scene, i));
    return model;
}

TickState makeState(const TickModel& model) {
    TickState state;
    for (const Body& body : model.world.bodies) state.X_WP.push_back(body.X_WP_start);
    for (const HandModel& hand : model.hands) state.hands.push_back(makeHandState(hand));
    state.balance = balanceMemory(model.hands);
    return state;
}

}  // namespace passung::tick
