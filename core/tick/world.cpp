#include "core/tick/world.h"

#include <algorithm>

namespace passung::tick {

namespace {

/// What bodies of that part have in common; `world` keeps its solid, for which it has room.
Body bodyOf(const scene::Part& part, scene::Geometry geometry, World& world) {
    Body body;
    body.box = geometry::boundsOf(part.mesh);
    body.box.low.array() -= part.chord_error;
    body.box.high.array() += part.chord_error;
    body.clusters = part.clusters.get();
    if (geometry == scene::Geometry::ClosedForm) {
        body.solid = &world.solids.emplace_back(*closed_form::solidOf(*part.shape));
        body.reach = closed_form::reachOf(*body.solid);
    } else if (geometry == scene::Geometry::Surface) {
        body.surface = body.clusters;
        body.reach = body.surface->reach();
    } else {
        body.field = part.field.get();
        body.shell = part.shell ? &*part.shell : nullptr;
        body.edges = part.edges.get();
        if (body.shell != nullptr) body.reach = body.shell->reach();
    }
    return body;
}

/// What hands close on.
void addFaces(World& world, const scene::Scene& scene, const std::vector<const scene::Part*>& built) {
    std::vector<const geometry::TriangleTree*> faces(built.size());
    world.faces.reserve(built.size());
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        if (!scene.spec.parts[i].pickable) continue;
        const auto at = std::lower_bound(built.begin(), built.end(), scene.parts[i].get()) - built.begin();
        const geometry::TriangleTree*& tree = faces[static_cast<std::size_t>(at)];
        if (tree == nullptr) tree = &world.faces.emplace_back(scene.parts[i]->mesh);
        world.bodies[i].faces = tree;
    }
}

/// The triangles of all that rest for good.
void addStillSurface(World& world) {
    std::vector<geometry::PlacedTree> still;
    std::size_t triangles = 0;
    for (const Body& body : world.bodies) {
        if (body.moves) continue;
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
    std::vector<const scene::Part*> built;
    built.reserve(scene.parts.size());
    for (const auto& part : scene.parts) built.push_back(part.get());
    std::sort(built.begin(), built.end());
    built.erase(std::unique(built.begin(), built.end()), built.end());
    world.solids.reserve(built.size());
    std::vector<Body> bodies;
    bodies.reserve(built.size());
    for (const scene::Part* part : built) bodies.push_back(bodyOf(*part, world.geometry, world));
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        const auto at = std::lower_bound(built.begin(), built.end(), scene.parts[i].get());
        Body& body = world.bodies.emplace_back(bodies[static_cast<std::size_t>(at - built.begin())]);
        body.X_WP_start = scene.spec.parts[i].X_WP;
        body.moves = scene.spec.parts[i].moves();
    }
    addFaces(world, scene, built);
    if (world.geometry == scene::Geometry::Surface) addStillSurface(world);
    return world;
}

}  // namespace passung::tick
