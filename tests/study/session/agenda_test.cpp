#include "study/session/agenda.h"

#include <gtest/gtest.h>

namespace passung::session {
namespace {

/// Blocks of `sizes` trials.
std::vector<design::PlannedTrial> plan(std::vector<std::size_t> sizes) {
    std::vector<design::PlannedTrial> trials;
    for (std::size_t block = 0; block < sizes.size(); ++block) {
        for (std::size_t i = 0; i < sizes[block]; ++i) {
            design::PlannedTrial trial;
            trial.trial_index = static_cast<std::int64_t>(trials.size());
            trial.block_index = static_cast<std::int64_t>(block);
            trials.push_back(trial);
        }
    }
    return trials;
}

/// Ends all trials that are left and says in which order they came.
std::vector<std::size_t> rest(Agenda agenda) {
    std::vector<std::size_t> order;
    for (; !agenda.empty(); agenda.end(Then::Done)) order.push_back(agenda.next());
    return order;
}

using Order = std::vector<std::size_t>;

TEST(Agenda, KeepsThePlannedOrder) {
    // Truth: closed form
    EXPECT_EQ(rest(Agenda(plan({2, 2}))), (Order{0, 1, 2, 3}));
}

TEST(Agenda, ARepetitionAtTheEndOfTheBlockComesBeforeTheNextBlock) {
    // Truth: closed form
    Agenda agenda(plan({3, 2}));
    agenda.end(Then::RepeatAtBlockEnd);
    EXPECT_EQ(rest(agenda), (Order{1, 2, 0, 3, 4}));
    EXPECT_EQ(agenda.finished(), 0u) << "what is to be repeated is not over";
    for (int i = 0; i < 2; ++i) agenda.end(Then::Done);
    agenda.end(Then::RepeatAtBlockEnd);
    EXPECT_EQ(rest(agenda), (Order{0, 3, 4})) << "alone it is repeated at once";
    agenda.end(Then::RepeatNow);
    EXPECT_EQ(agenda.next(), 0u);
}

TEST(Agenda, GoesBackTrialByTrialInTheOrderInWhichTheyEnded) {
    // Truth: closed form
    Agenda agenda(plan({3}));
    EXPECT_FALSE(agenda.canGoBack());
    agenda.end(Then::RepeatAtBlockEnd);
    agenda.end(Then::Done);
    agenda.end(Then::Done);
    EXPECT_EQ(agenda.last(), 2u);
    agenda.bring(agenda.last());
    EXPECT_EQ(rest(agenda), (Order{2, 0}));
    agenda.bring(agenda.last());
    EXPECT_EQ(rest(agenda), (Order{1, 2, 0}));
    EXPECT_FALSE(agenda.canGoBack());
    EXPECT_EQ(agenda.finished(), 0u);
}

TEST(Agenda, WhatIsNotNeededIsPassedOverAndComesAtItsPlaceWhenItIs) {
    // Truth: closed form
    Agenda agenda(plan({4, 1}));
    const auto leaveOut = [&](std::int64_t index) {
        agenda.leaveOut([&](const design::PlannedTrial& trial) { return trial.trial_index == index; });
    };
    leaveOut(1);
    agenda.end(Then::RepeatAtBlockEnd);
    EXPECT_EQ(rest(agenda), (Order{2, 3, 0, 4}));
    EXPECT_EQ(agenda.remaining().size(), 4u);
    EXPECT_EQ(agenda.finished(), 0u);
    EXPECT_EQ(agenda.leftOut(), 1u);
    leaveOut(-1);
    EXPECT_EQ(rest(agenda), (Order{1, 2, 3, 0, 4}));
    agenda.leaveOut([](const design::PlannedTrial&) { return true; });
    EXPECT_TRUE(agenda.empty());
}

}  // namespace
}  // namespace passung::session
