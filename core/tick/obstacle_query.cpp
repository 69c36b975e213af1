#include "core/tick/obstacle_query.h"

#include <algorithm>

namespace passung::tick {

QueryAnswer queryObstacles(const TickModel& model, const Pose& X_WS, QueryRequest request, QueryWorkspace& workspace,
                           ContactManifold& manifold) noexcept {
    request.mode = model.contact.mode;
    request.max_nodes = model.contact.budget_nodes;
    QueryAnswer all;
    all.phi = all.lower_bound = request.search_below;
    for (const Obstacle& obstacle : model.obstacles) {
        const QueryAnswer answer =
            queryContacts(*obstacle.field, obstacle.X_WF, *model.shell, X_WS, request, workspace, manifold);
        if (answer.found) {
            all.found = true;
            all.phi = request.search_below = answer.phi;
            all.closest_W = answer.closest_W;
            all.normal_W = answer.normal_W;
            all.closest_F = answer.closest_F;
        }
        all.lower_bound = std::min(all.lower_bound, answer.lower_bound);
        all.quality = std::min(all.quality, answer.quality);
        all.nodes_visited += answer.nodes_visited;
        all.points_tested += answer.points_tested;
        all.budget_reached = all.budget_reached || answer.budget_reached;
        all.manifold_full = all.manifold_full || answer.manifold_full;
    }
    return all;
}

void account(const QueryAnswer& answer, TickFrame& frame) noexcept {
    frame.nodes_visited += static_cast<std::uint32_t>(answer.nodes_visited);
    frame.quality = std::min(frame.quality, answer.quality);
    if (answer.budget_reached) frame.status |= kBudgetReached;
    if (answer.manifold_full) frame.status |= kContactCap;
}

}  // namespace passung::tick
