#include "ui/presenter/design_balance.h"

namespace passung::presenter {

DesignBalance designBalance(const plan::StudyPlan& plan, const std::vector<session::DesignPlace>& places) {
    const auto design = plan::designOf(plan);
    DesignBalance balance{{}, {}, design::evenNumber(design), plan.participants};
    for (const auto& factor : plan.factors) balance.factors.push_back(factor.name);
    const auto groups = plan::groupNames(plan);
    for (std::size_t group = 0; group < groups.size(); ++group) {
        std::vector<std::size_t> slots;
        for (const session::DesignPlace& place : places)
            if (place.group == group) slots.push_back(place.slot);
        balance.groups.push_back({groups[group], slots.size(), design::balancesOf(design, slots)});
    }
    return balance;
}

}  // namespace passung::presenter
