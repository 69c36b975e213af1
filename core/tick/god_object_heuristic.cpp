#include "core/tick/god_object_heuristic.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/tick/constrained_motion.h"
#include "core/tick/obstacle_query.h"

namespace passung::tick {

namespace {

constexpr double kLongestStep = 0.5;     // of a sub-step near an obstacle, per cell
constexpr double kShortestReach = 0.04;  // per cell: what is looked at even when nothing moves
constexpr double kReachGrowth = 2.0;     // over the last motion, so that a start from rest is not held back for long
constexpr double kStill = 1e-8;          // [m]: a motion below this is none
constexpr double kLeastLever = 0.1;      // per ρ: contacts that a rotation hardly relieves are left out of θ
constexpr double kLargestTurn = 0.035;   // [rad] of one correction

Pose moved(const Pose& pose, const Motion& u, double metric_radius) noexcept {
    Pose result{rotationFromVector(u.tail<3>() / metric_radius) * pose.q, pose.p + u.head<3>()};
    result.q.normalize();
    return result;
}

/// No point of the shell moves farther than this [m].
double longestPath(const TickModel& model, const Motion& u) noexcept {
    return u.head<3>().norm() + u.tail<3>().norm() / model.metric_radius * model.shell->reach();
}

double overlap(const TickState& state) noexcept { return std::max(0.0, -state.clearance); }

/// Looks around the proxy: all contacts within `reach`, and up to `search` [m] how far the nearest one is if none is.
/// Room beyond the reach is used without another look, so that it has to be proven.
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

Motion unconstrainedMotion(const TickModel& model, const Pose& X_WG, const Pose& X_WH) noexcept {
    Motion u;
    u.head<3>() = X_WH.p - X_WG.p;
    u.tail<3>() = model.metric_radius * rotationVector(X_WH.q * X_WG.q.conjugate());
    return u;
}

bool isInside(const ContactPoint& contact) noexcept { return contact.phi < 0.0 && !(contact.radius > 0.0); }

/// Direction of the correction: translation along the penalty force, rotation about its torque, shared by λ.
Motion correctionOf(const TickModel& model, const TickState& state, double depth) noexcept {
    const double rho = model.metric_radius;
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (const ContactPoint& c : state.manifold) {
        if (!isInside(c)) continue;
        const Vec3 f = -c.phi * c.gradient;
        force += f;
        torque += (c.position - state.X_WG.p).cross(f);
    }
    const double F = force.norm(), T = torque.norm() / rho;
    Motion u = Motion::Zero();
    if (!(F + T > 0.0)) return u;
    const double lambda = F / (F + T);
    if (F > 0.0) u.head<3>() = lambda * depth / F * force;
    if (!(T > 0.0)) return u;
    const Vec3 axis = torque.normalized();
    double ph = 0.0, hh = 0.0;
    for (const ContactPoint& c : state.manifold) {
        const double lever = c.gradient.dot(axis.cross(c.position - state.X_WG.p));
        if (!isInside(c) || !(lever > kLeastLever * rho)) continue;
        ph += -c.phi * lever;
        hh += lever * lever;
    }
    const double theta = hh > 0.0 ? std::clamp(ph / hh, 0.0, std::min(kLargestTurn, 3.0 * depth / rho)) : 0.0;
    u.tail<3>() = (1.0 - lambda) * theta * rho * axis;
    return u;
}

Surroundings surroundings(const TickModel& model, const TickState& state) noexcept {
    return {state.manifold, state.X_WG.p, model.metric_radius, -kKeep * model.finest_cell};
}

/// Pushes the proxy out of the overlap that a step's linearisation missed, around a rim for instance: the least motion
/// that obeys the contacts found there.
void relieve(const TickModel& model, TickState& state, TickFrame& frame, double reach) noexcept {
    const double s = model.finest_cell;
    for (int i = 0; i < kReliefs && overlap(state) > kRelieve * s; ++i) {
        const ConstrainedMotion out = constrainMotion(Motion::Zero(), surroundings(model, state));
        if (longestPath(model, out.u) > kLongestStep * s) return;
        look(model, state, frame, moved(state.X_WG, out.u, model.metric_radius), reach, reach);
    }
}

/// #4: what the contacts leave of `wanted`.
Motion allowedMotion(const TickModel& model, TickState& state, TickFrame& frame, const Motion& wanted) noexcept {
    const Surroundings around = surroundings(model, state);
    if (model.friction.empty()) {
        const ConstrainedMotion constrained = constrainMotion(wanted, around);
        if (!constrained.converged) frame.status |= kIterationLimit;
        return constrained.u;
    }
    const RubbedMotion rubbed = constrainWithFriction(wanted, around, model.friction, state.rubbing);
    state.rubbing = rubbed.patches;
    if (!rubbed.converged || !rubbed.motion.converged) frame.status |= kIterationLimit;
    return rubbed.motion.u;
}

}  // namespace

void lookAround(const TickModel& model, TickState& state, TickFrame& frame, const Pose& X_WG) noexcept {
    const double reach = kLongestStep * model.finest_cell;
    look(model, state, frame, X_WG, reach, reach);
}

void correctProxy(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    const double s = model.finest_cell;
    if (frame.relocated) {
        state.X_WG = frame.X_WH;
        state.manifold_reach = -1.0;
        state.has_last_proxy = state.has_last_stretch = false;
        state.rubbing = {};
    }
    if (state.manifold_reach < 0.0) lookAround(model, state, frame, state.X_WG);
    for (int i = 0; i < kCorrections && overlap(state) > kAccept * s; ++i) {
        const Pose X_before = state.X_WG;
        const double depth = overlap(state);
        Motion u = correctionOf(model, state, depth - kKeep * s);
        bool better = false;
        for (int half = 0; half <= kHalvings && !better; ++half, u *= 0.5) {
            lookAround(model, state, frame, moved(X_before, u, model.metric_radius));
            better = overlap(state) < depth;
        }
        if (!better) {
            frame.status |= kStepRejected;
            lookAround(model, state, frame, X_before);
            return;
        }
    }
}

void moveProxy(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    const double s = model.finest_cell;
    const Pose X_before = state.X_WG;
    double reach = std::clamp(kReachGrowth * state.last_motion, kShortestReach * s, kLongestStep * s);
    bool arrived = false;
    for (int sub_step = 0; sub_step < kSubSteps; ++sub_step) {
        const Motion wanted = unconstrainedMotion(model, state.X_WG, frame.X_WH);
        const double path = longestPath(model, wanted);
        arrived = path < kStill;
        if (arrived) break;
        frame.iterations = static_cast<std::uint32_t>(sub_step + 1);
        const Pose X_here = state.X_WG;
        const double accepted = std::max(kAccept * s, overlap(state));
        if (state.room > path) {  // nothing is in the way: arrive
            look(model, state, frame, frame.X_WH, reach, std::max(reach, 2.0 * path));
            arrived = overlap(state) <= accepted;
            if (arrived) state.rubbing = {};  // free
            if (arrived) break;
            frame.status |= kStepRejected;
            look(model, state, frame, X_here, reach, reach);
        }
        // Step as far as the contacts are known, farther only where there is proven room.
        const double known = std::max(state.manifold_reach, state.room);
        Motion u = allowedMotion(model, state, frame, wanted);
        const double step_path = longestPath(model, u);
        arrived = step_path < kStill;
        if (arrived) break;
        if (step_path > known) u *= known / step_path;
        const double next_reach = std::clamp(kReachGrowth * std::min(step_path, path), reach, kLongestStep * s);
        bool good = false, whole = step_path <= known;
        for (int half = 0; half <= kHalvings; ++half, u *= 0.5) {
            look(model, state, frame, moved(X_here, u, model.metric_radius), next_reach, std::max(next_reach, path));
            relieve(model, state, frame, next_reach);
            good = overlap(state) <= accepted;
            if (good) break;
            frame.status |= kStepRejected;
            whole = false;
        }
        arrived = good && whole;  // the whole constrained motion was made
        if (!good) look(model, state, frame, X_here, next_reach, next_reach);
        if (!good || whole) break;
        reach = next_reach;
    }
    if (!arrived) frame.status |= kIterationLimit;
    state.last_motion = unconstrainedMotion(model, X_before, state.X_WG).norm();
}

void filterProxy(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    const double alpha = 1.0 - std::exp(-2.0 * std::numbers::pi * model.contact.proxy_filter * kTickSeconds);
    const bool in_contact = state.clearance < kKeep * model.finest_cell;
    if (in_contact && state.has_last_proxy) {
        const Pose X_target = state.X_WG;
        const Motion u = unconstrainedMotion(model, state.X_WG_last, X_target);
        const double reach = state.manifold_reach;
        const double accepted = std::max(kAccept * model.finest_cell, overlap(state));
        look(model, state, frame, moved(state.X_WG_last, alpha * u, model.metric_radius), reach, reach);
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
