#include "core/tick/hand_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/field/distance_field.h"
#include "core/scene/part_mass.h"
#include "core/tick/hand_state.h"

namespace passung::tick {

namespace {

constexpr double kEmptyHandRadius = 0.05;  // [m]: about a hand's

/// Shares of a cell, or less, so that no more overlap than `most` is accepted [m].
ProxyMargins marginsOf(const HandModel& model, const ProxyMargins& share, double most) {
    const double s = std::min(model.finest_cell, most / share.accept);
    return {share.keep * s, share.relieve * s, share.accept * s};
}

ProxyMargins marginsOf(const HandModel& model) {
    if (model.hasFieldProxyOf(scene::ContactMethod::GodObjectHeuristic))
        return marginsOf(model, {kKeep, kRelieve, kAccept}, model.contact.tolerance);
    if (model.hasFieldProxyOf(scene::ContactMethod::GodObject))
        return marginsOf(model, {kKept, kRelieved, kAccepted}, 0.5 * model.contact.tolerance);
    return {};
}

/// What the held part is to contact.
void addHeld(HandModel& model, const Body& held) {
    model.reach = held.reach;
    if (held.solid) {
        model.held_solid = held.solid;
    } else if (held.surface != nullptr) {
        model.held_surface = held.surface;
    } else {
        model.shell = held.shell;
        model.edges = held.edges;
        if (model.contact.two_way) model.held_field = held.field;
    }
}

/// All parts but the held one.
void addObstacles(HandModel& model, const World& world) {
    const bool two_way = model.contact.two_way;
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        if (i == model.body) continue;
        const Body& body = world.bodies[i];
        (body.moves ? model.moving : model.resting).push_back(static_cast<std::uint32_t>(model.obstacles.size()));
        model.obstacles.push_back({.body = i,
                                   .field = body.field,
                                   .shell = two_way ? body.shell : nullptr,
                                   .edges = two_way ? body.edges : nullptr,
                                   .solid = body.solid});
    }
}

/// Of the fields that are looked at.
double finestCellOf(const HandModel& model) {
    double finest = model.held_field != nullptr ? model.held_field->cell() : std::numeric_limits<double>::infinity();
    for (const Obstacle& obstacle : model.obstacles)
        if (obstacle.field != nullptr) finest = std::min(finest, obstacle.field->cell());
    return std::isfinite(finest) ? finest : 0.0;
}

/// Of the held part's surface about its origin [m].
double gyrationRadius(const HandModel& model, const scene::Scene& scene) {
    if (model.shell != nullptr) return model.shell->gyrationRadius();
    const geometry::TriangleMesh& mesh = scene.parts[model.body]->mesh;
    double area = 0.0, second = 0.0;
    for (const auto& triangle : mesh.triangles) {
        const Vec3 &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]], &c = mesh.vertices[triangle[2]];
        const double size = 0.5 * (b - a).cross(c - a).norm();
        area += size;
        second += size / 12.0 * (a.squaredNorm() + b.squaredNorm() + c.squaredNorm() + (a + b + c).squaredNorm());
    }
    return area > 0.0 ? std::sqrt(second / area) : 0.0;
}

/// The coefficients of the held part with each obstacle, if any rubs.
void addFriction(HandModel& model, const scene::Scene& scene) {
    const auto& parts = scene.spec.parts;
    const scene::PartSpec& held = parts[model.body];
    std::vector<motion::Friction> friction;
    bool any = false;
    for (const Obstacle& obstacle : model.obstacles) {
        const scene::PartSpec& other = parts[obstacle.body];
        friction.push_back(
            {std::sqrt(held.friction * other.friction), std::sqrt(held.sliding_friction * other.sliding_friction)});
        any = any || friction.back().at_rest > 0.0;
    }
    if (any) model.friction = std::move(friction);
}

/// The held part's mass and what gravity does to it, if the scene asks for either.
void addMass(HandModel& model, const scene::Scene& scene) {
    const double density = scene.spec.parts[model.body].density;
    const scene::Effects& effects = scene.spec.effects;
    if ((effects.weight.gravity.isZero(0.0) && !effects.inertia.any()) || !(density > 0.0)) return;
    const auto body = scene::massOf(*scene.parts[model.body], density);
    if (!body) return;
    model.weight = body->mass * effects.weight.gravity;
    model.mass = body->mass;
    model.centre = body->centre;
    model.moments = body->inertia;
}

/// Poses that the scene names, for what the first hand begins with; goals of steps, for the parts that they are of.
void addSnapPlaces(HandModel& model, const scene::SceneSpec& spec, std::size_t hand) {
    if (hand == 0 && model.body == spec.heldBy(0))
        for (const Pose& X_WG : spec.effects.snap.X_WG) model.snap_places.push_back({.X_IS = X_WG});
    for (const scene::AssemblyStep& step : spec.effects.pick.steps) {
        if (step.part != model.body) continue;
        SnapPlace place{.X_IS = step.X_IGoal, .folds = step.folds};
        if (step.into != scene::AssemblyStep::kWorld) place.into = model.obstacleOf(step.into);
        model.snap_places.push_back(place);
    }
}

template <const auto&... stage>
void addStages(HandModel& model, StageList<stage...>) {
    const auto add = [&model](const StageCard& card, auto* run) {
        if (card.needs(model))
            model.stages.push_back({card.name, card.reason(model), card.senses, card.before_start, run});
        else if (card.spared != nullptr)
            model.spared.push_back({card.name, card.spared(model)});
    };
    (add(stage.card, runStage<stage>), ...);
}

}  // namespace

const char* contactInstead(const HandModel& model) noexcept {
    if (!model.hasPart()) return "the hand holds nothing";
    if (!model.hasObstacles()) return "the scene has no obstacle";
    if (model.contact.method == scene::ContactMethod::Penalty)
        return model.rendersAtHand() ? "contact.method is penalty" : "contact.method is penalty, through a tool";
    if (model.hasClosedForm()) return "contact is computed from the shapes' closed forms";
    if (model.hasSurfaces()) return "contact is computed from surfaces";
    return model.contact.method == scene::ContactMethod::GodObject ? "contact.method is god_object"
                                                                   : "contact.method is god_object_heuristic";
}

std::uint32_t HandModel::wrenchEffects() const noexcept {
    const auto bit = [](WrenchEffect effect, bool has) {
        return static_cast<std::uint32_t>(has) << static_cast<unsigned>(effect);
    };
    return bit(WrenchEffect::Transients, hasTransients()) | bit(WrenchEffect::Weight, hasWeight()) |
           bit(WrenchEffect::Viscosity, effects.viscosity.any()) |
           bit(WrenchEffect::Guidance, effects.guidance.share > 0.0) | bit(WrenchEffect::Snap, !snap_places.empty()) |
           bit(WrenchEffect::Inertia, hasInertia()) | bit(WrenchEffect::KeepApart, keepsApart());
}

geometry::NearList nearListOf(const HandModel& model, double beyond) {
    std::vector<geometry::NearPart> parts;
    for (const Obstacle& obstacle : model.obstacles) {
        const Body& body = model.bodies[obstacle.body];
        geometry::NearPart& part = parts.emplace_back(geometry::NearPart{body.box, body.X_WP_start});
        const double more = beyond + (body.field != nullptr ? body.field->sheetOffset() : 0.0);
        part.box.low.array() -= more;
        part.box.high.array() += more;
    }
    geometry::NearList near(model.bodies[model.body].box, parts);
    near.within(model.X_WG_start, 0.0);  // so that the first tick does not have to look at all
    return near;
}

HandModel makeHandModel(const World& world, const scene::Scene& scene, std::size_t hand, std::size_t body,
                        bool follows) {
    const scene::SceneSpec& spec = scene.spec;
    HandModel model;
    model.bodies = world.bodies;
    model.body = body;
    model.follows = follows;
    model.has_others = spec.handCount() > 1;
    model.geometry = world.geometry;
    model.contact = spec.contact;
    const scene::HandSpec device = spec.hand(hand);
    model.limits = device.limits;
    model.registration = device.registration;
    model.start_gate = device.start_gate;
    model.effects = spec.effects;
    model.effects.navigation = device.navigation;
    if (hand > 0) model.effects.guidance = {};
    model.record_hand_depth = spec.record_hand_depth;
    model.display_wrench = spec.display_wrench;
    const double ratio = spec.contact.rotational_stiffness / spec.contact.stiffness;
    model.metric_radius = std::sqrt(ratio);
    model.X_WG_start = model.hasPart() ? world.bodies[body].X_WP_start : model.start_gate.X_WH;
    if (model.hasPart()) {
        addHeld(model, world.bodies[body]);
        addObstacles(model, world);
        if (!world.still_surface.empty()) model.still_surface = &world.still_surface.front();
        model.first_triangles = world.first_triangles;
        model.finest_cell = finestCellOf(model);
        addFriction(model, scene);
        addMass(model, scene);
        if (!(ratio > 0.0)) model.metric_radius = std::max(gyrationRadius(model, scene), 1e-6);
        model.margins = marginsOf(model);
    } else if (!(ratio > 0.0)) {
        model.metric_radius = kEmptyHandRadius;
    }
    if (model.effects.guidance.share > 0.0)
        model.way = GuideWay(model.X_WG_start, model.effects.guidance.X_WG, model.metric_radius);
    if (model.effects.snap.any() && model.hasPart() && !follows) addSnapPlaces(model, spec, hand);
    addStages(model, AllStages{});
    return model;
}

}  // namespace passung::tick
