#include "core/tick/obstacle_query.h"

#include <algorithm>

#include "core/contact/edge_search.h"

namespace passung::tick {

namespace {

void merge(const contact::QueryAnswer& answer, contact::QueryAnswer& all) noexcept {
    if (answer.found && answer.phi < all.phi) {
        all.found = true;
        all.phi = answer.phi;
        all.closest_W = answer.closest_W;
        all.normal_W = answer.normal_W;
        all.closest_F = answer.closest_F;
    }
    all.lower_bound = std::min(all.lower_bound, answer.lower_bound);
    all.quality = std::min(all.quality, answer.quality);
    all.nodes_visited += answer.nodes_visited;
    all.points_tested += answer.points_tested;
    all.points_spared += answer.points_spared;
    all.contacts += answer.contacts;
    all.load.force += answer.load.force;
    all.load.torque += answer.load.torque;
    all.budget_reached = all.budget_reached || answer.budget_reached;
    all.manifold_full = all.manifold_full || answer.manifold_full;
}

/// The points of a shell, and its edges if asked for.
contact::QueryAnswer query(const field::DistanceField& field, const Pose& X_WF, const shell::SphereTree& shell,
                           const shell::EdgeCurves& edges, const Pose& X_WS, contact::QueryRequest request,
                           contact::QueryWorkspace& workspace, contact::ContactManifold& manifold,
                           contact::ShellCertificates* known) noexcept {
    contact::QueryAnswer answer = contact::queryContacts(field, X_WF, shell, X_WS, request, workspace, manifold,
                                                         known != nullptr ? &known->nodes : nullptr);
    if (!request.edges) return answer;
    if (!request.refine) request.search_below = answer.phi;
    merge(contact::searchEdges(field, X_WF, edges, X_WS, request, manifold,
                               known != nullptr ? &known->stretches : nullptr),
          answer);
    return answer;
}

/// The obstacle's points against the held part's field. If the held part moves by u, φ at a fixed point changes by
/// -g · u, g the gradient of its field: told with normal and gradient reversed such a point is a contact like any
/// other.
contact::QueryAnswer queryBack(const HandModel& model, const Obstacle& obstacle, const Pose& X_WO, const Pose& X_WS,
                               const contact::QueryRequest& request, contact::QueryWorkspace& workspace,
                               contact::ContactManifold& manifold, contact::ShellCertificates* known) noexcept {
    const std::size_t first = manifold.size();
    contact::QueryAnswer answer =
        query(*model.held_field, X_WS, *obstacle.shell, *obstacle.edges, X_WO, request, workspace, manifold, known);
    manifold.reverseFrom(first);
    answer.load.force = -answer.load.force;
    answer.load.torque = (X_WO.p - X_WS.p).cross(answer.load.force) - answer.load.torque;
    answer.normal_W = -answer.normal_W;
    return answer;
}

}  // namespace

contact::QueryAnswer queryObstacles(const HandModel& model, const ObstaclePoses& obstacles, const Pose& X_WS,
                                    contact::QueryRequest request, contact::QueryWorkspace& workspace,
                                    contact::ContactManifold& manifold, Lookout& lookout, bool known,
                                    FewOfMany<ObstaclePush>* pushes) noexcept {
    request.mode = model.contact.mode;
    request.max_nodes = model.contact.budget_nodes;
    request.quality = model.contact.quality;
    contact::QueryAnswer all;
    all.phi = all.lower_bound = request.search_below;
    // What refinement finds between the samples must not hide the samples of another obstacle from it.
    const auto narrow = [&] {
        if (!request.refine) request.search_below = all.phi;
    };
    const auto take = [&](const contact::QueryAnswer& answer, std::uint32_t place) {
        merge(answer, all);
        narrow();
        if (pushes == nullptr || (answer.load.force.isZero(0.0) && answer.load.torque.isZero(0.0))) return;
        (*pushes)[place].wrench.force += answer.load.force;
        (*pushes)[place].wrench.torque += answer.load.torque;
    };
    obstacles.place(lookout.near);
    if (known) lookout.known.begin();
    for (const std::uint32_t place :
         lookout.near.within(X_WS, lookReach(std::max(request.collect_below, request.search_below)))) {
        const Obstacle& obstacle = model.obstacles[place];
        const std::size_t first = manifold.size();
        const Pose& X_WO = obstacles.X_WO[place];
        PairCertificates* const pair = known ? lookout.known.of(model, place) : nullptr;
        take(query(*obstacle.field, X_WO, *model.shell, *model.edges, X_WS, request, workspace, manifold,
                   pair != nullptr ? &pair->held : nullptr),
             place);
        if (obstacle.shell != nullptr)
            take(queryBack(model, obstacle, X_WO, X_WS, request, workspace, manifold,
                           pair != nullptr ? &pair->obstacle : nullptr),
                 place);
        manifold.assign(first, place);
    }
    return all;
}

bool overlapsObstacle(const HandModel& model, std::uint32_t i, const Pose& X_WO, const Pose& X_WS, double accepted,
                      QueryMemory& memory, Report& report) noexcept {
    const Obstacle& obstacle = model.obstacles[i];
    const contact::QueryRequest request{.collect_below = -1e300,
                                        .search_below = -accepted,
                                        .mode = model.contact.mode,
                                        .facing = model.contact.two_way,
                                        .edges = true};
    memory.scratch.clear();
    contact::QueryAnswer answer = query(*obstacle.field, X_WO, *model.shell, *model.edges, X_WS, request,
                                        memory.workspace, memory.scratch, nullptr);
    if (obstacle.shell != nullptr)
        merge(queryBack(model, obstacle, X_WO, X_WS, request, memory.workspace, memory.scratch, nullptr), answer);
    account(answer, report);
    return answer.found;
}

std::uint32_t workOf(const contact::QueryAnswer& answer) noexcept {
    return static_cast<std::uint32_t>(answer.nodes_visited + answer.points_tested + answer.points_spared +
                                      2 * answer.contacts);
}

void account(const contact::QueryAnswer& answer, Report& report) noexcept {
    report.nodes_visited += static_cast<std::uint32_t>(answer.nodes_visited);
    report.work += workOf(answer);
    report.quality = std::min(report.quality, answer.quality);
    if (answer.budget_reached) report.status |= kBudgetReached;
    if (answer.manifold_full) report.status |= kContactCap;
}

}  // namespace passung::tick
