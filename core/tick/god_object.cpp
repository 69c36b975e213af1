#include "core/tick/god_object.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/tick/proxy.h"
#include "core/tick/proxy_way.h"

namespace passung::tick {

namespace {

/// What the step `u` met and went more than `relieve` into, as contacts of the place where it began (cuts:
/// god_object.h).
void addCuts(const MovingProxy& moving, const Pose& X_met, const motion::Motion& u) noexcept {
    const auto& [model, proxy, memory, report, obstacles] = static_cast<const ProxyView&>(moving);
    const motion::Surroundings here = surroundings(moving);
    const Pose back = proxy.X_WG * X_met.inverse();
    for (const contact::ContactPoint& met : memory.scratch) {
        if (!(met.phi < -model.margins.relieve)) continue;
        contact::ContactPoint cut = met;
        cut.position = back * met.position;
        cut.phi = met.phi - met.gradient.dot(here.wayOf(cut.position, u));
        if (!proxy.manifold.tryPush(cut)) return;
        ++proxy.cuts;
    }
}

/// Cuts are those of one step.
void forgetCuts(Proxy& proxy) noexcept {
    proxy.manifold.keepFirst(proxy.manifold.size() - std::min(proxy.cuts, proxy.manifold.size()));
    proxy.cuts = 0;
    proxy.tried = 0;
}

struct Step {
    motion::Motion u = motion::Motion::Zero();  // as made
    motion::FrictionPatches rubbing;
    bool made = false;
    bool whole = false;      // all that was allowed
    bool halved = false;     // less, because even the last cuts did not keep it out
    bool at_rest = false;    // nothing is allowed
    bool suspended = false;  // the work of the tick was done
};

/// What a step may do, and how to look around where it ends [m].
struct StepBounds {
    double known;     // no farther than is known around the proxy
    double accepted;  // most overlap that it may leave
    double reach, search;
};

/// Makes what is `allowed` of `wanted` within `bounds`.
Step makeStep(const MovingProxy& moving, const motion::Motion& wanted, const motion::Surroundings& around,
              AllowedMotion allowed, const StepBounds& bounds, const ProxyWay& way, LookBudget& budget) noexcept {
    const HandModel& model = moving.model;
    Proxy& proxy = moving.proxy;
    SuspendedStep& step = proxy.step;
    ProxyPlace here = placeOf(proxy);
    // A step that was suspended goes on with its cuts, as short as it was then.
    const int before = std::clamp(proxy.tried, 0, kCuts + kHalvings);
    double share = std::ldexp(1.0, -std::max(0, before - kCuts));
    for (int tried = before; tried <= kCuts + kHalvings; ++tried) {
        if (!step.look.open) {
            const double length = longestPath(moving, allowed.u);
            if (length < kStill) return {.rubbing = allowed.rubbing, .at_rest = true};
            step.share = share * (length > bounds.known ? bounds.known / length : 1.0);
            step.u = step.share * allowed.u;
            step.halved = share < 1.0;
            step.rubbing = allowed.rubbing;
            step.X_WT = moving.target.X_WT;
            const bool bends = model.hasNodeBudget() && way.bentBy(step.u) > model.margins.relieve;
            if (bends || !budget.allows()) {
                proxy.tried = tried;
                return {.rubbing = {}, .suspended = true};
            }
        }
        budget.begin();
        if (!lookAround(moving, moving.target.metric.moved(here.X_WG, step.u), bounds.reach, bounds.search)) {
            proxy.tried = tried;
            return {.rubbing = {}, .suspended = true};
        }
        const motion::Motion u = step.u;
        if (overlap(proxy) <= bounds.accepted) {
            noteFollowed(proxy, step.X_WT, step.share);
            return {.u = u, .rubbing = step.rubbing, .made = true, .whole = step.share == 1.0, .halved = step.halved};
        }
        moving.report.status |= kStepRejected;
        const Pose X_met = proxy.X_WG;
        takeBack(moving, here);
        if (tried < kCuts) {
            addCuts(moving, X_met, u);
            here.cuts = proxy.cuts;
            allowed = allowedMotion(moving, wanted, around);
        } else {
            share *= 0.5;
        }
    }
    return {};
}

}  // namespace

void sweepProxy(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                const ObstaclePoses& obstacles, Proxy& proxy, ProxyMotion& motion, QueryMemory& memory, Pushes& pushes,
                Report& report) noexcept {
    const MovingProxy moving{{model, proxy, memory, report, obstacles}, hand, target, motion, pushes};
    if (!startProxy(moving)) {
        report.status |= kSuspended | kIterationLimit;
        noteLag(moving, false);
        return;
    }
    const ProxyMargins& margins = model.margins;
    const double longest = kLongestStep * model.finest_cell;
    const Pose X_before = proxy.X_WG;
    double reach = nextReach(model, motion.last_motion);
    double repair = kRepair * model.finest_cell;
    ProxyWay way(model, target.metric);
    const double between = std::max(margins.relieve, overlap(proxy));
    LookBudget budget(target.work, report);
    const bool budgeted = model.hasNodeBudget();
    bool arrived = false, whole = false;  // whole: the last step was all that was allowed
    bool suspended = false;
    for (int sweep = 0; sweep <= kSweeps; ++sweep) {
        const motion::Motion wanted = target.wantedAt(proxy.X_WG);
        const double path = longestPath(moving, wanted);
        const double before = overlap(proxy);
        const bool goes_on = proxy.step.look.open;  // with what an earlier tick began
        arrived = !goes_on && path < kStill && before <= margins.relieve;
        if (arrived) break;
        const double accepted = std::max(margins.accept, before + 0.1 * margins.keep);
        const bool free = proxy.clearance_bound > path;
        if (sweep < kSweeps && free && !budgeted) {
            if (!way.goesOn(model, wanted, path)) break;
            const bool bent = way.bentBy(wanted) > margins.relieve;
            suspended = !budget.allows(bent ? 1 + kLooksBetween : 1);
            if (suspended || (bent && cutsCorner(moving, X_before, target.X_WT, between))) break;
            report.iterations = static_cast<std::uint32_t>(sweep + 1);
            budget.begin();
            arrived = arriveFreely(moving, path, reach, accepted);
            if (arrived) break;
        }

        motion::Surroundings around = surroundings(moving);
        around.sunk_out = -std::max(margins.keep, before - repair);
        const AllowedMotion allowed = allowedMotion(moving, wanted, around);
        const double step = longestPath(moving, allowed.u);
        const double next_reach = std::clamp(kReachGrowth * std::min(step, path), reach, longest);
        const double search = std::max(next_reach, free && budgeted ? 2.0 * path : path);
        // Contacts that held may be left behind by now, so that the way ends only where those of now leave nothing.
        const bool on_the_way = whole && before <= margins.relieve;
        arrived =
            !goes_on && step < (on_the_way ? std::max(kEnough * model.finest_cell, kRest * way.length()) : kStill);
        if (arrived && sweep == 0) motion.rubbing = allowed.rubbing;
        const double known = std::max(proxy.manifold_reach, proxy.clearance_bound);
        const motion::Motion next = (step > known ? known / step : 1.0) * allowed.u;
        const bool stops = !goes_on && (budgeted ? way.bentBy(next) > margins.relieve : !way.goesOn(model, next, step));
        arrived = arrived || (on_the_way && stops);
        if (arrived || stops) break;
        if (sweep == kSweeps) break;
        suspended = !budget.allows(way.bentBy(allowed.u) > margins.relieve ? 1 + kLooksBetween : 1);
        if (suspended) break;
        report.iterations = static_cast<std::uint32_t>(sweep + 1);
        const Pose X_here = proxy.X_WG;
        const Step made =
            makeStep(moving, wanted, around, allowed,
                     {.known = known, .accepted = accepted, .reach = next_reach, .search = search}, way, budget);
        arrived = made.at_rest;
        suspended = made.suspended;
        if (arrived && sweep == 0) motion.rubbing = made.rubbing;
        if (!made.made) break;
        way.add(made.u);
        if (!budgeted && way.bentBy(motion::Motion::Zero()) > margins.relieve) {
            suspended = !budget.allows(kLooksBetween);
            if (suspended || cutsCorner(moving, X_before, proxy.X_WG, between)) {
                queryAround(moving, X_here, reach, reach);
                break;
            }
        }
        if (!made.halved) motion.rubbing = made.rubbing;
        repair = std::max(0.0, repair - std::max(0.0, before - overlap(proxy)));
        whole = made.whole && !goes_on;
        reach = next_reach;
    }
    if (!arrived) report.status |= kIterationLimit;
    if (suspended)
        report.status |= kSuspended;
    else
        forgetCuts(proxy);
    noteLag(moving, arrived);
    if (!suspended || way.length() > 0.0) motion.last_motion = target.metric.between(X_before, proxy.X_WG).norm();
}

}  // namespace passung::tick
