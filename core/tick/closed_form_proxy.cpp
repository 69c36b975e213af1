#include "core/tick/closed_form_proxy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/tick/contact_energy.h"

namespace passung::tick {

namespace {

/// In place of the pushes so far: K λ along each contact's normal, and what rubs (contact_energy.h).
void noteHold(const HandModel& model, const HeldTarget& target, const Proxy& proxy, const closed_form::PoseMemory& hold,
              const motion::FrictionPatches& rubbing, Pushes& pushes) noexcept {
    clearPushes(pushes);
    for (const closed_form::HeldContact& held : hold.all()) {
        const Vec3 push = held.push * held.contact.normal;
        addPush(model, target, proxy.X_WG, held.contact.point, push,
                model.contact.stiffness * target.stiffness * push.norm(), pushes.pushes[held.pair]);
    }
    for (int p = 0; p < rubbing.count; ++p) {
        const motion::FrictionPatch& patch = rubbing.patch[static_cast<std::size_t>(p)];
        addRub(model, target, proxy.X_WG, patch, pushes.pushes[patch.obstacle]);
    }
}

void note(const closed_form::ConstrainedPose& found, Report& report) noexcept {
    if (!found.converged) report.status |= kIterationLimit;
    if (found.full) report.status |= kContactCap;
    report.iterations += static_cast<std::uint32_t>(found.iterations);
}

int mostLooks(const HandModel& model, const ClosedFormMemory& memory) noexcept {
    if (memory.has_thread) return closed_form::kThreadLooks;
    return model.contact.method == scene::ContactMethod::GodObject ? closed_form::kMostLooks : kHeuristicLooks;
}

std::vector<closed_form::SolidPair> pairsOf(const HandModel& model) {
    std::vector<closed_form::SolidPair> pairs;
    for (std::size_t i = 0; i < model.obstacles.size(); ++i)
        pairs.push_back({model.held_solid, model.obstacles[i].solid, model.bodies[model.obstacles[i].body].X_WP_start,
                         motion::Metric{model.metric_radius}});
    return pairs;
}

}  // namespace

ClosedFormMemory closedFormMemory(const HandModel& model) {
    ClosedFormMemory memory;
    const auto pairs = pairsOf(model);
    memory.near_hand = nearListOf(model, 0.0);
    memory.solver = closed_form::PoseSolver(pairs, memory.near_hand, model.friction);
    for (const closed_form::SolidPair& pair : pairs) memory.at_hand.emplace_back(pair);
    memory.has_thread = closed_form::isThread(*model.held_solid) ||
                        std::any_of(model.obstacles.begin(), model.obstacles.end(),
                                    [](const Obstacle& obstacle) { return closed_form::isThread(*obstacle.solid); });
    return memory;
}

void followInClosedForm(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                        const ObstaclePoses& obstacles, Proxy& proxy, ClosedFormHold& held, ClosedFormMemory& memory,
                        Pushes& pushes, Report& report) noexcept {
    for (const ObstaclePoses::Carried& in_hand : obstacles.inHands()) {
        memory.solver.place(in_hand.obstacle, obstacles.X_WO[in_hand.obstacle]);
        memory.at_hand[in_hand.obstacle].place(obstacles.X_WO[in_hand.obstacle]);
    }
    obstacles.place(memory.solver.near());
    obstacles.place(memory.near_hand);
    if (hand.relocated) {  // a spring from the old place would throw the hand across the room
        proxy.X_WG = hand.X_WH;
        held.hold = {};
    }
    const closed_form::ConstrainedPose found =
        memory.solver.solve(proxy.X_WG, target.X_WT, held.hold, mostLooks(model, memory), target.pullBeside());
    proxy.X_WG = found.X_WG;
    proxy.clearance = -found.overlap;
    note(found, report);
    noteHold(model, target, proxy, held.hold, memory.solver.patches(), pushes);
}

void filterInClosedForm(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                        const ClosedFormHold& held, FilteredHold& filter, Proxy& proxy, ClosedFormMemory& memory,
                        Report& report) noexcept {
    if (hand.relocated) filter.has_last_proxy = false;
    const double alpha = 1.0 - std::exp(-2.0 * std::numbers::pi * model.contact.proxy_filter * kTickSeconds);
    if (held.hold.count > 0 && filter.has_last_proxy) {
        const motion::Motion u = target.metric.between(filter.X_WG_last, proxy.X_WG);
        const closed_form::ConstrainedPose found = memory.solver.solve(
            filter.X_WG_last, target.metric.moved(filter.X_WG_last, alpha * u), filter.hold, mostLooks(model, memory));
        proxy.X_WG = found.X_WG;
        proxy.clearance = -found.overlap;
        note(found, report);
    } else {
        filter.hold = {};
    }
    filter.X_WG_last = proxy.X_WG;
    filter.has_last_proxy = true;
}

void describeClosedForm(const HandModel&, const HeldTarget& target, const Proxy& proxy, const ClosedFormHold& held,
                        ContactRecord& record) noexcept {
    record.proxy_depth = overlap(proxy);
    record.contacts = std::max(target.contacts_of_hands, static_cast<std::uint32_t>(held.hold.count));
}

void measureClosedFormDepth(const HandModel&, const HandSample& hand, ClosedFormMemory& memory, HandDepth& depth,
                            Report& report) noexcept {
    depth.hand_depth = 0.0;
    for (const std::uint32_t i : memory.near_hand.within(hand.X_WH, 0.0)) {
        const closed_form::ContactSearch::Overlap found = memory.at_hand[i].overlapAt(hand.X_WH, memory.search);
        depth.hand_depth = std::max(depth.hand_depth, found.depth);
        if (found.full) report.status |= kContactCap;
    }
}

}  // namespace passung::tick
