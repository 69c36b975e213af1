#include "core/tick/world.h"

namespace passung::tick {

namespace {

Body bodyOf(const scene::Scene& scene, std::size_t i, scene::Geometry geometry) {
    const scene::PartSpec& spec = scene.spec.parts[i];
    const scene::Part& part = *scene.parts[i];
    Body body{.X_WP_start = spec.X_WP, .held = spec.held};
    if (geometry == scene::Geometry::ClosedForm) {
        body.solid = *closed_form::solidOf(*part.shape);
        body.reach = closed_form::reachOf(*body.solid);
    } else if (geometry == scene::Geometry::Surface) {
        body.surface = part.clusters.get();
        body.reach = body.surface->reach();
    } else {
        body.field = part.field.get();
        body.shell = part.shell ? &*part.shell : nullptr;
        body.edges = part.edges.get();
        if (body.shell != nullptr) body.reach = body.shell->reach();
    }
    return body;
}

/// The triangles of all that rest.
void addStillSurface(World& world) {
    std::vector<geometry::PlacedTree> still;
    std::size_t triangles = 0;
    for (const Body& body : world.bodies) {
        if (body.held) continue;
        still.push_back({body.surface, body.X_WP_start});
        world.first_triangles.push_back(static_cast<std::uint32_t>(triangles));
        triangles += body.surface->triangleCount();
    }
    if (!still.empty()) world.still_surface.emplace_back(still);
}

}  // namespace

World makeWorld(const scene::Scene& scene) {
    World world;
    world.geometry = scene::geometryOf(scene.spec).geometry;
    for (std::size_t i = 0; i < scene.parts.size(); ++i) world.bodies.push_back(bodyOf(scene, i, world.geometry));
    if (world.geometry == scene::Geometry::Surface) addStillSurface(world);
    return world;
}

}  // namespace passung::tick
