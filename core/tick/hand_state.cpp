#include "core/tick/hand_state.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/field/distance_field.h"
#include "core/shell/edge_curves.h"

namespace passung::tick {

namespace {

/// Empty ones, of each obstacle.
std::vector<PairCertificates> certificatesOf(const HandModel& model) {
    std::vector<PairCertificates> all;
    // Cells of a size that was chosen take no tolerance.
    const auto of = [&](const shell::SphereTree& shell, const shell::EdgeCurves& edges,
                        const field::DistanceField& field) {
        const double accuracy = std::max(model.contact.tolerance, model.contact.cell > 0.0 ? field.cell() : 0.0);
        return contact::ShellCertificates{contact::Certificates(shell.nodes().size(), accuracy, field.change()),
                                          contact::Certificates(edges.stretches().size(), accuracy)};
    };
    for (const Obstacle& obstacle : model.obstacles) {
        PairCertificates pair;
        pair.held = of(*model.shell, *model.edges, *obstacle.field);
        if (obstacle.shell != nullptr) pair.obstacle = of(*obstacle.shell, *obstacle.edges, *model.held_field);
        all.push_back(std::move(pair));
    }
    return all;
}

void addQueryMemory(const HandModel& model, Proxy& proxy, QueryMemory& memory) {
    // When a budget ends a node stands in by a point and a sphere, and every obstacle may touch every point and every
    // edge around every station.
    const auto most = [](const shell::SphereTree& shell, const shell::EdgeCurves& edges) {
        return shell.points().size() + 2 * shell.nodes().size() + edges.stations().size();
    };
    std::size_t capacity = most(*model.shell, *model.edges) * model.obstacles.size();
    std::size_t nodes = model.shell->nodes().size();
    for (const Obstacle& obstacle : model.obstacles) {
        if (obstacle.shell == nullptr) continue;
        capacity += most(*obstacle.shell, *obstacle.edges);
        nodes = std::max(nodes, obstacle.shell->nodes().size());
    }
    proxy.manifold = contact::ContactManifold(capacity);
    memory.scratch = contact::ContactManifold(capacity);
    memory.workspace = contact::QueryWorkspace(nodes);
    if (model.hasNodeBudget()) {
        proxy.step.look.found = contact::ContactManifold(capacity);
        proxy.step.look.workspace = contact::QueryWorkspace(nodes);
    }
    // Of answers from a part of a look not: what that leaves depends on what is looked at first.
    const bool partly = model.contact.budget_nodes > 0;
    if (model.hasNodeBudget() || (model.hasFieldProxy() && !partly)) memory.near_proxy = certificatesOf(model);
    if (!partly) memory.near_hand = certificatesOf(model);
}

}  // namespace

HandState makeHandState(const HandModel& model) {
    HandState state;
    for (const Obstacle& obstacle : model.obstacles) state.X_WO.push_back(model.bodies[obstacle.body].X_WP_start);
    for (const std::uint32_t i : model.moving) {
        state.X_WO_known.push_back(state.X_WO[i]);
        state.X_WO_begin.push_back(state.X_WO[i]);
    }
    state.X_WT = model.X_WG_start;
    if (!model.moving.empty()) state.from_hands.resize(model.obstacles.size());
    state.engaged = model.start_gate.hold_ticks <= 0;
    state.X_WG = state.step.X_WT_followed = model.X_WG_start;
    state.pairs.resize(model.obstacles.size() + 1);
    state.pushes.resize(state.pairs.size());
    state.last_shares.resize(state.pairs.size());
    state.push_line.resize(state.pairs.size() * (static_cast<std::size_t>(model.limits.delay_ticks) + 1));
    if (model.hasClosedForm())
        static_cast<ClosedFormMemory&>(state) = closedFormMemory(model);
    else if (model.hasSurfaces())
        static_cast<SurfaceFollow&>(state) = surfaceFollow(model);
    else if (model.geometry == scene::Geometry::Field)
        addQueryMemory(model, state, state);
    return state;
}

}  // namespace passung::tick
