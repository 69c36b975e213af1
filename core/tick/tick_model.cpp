#include "core/tick/tick_model.h"

#include <algorithm>

#include "core/tick/tick_state.h"

namespace passung::tick {

std::size_t TickModel::placeOf(std::size_t body) const noexcept {
    const auto at = std::lower_bound(pickable.begin(), pickable.end(), body);
    return static_cast<std::size_t>(at - pickable.begin());
}

const HandModel& TickModel::hand(std::size_t hand, std::size_t body, bool follows) const noexcept {
    if (follows) return following[hand][placeOf(body)];
    if (body == hands[hand].body) return hands[hand];
    return body == kNoBody ? carrying[hand].back() : carrying[hand][placeOf(body)];
}

std::uint32_t mostWork(const HandModel& model) noexcept {
    return model.geometry == scene::Geometry::Surface ? static_cast<std::uint32_t>(kSurfaceBudget) : kFieldBudget;
}
std::uint32_t workDone(const HandModel& model, const TickFrame& frame) noexcept {
    return model.hasSurfaces() ? frame.nodes_visited : frame.work;
}

TickModel makeModel(const scene::Scene& scene) {
    const scene::SceneSpec& spec = scene.spec;
    TickModel model;
    model.world = makeWorld(scene);
    model.pick = spec.effects.pick;
    model.step_order = scene::orderOf(model.pick.steps);
    for (std::size_t i = 0; i < spec.parts.size(); ++i)
        if (spec.parts[i].pickable) model.pickable.push_back(i);
    for (std::size_t hand = 0; hand < spec.handCount(); ++hand) {
        const std::size_t held = spec.heldBy(hand);
        model.hands.push_back(makeHandModel(model.world, scene, hand, held < spec.parts.size() ? held : kNoBody));
        if (!model.picks()) continue;
        std::vector<HandModel>&carrying = model.carrying.emplace_back(), &following = model.following.emplace_back();
        if (!spec.canPick(hand)) continue;
        for (const std::size_t body : model.pickable) carrying.push_back(makeHandModel(model.world, scene, hand, body));
        carrying.push_back(makeHandModel(model.world, scene, hand, kNoBody));
        if (spec.handCount() == 1 || spec.contact.method == scene::ContactMethod::Penalty) continue;
        for (const std::size_t body : model.pickable)
            following.push_back(makeHandModel(model.world, scene, hand, body, true));
    }
    return model;
}

TickState makeState(const TickModel& model) {
    TickState state;
    for (const Body& body : model.world.bodies) state.X_WP.push_back(body.X_WP_start);
    for (const HandModel& hand : model.hands) {
        state.hands.push_back(makeHandState(hand));
        state.holds.push_back({.body = hand.body});
    }
    state.waiting.resize(model.pickable.size());
    state.locked.resize(model.world.bodies.size());
    for (std::size_t i = 0; i < model.pickable.size(); ++i) {
        const std::size_t body = model.pickable[i];
        const auto holds = [body](const HandModel& hand) { return hand.body == body; };
        const auto picks = [](const std::vector<HandModel>& of_hand) { return !of_hand.empty(); };
        const auto hand = std::find_if(model.carrying.begin(), model.carrying.end(), picks);
        if (hand == model.carrying.end()) break;
        // Of a part that a hand holds: what that hand has when it has let go.
        const bool is_held = std::any_of(model.hands.begin(), model.hands.end(), holds);
        HandState made = makeHandState(is_held ? hand->back() : (*hand)[i]);
        swapParts(made, state.waiting[i]);
    }
    state.balance = balanceMemory(model);
    return state;
}

}  // namespace passung::tick
