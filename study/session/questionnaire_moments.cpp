#include "study/session/questionnaire_moments.h"

#include <algorithm>

namespace passung::session {
namespace {

using plan::Moment;
using Trials = std::span<const design::PlannedTrial>;

bool endsBlock(const design::PlannedTrial& trial, Trials to_do) {
    return std::none_of(to_do.begin(), to_do.end(),
                        [&](const design::PlannedTrial& later) { return later.block_index == trial.block_index; });
}

bool endsCondition(const design::PlannedTrial& trial, Trials to_do) {
    return std::none_of(to_do.begin(), to_do.end(), [&](const design::PlannedTrial& later) {
        return later.block_index == trial.block_index && later.condition == trial.condition;
    });
}

bool beginsBlock(const design::PlannedTrial& trial, const design::PlannedTrial* before) {
    return before != nullptr ? before->block_index != trial.block_index : trial.trial_in_block == 0;
}

bool isOfBlock(const plan::PlannedQuestionnaire& planned, const design::PlannedTrial& trial) {
    if (planned.block.empty()) return trial.phase != plan::phaseName(plan::Phase::Practice);
    return planned.block == trial.block;
}

/// After `trial` and what ends with it. Nothing of a moment before, or of another block.
std::optional<Occasion> occasionAfter(const plan::PlannedQuestionnaire& planned, const design::PlannedTrial& trial) {
    if (planned.moment == Moment::SessionEnd) return Occasion{};
    if (!isOfBlock(planned, trial)) return std::nullopt;
    switch (planned.moment) {
        case Moment::AfterTrial:
            return Occasion{0, trial.block_index, trial.trial_index, trial.condition};
        case Moment::AfterCondition:
            return Occasion{0, trial.block_index, {}, trial.condition};
        case Moment::AfterBlock:
            return Occasion{0, trial.block_index, {}, {}};
        case Moment::SessionEnd:
        case Moment::SessionStart:
        case Moment::BeforeBlock:
            break;
    }
    return std::nullopt;
}

/// Nothing if the moment is not now.
std::optional<Occasion> occasionOf(const plan::PlannedQuestionnaire& planned, const design::PlannedTrial* before,
                                   Trials to_do) {
    const design::PlannedTrial* after = to_do.empty() ? nullptr : &to_do.front();
    switch (planned.moment) {
        case Moment::AfterTrial:
            if (before != nullptr) return occasionAfter(planned, *before);
            break;
        case Moment::AfterCondition:
            if (before != nullptr && endsCondition(*before, to_do)) return occasionAfter(planned, *before);
            break;
        case Moment::AfterBlock:
            if (before != nullptr && endsBlock(*before, to_do)) return occasionAfter(planned, *before);
            break;
        case Moment::SessionEnd:
            if (after == nullptr) return Occasion{};
            break;
        case Moment::SessionStart:
            if (before == nullptr && after != nullptr && after->trial_index == 0) return Occasion{};
            break;
        case Moment::BeforeBlock:
            if (after != nullptr && beginsBlock(*after, before) && isOfBlock(planned, *after))
                return Occasion{0, after->block_index, {}, {}};
            break;
    }
    return std::nullopt;
}

}  // namespace

std::vector<Occasion> occasionsBetween(const plan::StudyPlan& plan, const design::PlannedTrial* before, Trials to_do) {
    std::vector<Occasion> due;
    for (const Moment moment : {Moment::AfterTrial, Moment::AfterCondition, Moment::AfterBlock, Moment::SessionEnd,
                                Moment::SessionStart, Moment::BeforeBlock})
        for (std::size_t i = 0; i < plan.questionnaires.size(); ++i) {
            if (plan.questionnaires[i].moment != moment) continue;
            auto occasion = occasionOf(plan.questionnaires[i], before, to_do);
            if (!occasion) continue;
            occasion->questionnaire = i;
            due.push_back(*occasion);
        }
    return due;
}

std::vector<Occasion> occasionsAbout(const plan::StudyPlan& plan, const design::PlannedTrial& trial) {
    std::vector<Occasion> about;
    for (std::size_t i = 0; i < plan.questionnaires.size(); ++i) {
        auto occasion = occasionAfter(plan.questionnaires[i], trial);
        if (!occasion) continue;
        occasion->questionnaire = i;
        about.push_back(*occasion);
    }
    return about;
}

bool isAbout(const plan::StudyPlan& plan, const Occasion& occasion, const design::PlannedTrial& trial) {
    if (plan.questionnaires[occasion.questionnaire].moment == Moment::BeforeBlock) return false;
    return (!occasion.block_index || *occasion.block_index == trial.block_index) &&
           (!occasion.trial_index || *occasion.trial_index == trial.trial_index) &&
           (!occasion.condition || *occasion.condition == trial.condition);
}

}  // namespace passung::session
