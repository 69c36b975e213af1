#include "study/plan/study_plan.h"

#include <algorithm>

namespace passung::plan {

const char* phaseName(Phase phase) { return phase == Phase::Practice ? "practice" : "main"; }

const char* factorKindName(FactorKind kind) {
    switch (kind) {
        case FactorKind::Within:
            return "within";
        case FactorKind::Between:
            return "between";
        case FactorKind::Nuisance:
            return "nuisance";
    }
    return "";
}

const char* blockOrderName(BlockOrder order) {
    switch (order) {
        case BlockOrder::Williams:
            return "williams";
        case BlockOrder::Permutations:
            return "permutations";
        case BlockOrder::Random:
            return "random";
        case BlockOrder::Shuffled:
            return "shuffled";
        case BlockOrder::Listed:
            return "listed";
    }
    return "";
}

const char* restEndsName(RestEnds ends) {
    switch (ends) {
        case RestEnds::ByTime:
            return "time";
        case RestEnds::ByParticipant:
            return "participant";
        case RestEnds::ByExperimenter:
            return "experimenter";
    }
    return "";
}

const char* shownResultName(ShownResult result) {
    switch (result) {
        case ShownResult::None:
            return "none";
        case ShownResult::Outcome:
            return "outcome";
        case ShownResult::Time:
            return "time";
    }
    return "";
}

const char* momentName(Moment moment) {
    switch (moment) {
        case Moment::SessionStart:
            return "session_start";
        case Moment::BeforeBlock:
            return "before_block";
        case Moment::AfterBlock:
            return "after_block";
        case Moment::AfterTrial:
            return "after_trial";
        case Moment::AfterCondition:
            return "after_condition";
        case Moment::SessionEnd:
            return "session_end";
    }
    return "";
}

design::Design designOf(const StudyPlan& plan) {
    design::Design design;
    for (const Factor& factor : plan.factors)
        design.factors.push_back({factor.name, factor.kind, factor.levels.size()});
    const std::size_t shared = plan.shared_conditions > 0 ? plan.shared_conditions : plan.conditions.size();
    for (std::size_t c = 0; c < shared; ++c) {
        const Condition& condition = plan.conditions[c];
        bool catch_trial = false;
        for (std::size_t f = 0; f < condition.levels.size(); ++f)
            catch_trial = catch_trial || plan.factors[f].levels[condition.levels[f]].catch_trial;
        design.conditions.push_back({condition.levels, catch_trial});
        // Plans made by hand may leave the levels out: each condition is its own then.
        design.conditions.back().levels.resize(plan.factors.size(), design.conditions.size() - 1);
    }
    for (const Block& block : plan.blocks)
        design.blocks.push_back({block.name, block.adaptive ? kAdaptivePhase : phaseName(block.phase),
                                 block.repetitions, block.order, static_cast<std::size_t>(block.trials), block.blocked,
                                 block.blocked_order, block.constraints, block.catches, block.session,
                                 block.first_condition, block.conditions});
    design.allocation_blocks = plan.allocation_blocks;
    return design;
}

std::vector<std::string> groupNames(const StudyPlan& plan) {
    std::vector<std::string> names;
    for (const auto& levels : design::groupsOf(designOf(plan))) {
        std::string name;
        std::size_t next = 0;
        for (const Factor& factor : plan.factors)
            if (factor.kind == FactorKind::Between)
                name += (next > 0 ? "/" : "") + factor.levels[levels[next]].label, ++next;
        names.push_back(name.empty() ? "all" : name);
    }
    return names;
}

int sessionsOf(const StudyPlan& plan) {
    int sessions = 1;
    for (const Block& block : plan.blocks) sessions = std::max(sessions, block.session);
    return sessions;
}

std::size_t plannedConditions(const StudyPlan& plan) {
    return plan.first_variant > 0 ? plan.first_variant : plan.conditions.size();
}

}  // namespace passung::plan
