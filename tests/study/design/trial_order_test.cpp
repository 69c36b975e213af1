#include "study/design/trial_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "study/design/williams.h"

namespace passung::design {
namespace {

using Row = std::vector<std::size_t>;

Row conditionsOf(const std::vector<PlannedTrial>& trials, std::int64_t block, int repetition) {
    Row row;
    for (const auto& trial : trials)
        if (trial.block_index == block && trial.repetition == repetition) row.push_back(trial.condition);
    return row;
}

/// One within factor with a level for each condition.
std::vector<PlannedTrial> planSession(std::size_t conditions, const std::vector<BlockPlan>& blocks,
                                      const SessionKey& key) {
    Design design;
    design.factors = {{"factor", FactorKind::Within, conditions}};
    for (std::size_t level = 0; level < conditions; ++level) design.conditions.push_back({{level}, false});
    design.blocks = blocks;
    return *design::planSession(design, key);
}

std::vector<BlockPlan> practiceAndMain() {
    return {{"practice", "practice", 1, Order::Random, 2}, {"main", "main", 3, Order::Williams, 0}};
}

TEST(TrialOrder, RelabelsByTheStudysStream) {
    // Truth: independent program (integer arithmetic in Python 3.11 from the definition of the stream).
    EXPECT_EQ(relabelling(4, "demo", "", 42), (Row{1, 2, 0, 3}));
    EXPECT_EQ(relabelling(8, "peg_in_hole", "", 20240501), (Row{2, 7, 4, 1, 3, 5, 6, 0}));
}

TEST(TrialOrder, GivesEachSlotItsRelabelledRow) {
    // Truth: closed form: row of the square 0132 1203 2310 3021, entries replaced by the labels 1 2 0 3.
    const std::vector<BlockPlan> blocks{{"main", "main", 1, Order::Williams, 0}};
    const std::vector<Row> expected{{1, 2, 3, 0}, {2, 0, 1, 3}, {0, 3, 2, 1}, {3, 1, 0, 2}, {1, 2, 3, 0}};
    for (std::size_t slot = 0; slot < expected.size(); ++slot)
        EXPECT_EQ(conditionsOf(planSession(4, blocks, {"demo", 42, "P001", slot}), 0, 1), expected[slot]) << slot;
}

TEST(TrialOrder, ShufflesEveryRepetitionOfARandomBlock) {
    // Truth: independent program (integer arithmetic in Python 3.11 from the definition of the stream).
    const std::vector<BlockPlan> blocks{{"practice", "practice", 3, Order::Random, 0}};
    const auto trials = planSession(4, blocks, {"demo", 42, "P001", 0});
    EXPECT_EQ(conditionsOf(trials, 0, 1), (Row{1, 0, 2, 3}));
    EXPECT_EQ(conditionsOf(trials, 0, 2), (Row{2, 3, 0, 1}));
    EXPECT_EQ(conditionsOf(trials, 0, 3), (Row{3, 2, 0, 1}));
    EXPECT_EQ(conditionsOf(planSession(4, blocks, {"demo", 42, "P002", 0}), 0, 1), (Row{3, 1, 2, 0}));
}

TEST(TrialOrder, ListsAndNumbersEveryTrial) {
    // Truth: closed form: written out by hand.
    const std::vector<BlockPlan> blocks{{"warm_up", "practice", 1, Order::Listed, 1},
                                        {"main", "main", 2, Order::Listed, 2}};
    const std::vector<PlannedTrial> expected{
        {0, 0, "warm_up", 0, "practice", 0, 1}, {1, 1, "main", 0, "main", 0, 1}, {2, 1, "main", 1, "main", 1, 1},
        {3, 1, "main", 2, "main", 0, 2},        {4, 1, "main", 3, "main", 1, 2},
    };
    EXPECT_EQ(planSession(3, blocks, {"demo", 42, "P001", 0}), expected);
}

TEST(TrialOrder, NobodyGetsAnOrderTwiceBeforeAllRowsAreUsed) {
    // Truth: invariant, by counting: the passes of one person are all different, and in each pass the people of one
    // turn of the square are balanced: every position once (odd n: twice), every neighbour once (twice).
    for (const std::size_t n : {2u, 3u, 4u, 5u, 6u, 7u, 8u, 12u}) {
        const std::size_t rows = williamsRows(n);
        const auto passes = static_cast<int>(std::min<std::size_t>(rows, 12));
        std::vector<Square> by_pass(static_cast<std::size_t>(passes));
        for (std::size_t slot = 0; slot < rows; ++slot) {
            const auto trials =
                planSession(n, {{"main", "main", passes, Order::Williams, 0}}, {"demo", 1, "P001", slot});
            std::set<Row> orders;
            for (int pass = 1; pass <= passes; ++pass) {
                const Row order = conditionsOf(trials, 0, pass);
                EXPECT_TRUE(orders.insert(order).second) << n << " conditions, slot " << slot << ", pass " << pass;
                by_pass[static_cast<std::size_t>(pass - 1)].push_back(order);
            }
        }
        for (const Square& pass : by_pass) {
            const Balance balance = balanceOf(pass);
            EXPECT_TRUE(balance.positions.even() && balance.neighbours.even()) << n;
        }
    }
}

TEST(TrialOrder, NoConditionFollowsItselfFromOnePassToTheNext) {
    // Truth: invariant; two conditions cannot do without, and an odd square turns over after n passes.
    for (const std::size_t n : {3u, 4u, 5u, 6u, 7u, 8u, 12u})
        for (std::size_t slot = 0; slot < williamsRows(n); ++slot) {
            const auto trials =
                planSession(n, {{"main", "main", static_cast<int>(n), Order::Williams, 0}}, {"demo", 1, "P001", slot});
            for (std::size_t i = 1; i < trials.size(); ++i)
                EXPECT_NE(trials[i].condition, trials[i - 1].condition) << n << " conditions, slot " << slot;
        }
}

TEST(TrialOrder, ABlockHasTheConditionsThatItChooses) {
    // Truth: closed form: listed as chosen; a square of three balances three people twice over.
    BlockPlan listed{"listed", "main", 1, Order::Listed, 0};
    listed.conditions = {4, 1};
    EXPECT_EQ(conditionsOf(planSession(6, {listed}, {"demo", 1, "P001", 0}), 0, 1), (Row{4, 1}));
    BlockPlan three{"three", "main", 1, Order::Williams, 0};
    three.conditions = {5, 0, 2};
    std::set<Row> orders;
    for (std::size_t slot = 0; slot < 6; ++slot) {
        Row order = conditionsOf(planSession(6, {three}, {"demo", 1, "P001", slot}), 0, 1);
        orders.insert(order);
        std::sort(order.begin(), order.end());
        EXPECT_EQ(order, (Row{0, 2, 5}));
    }
    EXPECT_EQ(orders.size(), 6u);
    three.first_condition = 100;  // its own ones
    for (const auto& trial : planSession(6, {three}, {"demo", 1, "P001", 0})) {
        EXPECT_GE(trial.condition, 100u);
        EXPECT_LT(trial.condition, 103u);
    }
}

TEST(TrialOrder, TakesTheFirstTrialsOfAShortenedPass) {
    // Truth: invariant: `trials` cuts a pass, it does not change its order.
    auto blocks = practiceAndMain();
    const auto cut = planSession(6, blocks, {"demo", 9, "P001", 4});
    blocks[0].trials = 0;
    const auto whole = planSession(6, blocks, {"demo", 9, "P001", 4});
    const auto row = conditionsOf(whole, 0, 1);
    EXPECT_EQ(conditionsOf(cut, 0, 1), (Row{row[0], row[1]}));
}

TEST(TrialOrder, OneBlocksDrawsDoNotMoveAnothers) {
    // Truth: invariant: streams are named by block.
    std::vector<BlockPlan> blocks{{"first", "main", 1, Order::Random, 0}, {"second", "main", 2, Order::Random, 0}};
    const SessionKey key{"demo", 5, "P010", 0};
    const auto before = conditionsOf(planSession(7, blocks, key), 1, 2);
    blocks[0].repetitions = 4;
    EXPECT_EQ(conditionsOf(planSession(7, blocks, key), 1, 2), before);
    blocks.erase(blocks.begin());
    EXPECT_EQ(conditionsOf(planSession(7, blocks, key), 0, 2), before);
}

TEST(TrialOrder, RelabellingKeepsTheBalance) {
    // Truth: invariant: a permutation of the names cannot change counts.
    const std::vector<BlockPlan> blocks{{"main", "main", 1, Order::Williams, 0}};
    for (std::size_t n = 2; n <= 10; ++n)
        for (std::uint64_t seed : {0u, 1u, 99u}) {
            Square orders;
            for (std::size_t slot = 0; slot < williamsRows(n); ++slot)
                orders.push_back(conditionsOf(planSession(n, blocks, {"demo", seed, "P001", slot}), 0, 1));
            const auto balance = balanceOf(orders);
            EXPECT_TRUE(balance.positions.even() && balance.neighbours.even()) << n << " conditions, seed " << seed;
        }
}

TEST(TrialOrder, DependsOnTheSeed) {
    // Truth: invariant: of 40 seeds, the chance that all relabel 8 conditions alike is nil.
    int different = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed)
        different += relabelling(8, "demo", "", seed) != relabelling(8, "demo", "", 0);
    EXPECT_GE(different, 38);
}

}  // namespace
}  // namespace passung::design
