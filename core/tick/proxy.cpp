#include "core/tick/proxy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/tick/obstacle_query.h"

namespace passung::tick {

Pose moved(const TickModel& model, const Pose& pose, const Motion& u) noexcept {
    Pose result{rotationFromVector(u.tail<3>() / model.metric_radius) * pose.q, pose.p + u.head<3>()};
    result.q.normalize();
    return result;
}

Motion unconstrainedMotion(const TickModel& model, const Pose& X_WG, const Pose& X_WH) noexcept {
    Motion u;
    u.head<3>() = X_WH.p - X_WG.p;
    u.tail<3>() = model.metric_radius * rotationVector(X_WH.q * X_WG.q.conjugate());
    return u;
}

double longestPath(const TickModel& model, const Motion& u) noexcept {
    return u.head<3>().norm() + u.tail<3>().norm() / model.metric_radius * model.shell->reach();
}

double overlap(const TickState& state) noexcept { return std::max(0.0, -state.clearance); }

bool isInside(const ContactPoint& contact) noexcept { return contact.phi < 0.0 && !(contact.radius > 0.0); }

void look(const TickModel& model, TickState& state, TickFrame& frame, const Pose& X_WG, double reach,
          double search) noexcept {
    state.scratch.clear();
    QueryRequest request{.collect_below = reach, .search_below = search, .spheres = true};
    QueryAnswer answer = queryObstacles(model, X_WG, request, state.workspace, state.scratch);
    account(answer, frame);
    std::swap(state.manifold, state.scratch);
    state.X_WG = X_WG;
    state.manifold_reach = reach;
    state.clearance = state.room = answer.phi;
    for (const ContactPoint& contact : state.manifold) state.room = std::min(state.room, contact.phi);
    if (!(state.room > reach)) return;
    request.prove = true;
    state.scratch.clear();
    answer = queryObstacles(model, X_WG, request, state.workspace, state.scratch);
    account(answer, frame);
    state.room = std::max(reach, answer.lower_bound);
}

void lookAround(const TickModel& model, TickState& state, TickFrame& frame, const Pose& X_WG) noexcept {
    const double reach = kLongestStep * model.finest_cell;
    look(model, state, frame, X_WG, reach, reach);
}

void startProxy(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    if (frame.relocated) {
        state.X_WG = frame.X_WH;
        state.manifold_reach = -1.0;
        state.has_last_proxy = state.has_last_stretch = false;
        state.rubbing = {};
    }
    if (state.manifold_reach < 0.0) lookAround(model, state, frame, state.X_WG);
}

double nextReach(const TickModel& model, const TickState& state) noexcept {
    const double s = model.finest_cell;
    return std::clamp(kReachGrowth * state.last_motion, kShortestReach * s, kLongestStep * s);
}

bool arriveFreely(const TickModel& model, TickState& state, TickFrame& frame, double path, double reach,
                  double accepted) noexcept {
    const Pose X_here = state.X_WG;
    look(model, state, frame, frame.X_WH, reach, std::max(reach, 2.0 * path));
    if (overlap(state) <= accepted) {
        state.rubbing = {};  // free
        return true;
    }
    frame.status |= kStepRejected;
    look(model, state, frame, X_here, reach, reach);
    return false;
}

Surroundings surroundings(const TickModel& model, const TickState& state) noexcept {
    return {state.manifold, state.X_WG.p, model.metric_radius, -model.margins.keep};
}

AllowedMotion allowedMotion(const TickModel& model, const TickState& state, TickFrame& frame, const Motion& wanted,
                            const Surroundings& around) noexcept {
    if (model.friction.empty()) {
        const ConstrainedMotion constrained = constrainMotion(wanted, around);
        if (!constrained.converged) frame.status |= kIterationLimit;
        return {constrained.u, {}};
    }
    const RubbedMotion rubbed = constrainWithFriction(wanted, around, model.friction, state.rubbing);
    if (!rubbed.converged || !rubbed.motion.converged) frame.status |= kIterationLimit;
    return {rubbed.motion.u, rubbed.patches};
}

void filterProxy(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    const double alpha = 1.0 - std::exp(-2.0 * std::numbers::pi * model.contact.proxy_filter * kTickSeconds);
    const bool in_contact = state.clearance < model.margins.keep;
    if (in_contact && state.has_last_proxy) {
        const Pose X_target = state.X_WG;
        const Motion u = unconstrainedMotion(model, state.X_WG_last, X_target);
        const double reach = state.manifold_reach;
        const double accepted = std::max(model.margins.accept, overlap(state));
        look(model, state, frame, moved(model, state.X_WG_last, alpha * u), reach, reach);
        if (overlap(state) > accepted) look(model, state, frame, X_target, reach, reach);
    }
    state.X_WG_last = state.X_WG;
    state.has_last_proxy = true;
}

void describeProxy(const TickModel&, TickState& state, TickFrame& frame) noexcept {
    frame.proxy_depth = overlap(state);
    for (const ContactPoint& contact : state.manifold) frame.contacts += isInside(contact) ? 1u : 0u;
}

void measureHandDepth(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    state.scratch.clear();
    const QueryAnswer answer =
        queryObstacles(model, frame.X_WH, {.collect_below = -1e300}, state.workspace, state.scratch);
    frame.nodes_visited += static_cast<std::uint32_t>(answer.nodes_visited);
    frame.hand_depth = std::max(0.0, -answer.phi);
}

}  // namespace passung::tick
