#include "core/tick/hand_model.h"

#include <algorithm>
#include <cmath>

#include "core/field/distance_field.h"
#include "core/tick/hand_state.h"

namespace passung::tick {

namespace {

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

void addFields(HandModel& model, const scene::Scene& scene) {
    const scene::SceneSpec& spec = scene.spec;
    model.shell = &*scene.parts[scene.held]->shell;
    model.reach = model.shell->reach();
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
}

/// The held part's first, then the obstacles'.
void addSolids(HandModel& model, const scene::Scene& scene) {
    const auto solidOf = [&](std::size_t part) { return *closed_form::solidOf(*scene.parts[part]->shape); };
    model.solids.push_back(solidOf(scene.held));
    model.reach = closed_form::reachOf(model.solids.front());
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        if (i == scene.held) continue;
        model.solids.push_back(solidOf(i));
        model.obstacles.push_back({nullptr, scene.spec.parts[i].X_WP});
    }
}

/// The held part's triangles, and those of all obstacles in the world.
void addSurfaces(HandModel& model, const scene::Scene& scene) {
    model.held_surface = scene.parts[scene.held]->clusters.get();
    model.reach = model.held_surface->reach();
    std::vector<geometry::PlacedTree> obstacles;
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        if (i == scene.held) continue;
        obstacles.push_back({scene.parts[i]->clusters.get(), scene.spec.parts[i].X_WP});
        model.obstacles.push_back({nullptr, obstacles.back().X});
        model.first_triangles.push_back(static_cast<std::uint32_t>(triangles));
        triangles += obstacles.back().tree->triangleCount();
    }
    model.obstacle_surface.emplace(obstacles);
}

/// Of the held part's surface about its origin [m].
double gyrationRadius(const HandModel& model, const scene::Scene& scene) {
    if (model.shell != nullptr) return model.shell->gyrationRadius();
    const geometry::TriangleMesh& mesh = scene.parts[scene.held]->mesh;
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
    const scene::PartSpec& held = parts[scene.held];
    std::vector<motion::Friction> friction;
    bool any = false;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i == scene.held) continue;
        friction.push_back({std::sqrt(held.friction * parts[i].friction),
                            std::sqrt(held.sliding_friction * parts[i].sliding_friction)});
        any = any || friction.back().at_rest > 0.0;
    }
    if (any) model.friction = std::move(friction);
}

template <const auto&... stage>
void addStages(HandModel& model, StageList<stage...>) {
    const auto add = [&model](const StageCard& card, auto* run) {
        if (card.needs(model)) model.stages.push_back({card.name, card.reason(model), card.before_start, run});
    };
    (add(stage.card, runStage<stage>), ...);
}

}  // namespace

HandModel makeModel(const scene::Scene& scene) {
    HandModel model;
    const scene::SceneSpec& spec = scene.spec;
    model.contact = spec.contact;
    model.limits = spec.limits;
    model.registration = spec.registration;
    model.start_gate = spec.start_gate;
    model.effects = spec.effects;
    model.record_hand_depth = spec.record_hand_depth;
    model.display_wrench = spec.display_wrench;
    model.X_WG_start = spec.parts[scene.held].X_WP;
    model.geometry = scene::geometryOf(spec).geometry;
    if (model.geometry == scene::Geometry::ClosedForm)
        addSolids(model, scene);
    else if (model.geometry == scene::Geometry::Surface)
        addSurfaces(model, scene);
    else
        addFields(model, scene);
    addFriction(model, scene);
    const double ratio = spec.contact.rotational_stiffness / spec.contact.stiffness;
    model.metric_radius = ratio > 0.0 ? std::sqrt(ratio) : std::max(gyrationRadius(model, scene), 1e-6);
    model.margins = marginsOf(model);
    addStages(model, AllStages{});
    return model;
}

}  // namespace passung::tick
