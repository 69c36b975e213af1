#include "core/tick/proxy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/tick/contact_energy.h"
#include "core/tick/obstacle_query.h"

namespace passung::tick {

namespace {

constexpr double kSamePoint = 1e-6;  // [m]: points of one part are farther apart

/// The contacts of now that held the last motion.
std::span<const std::uint32_t> likelyContacts(const TickModel& model, const TickState& state,
                                              std::array<std::uint32_t, 6>& places) noexcept {
    std::size_t found = 0;
    std::array<Vec3, 12> held;
    const auto count = static_cast<std::size_t>(2 * state.held.count);
    for (std::size_t i = 0; 2 * i < count; ++i) {
        held[2 * i] = state.X_WG * state.held.point[i].p_G;
        held[2 * i + 1] = state.held.point[i].p_W;
    }
    if (count == 0) return {};
    for (std::size_t k = 0; k < state.manifold.size() && found < places.size(); ++k) {
        const ContactPoint& contact = state.manifold[k];
        if (contact.phi > model.margins.relieve) continue;  // a contact that held is hardly farther away
        for (std::size_t i = 0; i < count; ++i) {
            if (std::abs(contact.position.x() - held[i].x()) > kSamePoint ||
                (contact.position - held[i]).squaredNorm() > kSamePoint * kSamePoint)
                continue;
            places[found++] = static_cast<std::uint32_t>(k);
            break;
        }
    }
    return {places.data(), found};
}

void noteHeld(const ConstrainedMotion& motion, TickState& state) noexcept {
    state.held.count = motion.active;
    const Pose X_GW = state.X_WG.inverse();
    for (int i = 0; i < motion.active; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const Vec3& p = state.manifold[motion.held[at].contact].position;
        state.held.point[at] = {X_GW * p, p};
    }
}

void note(int count, std::uint32_t& most) noexcept { most = std::max(most, static_cast<std::uint32_t>(count)); }

}  // namespace

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
    QueryRequest request{.collect_below = reach,
                         .search_below = search,
                         .spheres = true,
                         .facing = model.contact.two_way,
                         .edges = true};
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

bool overlapsBetween(const TickModel& model, TickState& state, TickFrame& frame, const Pose& X_from, const Pose& X_to,
                     double share, double accepted) noexcept {
    const Pose X{X_from.q.slerp(share, X_to.q), X_from.p + share * (X_to.p - X_from.p)};
    state.scratch.clear();
    const QueryRequest request{
        .collect_below = -1e300, .search_below = -accepted, .facing = model.contact.two_way, .edges = true};
    const QueryAnswer answer = queryObstacles(model, X, request, state.workspace, state.scratch);
    account(answer, frame);
    return answer.found;
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
    clearPushes(state);
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
        clearPushes(state);
        return true;
    }
    frame.status |= kStepRejected;
    look(model, state, frame, X_here, reach, reach);
    return false;
}

Surroundings surroundings(const TickModel& model, const TickState& state) noexcept {
    return {state.manifold, state.X_WG.p, model.metric_radius, -model.margins.keep};
}

AllowedMotion allowedMotion(const TickModel& model, TickState& state, TickFrame& frame, const Motion& wanted,
                            const Surroundings& around) noexcept {
    std::array<std::uint32_t, 6> places;
    const auto likely = likelyContacts(model, state, places);
    AllowedMotion allowed;
    if (model.friction.empty()) {
        const ConstrainedMotion constrained = constrainMotion(wanted, around, likely);
        if (!constrained.converged) frame.status |= kIterationLimit;
        note(constrained.iterations, frame.rows_taken);
        allowed.u = constrained.u;
        noteHeld(constrained, state);
        notePushes(model, state, constrained, allowed.rubbing);
    } else {
        const RubbedMotion rubbed = constrainWithFriction(wanted, around, model.friction, state.rubbing, likely);
        if (!rubbed.converged || !rubbed.motion.converged) frame.status |= kIterationLimit;
        note(rubbed.motion.iterations, frame.rows_taken);
        note(rubbed.sweeps, frame.friction_turns);
        allowed = {rubbed.motion.u, rubbed.patches};
        noteHeld(rubbed.motion, state);
        notePushes(model, state, rubbed.motion, rubbed.patches);
    }
    return allowed;
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
