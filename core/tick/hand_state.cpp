#include "core/tick/hand_state.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/field/distance_field.h"
#include "core/shell/edge_curves.h"

namespace passung::tick {

namespace {

void addQueryMemory(const HandModel& model, Proxy& proxy, QueryMemory& memory) {
    // When a budget ends a node stands in by a point and a sphere, and an obstacle may touch every point and every edge
    // around every station. One of them finds room so, and beside it half of the points once more, of whatever
    // others are touched: more is kContactCap.
    const auto most = [](const shell::SphereTree& shell, const shell::EdgeCurves& edges) {
        return shell.points().size() + 2 * shell.nodes().size() + edges.stations().size();
    };
    std::size_t points = 0, both = 0;  // of the largest obstacle's
    std::size_t nodes = model.shell->nodes().size();
    for (const Obstacle& obstacle : model.obstacles) {
        if (obstacle.shell == nullptr) continue;
        points = std::max(points, obstacle.shell->points().size());
        both = std::max(both, most(*obstacle.shell, *obstacle.edges));
        nodes = std::max(nodes, obstacle.shell->nodes().size());
    }
    const std::size_t once_more = model.obstacles.size() > 1 ? (model.shell->points().size() + points) / 2 : 0;
    const std::size_t capacity =
        model.hasObstacles() ? most(*model.shell, *model.edges) + both + once_more : std::size_t{0};
    proxy.manifold = contact::ContactManifold(capacity);
    memory.scratch = contact::ContactManifold(capacity);
    memory.workspace = contact::QueryWorkspace(nodes);
    if (model.hasNodeBudget()) {
        proxy.step.look.found = contact::ContactManifold(capacity);
        proxy.step.look.workspace = contact::QueryWorkspace(nodes);
        proxy.step.look.near.resize(model.obstacles.size());
    }
    // Of answers from a part of a look not: what that leaves depends on what is looked at first.
    const bool partly = model.contact.budget_nodes > 0;
    memory.around_proxy = memory.around_hand = lookoutOf(model);
    if (model.hasNodeBudget() || (model.hasFieldProxy() && !partly)) memory.around_proxy.known = KnownPairs(model);
    if (!partly) memory.around_hand.known = KnownPairs(model);
}

}  // namespace

HandState makeHandState(const HandModel& model) {
    HandState state;
    for (const Obstacle& obstacle : model.obstacles) state.X_WO.push_back(model.bodies[obstacle.body].X_WP_start);
    if (!model.moving.empty()) state.X_WO_known = state.X_WO;
    state.X_DG = model.registration.X_DH;
    state.X_WT = model.X_WG_start;
    state.metric = motion::Metric{model.metric_radius};
    state.offset.scale = model.registration.scale;
    if (model.meetsHands()) state.from_hands.resize(model.obstacles.size());
    state.engaged = model.start_gate.hold_ticks <= 0;
    state.X_WG = state.step.X_WT_followed = model.X_WG_start;
    state.pairs.resize(model.bodies.size() + 1);
    state.last_shares.resize(state.pairs.size());
    state.pushes.resize(model.bodies.size());
    state.shared_pressures.resize(model.bodies.size());
    if (model.limits.delay_ticks > 0)
        state.push_line.assign(static_cast<std::size_t>(model.limits.delay_ticks) + 1,
                               FewOfMany<Wrench>(state.pushes.size()));
    if (model.hasClosedForm())
        static_cast<ClosedFormMemory&>(state) = closedFormMemory(model);
    else if (model.hasSurfaces())
        static_cast<SurfaceFollow&>(state) = surfaceFollow(model);
    else if (model.geometry == scene::Geometry::Field && model.hasPart() && !model.follows)
        addQueryMemory(model, state, state);
    if (model.hasInertia()) measureBy(model, std::array{Vec3(Vec3::Zero())}, state);
    return state;
}

void measureBy(const HandModel& model, std::span<const Vec3> held, HandState& hand, double pulled) noexcept {
    hand.springs = static_cast<int>(held.size());
    hand.stiffness = hand.springs;
    motion::Metric metric{model.metric_radius, held[0]};
    if (model.hasInertia()) {
        hand.pull = pullOf(model, held, momentumOf(model, hand, hand.X_WG));
        hand.stiffness = hand.pull.stiffness();
        metric = hand.pull.movingMetric();
    } else if (held.size() > 1) {
        metric = motion::Metric::betweenHands(model.metric_radius, held[0], held[1], pulled);
    }
    hand.metric = metric;
    if (model.hasClosedForm()) hand.solver.measureBy(metric);
    if (model.hasSurfaces()) hand.surface->measureBy(metric);
    if (model.hasFieldProxy()) hand.step.look.open = false;
}

void regrip(const Pose& X_DG, const Vec3& p_GC, HandState& hand) noexcept {
    const Pose change = hand.X_DG.inverse() * X_DG;
    hand.X_DG = X_DG;
    hand.X_DG.q.normalize();
    hand.p_GC = p_GC;
    hand.sample.X_WH = hand.sample.X_WH * change;
    hand.clutch.noted = false;
    hand.touching = false;
}

void placeObstacles(const HandModel& model, std::span<const Pose> X_WP, HandState& hand) noexcept {
    const auto rest = [&](std::uint32_t i, geometry::NearList& near) {
        near.carry(i, hand.X_WO[i]);
        near.rest(i);
    };
    for (const std::uint32_t i : model.moving) {
        const Pose& now = X_WP[model.obstacles[i].body];
        const bool in_hand = std::any_of(hand.inHands().begin(), hand.inHands().end(),
                                         [i](const ObstaclePoses::Carried& carried) { return carried.obstacle == i; });
        const bool same = now.p == hand.X_WO[i].p && now.q.coeffs() == hand.X_WO[i].q.coeffs();
        if (same && !in_hand) continue;
        hand.X_WO_known[i] = hand.X_WO[i] = now;
        if (model.hasClosedForm()) {
            hand.solver.place(i, now);
            hand.at_hand[i].place(now);
            rest(i, hand.solver.near());
            rest(i, hand.near_hand);
        } else if (model.hasSurfaces()) {
            hand.surface->leaveBody(surfaceBodyOf(model, i));
            hand.surface->moveBody(surfaceBodyOf(model, i), now);
        } else if (model.geometry == scene::Geometry::Field && !model.follows) {
            hand.manifold_reach = -1.0;
            hand.step.look.open = false;
            rest(i, hand.around_proxy.near);
            rest(i, hand.around_hand.near);
        }
    }
    hand.carried_count = 0;
}

namespace {

template <class... Part>
void swapAll(HandState& hand, Parts<Part...>& part) noexcept {
    using std::swap;
    (swap(static_cast<Part&>(hand), static_cast<Part&>(part)), ...);
}

}  // namespace

void swapParts(HandState& hand, PartState& part) noexcept { swapAll(hand, part); }

}  // namespace passung::tick
