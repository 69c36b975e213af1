#include "core/tick/god_object_heuristic.h"

#include <algorithm>
#include <cmath>

#include "core/tick/proxy.h"
#include "core/tick/proxy_way.h"

namespace passung::tick {

namespace {

constexpr double kLeastLever = 0.1;     // per ρ: contacts that a rotation hardly relieves are left out of θ
constexpr double kLargestTurn = 0.035;  // [rad] of one correction

/// Direction of the correction: translation along the penalty force, rotation about its torque, shared by λ.
motion::Motion correctionOf(const motion::Metric& metric, const Proxy& proxy, double depth) noexcept {
    const double rho = metric.radius;
    const motion::PlacedMetric here = metric.at(proxy.X_WG);
    const Vec3& centre = here.centre;
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (const contact::ContactPoint& c : proxy.manifold) {
        if (!isInside(c)) continue;
        const Vec3 f = -c.phi * c.gradient;
        force += f;
        torque += (c.position - centre).cross(f);
    }
    const double F = force.norm(), T = torque.norm() / rho;
    motion::Motion u = motion::Motion::Zero();
    if (!(F + T > 0.0)) return u;
    const double lambda = F / (F + T);
    if (F > 0.0) u.head<3>() = lambda * depth / F * force;
    if (!(T > 0.0)) return u;
    const Vec3 axis = torque.normalized();
    double ph = 0.0, hh = 0.0;
    for (const contact::ContactPoint& c : proxy.manifold) {
        const double lever = c.gradient.dot(axis.cross(c.position - centre));
        if (!isInside(c) || !(lever > kLeastLever * rho)) continue;
        ph += -c.phi * lever;
        hh += lever * lever;
    }
    const double theta = hh > 0.0 ? std::clamp(ph / hh, 0.0, std::min(kLargestTurn, 3.0 * depth / rho)) : 0.0;
    u.tail<3>() = here.tailOf((1.0 - lambda) * theta, axis);
    return u;
}

/// What a stage leaves of the overlap that it begins with.
double leftOf(const HandModel& model, double overlap) noexcept {
    return std::max(model.margins.keep, overlap - kLeave * model.finest_cell);
}

/// What is around the proxy, with no more asked of what is deeper than `left`.
motion::Surroundings around(const MovingProxy& moving, double left) noexcept {
    motion::Surroundings result = surroundings(moving);
    result.sunk_out = -left;
    return result;
}

/// Pushes the proxy out of the overlap that a step's linearisation missed, around a rim for instance: the least motion
/// that obeys the contacts found there.
void relieve(const MovingProxy& moving, double reach, double left, LookBudget& budget) noexcept {
    const auto& [model, proxy, memory, report, obstacles] = static_cast<const ProxyView&>(moving);
    const double s = model.finest_cell;
    for (int i = 0; i < kReliefs && overlap(proxy) > std::max(model.margins.relieve, left); ++i) {
        const motion::ConstrainedMotion out = motion::constrainMotion(motion::Motion::Zero(), around(moving, left));
        if (longestPath(moving, out.u) > kLongestStep * s || !budget.allows(2)) return;
        budget.begin();
        queryAround(moving, moving.target.metric.moved(proxy.X_WG, out.u), reach, reach);
    }
}

}  // namespace

void correctProxy(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                  const ObstaclePoses& obstacles, Proxy& proxy, ProxyMotion& motion, QueryMemory& memory,
                  Pushes& pushes, Report& report) noexcept {
    const MovingProxy moving{{model, proxy, memory, report, obstacles}, hand, target, motion, pushes};
    if (!startProxy(moving)) return;
    const double left = leftOf(model, overlap(proxy));
    for (int i = 0; i < kCorrections && overlap(proxy) > std::max(model.margins.accept, left); ++i) {
        const Pose X_before = proxy.X_WG;
        const double depth = overlap(proxy);
        motion::Motion u = correctionOf(target.metric, proxy, depth - left);
        bool better = false;
        for (int half = 0; half <= kHalvings && !better; ++half, u *= 0.5) {
            surveyContacts(moving, moving.target.metric.moved(X_before, u));
            better = overlap(proxy) < depth;
        }
        if (!better) {
            report.status |= kStepRejected;
            surveyContacts(moving, X_before);
            return;
        }
    }
}

void moveProxy(const HandModel& model, const HandSample& hand, const HeldTarget& target, const ObstaclePoses& obstacles,
               Proxy& proxy, ProxyMotion& motion, QueryMemory& memory, Pushes& pushes, Report& report) noexcept {
    const MovingProxy moving{{model, proxy, memory, report, obstacles}, hand, target, motion, pushes};
    const double s = model.finest_cell;
    const Pose X_before = proxy.X_WG;
    const double left = leftOf(model, overlap(proxy));
    double reach = nextReach(model, motion.last_motion);
    ProxyWay way(model, target.metric);
    const double between = std::max(model.margins.relieve, overlap(proxy));
    LookBudget budget(target.work, report);
    bool arrived = false, suspended = false;
    for (int sub_step = 0; sub_step < kSubSteps; ++sub_step) {
        const motion::Motion wanted = target.wantedAt(proxy.X_WG);
        const double path = longestPath(moving, wanted);
        arrived = path < kStill;
        if (arrived) break;
        suspended = !budget.allows();
        if (suspended) break;
        report.iterations = static_cast<std::uint32_t>(sub_step + 1);
        const Pose X_here = proxy.X_WG;
        const double accepted = std::max(model.margins.accept, overlap(proxy));
        if (proxy.clearance_bound > path) {
            if (!way.goesOn(model, wanted, path)) break;
            const bool bent = way.bentBy(wanted) > model.margins.relieve;
            suspended = bent && !budget.allows(1 + kLooksBetween);
            if (suspended || (bent && cutsCorner(moving, X_before, target.X_WT, between))) break;
        }
        // Nothing in the way: arrive.
        budget.begin();
        arrived = proxy.clearance_bound > path && arriveFreely(moving, path, reach, accepted);
        if (arrived) break;
        // Step as far as the contacts are known, farther only where there is proven room.
        const double known = std::max(proxy.manifold_reach, proxy.clearance_bound);
        const AllowedMotion allowed = allowedMotion(moving, wanted, around(moving, left));
        motion::Motion u = allowed.u;
        const double step_path = longestPath(moving, u);
        arrived = step_path < kStill;
        if (arrived) motion.rubbing = allowed.rubbing;  // at rest
        if (arrived) break;
        if (step_path > known) u *= known / step_path;
        if (!way.goesOn(model, u, step_path)) break;
        const double next_reach = std::clamp(kReachGrowth * std::min(step_path, path), reach, kLongestStep * s);
        // A step that was suspended goes on as short as it was then.
        const int tried = std::clamp(proxy.tried, 0, kHalvings);
        u *= std::ldexp(1.0, -tried);
        bool good = false, whole = step_path <= known && tried == 0;
        int half = tried;
        for (; half <= kHalvings; ++half, u *= 0.5) {
            suspended = half > tried && !budget.allows(2);  // one of them back
            if (suspended) break;
            budget.begin();
            queryAround(moving, moving.target.metric.moved(X_here, u), next_reach, std::max(next_reach, path));
            relieve(moving, next_reach, left, budget);
            good = overlap(proxy) <= accepted;
            if (good && half == 0) motion.rubbing = allowed.rubbing;
            if (good) break;
            report.status |= kStepRejected;
            whole = false;
        }
        if (good) {
            way.add(target.metric.between(X_here, proxy.X_WG));
            const bool bent = way.bentBy(motion::Motion::Zero()) > model.margins.relieve;
            suspended = bent && !budget.allows(kLooksBetween);
            good = !bent || (!suspended && !cutsCorner(moving, X_before, proxy.X_WG, between));
        }
        arrived = good && whole;  // the whole constrained motion was made
        if (good) noteFollowed(proxy, target.X_WT, std::min(1.0, known / step_path) * std::ldexp(1.0, -half));
        if (!good) queryAround(moving, X_here, next_reach, next_reach);
        if (suspended) proxy.tried = half;
        if (!good || whole) break;
        reach = next_reach;
    }
    noteLag(moving, arrived);
    if (!arrived) report.status |= kIterationLimit;
    if (suspended) report.status |= kSuspended;
    motion.last_motion = target.metric.between(X_before, proxy.X_WG).norm();
}

}  // namespace passung::tick
