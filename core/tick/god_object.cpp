#include "core/tick/god_object.h"

#include <algorithm>

#include "core/tick/proxy.h"
#include "core/tick/proxy_way.h"

namespace passung::tick {

namespace {

/// Makes `u`, or as much of it as leaves no more overlap than `accepted`; the share made, 0 if the proxy stays.
double makeStep(const TickModel& model, TickState& state, TickFrame& frame, const Motion& u, double reach,
                double search, double accepted) noexcept {
    const Pose X_here = state.X_WG;
    double share = 1.0;
    for (int half = 0; half <= kHalvings; ++half, share *= 0.5) {
        look(model, state, frame, moved(model, X_here, share * u), reach, search);
        if (overlap(state) <= accepted) return share;
        frame.status |= kStepRejected;
    }
    look(model, state, frame, X_here, reach, reach);
    return 0.0;
}

}  // namespace

void sweepProxy(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    startProxy(model, state, frame);
    const ProxyMargins& margins = model.margins;
    const double longest = kLongestStep * model.finest_cell;
    const Pose X_before = state.X_WG;
    double reach = nextReach(model, state);
    double repair = kRepair * model.finest_cell;
    ProxyWay way(model);
    const double between = std::max(margins.relieve, overlap(state));
    bool arrived = false, whole = false;  // whole: the last step was all that was allowed
    for (int sweep = 0; sweep <= kSweeps; ++sweep) {
        const Motion wanted = unconstrainedMotion(model, state.X_WG, frame.X_WH);
        const double path = longestPath(model, wanted);
        const double before = overlap(state);
        arrived = path < kStill && before <= margins.relieve;
        if (arrived) break;
        const double accepted = std::max(margins.accept, before + 0.1 * margins.keep);
        if (sweep < kSweeps && state.room > path) {
            if (!way.goesOn(model, wanted, path)) break;
            if (way.bentBy(wanted) > margins.relieve && cutsCorner(model, state, frame, X_before, frame.X_WH, between))
                break;
            frame.iterations = static_cast<std::uint32_t>(sweep + 1);
            arrived = arriveFreely(model, state, frame, path, reach, accepted);
            if (arrived) break;
        }

        Surroundings around = surroundings(model, state);
        around.sunk_out = -std::max(margins.keep, before - repair);
        const AllowedMotion allowed = allowedMotion(model, state, frame, wanted, around);
        const double step = longestPath(model, allowed.u);
        const double known = std::max(state.manifold_reach, state.room);
        const double share = step > known ? known / step : 1.0;
        const double next_reach = std::clamp(kReachGrowth * std::min(step, path), reach, longest);
        // Contacts that held may be left behind by now, so that the way ends only where those of now leave nothing.
        const bool on_the_way = whole && before <= margins.relieve;
        arrived = step < (on_the_way ? std::max(kEnough * model.finest_cell, kRest * way.length()) : kStill);
        if (arrived && sweep == 0) state.rubbing = allowed.rubbing;
        const bool stops = !way.goesOn(model, share * allowed.u, step);
        arrived = arrived || (on_the_way && stops);
        if (arrived || stops) break;
        if (sweep == kSweeps) break;
        frame.iterations = static_cast<std::uint32_t>(sweep + 1);
        const Pose X_here = state.X_WG;
        const double made =
            makeStep(model, state, frame, share * allowed.u, next_reach, std::max(next_reach, path), accepted);
        if (made == 0.0) break;
        way.add(made * share * allowed.u);
        if (way.bentBy(Motion::Zero()) > margins.relieve &&
            cutsCorner(model, state, frame, X_before, state.X_WG, between)) {
            look(model, state, frame, X_here, reach, reach);
            break;
        }
        if (made == 1.0) state.rubbing = allowed.rubbing;
        repair = std::max(0.0, repair - std::max(0.0, before - overlap(state)));
        whole = made * share == 1.0;
        reach = next_reach;
    }
    if (!arrived) frame.status |= kIterationLimit;
    state.last_motion = unconstrainedMotion(model, X_before, state.X_WG).norm();
}

}  // namespace passung::tick
