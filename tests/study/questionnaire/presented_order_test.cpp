#include "study/questionnaire/presented_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace passung::questionnaire {
namespace {

/// Three ratings, then four pairs.
Definition ratingsAndPairs(bool shuffled) {
    Definition definition;
    definition.shuffled = shuffled;
    definition.items.resize(7);
    for (std::size_t i = 3; i < 7; ++i) definition.items[i].response.kind = AnswerKind::Pair;
    return definition;
}

TEST(PresentedOrder, IsTheFilesUnlessShuffled) {
    // Truth: closed form
    EXPECT_EQ(presentedOrder(ratingsAndPairs(false), 5), (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6}));
}

TEST(PresentedOrder, OfASeedIsTheSameWithEveryCompiler) {
    // Truth: regression (first run; the generator's own golden values are in random_test.cpp)
    EXPECT_EQ(presentedOrder(ratingsAndPairs(true), 1), (std::vector<std::size_t>{2, 0, 1, 6, 4, 5, 3}));
}

TEST(PresentedOrder, ShowsEveryItemOnceAndRatingsBeforePairs) {
    // Truth: invariant
    std::map<std::vector<std::size_t>, int> seen;
    for (std::uint64_t seed = 0; seed < 600; ++seed) {
        auto order = presentedOrder(ratingsAndPairs(true), seed);
        ++seen[std::vector<std::size_t>(order.begin(), order.begin() + 3)];
        EXPECT_LT(*std::max_element(order.begin(), order.begin() + 3), 3u);
        std::sort(order.begin(), order.end());
        EXPECT_EQ(order, presentedOrder(ratingsAndPairs(false), 0));
    }
    EXPECT_EQ(seen.size(), 6u) << "every order of the three ratings";
}

}  // namespace
}  // namespace passung::questionnaire
