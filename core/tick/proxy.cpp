#include "core/tick/proxy.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/tick/contact_energy.h"
#include "core/tick/field_look.h"
#include "core/tick/obstacle_query.h"

namespace passung::tick {

namespace {

constexpr double kSamePoint = 1e-6;  // [m]: points of one part are farther apart

/// The contacts of now that held the last motion.
std::span<const std::uint32_t> likelyContacts(const MovingProxy& moving,
                                              std::array<std::uint32_t, 6>& places) noexcept {
    const Proxy& proxy = moving.proxy;
    const ActivePoints& last = moving.motion.held;
    std::size_t found = 0;
    std::array<Vec3, 12> held;
    const auto count = static_cast<std::size_t>(2 * last.count);
    for (std::size_t i = 0; 2 * i < count; ++i) {
        held[2 * i] = proxy.X_WG * last.point[i].p_G;
        held[2 * i + 1] = last.point[i].p_W;
    }
    if (count == 0) return {};
    for (std::size_t k = 0; k < proxy.manifold.size() && found < places.size(); ++k) {
        const contact::ContactPoint& contact = proxy.manifold[k];
        if (contact.phi > moving.model.margins.relieve) continue;  // a contact that held is hardly farther away
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

void noteActive(const motion::ConstrainedMotion& motion, const Proxy& proxy, ActivePoints& held) noexcept {
    held.count = motion.active;
    const Pose X_GW = proxy.X_WG.inverse();
    for (int i = 0; i < motion.active; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const Vec3& p = proxy.manifold[motion.active_contacts[at].contact].position;
        held.point[at] = {X_GW * p, p};
    }
}

void note(int count, std::uint32_t& most) noexcept { most = std::max(most, static_cast<std::uint32_t>(count)); }

}  // namespace

double overlap(const Proxy& proxy) noexcept { return std::max(0.0, -proxy.clearance); }

bool isInside(const contact::ContactPoint& contact) noexcept { return contact.phi < 0.0 && !(contact.radius > 0.0); }

void queryAround(const ProxyView& view, const Pose& X_WG, double reach, double search) noexcept {
    const auto& [model, proxy, memory, report, obstacles] = view;
    memory.scratch.clear();
    contact::QueryRequest request{.collect_below = reach,
                                  .search_below = search,
                                  .spheres = true,
                                  .facing = model.contact.two_way,
                                  .edges = true};
    // What a budget leaves (tick_query.h) is kept out by spheres; every point that was looked at has to hold it
    // besides, and what that is depends on what is known.
    const bool whole = model.contact.budget_nodes == 0;
    if (whole) request.every_below = model.margins.accept;
    contact::QueryAnswer answer =
        queryObstacles(model, obstacles, X_WG, request, memory.workspace, memory.scratch, memory.around_proxy, whole);
    account(answer, report);
    std::swap(proxy.manifold, memory.scratch);
    proxy.cuts = 0;
    proxy.tried = 0;
    proxy.X_WG = X_WG;
    proxy.manifold_reach = reach;
    proxy.clearance = proxy.clearance_bound = answer.phi;
    noteObstacles(view);
    for (const contact::ContactPoint& contact : proxy.manifold)
        proxy.clearance_bound = std::min(proxy.clearance_bound, contact.phi);
    if (!(proxy.clearance_bound > reach)) return;
    request.prove = true;
    memory.scratch.clear();
    answer = queryObstacles(model, obstacles, X_WG, request, memory.workspace, memory.scratch, memory.around_proxy);
    account(answer, report);
    proxy.clearance_bound = std::max(reach, answer.lower_bound);
}

bool lookAround(const ProxyView& view, const Pose& X_WG, double reach, double search) noexcept {
    const auto& [model, proxy, memory, report, obstacles] = view;
    if (!model.hasNodeBudget()) {
        queryAround(view, X_WG, reach, search);
        return true;
    }
    FieldLook& look = proxy.step.look;
    if (!look.open) beginLook(look, X_WG, reach, search, memory.around_proxy.near);
    if (!goOnLooking(model, obstacles, look, memory.around_proxy.known, report)) return false;
    std::swap(memory.scratch, proxy.manifold);
    std::swap(proxy.manifold, look.found);
    proxy.cuts = 0;
    proxy.tried = 0;
    proxy.X_WG = look.X_WG;
    proxy.manifold_reach = look.reach;
    proxy.clearance = look.nearest;
    proxy.clearance_bound = look.clearance_bound;
    noteObstacles(view);
    return true;
}

void noteObstacles(const ProxyView& view) noexcept {
    for (const auto& in_hand : view.obstacles.inHands())
        view.proxy.X_WO_known[in_hand.obstacle] = view.obstacles.X_WO[in_hand.obstacle];
}

void forgetMoved(const ProxyView& view) noexcept {
    const auto& [model, proxy, memory, report, obstacles] = view;
    double nearer = 0.0;
    bool touched = false;
    for (const auto& in_hand : obstacles.inHands()) {
        const std::uint32_t obstacle = in_hand.obstacle;
        const Pose &before = proxy.X_WO_known[obstacle], &now = obstacles.X_WO[obstacle];
        if (now.p == before.p && now.q.coeffs() == before.q.coeffs()) continue;
        const Pose back = before * now.inverse();
        const double around = model.reach + std::max(0.0, proxy.clearance_bound);
        nearer = std::max(nearer, (back * proxy.X_WG.p - proxy.X_WG.p).norm() + rotationVector(back.q).norm() * around);
        touched = touched || std::any_of(proxy.manifold.begin(), proxy.manifold.end(),
                                         [=](const auto& contact) { return contact.obstacle == obstacle; });
    }
    if (nearer == 0.0 || proxy.manifold_reach < 0.0) return;
    proxy.manifold_reach -= nearer;
    proxy.clearance_bound -= nearer;
    if (touched || proxy.manifold_reach < kShortestReach * model.finest_cell) proxy.manifold_reach = -1.0;
    noteObstacles(view);
}

ProxyPlace placeOf(const Proxy& proxy) noexcept {
    return {proxy.X_WG, proxy.manifold_reach, proxy.clearance, proxy.clearance_bound, proxy.cuts};
}

void takeBack(const ProxyView& view, const ProxyPlace& place) noexcept {
    Proxy& proxy = view.proxy;
    std::swap(proxy.manifold, view.memory.scratch);
    proxy.X_WG = place.X_WG;
    proxy.manifold_reach = place.reach;
    proxy.clearance = place.clearance;
    proxy.clearance_bound = place.clearance_bound;
    proxy.cuts = place.cuts;
}

bool overlapsBetween(const ProxyView& view, const Pose& X_from, const Pose& X_to, double share,
                     double accepted) noexcept {
    const Pose X{X_from.q.slerp(share, X_to.q), X_from.p + share * (X_to.p - X_from.p)};
    view.memory.scratch.clear();
    const contact::QueryRequest request{
        .collect_below = -1e300, .search_below = -accepted, .facing = view.model.contact.two_way, .edges = true};
    const contact::QueryAnswer answer = queryObstacles(view.model, view.obstacles, X, request, view.memory.workspace,
                                                       view.memory.scratch, view.memory.around_proxy, true);
    account(answer, view.report);
    return answer.found;
}

void surveyContacts(const ProxyView& view, const Pose& X_WG) noexcept {
    const double reach = kLongestStep * view.model.finest_cell;
    queryAround(view, X_WG, reach, reach);
}

bool startProxy(const MovingProxy& moving) noexcept {
    Proxy& proxy = moving.proxy;
    if (moving.hand.relocated) {
        proxy.X_WG = moving.hand.X_WH;
        proxy.manifold_reach = -1.0;
        proxy.step.look.open = false;
        proxy.step.X_WT_followed = moving.hand.X_WH;
        moving.motion.rubbing = {};
    }
    clearPushes(moving.pushes);
    forgetMoved(moving);
    if (!(proxy.manifold_reach < 0.0)) return true;
    const double reach = kLongestStep * moving.model.finest_cell;
    return lookAround(moving, proxy.X_WG, reach, reach);
}

double nextReach(const HandModel& model, double last_motion) noexcept {
    const double s = model.finest_cell;
    return std::clamp(kReachGrowth * last_motion, kShortestReach * s, kLongestStep * s);
}

bool arriveFreely(const MovingProxy& moving, double path, double reach, double accepted) noexcept {
    const Pose X_here = moving.proxy.X_WG;
    queryAround(moving, moving.target.X_WT, reach, std::max(reach, 2.0 * path));
    if (overlap(moving.proxy) <= accepted) {
        moving.motion.rubbing = {};  // free
        clearPushes(moving.pushes);
        return true;
    }
    moving.report.status |= kStepRejected;
    queryAround(moving, X_here, reach, reach);
    return false;
}

void noteFollowed(Proxy& proxy, const Pose& X_WT, double share) noexcept {
    Pose& followed = proxy.step.X_WT_followed;
    followed = share == 1.0 ? X_WT : Pose{followed.q.slerp(share, X_WT.q), followed.p + share * (X_WT.p - followed.p)};
}

void noteLag(const MovingProxy& moving, bool arrived) noexcept {
    Pose& followed = moving.proxy.step.X_WT_followed;
    if (arrived) followed = moving.target.X_WT;
    moving.proxy.lag = longestPath(moving, moving.target.metric.between(followed, moving.target.X_WT));
}

double longestPath(const MovingProxy& moving, const motion::Motion& u) noexcept {
    return moving.target.metric.wayOf(u, moving.model.shell->reach());
}

motion::Surroundings surroundings(const MovingProxy& moving) noexcept {
    return {moving.proxy.manifold, moving.target.metric.at(moving.proxy.X_WG), -moving.model.margins.keep};
}

AllowedMotion allowedMotion(const MovingProxy& moving, const motion::Motion& wanted,
                            const motion::Surroundings& around) noexcept {
    const HandModel& model = moving.model;
    Report& report = moving.report;
    std::array<std::uint32_t, 6> places;
    const auto likely = likelyContacts(moving, places);
    AllowedMotion allowed;
    if (model.friction.empty()) {
        const motion::ConstrainedMotion constrained = motion::constrainMotion(wanted, around, likely);
        if (!constrained.converged) report.status |= kIterationLimit;
        note(constrained.iterations, report.rows_taken);
        allowed.u = constrained.u;
        noteActive(constrained, moving.proxy, moving.motion.held);
        notePushes(model, moving.target, moving.proxy, constrained, allowed.rubbing, moving.pushes);
    } else {
        const motion::FrictionMotion rubbed =
            motion::constrainWithFriction(wanted, around, model.friction, moving.motion.rubbing, likely);
        if (!rubbed.converged || !rubbed.motion.converged) report.status |= kIterationLimit;
        note(rubbed.motion.iterations, report.rows_taken);
        note(rubbed.sweeps, report.friction_turns);
        allowed = {rubbed.motion.u, rubbed.patches};
        noteActive(rubbed.motion, moving.proxy, moving.motion.held);
        notePushes(model, moving.target, moving.proxy, rubbed.motion, rubbed.patches, moving.pushes);
    }
    return allowed;
}

void followHand(const HandModel& model, const HandSample& hand, const HeldTarget& target, Proxy& proxy) noexcept {
    proxy.X_WG = model.hasInertia() && !hand.relocated ? target.X_WT : hand.X_WH;
}

void filterProxy(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                 const ObstaclePoses& obstacles, ProxyFilter& filter, Proxy& proxy, QueryMemory& memory,
                 Report& report) noexcept {
    if (hand.relocated) filter.has_last_proxy = false;  // the proxy was set to the hand
    const double alpha = 1.0 - std::exp(-2.0 * std::numbers::pi * model.contact.proxy_filter * kTickSeconds);
    const bool in_contact = proxy.clearance < model.margins.keep;
    // A step that is still being looked at begins where the proxy is.
    if (in_contact && filter.has_last_proxy && !proxy.step.look.open) {
        const ProxyView view{model, proxy, memory, report, obstacles};
        const motion::Motion u = target.metric.between(filter.X_WG_last, proxy.X_WG);
        const double reach = proxy.manifold_reach;
        const double accepted = std::max(model.margins.accept, overlap(proxy));
        const ProxyPlace unfiltered = placeOf(proxy);
        if (!lookAround(view, target.metric.moved(filter.X_WG_last, alpha * u), reach, reach))
            proxy.step.look.open = false;
        else if (overlap(proxy) > accepted)
            takeBack(view, unfiltered);
    }
    filter.X_WG_last = proxy.X_WG;
    filter.has_last_proxy = true;
}

void describeProxy(const HandModel&, const Proxy& proxy, ContactRecord& record) noexcept {
    record.proxy_depth = overlap(proxy);
    record.proxy_lag = proxy.lag;
    const contact::ContactPoint* const end = proxy.manifold.end() - std::min(proxy.cuts, proxy.manifold.size());
    record.contacts = static_cast<std::uint32_t>(std::count_if(proxy.manifold.begin(), end, isInside));
}

void measureHandDepth(const HandModel& model, const HandSample& hand, const ObstaclePoses& obstacles,
                      QueryMemory& memory, HandDepth& depth, Report& report) noexcept {
    memory.scratch.clear();
    const contact::QueryAnswer answer = queryObstacles(model, obstacles, hand.X_WH, {.collect_below = -1e300},
                                                       memory.workspace, memory.scratch, memory.around_hand, true);
    report.nodes_visited += static_cast<std::uint32_t>(answer.nodes_visited);
    report.work += workOf(answer);
    depth.hand_depth = std::max(0.0, -answer.phi);
}

}  // namespace passung::tick
