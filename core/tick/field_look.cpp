#include "core/tick/field_look.h"

#include <algorithm>

#include "core/tick/obstacle_query.h"

namespace passung::tick {

namespace {

/// The held part's points and edges in an obstacle's field, or in two-way contact the other way round.
struct Way {
    const field::DistanceField& field;
    const Pose& X_WF;
    const shell::SphereTree& shell;
    const shell::EdgeCurves& edges;
    const Pose& X_WS;
    contact::ShellCertificates* known;
};

Way wayOf(const HandModel& model, const ObstaclePoses& obstacles, const FieldLook& look, KnownPairs& known) noexcept {
    const std::uint32_t i = look.near[look.at];
    const Obstacle& obstacle = model.obstacles[i];
    const Pose& X_WO = obstacles.X_WO[i];
    PairCertificates* const pair = look.proves ? nullptr : known.of(model, i);
    if (look.back)
        return {*model.held_field, look.X_WG, *obstacle.shell,
                *obstacle.edges,   X_WO,      pair != nullptr ? &pair->obstacle : nullptr};
    return {*obstacle.field, X_WO, *model.shell, *model.edges, look.X_WG, pair != nullptr ? &pair->held : nullptr};
}

contact::QueryRequest requestOf(const HandModel& model, const FieldLook& look, int left) noexcept {
    return {.collect_below = look.reach,
            .every_below = model.margins.accept,
            .search_below = look.clearance,
            .max_nodes = left,
            .pauses = true,
            .mode = model.contact.mode,
            .prove = look.proves,
            .facing = model.contact.two_way,
            .edges = true};
}

/// After points come their edges, then the other way, then the next obstacle. True: there is none.
bool turnToNext(const HandModel& model, FieldLook& look) noexcept {
    look.along_edges = !look.along_edges;
    if (look.along_edges) return false;
    if (look.back) look.found.reverseFrom(look.first_of_way);
    look.back = !look.back && model.obstacles[look.near[look.at]].shell != nullptr;
    look.first_of_way = look.found.size();
    if (look.back) return false;
    look.found.assign(look.first_of_obstacle, look.near[look.at]);
    look.first_of_obstacle = look.first_of_way;
    return ++look.at == look.near_count;
}

void startRound(FieldLook& look, bool proves) noexcept {
    look.proves = proves;
    look.along_edges = look.back = false;
    look.at = 0;
    look.first_of_way = look.first_of_obstacle = 0;
    look.clearance = look.clearance_bound = look.search;
    look.found.clear();
}

}  // namespace

void beginLook(FieldLook& look, const Pose& X_WG, double reach, double search, geometry::NearList& near) noexcept {
    look.open = true;
    look.X_WG = X_WG;
    look.reach = reach;
    look.search = search;
    const auto found = near.within(X_WG, lookReach(std::max(reach, search)));
    std::copy(found.begin(), found.end(), look.near.begin());
    look.near_count = found.size();
    look.workspace.drop();
    look.edges.open = false;
    startRound(look, false);
}

bool goOnLooking(const HandModel& model, const ObstaclePoses& obstacles, FieldLook& look, KnownPairs& known,
                 Report& report) noexcept {
    const int budget = model.contact.budget_nodes;
    int left = budget;
    known.begin();
    for (bool ended = look.near_count == 0; !ended;) {
        const Way way = wayOf(model, obstacles, look, known);
        const contact::QueryRequest request = requestOf(model, look, left);
        const contact::QueryAnswer answer =
            look.along_edges ? contact::searchEdges(way.field, way.X_WF, way.edges, way.X_WS, request, look.found,
                                                    way.known != nullptr ? &way.known->stretches : nullptr, &look.edges)
                             : contact::queryContacts(way.field, way.X_WF, way.shell, way.X_WS, request, look.workspace,
                                                      look.found, way.known != nullptr ? &way.known->nodes : nullptr);
        account(answer, report);
        if (answer.paused) return false;
        look.clearance = std::min(look.clearance, answer.phi);
        look.clearance_bound = std::min(look.clearance_bound, answer.lower_bound);
        left = std::max(1, left - answer.nodes_visited);
        ended = turnToNext(model, look);
        if (ended && !look.proves) {
            look.nearest = look.clearance_bound = look.clearance;
            ended = !(look.nearest > look.reach);
            if (!ended) startRound(look, true);
        }
        if (!look.along_edges) left = budget;
    }
    if (look.near_count == 0) {
        look.nearest = look.clearance_bound = look.clearance;
        look.proves = look.nearest > look.reach;
    }
    if (look.proves) look.clearance_bound = std::max(look.reach, look.clearance_bound);
    look.open = false;
    return true;
}

}  // namespace passung::tick
