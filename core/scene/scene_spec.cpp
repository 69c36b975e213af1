#include "core/scene/scene_spec.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/scene/contact_geometry.h"

namespace passung::scene {

namespace {

class Checks {
public:
    void positive(const char* key, double value) {
        require(std::isfinite(value) && value > 0.0, key, value, "must be > 0");
    }
    void notNegative(const char* key, double value) {
        require(std::isfinite(value) && value >= 0.0, key, value, "must be ≥ 0");
    }
    void require(bool holds, const std::string& key, double value, const char* requirement) {
        if (!holds) errors.push_back({.message = requirement, .key = key, .value = std::to_string(value)});
    }
    void finite(const std::string& key, const Pose& pose) {
        if (!isFinite(pose) || !(std::abs(pose.q.norm() - 1.0) < 1e-9)) {
            errors.push_back({.message = "must be finite with a unit rotation", .key = key});
        }
    }
    void device(const HandSpec& hand) {
        const auto& [limits, registration, start_gate, name, navigation] = hand;
        finite("start gate: pose", start_gate.X_WH);
        positive("limits: max force", limits.max_force);
        notNegative("limits: max torque", limits.max_torque);
        positive("limits: max force rate", limits.max_force_rate);
        positive("limits: max speed", limits.max_speed);
        positive("limits: max spin", limits.max_spin);
        require(limits.delay_ticks >= 0 && limits.delay_ticks <= kMaxDelayTicks, "limits: delay_ticks",
                limits.delay_ticks, "must be 0 … 100");
        finite("registration: device base", registration.X_WB);
        finite("registration: handle", registration.X_DH);
        positive("registration: scale", registration.scale);
        notNegative("start gate: position tolerance", start_gate.position_tolerance);
        notNegative("start gate: angle tolerance", start_gate.angle_tolerance);
        require(start_gate.hold_ticks >= 0, "start gate: hold", start_gate.hold_ticks, "must be ≥ 0");
        navigate(navigation);
    }
    void navigate(const Navigation& navigation) {
        const auto& [clutch, second_scale, drift] = navigation;
        for (const int button : {clutch.button, second_scale.button})
            require(button >= 0 && button <= kButtons, "navigation: button", button, "must be 1 … 24, or 0 for none");
        require(clutch.button == 0 || clutch.button != second_scale.button, "navigation: button", clutch.button,
                "must differ for clutch and scale");
        positive("navigation: scale", second_scale.scale);
        require(drift.share >= 0.0 && drift.share <= kMostDrift, "navigation: share", drift.share, "must be 0 … 0.5");
        positive("navigation: radius", drift.radius);
        require(drift.home.allFinite(), "navigation: home", drift.home.norm(), "must be finite");
    }
    std::vector<Error> errors;
};

void checkGuidance(const SceneSpec& scene, Checks& check) {
    const Guidance& guidance = scene.effects.guidance;
    check.require(guidance.share >= 0.0 && guidance.share <= 1.0, "effects: guidance: share", guidance.share,
                  "must be 0 … 1");
    check.positive("effects: guidance: speed", guidance.speed);
    check.positive("effects: guidance: lead", guidance.lead);
    check.notNegative("effects: guidance: stiffness", guidance.stiffness);
    check.notNegative("effects: guidance: rotational stiffness", guidance.rotational_stiffness);
    for (const Pose& X_WG : guidance.X_WG) check.finite("effects: guidance: way", X_WG);
    const auto poses = static_cast<double>(guidance.X_WG.size());
    check.require(guidance.X_WG.size() <= kMostWayPoses, "effects: guidance: way", poses, "must have at most 64 poses");
    if (!(guidance.share > 0.0)) return;
    check.require(!guidance.X_WG.empty(), "effects: guidance: way", poses, "must have a pose at least");
    check.require(!scene.effects.picks(), "effects: guidance: share", guidance.share,
                  "must be 0 where parts are picked up: its way is that of one part");
}

void checkSnap(const SceneSpec& scene, Checks& check) {
    const Snap& snap = scene.effects.snap;
    check.notNegative("effects: snap: stiffness", snap.stiffness);
    check.positive("effects: snap: range", snap.range);
    for (const Pose& X_WG : snap.X_WG) check.finite("effects: snap: at", X_WG);
    const auto poses = static_cast<double>(snap.X_WG.size());
    check.require(snap.X_WG.size() <= kMostWayPoses, "effects: snap: at", poses, "must have at most 64 poses");
    if (!snap.any()) return;
    check.require(!snap.X_WG.empty() || scene.effects.picks(), "effects: snap: at", poses,
                  "must have a pose where no part is picked up");
}

void checkInertia(const SceneSpec& scene, Checks& check) {
    const double scale = scene.effects.inertia.scale;
    check.notNegative("effects: inertia: scale", scale);
    check.require(!(scale > 0.0) || scene.contact.method != ContactMethod::Penalty, "effects: inertia: scale", scale,
                  "must be 0 with the penalty: no proxy moves on by itself");
}

void checkKeepApart(const SceneSpec& scene, Checks& check) {
    const KeepApart& apart = scene.effects.keep_apart;
    check.notNegative("effects: keep apart: stiffness", apart.stiffness);
    check.positive("effects: keep apart: range", apart.range);
    check.require(!apart.any() || scene.handCount() > 1, "effects: keep apart: stiffness", apart.stiffness,
                  "must be 0 with one hand");
}

}  // namespace

std::size_t SceneSpec::heldBy(std::size_t i) const {
    const auto held = [i](const PartSpec& part) { return part.held && part.hand == i; };
    return static_cast<std::size_t>(std::find_if(parts.begin(), parts.end(), held) - parts.begin());
}

bool SceneSpec::canPick(std::size_t i) const {
    const std::size_t held = heldBy(i);
    return effects.picks() && (held == parts.size() || parts[held].pickable);
}

std::vector<std::size_t> SceneSpec::obstaclesOf(std::size_t i) const {
    std::vector<std::size_t> obstacles;
    for (std::size_t part = 0; part < parts.size(); ++part)
        if (part != heldBy(i) || canPick(i)) obstacles.push_back(part);
    return obstacles;
}

std::vector<Error> SceneSpec::validate() const {
    Checks check;
    std::vector<int> held(handCount());
    std::set<std::string> names;
    for (const auto& part : parts) {
        if (part.held && part.hand < held.size()) ++held[part.hand];
        if (part.held && part.hand >= held.size())
            check.errors.push_back(
                {.message = "is held by a hand that the scene has not", .key = "part", .value = part.name});
        check.finite("part " + part.name + ": pose", part.X_WP);
        if (!names.insert(part.name).second) {
            check.errors.push_back({.message = "part names must differ", .key = "part", .value = part.name});
        }
        if (const auto* shape = std::get_if<shape::Shape>(&part.geometry)) {
            for (auto error : shape::validate(*shape)) {
                error.key = "part " + part.name + ": " + error.key;
                check.errors.push_back(std::move(error));
            }
        }
    }
    for (const PartSpec& part : parts) {
        check.notNegative("part: density", part.density);
        check.notNegative("part: friction", part.friction);
        check.notNegative("part: sliding friction", part.sliding_friction);
        check.require(!(part.sliding_friction > part.friction), "part: sliding friction", part.sliding_friction,
                      "must not exceed the friction at rest");
    }
    check.require(held.size() <= kMostHands, "hands", static_cast<double>(held.size()), "must be 1 … 4");
    for (const int parts_of_hand : held)
        if (effects.picks())
            check.require(parts_of_hand <= 1, "part: held", parts_of_hand, "each hand may hold one part at most");
        else
            check.require(parts_of_hand == 1, "part: held", parts_of_hand,
                          held.size() == 1 ? "exactly one part must be held" : "each hand must hold exactly one part");
    const bool pickable = std::any_of(parts.begin(), parts.end(), [](const PartSpec& part) { return part.pickable; });
    check.notNegative("effects: pick: reach", effects.pick.reach);
    check.require(effects.pick.button >= 1 && effects.pick.button <= kButtons, "effects: pick: button",
                  effects.pick.button, "must be 1 … 24");
    for (std::size_t i = 0; effects.picks() && i < handCount(); ++i) {
        const Navigation navigation = hand(i).navigation;
        check.require(
            effects.pick.button != navigation.clutch.button && effects.pick.button != navigation.second_scale.button,
            "effects: pick: button", effects.pick.button, "must be another one than those of navigation");
    }
    const int undo = effects.pick.undo_button;
    check.require(undo >= 0 && undo <= kButtons && undo != effects.pick.button, "effects: pick: undo_button", undo,
                  "must be 1 … 24, or 0 for none, and another one than effects.pick.button");
    for (const StepProblem& problem : problemsOf(effects.pick.steps, *this))
        check.errors.push_back(
            {.message = problem.message,
             .key = "effects: pick: step " + std::to_string(problem.step + 1) + ": " + std::string(problem.key)});
    check.require(pickable == effects.picks(), "effects: pick: reach", effects.pick.reach,
                  pickable ? "must be > 0 where a part is pickable" : "must be 0 where no part is pickable");
    check.positive("contact: stiffness", contact.stiffness);
    check.notNegative("contact: rotational stiffness", contact.rotational_stiffness);
    check.notNegative("contact: damping", contact.damping);
    check.notNegative("contact: rotational damping", contact.rotational_damping);
    check.positive("contact: area stiffness", contact.area_stiffness);
    check.positive("contact: penalty stiffness", contact.penalty_stiffness);
    check.positive("contact: tool mass", contact.tool_mass);
    check.positive("contact: tool inertia", contact.tool_inertia);
    if (contact.coupling != PenaltyCoupling::Direct && contact.method != ContactMethod::Penalty)
        check.errors.push_back(
            {.message = "needs the penalty method: a god object has its own", .key = "contact: coupling"});
    if (const auto problem = geometryProblem(*this))
        check.errors.push_back({.message = *problem, .key = "contact: geometry"});
    check.positive("contact: tolerance", contact.tolerance);
    check.notNegative("contact: cell", contact.cell);
    check.positive("contact: spacing", contact.spacing);
    check.require(contact.budget_nodes >= 0, "contact: budget_nodes", contact.budget_nodes, "must be ≥ 0");
    check.require(contact.quality >= 0.0 && contact.quality <= 1.0, "contact: quality", contact.quality,
                  "must be 0 … 1");
    check.require(!(contact.quality > 0.0) || (contact.budget_nodes > 0 && contact.method == ContactMethod::Penalty),
                  "contact: quality", contact.quality,
                  "must be 0 without a penalty under a budget of nodes: nothing is left out then");
    if (handCount() > 1 && std::count_if(parts.begin(), parts.end(),
                                         [](const PartSpec& part) { return part.moves() && part.friction > 0.0; }) > 1)
        check.errors.push_back({.message = "must be 0 on all parts that hands hold but one: nothing rubs between hands",
                                .key = "part: friction"});
    check.require(contact.budget_nodes <= 0 || handCount() == 1, "contact: budget_nodes", contact.budget_nodes,
                  "must be 0 with more than one hand: a look may not take several ticks where parts move meanwhile");
    check.notNegative("effects: passivity damping", effects.passivity_damping);
    const Transients& transients = effects.transients;
    check.notNegative("effects: transients: amplitude", transients.amplitude);
    check.positive("effects: transients: frequency", transients.frequency);
    check.require(!(transients.frequency >= 500.0), "effects: transients: frequency", transients.frequency,
                  "must be below half the tick's rate, 500 Hz");
    check.positive("effects: transients: decay", transients.decay);
    check.require(effects.weight.gravity.allFinite(), "effects: weight: gravity", effects.weight.gravity.norm(),
                  "must be finite");
    check.notNegative("effects: viscosity: damping", effects.viscosity.damping);
    check.notNegative("effects: viscosity: rotational damping", effects.viscosity.rotational_damping);
    checkGuidance(*this, check);
    checkSnap(*this, check);
    checkInertia(*this, check);
    checkKeepApart(*this, check);
    check.notNegative("contact: proxy filter", contact.proxy_filter);
    for (std::size_t i = 0; i < handCount(); ++i) check.device(hand(i));
    return check.errors;
}

void dropRegistrations(SceneSpec& spec) {
    const auto drop = [](Registration& registration, Navigation& navigation) {
        navigation.second_scale.scale /= registration.scale;
        navigation.drift.radius *= registration.scale;
        navigation.drift.home = registration.X_WB * (registration.scale * navigation.drift.home);
        registration = Registration{};
    };
    drop(spec.registration, spec.effects.navigation);
    for (HandSpec& hand : spec.other_hands) drop(hand.registration, hand.navigation);
}

}  // namespace passung::scene
