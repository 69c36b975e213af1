#include "core/tick/god_object_heuristic.h"

#include <algorithm>

#include "core/tick/proxy.h"
#include "core/tick/proxy_way.h"

namespace passung::tick {

namespace {

constexpr double kLeastLever = 0.1;     // per ρ: contacts that a rotation hardly relieves are left out of θ
constexpr double kLargestTurn = 0.035;  // [rad] of one correction

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

/// What a stage leaves of the overlap that it begins with.
double leftOf(const TickModel& model, double overlap) noexcept {
    return std::max(model.margins.keep, overlap - kLeave * model.finest_cell);
}

/// What is around the proxy, with no more asked of what is deeper than `left`.
Surroundings around(const TickModel& model, const TickState& state, double left) noexcept {
    Surroundings result = surroundings(model, state);
    result.sunk_out = -left;
    return result;
}

/// Pushes the proxy out of the overlap that a step's linearisation missed, around a rim for instance: the least motion
/// that obeys the contacts found there.
void relieve(const TickModel& model, TickState& state, TickFrame& frame, double reach, double left) noexcept {
    const double s = model.finest_cell;
    for (int i = 0; i < kReliefs && overlap(state) > std::max(model.margins.relieve, left); ++i) {
        const ConstrainedMotion out = constrainMotion(Motion::Zero(), around(model, state, left));
        if (longestPath(model, out.u) > kLongestStep * s) return;
        look(model, state, frame, moved(model, state.X_WG, out.u), reach, reach);
    }
}

}  // namespace

void correctProxy(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    startProxy(model, state, frame);
    const double left = leftOf(model, overlap(state));
    for (int i = 0; i < kCorrections && overlap(state) > std::max(model.margins.accept, left); ++i) {
        const Pose X_before = state.X_WG;
        const double depth = overlap(state);
        Motion u = correctionOf(model, state, depth - left);
        bool better = false;
        for (int half = 0; half <= kHalvings && !better; ++half, u *= 0.5) {
            lookAround(model, state, frame, moved(model, X_before, u));
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
    const double left = leftOf(model, overlap(state));
    double reach = nextReach(model, state);
    ProxyWay way(model);
    const double between = std::max(model.margins.relieve, overlap(state));
    bool arrived = false;
    for (int sub_step = 0; sub_step < kSubSteps; ++sub_step) {
        const Motion wanted = unconstrainedMotion(model, state.X_WG, frame.X_WH);
        const double path = longestPath(model, wanted);
        arrived = path < kStill;
        if (arrived) break;
        frame.iterations = static_cast<std::uint32_t>(sub_step + 1);
        const Pose X_here = state.X_WG;
        const double accepted = std::max(model.margins.accept, overlap(state));
        if (state.room > path) {
            if (!way.goesOn(model, wanted, path)) break;
            if (way.bentBy(wanted) > model.margins.relieve &&
                cutsCorner(model, state, frame, X_before, frame.X_WH, between))
                break;
        }
        // Nothing in the way: arrive.
        arrived = state.room > path && arriveFreely(model, state, frame, path, reach, accepted);
        if (arrived) break;
        // Step as far as the contacts are known, farther only where there is proven room.
        const double known = std::max(state.manifold_reach, state.room);
        const AllowedMotion allowed = allowedMotion(model, state, frame, wanted, around(model, state, left));
        Motion u = allowed.u;
        const double step_path = longestPath(model, u);
        arrived = step_path < kStill;
        if (arrived) state.rubbing = allowed.rubbing;  // at rest
        if (arrived) break;
        if (step_path > known) u *= known / step_path;
        if (!way.goesOn(model, u, step_path)) break;
        const double next_reach = std::clamp(kReachGrowth * std::min(step_path, path), reach, kLongestStep * s);
        bool good = false, whole = step_path <= known;
        for (int half = 0; half <= kHalvings; ++half, u *= 0.5) {
            look(model, state, frame, moved(model, X_here, u), next_reach, std::max(next_reach, path));
            relieve(model, state, frame, next_reach, left);
            good = overlap(state) <= accepted;
            if (good && half == 0) state.rubbing = allowed.rubbing;
            if (good) break;
            frame.status |= kStepRejected;
            whole = false;
        }
        if (good) {
            way.add(unconstrainedMotion(model, X_here, state.X_WG));
            good = way.bentBy(Motion::Zero()) <= model.margins.relieve ||
                   !cutsCorner(model, state, frame, X_before, state.X_WG, between);
        }
        arrived = good && whole;  // the whole constrained motion was made
        if (!good) look(model, state, frame, X_here, next_reach, next_reach);
        if (!good || whole) break;
        reach = next_reach;
    }
    if (!arrived) frame.status |= kIterationLimit;
    state.last_motion = unconstrainedMotion(model, X_before, state.X_WG).norm();
}

}  // namespace passung::tick
