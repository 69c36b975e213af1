#pragma once

#include <string>
#include <vector>

#include "study/design/balance.h"
#include "study/plan/study_plan.h"
#include "study/session/participant_order.h"

namespace passung::presenter {

/// How even the orders of a group's participants are.
struct GroupBalance {
    std::string group;
    std::size_t participants = 0;
    std::vector<design::FactorBalance> balancings;
};

/// How even a design is for those who have these places of it.
struct DesignBalance {
    std::vector<std::string> factors;  // names
    std::vector<GroupBalance> groups;
    std::size_t even_number = 1;  // multiples of it are balanced
    int planned = 0;              // participants
};
DesignBalance designBalance(const plan::StudyPlan& plan, const std::vector<session::DesignPlace>& places);

}  // namespace passung::presenter
