#include "study/design/constraints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace passung::design {
namespace {

using Row = std::vector<std::size_t>;

/// Item i has class i modulo `classes`.
ItemRule rule(Constraint constraint, std::size_t items, std::size_t classes) {
    ItemRule result{constraint, {}};
    for (std::size_t i = 0; i < items; ++i) result.class_of.push_back(i % classes);
    return result;
}

Pools onePool(const std::vector<std::size_t>& counts) {
    Pools pools(1);
    for (std::size_t item = 0; item < counts.size(); ++item) pools[0].insert(pools[0].end(), counts[item], item);
    return pools;
}

/// Does any order of the pool keep to the rule? By trying all.
bool anyOrder(Pools pools, const ItemRule& rule) {
    std::sort(pools[0].begin(), pools[0].end());
    do {
        if (keepsTo(pools, {rule})) return true;
    } while (std::next_permutation(pools[0].begin(), pools[0].end()));
    return false;
}

Constraint counted(Rule which, std::size_t count) { return {which, std::nullopt, count}; }

TEST(Constraints, MaxRunIsFeasibleByTheFormulaIfAnyOrderExists) {
    // Truth: independent program: all orders of every pool of at most 8 items in 3 classes, tried one by one.
    for (std::size_t a = 1; a <= 5; ++a)
        for (std::size_t b = 0; b <= 2; ++b)
            for (std::size_t c = 0; c <= 1; ++c)
                for (std::size_t r = 1; r <= 3; ++r) {
                    const auto pools = onePool({a, b, c});
                    const auto one = rule(counted(Rule::MaxRun, r), 3, 3);
                    EXPECT_EQ(!infeasible(pools, one), anyOrder(pools, one)) << a << b << c << " run " << r;
                }
}

TEST(Constraints, MinDistanceIsFeasibleByTheFormulaIfAnyOrderExists) {
    // Truth: independent program: all orders of every pool of at most 8 items in 3 classes, tried one by one.
    for (std::size_t a = 1; a <= 3; ++a)
        for (std::size_t b = 0; b <= 3; ++b)
            for (std::size_t c = 0; c <= 2; ++c)
                for (std::size_t d = 1; d <= 4; ++d) {
                    const auto pools = onePool({a, b, c});
                    const auto one = rule(counted(Rule::MinDistance, d), 3, 3);
                    EXPECT_EQ(!infeasible(pools, one), anyOrder(pools, one)) << a << b << c << " distance " << d;
                }
}

TEST(Constraints, FirstAndWindowAreRefusedWhereNothingCanHelp) {
    // Truth: counted by hand: three trials of class 0; positions 2 to 3 are two.
    const auto pools = onePool({3, 2});
    Constraint window{Rule::PositionWindow, std::nullopt, 1, 0, 2, 3};
    EXPECT_TRUE(infeasible(pools, rule(window, 2, 2)));
    window.to = 4;
    EXPECT_FALSE(infeasible(pools, rule(window, 2, 2)));
    EXPECT_FALSE(infeasible(pools, rule({Rule::FirstNot, std::nullopt, 1, 0}, 2, 2)));
    EXPECT_TRUE(infeasible(onePool({3}), rule({Rule::FirstNot, std::nullopt, 1, 0}, 1, 1)));
}

TEST(Constraints, FoundOrdersKeepToAllRulesAndToTheirPools) {
    // Truth: invariant: 200 seeds; three passes of six, no condition twice in a row, at most two of a class together.
    const Pools pools(3, Row{0, 1, 2, 3, 4, 5});
    Constraint window{Rule::PositionWindow, std::nullopt, 1, 4, 2, 17};
    const std::vector<ItemRule> rules{rule(counted(Rule::MaxRun, 1), 6, 6), rule(counted(Rule::MaxRun, 2), 6, 2),
                                      rule({Rule::FirstNot, std::nullopt, 1, 2}, 6, 6), rule(window, 6, 6)};
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        Random random(seed);
        const auto order = constrainedOrder(pools, rules, random);
        ASSERT_TRUE(order) << seed;
        EXPECT_TRUE(keepsTo(order->pools, rules));
        ASSERT_EQ(order->pools.size(), 3u);
        for (Row pool : order->pools) {
            std::sort(pool.begin(), pool.end());
            EXPECT_EQ(pool, pools[0]);
        }
    }
}

TEST(Constraints, EqualSeedsGiveEqualOrders) {
    // Truth: regression (this version, integer arithmetic only: any compiler must give the same).
    Random random(7);
    const auto order = constrainedOrder(onePool({3, 3, 2}), {rule(counted(Rule::MaxRun, 1), 3, 3)}, random);
    ASSERT_TRUE(order);
    EXPECT_EQ(order->pools[0], (Row{0, 1, 2, 1, 2, 0, 1, 0}));
}

TEST(Constraints, TightOrdersAreFoundExactly) {
    // Truth: counted by hand: m = r (N - m + 1) leaves one pattern: 0 0 1 0 0 1 0 0 1 0 0.
    const auto pools = onePool({8, 3});
    const auto tight = rule(counted(Rule::MaxRun, 2), 2, 2);
    ASSERT_FALSE(infeasible(pools, tight));
    Random random(1);
    const auto order = constrainedOrder(pools, {tight}, random);
    ASSERT_TRUE(order);
    EXPECT_EQ(order->pools[0], (Row{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}));
}

TEST(Constraints, SaysWhenRulesContradictOneAnother) {
    // Truth: counted by hand: both classes are barred from the first place, each alone could be kept.
    const auto pools = onePool({2, 2});
    const std::vector<ItemRule> rules{rule({Rule::FirstNot, std::nullopt, 1, 0}, 2, 2),
                                      rule({Rule::FirstNot, std::nullopt, 1, 1}, 2, 2)};
    for (const auto& one : rules) EXPECT_FALSE(infeasible(pools, one));
    Random random(1);
    EXPECT_FALSE(constrainedOrder(pools, rules, random));
}

TEST(Constraints, ReportsHowManyShufflesKeepToThem) {
    // Truth: closed form: of the 6 orders of 0 0 1 1, two alternate: 1/3; 5 standard errors of 3000 draws are 0.043.
    Random random(3);
    EXPECT_NEAR(acceptedShare(onePool({2, 2}), {rule(counted(Rule::MaxRun, 1), 2, 2)}, random, 3000), 1.0 / 3.0, 0.043);
}

}  // namespace
}  // namespace passung::design
