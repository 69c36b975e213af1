#include "core/tick/tick_model.h"

#include <algorithm>
#include <cmath>

#include "core/tick/contact_energy.h"
#include "core/tick/god_object.h"
#include "core/tick/god_object_heuristic.h"
#include "core/tick/input_guard.h"
#include "core/tick/output_stage.h"
#include "core/tick/passivity.h"
#include "core/tick/penalty.h"
#include "core/tick/penalty_tool.h"
#include "core/tick/proxy.h"
#include "core/tick/transients.h"
#include "core/tick/virtual_coupling.h"

namespace passung::tick {

namespace {

/// Stage of a scene without obstacles: the held part is where the hand is.
void followHand(const TickModel&, TickState& state, TickFrame& frame) noexcept { state.X_WG = frame.X_WH; }

void addPenalty(TickModel& model) {
    model.stages.push_back({"contacts at the hand",
                            model.contact.two_way
                                ? "contact.method is penalty: forces come from the overlap at the device's own pose; "
                                  "contact.two_way: of the held part's points and of the obstacles' points"
                                : "contact.method is penalty: forces come from the overlap at the "
                                  "device's own pose",
                            false, findContactsAtHand});
    model.stages.push_back(
        {"penalty wrench", "turns the overlap into force and torque by contact.variant", false, renderPenalty});
}

/// Shares of a cell, or less, so that no more overlap than `most` is accepted [m].
ProxyMargins marginsOf(const TickModel& model, const ProxyMargins& share, double most) {
    const double s = std::min(model.finest_cell, most / share.accept);
    return {share.keep * s, share.relieve * s, share.accept * s};
}

void addGodObjectHeuristic(TickModel& model) {
    model.margins = marginsOf(model, {kKeep, kRelieve, kAccept}, model.contact.tolerance);
    model.stages.push_back({"proxy correction",
                            model.contact.two_way
                                ? "contact.method is god_object_heuristic: steps #1 and #2, contacts at the last proxy "
                                  "and relief of its overlap; contact.two_way: here and below of the held part's "
                                  "points and of the obstacles' points"
                                : "contact.method is god_object_heuristic: steps #1 and #2, contacts at "
                                  "the last proxy and relief of its overlap",
                            false, correctProxy});
    model.stages.push_back({"proxy motion", "steps #3 and #4: the proxy follows the hand as far as the contacts let it",
                            false, moveProxy});
}

void addGodObject(TickModel& model) {
    model.margins = marginsOf(model, {kKept, kRelieved, kAccepted}, 0.5 * model.contact.tolerance);
    model.stages.push_back({"proxy sweep",
                            model.contact.two_way
                                ? "contact.method is god_object: the proxy follows the hand as far as all contacts "
                                  "within reach let it; contact.two_way: of the held part's points and of the "
                                  "obstacles' points"
                                : "contact.method is god_object: the proxy follows the hand as far as all contacts "
                                  "within reach let it",
                            false, sweepProxy});
}

void addPenaltyTool(TickModel& model) {
    model.stages.push_back({"penalty tool",
                            model.contact.coupling == model::PenaltyCoupling::Virtual
                                ? "contact.coupling is virtual: a tool with mass between the hand's spring and the "
                                  "contacts' penalty"
                                : "contact.coupling is quasi_static: a tool where the hand's spring and the contacts' "
                                  "penalty balance",
                            false, settleTool});
}

void addProxyFilter(TickModel& model) {
    if (!(model.contact.proxy_filter > 0.0)) return;
    model.stages.push_back(
        {"proxy filter", "contact.proxy_filter_hz is set: a low-pass of the proxy in contact", false, filterProxy});
}

/// What follows the proxy's motion, whatever the method.
void addProxy(TickModel& model, bool record_hand_depth) {
    model.stages.push_back({"proxy record", "overlap and contacts at the proxy, for the record", false, describeProxy});
    if (record_hand_depth) {
        model.stages.push_back(
            {"hand depth", "the overlap at the device's pose is measured and recorded", false, measureHandDepth});
    }
    model.stages.push_back({"virtual coupling", "spring and damper between proxy and hand", false, renderCoupling});
}

/// The coefficients of the held part with each obstacle, if any rubs.
void addFriction(TickModel& model, const model::Scene& scene) {
    const auto& parts = scene.spec.parts;
    const model::PartSpec& held = parts[scene.held];
    std::vector<Friction> friction;
    bool any = false;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i == scene.held) continue;
        friction.push_back({std::sqrt(held.friction * parts[i].friction),
                            std::sqrt(held.sliding_friction * parts[i].sliding_friction)});
        any = any || friction.back().at_rest > 0.0;
    }
    if (any) model.friction = std::move(friction);
}

}  // namespace

TickModel makeModel(const model::Scene& scene) {
    TickModel model;
    const model::SceneSpec& spec = scene.spec;
    model.contact = spec.contact;
    model.limits = spec.limits;
    model.registration = spec.registration;
    model.start_gate = spec.start_gate;
    model.passivity_damping = spec.effects.passivity_damping;
    model.transients = spec.effects.transients;
    model.X_WG_start = spec.parts[scene.held].X_WP;
    model.shell = &*scene.parts[scene.held]->shell;
    model.edges = &*scene.parts[scene.held]->edges;
    const bool two_way = spec.contact.two_way;
    if (two_way) model.held_field = &*scene.parts[scene.held]->field;
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        const bool held = i == scene.held;
        if (!held)
            model.obstacles.push_back({&*scene.parts[i]->field, spec.parts[i].X_WP,
                                       two_way ? &*scene.parts[i]->shell : nullptr,
                                       two_way ? &*scene.parts[i]->edges : nullptr});
        if (held && !two_way) continue;
        const double cell = scene.parts[i]->field->cell();
        model.finest_cell = model.finest_cell > 0.0 ? std::min(model.finest_cell, cell) : cell;
    }
    addFriction(model, scene);
    const double ratio = spec.contact.rotational_stiffness / spec.contact.stiffness;
    model.metric_radius = ratio > 0.0 ? std::sqrt(ratio) : std::max(model.shell->gyrationRadius(), 1e-6);

    model.stages.push_back({"input guard", "always: a device may lie, stall or vanish", true, guardInput});
    model.stages.push_back({"energy account",
                            "always: what the controller takes in and gives out at the handle is recorded", true,
                            observeEnergy});
    if (spec.start_gate.hold_ticks > 0) {
        model.stages.push_back({"start gate", "start_gate is set: contact begins when the hand holds the start pose",
                                true, waitForStartPose});
    }
    if (model.obstacles.empty()) {
        model.stages.push_back({"free hand", "the scene has no obstacle", false, followHand});
    } else if (spec.contact.rendersAtHand()) {
        addPenalty(model);
    } else {
        if (spec.contact.method == model::ContactMethod::Penalty)
            addPenaltyTool(model);
        else if (spec.contact.method == model::ContactMethod::GodObject)
            addGodObject(model);
        else
            addGodObjectHeuristic(model);
        if (spec.contact.method != model::ContactMethod::Penalty) addProxyFilter(model);
        addProxy(model, spec.record_hand_depth);
    }
    if (spec.effects.transients.amplitude > 0.0 && !model.obstacles.empty()) {
        model.stages.push_back({"contact transients",
                                "effects.transients is set: a decaying vibration is added at every impact", false,
                                renderTransients});
    }
    if (!model.obstacles.empty()) {
        model.stages.push_back(
            {"contact shares", "always: the energy account is kept for each obstacle too", false, sharePushes});
    }
    if (spec.limits.delay_ticks > 0) {
        model.stages.push_back({"output delay", "device.delay_ticks is set", true, delayOutput});
    }
    if (spec.effects.passivity_damping > 0.0) {
        model.stages.push_back({"passivity controller",
                                "effects.passivity_controller is set: a damper takes back energy that was given out",
                                false, dampActivity});
    }
    if (!spec.display_wrench) {
        model.stages.push_back({"no wrench", "feedback.kinesthetic is false: contact is computed, nothing is displayed",
                                true, withholdWrench});
    }
    model.stages.push_back(
        {"output limits", "always, last: finite, within the device's limits, rising slowly enough", true, limitOutput});
    return model;
}

TickState makeState(const TickModel& model) {
    TickState state;
    state.engaged = model.start_gate.hold_ticks <= 0;
    state.X_WG = model.X_WG_start;
    state.pairs.resize(model.obstacles.size() + 1);
    state.push_line.resize(state.pairs.size() * (static_cast<std::size_t>(model.limits.delay_ticks) + 1));
    // When a budget ends a node stands in by a point and a sphere, and every obstacle may touch every point and every
    // edge around every station.
    const auto most = [](const model::SphereTree& shell, const model::EdgeCurves& edges) {
        return shell.points().size() + 2 * shell.nodes().size() + edges.stations().size();
    };
    std::size_t capacity = most(*model.shell, *model.edges) * model.obstacles.size();
    std::size_t nodes = model.shell->nodes().size();
    for (const Obstacle& obstacle : model.obstacles) {
        if (obstacle.shell == nullptr) continue;
        capacity += most(*obstacle.shell, *obstacle.edges);
        nodes = std::max(nodes, obstacle.shell->nodes().size());
    }
    state.manifold = ContactManifold(capacity);
    state.scratch = ContactManifold(capacity);
    state.workspace = QueryWorkspace(nodes);
    return state;
}

}  // namespace passung::tick
