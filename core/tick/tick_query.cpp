#include "core/tick/tick_query.h"

#include <algorithm>
#include <limits>

#include "core/tick/obstacle_query.h"
#include "core/tick/penalty.h"
#include "core/tick/proxy.h"
#include "core/tick/tick_model.h"
#include "core/tick/tick_state.h"

namespace passung::tick {

TickQuery::TickQuery(const scene::Scene& scene, double area_stiffness) : models_(scene) {
    states_.push_back(makeState(models_[0]));
    weighted_.variant = scene::PenaltyVariant::AreaWeighted;
    weighted_.area_stiffness = area_stiffness;
    weighted_.two_way = scene.spec.contact.two_way;
}

TickQuery::~TickQuery() = default;

QueryReading TickQuery::at(const Pose& X_WS) noexcept {
    const HandModel& model = models_[0].hands.front();
    HandState& state = states_[0].hands.front();
    TickFrame frame;
    frame.X_WH = X_WS;
    if (!model.contact.rendersAtHand()) {
        surveyContacts({model, state, state, frame, state}, X_WS);
        return {std::max(0.0, -state.clearance), penaltyWrench(weighted_, state.manifold, X_WS.p)};
    }
    runStage<kContactsAtHand>(model, state, frame);
    const bool summed = model.contact.variant == scene::PenaltyVariant::AreaWeighted;
    return {frame.hand_depth,
            summed ? weightedWrench(weighted_, frame.load) : penaltyWrench(weighted_, state.manifold, X_WS.p)};
}

double TickQuery::distanceAt(const Pose& X_WS) noexcept {
    const HandModel& model = models_[0].hands.front();
    HandState& state = states_[0].hands.front();
    contact::QueryRequest request = penaltyRequest(model.contact.variant);
    request.search_below = std::numeric_limits<double>::infinity();
    state.scratch.clear();
    return queryObstacles(model, state, X_WS, request, state.workspace, state.scratch, state.around_hand).phi;
}

}  // namespace passung::tick
