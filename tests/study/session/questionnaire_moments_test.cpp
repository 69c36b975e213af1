#include "study/session/questionnaire_moments.h"

#include <gtest/gtest.h>

#include <span>

namespace passung::session {
namespace {

using plan::Moment;

/// Two practice trials, then two passes of conditions 0, 1 in block "main", then one trial of block "last".
std::vector<design::PlannedTrial> sevenTrials() {
    std::vector<design::PlannedTrial> trials;
    const auto add = [&](std::int64_t block_index, const char* block, const char* phase, std::int64_t in_block,
                         std::size_t condition) {
        trials.push_back({static_cast<std::int64_t>(trials.size()), block_index, block, in_block, phase, condition, 1});
    };
    for (std::int64_t i = 0; i < 2; ++i) add(0, "practice", "practice", i, static_cast<std::size_t>(i));
    for (std::int64_t i = 0; i < 4; ++i) add(1, "main", "main", i, static_cast<std::size_t>(i % 2));
    add(2, "last", "main", 0, 0);
    return trials;
}

std::vector<Occasion> between(const plan::StudyPlan& plan, const std::vector<design::PlannedTrial>& trials,
                              std::size_t next) {
    return occasionsBetween(plan, next > 0 ? &trials[next - 1] : nullptr, std::span(trials).subspan(next));
}

/// When a questionnaire with this moment and block is asked: "next trial: block/trial/condition", - for nothing.
std::vector<std::string> askedAt(Moment moment, const std::string& block = "") {
    plan::StudyPlan plan;
    plan.questionnaires.emplace_back();
    plan.questionnaires[0].moment = moment;
    plan.questionnaires[0].block = block;
    const auto trials = sevenTrials();
    std::vector<std::string> asked;
    const auto text = [](const auto& number) { return number ? std::to_string(*number) : std::string("-"); };
    for (std::size_t next = 0; next <= trials.size(); ++next)
        for (const Occasion& occasion : between(plan, trials, next))
            asked.push_back(std::to_string(next) + ": " + text(occasion.block_index) + "/" +
                            text(occasion.trial_index) + "/" + text(occasion.condition));
    return asked;
}

using Asked = std::vector<std::string>;

TEST(QuestionnaireMoments, ComeWhereTheirNamesSay) {
    // Truth: closed form (counted by hand from sevenTrials)
    EXPECT_EQ(askedAt(Moment::SessionStart), (Asked{"0: -/-/-"}));
    EXPECT_EQ(askedAt(Moment::SessionEnd), (Asked{"7: -/-/-"}));
    EXPECT_EQ(askedAt(Moment::BeforeBlock), (Asked{"2: 1/-/-", "6: 2/-/-"}));
    EXPECT_EQ(askedAt(Moment::AfterBlock), (Asked{"6: 1/-/-", "7: 2/-/-"}));
    EXPECT_EQ(askedAt(Moment::AfterTrial), (Asked{"3: 1/2/0", "4: 1/3/1", "5: 1/4/0", "6: 1/5/1", "7: 2/6/0"}));
    EXPECT_EQ(askedAt(Moment::AfterCondition), (Asked{"5: 1/-/0", "6: 1/-/1", "7: 2/-/0"}))
        << "after the last of a condition's trials in the block";
}

TEST(QuestionnaireMoments, OfOneBlockComeThereOnlyPracticeIncluded) {
    // Truth: closed form
    EXPECT_EQ(askedAt(Moment::AfterBlock, "practice"), (Asked{"2: 0/-/-"}));
    EXPECT_EQ(askedAt(Moment::BeforeBlock, "last"), (Asked{"6: 2/-/-"}));
    EXPECT_EQ(askedAt(Moment::AfterTrial, "last"), (Asked{"7: 2/6/0"}));
}

TEST(QuestionnaireMoments, WhatEndsComesBeforeWhatBegins) {
    // Truth: invariant: what is over is asked about before anything new, however the plan lists it.
    plan::StudyPlan plan;
    for (const Moment moment : {Moment::BeforeBlock, Moment::AfterBlock, Moment::AfterCondition, Moment::AfterTrial}) {
        plan.questionnaires.emplace_back();
        plan.questionnaires.back().moment = moment;
    }
    std::vector<std::size_t> order;
    for (const Occasion& occasion : between(plan, sevenTrials(), 6)) order.push_back(occasion.questionnaire);
    EXPECT_EQ(order, (std::vector<std::size_t>{3, 2, 1, 0}));
}

TEST(QuestionnaireMoments, ATrialThatIsToBeRepeatedKeepsItsConditionAndBlockOpen) {
    // Truth: closed form: trial 2 of block "main" was repeated after 5, so the block ends with it, its condition too.
    plan::StudyPlan plan;
    for (const Moment moment :
         {Moment::AfterCondition, Moment::AfterBlock, Moment::SessionStart, Moment::BeforeBlock}) {
        plan.questionnaires.emplace_back();
        plan.questionnaires.back().moment = moment;
    }
    const auto trials = sevenTrials();
    const std::vector<design::PlannedTrial> repeated = {trials[2], trials[6]}, rest = {trials[6]};
    const auto count = [&](const design::PlannedTrial* before, const std::vector<design::PlannedTrial>& to_do) {
        return occasionsBetween(plan, before, to_do).size();
    };
    EXPECT_EQ(count(&trials[5], repeated), 1u) << "condition 1 only";
    EXPECT_EQ(count(&trials[2], rest), 3u) << "condition 0, the block, and before the next";
    EXPECT_EQ(count(nullptr, {trials[3], trials[4]}), 0u) << "a session that goes on in the middle of a block";
}

TEST(QuestionnaireMoments, AFormIsAboutTheTrialsOfItsOccasion) {
    // Truth: closed form
    plan::StudyPlan plan;
    plan.questionnaires.resize(1);
    const auto count = [&](Moment moment, const Occasion& occasion) {
        plan.questionnaires[0].moment = moment;
        int about = 0;
        for (const auto& trial : sevenTrials()) about += isAbout(plan, occasion, trial) ? 1 : 0;
        return about;
    };
    EXPECT_EQ(count(Moment::SessionEnd, {}), 7);
    EXPECT_EQ(count(Moment::AfterBlock, {0, 1, {}, {}}), 4);
    EXPECT_EQ(count(Moment::AfterCondition, {0, 1, {}, 0}), 2);
    EXPECT_EQ(count(Moment::AfterTrial, {0, 1, 3, 1}), 1);
    EXPECT_EQ(count(Moment::BeforeBlock, {0, 1, {}, {}}), 0);
}

}  // namespace
}  // namespace passung::session
