#include "study/design/design.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "study/design/balance.h"
#include "study/design/permutations.h"
#include "study/design/trial_order.h"
#include "study/design/williams.h"

namespace passung::design {
namespace {

using Row = std::vector<std::size_t>;

/// Every combination of levels, the first factor slowest.
Design crossed(std::vector<FactorPlan> factors, std::vector<BlockPlan> blocks) {
    Design design;
    design.conditions.push_back({});
    for (const FactorPlan& factor : factors) {
        std::vector<ConditionPlan> longer;
        for (const ConditionPlan& condition : design.conditions)
            for (std::size_t level = 0; level < factor.levels; ++level) {
                longer.push_back(condition);
                longer.back().levels.push_back(level);
            }
        design.conditions = std::move(longer);
    }
    design.factors = std::move(factors);
    design.blocks = std::move(blocks);
    return design;
}

BlockPlan block(Order order, int repetitions = 1) { return {"main", "main", repetitions, order, 0}; }

BlockPlan blockedBy(std::size_t factor, Order order) {
    BlockPlan plan = block(order);
    plan.blocked = factor;
    return plan;
}

Row conditionsOf(const Design& design, std::size_t slot, std::size_t group = 0) {
    Row row;
    const auto trials = *planSession(design, {"demo", 42, "P001", slot, group});
    for (const auto& trial : trials) row.push_back(trial.condition);
    return row;
}

TEST(Permutations, AreAllOrdersInLexicographicOrder) {
    // Truth: closed form: written out for n = 3; for n to 5 ascending, different and n! of them.
    const std::vector<Row> three{{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (std::size_t row = 0; row < 6; ++row) EXPECT_EQ(permutation(3, row), three[row]);
    for (std::size_t n = 1; n <= 5; ++n)
        for (std::size_t row = 1; row < permutationCount(n); ++row)
            EXPECT_LT(permutation(n, row - 1), permutation(n, row));
    EXPECT_EQ(permutationCount(5), 120u);
}

TEST(Permutations, OfFourHaveEveryPairOfNeighboursSixTimes) {
    // Truth: closed form: 24 orders of 3 neighbours over 12 ordered pairs.
    Square rows;
    for (std::size_t row = 0; row < 24; ++row) rows.push_back(permutation(4, row));
    EXPECT_EQ(balanceOf(rows).neighbours.low, 6);
    EXPECT_EQ(balanceOf(rows).neighbours.high, 6);
}

TEST(Design, TakesTheRowsOfNestedSquaresByMixedRadix) {
    // Truth: independent program (integer arithmetic in Python 3.11: outer = slot mod 2, inner = (slot div 2) mod 6).
    const auto design = crossed({{"device", FactorKind::Within, 2}, {"method", FactorKind::Within, 3}},
                                {blockedBy(0, Order::Williams)});
    EXPECT_EQ(sequencesOf(design), 12u);
    EXPECT_EQ(conditionsOf(design, 0), (Row{5, 3, 4, 2, 0, 1}));
    EXPECT_EQ(conditionsOf(design, 1), (Row{2, 0, 1, 5, 3, 4}));
    EXPECT_EQ(conditionsOf(design, 5), (Row{1, 2, 0, 4, 5, 3}));
    EXPECT_EQ(conditionsOf(design, 11), (Row{0, 2, 1, 3, 5, 4}));
}

TEST(Design, NestedSquaresAreNotConfounded) {
    // Truth: invariant: over all slots every outer row meets every inner row once, whatever divides their numbers.
    for (const std::size_t outer : {2u, 3u, 4u})
        for (const std::size_t inner : {2u, 3u, 4u, 6u}) {
            const auto design = crossed({{"device", FactorKind::Within, outer}, {"method", FactorKind::Within, inner}},
                                        {blockedBy(0, Order::Williams)});
            const auto balancings = counterbalancingFactorsOf(design);
            std::set<std::pair<std::size_t, std::size_t>> pairs;
            for (std::size_t slot = 0; slot < sequencesOf(design); ++slot)
                pairs.insert({rowOf(balancings, 0, slot), rowOf(balancings, 1, slot)});
            EXPECT_EQ(pairs.size(), williamsRows(outer) * williamsRows(inner)) << outer << ' ' << inner;
            EXPECT_EQ(pairs.size(), sequencesOf(design));
        }
}

TEST(Design, RunsABlockedFactorsLevelsOneAfterTheOther) {
    // Truth: invariant: all repetitions of a level stand together.
    auto design =
        crossed({{"device", FactorKind::Within, 3}, {"method", FactorKind::Within, 2}}, {blockedBy(0, Order::Random)});
    design.blocks[0].repetitions = 2;
    const auto row = conditionsOf(design, 3);
    ASSERT_EQ(row.size(), 12u);
    for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(row[i] / 2, row[i / 4 * 4] / 2) << i;
}

TEST(Design, AssignsNuisanceLevelsByASquareOfTheirOwn) {
    // Truth: independent program (integer arithmetic in Python 3.11) for four slots.
    const auto design =
        crossed({{"method", FactorKind::Within, 3}, {"pegs", FactorKind::Nuisance, 3}}, {block(Order::Williams)});
    EXPECT_EQ(sequencesOf(design), 18u);
    EXPECT_EQ(conditionsOf(design, 0), (Row{8, 0, 4}));
    EXPECT_EQ(conditionsOf(design, 1), (Row{0, 4, 8}));
    EXPECT_EQ(conditionsOf(design, 6), (Row{6, 1, 5}));
    EXPECT_EQ(conditionsOf(design, 17), (Row{2, 7, 3}));
}

TEST(Design, GivesEveryAssignmentEquallyOftenInEveryPosition) {
    // Truth: invariant: over all slots each of 9 pairs stands in each of 3 positions 18 / 3 / 3 = 2 times.
    const auto design =
        crossed({{"method", FactorKind::Within, 3}, {"pegs", FactorKind::Nuisance, 3}}, {block(Order::Williams)});
    std::map<std::pair<std::size_t, std::size_t>, int> counts;
    for (std::size_t slot = 0; slot < sequencesOf(design); ++slot) {
        const auto row = conditionsOf(design, slot);
        ASSERT_EQ(row.size(), 3u);
        for (std::size_t i = 0; i < 3; ++i) ++counts[{row[i], i}];
    }
    EXPECT_EQ(counts.size(), 27u);
    for (const auto& [place, count] : counts) EXPECT_EQ(count, 2);
}

TEST(Design, ShowsAGroupItsLevelsOnly) {
    // Truth: closed form: condition = 3 · training + method; group g has training g.
    const auto design =
        crossed({{"training", FactorKind::Between, 2}, {"method", FactorKind::Within, 3}}, {block(Order::Williams)});
    EXPECT_EQ(groupsOf(design), (std::vector<Row>{{0}, {1}}));
    for (std::size_t group = 0; group < 2; ++group)
        for (const std::size_t condition : conditionsOf(design, 4, group)) EXPECT_EQ(condition / 3, group);
}

TEST(Design, ShufflesAllRepetitionsTogether) {
    // Truth: independent program (integer arithmetic in Python 3.11); repetitions counted by hand.
    const auto design = crossed({{"method", FactorKind::Within, 3}}, {block(Order::Shuffled, 2)});
    EXPECT_EQ(conditionsOf(design, 0), (Row{0, 1, 0, 2, 1, 2}));
    const auto trials = *planSession(design, {"demo", 42, "P001"});
    EXPECT_EQ(trials[2].repetition, 2);
    EXPECT_EQ(trials[3].repetition, 1);
}

TEST(Design, PutsCatchTrialsAmongTheOthers) {
    // Truth: independent program (integer arithmetic in Python 3.11, stream "catch").
    auto design = crossed({{"signal", FactorKind::Within, 6}}, {block(Order::Listed)});
    design.conditions[4].catch_trial = design.conditions[5].catch_trial = true;
    design.blocks[0].catches.trials = 2;
    const auto trials = *planSession(design, {"demo", 42, "P001"});
    EXPECT_EQ(conditionsOf(design, 0), (Row{0, 1, 5, 2, 4, 3}));
    for (const auto& trial : trials) EXPECT_EQ(trial.phase, trial.condition >= 4 ? "catch" : "main");
}

TEST(Design, KeepsCatchTrialsInTheirWindow) {
    // Truth: invariant: 30 participants, two catch trials a pass in positions 3 to 5 of 7.
    auto design = crossed({{"signal", FactorKind::Within, 6}}, {block(Order::Random, 2)});
    design.conditions[5].catch_trial = true;
    design.blocks[0].catches = {2, 3, 5};
    for (int number = 0; number < 30; ++number) {
        const std::string code = "P" + std::to_string(number);
        const auto trials = *planSession(design, {"demo", 1, code});
        ASSERT_EQ(trials.size(), 14u);
        int catches = 0;
        for (const auto& trial : trials) {
            if (trial.phase != "catch") continue;
            ++catches;
            const auto position = trial.trial_in_block % 7 + 1;
            EXPECT_TRUE(position >= 3 && position <= 5) << position;
        }
        EXPECT_EQ(catches, 4);
    }
}

TEST(Design, GivesEachSessionItsBlocks) {
    // Truth: closed form: two blocks, one in each session; indices of blocks stay those of the study.
    auto design = crossed({{"method", FactorKind::Within, 2}}, {block(Order::Listed), block(Order::Listed)});
    design.blocks[1].name = "second";
    design.blocks[1].session = 2;
    const auto first = *planSession(design, {"demo", 42, "P001", 0, 0, 1});
    const auto second = *planSession(design, {"demo", 42, "P001", 0, 0, 2});
    ASSERT_EQ(first.size(), 2u);
    ASSERT_EQ(second.size(), 2u);
    EXPECT_EQ(second[0].block, "second");
    EXPECT_EQ(second[0].block_index, 1);
    EXPECT_EQ(second[0].trial_index, 0);
}

TEST(Design, NamesWhatIsImpossible) {
    // Truth: closed form for the numbers; the words are a regression.
    auto six = crossed({{"method", FactorKind::Within, 6}}, {block(Order::Permutations)});
    ASSERT_EQ(problemsOf(six).size(), 1u);
    EXPECT_EQ(problemsOf(six)[0].message, "all orders of 6 conditions are too many; at most 5");
    six.blocks[0] = block(Order::Listed);
    six.blocks[0].constraints = {{Rule::MaxRun, 0, 1}};
    EXPECT_STREQ(problemsOf(six)[0].key, "constraints");
    six.blocks[0].constraints.clear();
    six.blocks[0].catches.trials = 1;
    EXPECT_EQ(problemsOf(six)[0].message, "no level of a factor has catch = true");
    auto uneven =
        crossed({{"training", FactorKind::Between, 2}, {"method", FactorKind::Within, 3}}, {block(Order::Williams)});
    EXPECT_TRUE(problemsOf(uneven).empty());
    uneven.conditions.pop_back();
    EXPECT_EQ(problemsOf(uneven)[0].message, "the groups see different numbers of conditions");
}

TEST(Balance, CountsWhatTakesTurns) {
    // Truth: closed form: 12 slots show each outer row 6 times, each inner row twice; the first 4 have inner rows
    // 012 and 120 twice each: 12 follows four times, 10 never.
    const auto design = crossed({{"device", FactorKind::Within, 2}, {"method", FactorKind::Within, 3}},
                                {blockedBy(0, Order::Williams)});
    std::vector<std::size_t> slots(12);
    std::iota(slots.begin(), slots.end(), std::size_t{0});
    EXPECT_EQ(balanceLines(design, slots),
              (std::vector<std::string>{
                  "levels of device, Williams square of 2 (2 rows): position counts 6, neighbour counts 6",
                  "conditions within device, Williams square of 3 (6 rows): position counts 4, neighbour counts 4"}));
    slots.resize(4);
    EXPECT_EQ(balanceLines(design, slots)[1],
              "conditions within device, Williams square of 3 (6 rows): position counts 0-2, neighbour counts 0-4, not "
              "balanced");
}

}  // namespace
}  // namespace passung::design
