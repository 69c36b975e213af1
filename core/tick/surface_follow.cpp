#include "core/tick/surface_follow.h"

#include <algorithm>
#include <vector>

#include "core/tick/contact_energy.h"

namespace passung::tick {

namespace {

/// Which obstacle a surface that rubs is, by its number (SurfaceProxy::patches).
std::size_t rubbingObstacle(const HandModel& model, std::size_t surface) noexcept {
    const std::size_t still = model.still_surface != nullptr ? model.resting.size() : 0;
    return surface < still ? model.resting[surface] : model.moving[surface - still];
}

/// In place of the pushes so far: K λ along each row's normal (contact_energy.h).
void noteRows(const HandModel& model, const HeldTarget& target, const surface::SurfaceProxy& surface,
              Pushes& pushes) noexcept {
    clearPushes(pushes);
    for (const surface::ContactRow& row : surface.rows()) {
        if (!(row.push > 0.0)) continue;
        addPush(model, target, surface.pose(), surface.pointOf(row), row.push * surface.normalOf(row),
                model.contact.stiffness * target.stiffness * row.push, pushes.pushes[obstacleOf(model, surface, row)]);
    }
    const motion::FrictionPatches& patches = surface.patches();
    for (int p = 0; p < patches.count; ++p) {
        const motion::FrictionPatch& patch = patches.patch[static_cast<std::size_t>(p)];
        addRub(model, target, surface.pose(), patch, pushes.pushes[rubbingObstacle(model, patch.obstacle)]);
    }
}

}  // namespace

std::size_t surfaceBodyOf(const HandModel& model, std::uint32_t obstacle) noexcept {
    const auto at = std::lower_bound(model.moving.begin(), model.moving.end(), obstacle);
    return static_cast<std::size_t>(at - model.moving.begin()) + (model.still_surface != nullptr ? 1 : 0);
}

std::size_t obstacleOf(const HandModel& model, const surface::SurfaceProxy& surface,
                       const surface::ContactRow& row) noexcept {
    const std::size_t still = model.still_surface != nullptr ? 1 : 0;
    if (row.body >= still) return model.moving[row.body - still];
    const auto& firsts = model.first_triangles;
    const auto after = std::upper_bound(firsts.begin(), firsts.end(), surface.triangleOf(row));
    return model.resting[static_cast<std::size_t>(after - firsts.begin()) - 1];
}

SurfaceFollow surfaceFollow(const HandModel& model) {
    SurfaceFollow follow;
    // Those that rest are one body, in the world; then those in other hands.
    std::vector<surface::SurfaceBody> bodies;
    if (model.still_surface != nullptr) {
        surface::SurfaceBody& still = bodies.emplace_back();
        still.tree = model.still_surface;
        for (std::size_t i = 0; !model.friction.empty() && i < model.resting.size(); ++i)
            still.rubbing.push_back({model.first_triangles[i], model.friction[model.resting[i]]});
    }
    for (const std::uint32_t i : model.moving) {
        const Body& body = model.bodies[model.obstacles[i].body];
        surface::SurfaceBody& moving = bodies.emplace_back();
        moving.tree = body.surface;
        moving.X_WB = body.X_WP_start;
        if (!model.friction.empty()) moving.rubbing.push_back({0, model.friction[i]});
    }
    follow.surface.emplace(
        *model.held_surface, bodies,
        surface::SurfaceSettings{
            .metric = motion::Metric{model.metric_radius}, .gap = kSurfaceGap, .budget = kSurfaceBudget});
    follow.surface->place(model.X_WG_start);
    follow.surface->prepare();
    return follow;
}

void followOnSurface(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                     const ObstaclePoses& obstacles, Proxy& proxy, SurfaceFollow& follow, Pushes& pushes,
                     Report& report) noexcept {
    for (const ObstaclePoses::Carried& in_hand : obstacles.inHands()) {
        const std::size_t body = surfaceBodyOf(model, in_hand.obstacle);
        if (in_hand.rests)
            follow.surface->leaveBody(body);
        else
            follow.surface->beginTick(body, in_hand.X_WO_begin);
        follow.surface->moveBody(body, obstacles.X_WO[in_hand.obstacle]);
    }
    follow.surface->setBudget(static_cast<int>(target.work));
    if (model.meetsHands()) follow.surface->setHands(hand.X_WH, target.others_way, target.contacts_of_hands > 0);
    // A spring from the old place would throw the hand across the room.
    if (hand.relocated) follow.surface->place(hand.X_WH);
    const surface::SurfaceTick& now = follow.surface->advance(target.X_WT, target.pullBeside());
    follow.gap = now.gap;
    follow.contacts = static_cast<std::uint32_t>(now.active);
    proxy.X_WG = now.X_WG;
    proxy.clearance = now.gap;
    report.iterations += static_cast<std::uint32_t>(now.looks);
    report.rows_taken = std::max(report.rows_taken, static_cast<std::uint32_t>(now.rows));
    report.friction_turns = std::max(report.friction_turns, static_cast<std::uint32_t>(now.turns));
    report.nodes_visited += static_cast<std::uint32_t>(now.work);
    if (now.suspended || now.waits) report.status |= kSuspended;
    if (now.meets) report.status |= kLedOut;
    if (now.stuck || now.unbalanced) report.status |= kIterationLimit;
    noteRows(model, target, *follow.surface, pushes);
}

void describeSurface(const HandModel&, const HeldTarget& target, const SurfaceFollow& follow,
                     ContactRecord& record) noexcept {
    record.proxy_depth = 0.0;
    record.proxy_gap = follow.gap;
    record.contacts = std::max(target.contacts_of_hands, follow.contacts);
}

void measureSurfaceDepth(const HandModel&, const HandSample& hand, const SurfaceFollow& follow,
                         HandDepth& depth) noexcept {
    depth.hand_depth = follow.surface->handDepth(hand.X_WH);
}

}  // namespace passung::tick
