#include "core/tick/penalty.h"

#include <algorithm>

namespace passung::tick {

namespace {

std::uint32_t countInside(const ContactManifold& manifold) noexcept {
    std::uint32_t count = 0;
    for (const ContactPoint& contact : manifold) count += contact.phi < 0.0 ? 1u : 0u;
    return count;
}

/// -b (v · û) û, no larger than what it opposes.
Vec3 dampingAlong(const Vec3& load, const Vec3& velocity, double damping) noexcept {
    const double size = load.norm();
    if (!(size > 0.0)) return Vec3::Zero();
    const Vec3 direction = load / size;
    const double along = -damping * velocity.dot(direction);
    return std::max(along, -size) * direction;
}

}  // namespace

QueryAnswer queryObstacles(const TickModel& model, const Pose& X_WS, double collect_below, double search_below,
                           QueryWorkspace& workspace, ContactManifold& manifold) noexcept {
    QueryAnswer best;
    best.phi = search_below;
    for (const Obstacle& obstacle : model.obstacles) {
        const QueryRequest request{collect_below, best.phi, model.contact.budget_nodes, model.contact.mode};
        QueryAnswer answer =
            queryContacts(*obstacle.field, obstacle.X_WF, *model.shell, X_WS, request, workspace, manifold);
        answer.nodes_visited += best.nodes_visited;
        answer.points_tested += best.points_tested;
        answer.quality = std::min(answer.quality, best.quality);
        answer.budget_reached = answer.budget_reached || best.budget_reached;
        answer.manifold_full = answer.manifold_full || best.manifold_full;
        if (answer.found || !best.found) {
            best = answer;
        } else {
            best.nodes_visited = answer.nodes_visited;
            best.points_tested = answer.points_tested;
            best.quality = answer.quality;
            best.budget_reached = answer.budget_reached;
            best.manifold_full = answer.manifold_full;
        }
    }
    return best;
}

void account(const QueryAnswer& answer, TickFrame& frame) noexcept {
    frame.nodes_visited += static_cast<std::uint32_t>(answer.nodes_visited);
    frame.quality = std::min(frame.quality, answer.quality);
    if (answer.budget_reached) frame.status |= kBudgetReached;
    if (answer.manifold_full) frame.status |= kContactCap;
}

void findContactsAtHand(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    state.X_WG = frame.X_WH;
    state.manifold.clear();
    const QueryAnswer answer = queryObstacles(model, frame.X_WH, 0.0, 0.0, state.workspace, state.manifold);
    account(answer, frame);
    frame.contacts = countInside(state.manifold);
    frame.hand_depth = frame.proxy_depth = std::max(0.0, -answer.phi);
}

Wrench penaltyWrench(const model::ContactSpec& contact, const ContactManifold& manifold, const Vec3& p_WO) noexcept {
    const bool weighted = contact.variant == model::PenaltyVariant::AreaWeighted;
    Wrench sum;
    double depth_sum = 0.0, deepest = 0.0;
    for (const ContactPoint& c : manifold) {
        if (!(c.phi < 0.0)) continue;
        const double depth = -c.phi;
        const Vec3 f = (weighted ? c.area * depth : depth) * -c.normal;
        sum.force += f;
        sum.torque += (c.position - p_WO).cross(f);
        depth_sum += depth;
        deepest = std::max(deepest, depth);
    }
    double scale = weighted ? contact.area_stiffness : contact.stiffness;
    if (contact.variant == model::PenaltyVariant::MaxNormalised) {
        const double coherent = std::max(sum.force.norm(), kLeastCoherence * depth_sum);
        scale = coherent > 0.0 ? contact.stiffness * deepest / coherent : 0.0;
    }
    return {scale * sum.force, scale * sum.torque};
}

void renderPenalty(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    Wrench wrench = penaltyWrench(model.contact, state.manifold, frame.X_WH.p);
    if (state.has_last_hand) {
        const Vec3 v = (frame.X_WH.p - state.X_WH_last.p) / kTickSeconds;
        const Vec3 w = rotationVector(frame.X_WH.q * state.X_WH_last.q.conjugate()) / kTickSeconds;
        const Vec3 force_damping = dampingAlong(wrench.force, v, model.contact.damping);
        const Vec3 torque_damping = dampingAlong(wrench.torque, w, model.contact.rotational_damping);
        wrench.force += force_damping;
        wrench.torque += torque_damping;
    }
    state.X_WH_last = frame.X_WH;
    state.has_last_hand = true;
    frame.F_H_W = wrench;
}

}  // namespace passung::tick
