#include "study/session/participant_order.h"

namespace passung::session {
namespace {

design::Order orderOf(protocol::BlockOrder order) {
    switch (order) {
        case protocol::BlockOrder::Williams:
            return design::Order::Williams;
        case protocol::BlockOrder::Random:
            return design::Order::Random;
        case protocol::BlockOrder::Listed:
            return design::Order::Listed;
    }
    return design::Order::Listed;
}

}  // namespace

std::vector<design::PlannedTrial> planTrials(const protocol::StudyPlan& plan, std::size_t slot,
                                             std::string_view participant) {
    std::vector<design::BlockPlan> blocks;
    for (const auto& block : plan.blocks)
        blocks.push_back({block.name, protocol::phaseName(block.phase), block.repetitions, orderOf(block.order),
                          static_cast<std::size_t>(block.trials)});
    return design::planSession(plan.conditions.size(), blocks, {plan.name, plan.seed, participant, slot});
}

}  // namespace passung::session
