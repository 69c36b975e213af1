#include "analysis/truth/accuracy_pick.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace passung::truth {
namespace {

SettingCost rowAt(double time, double error) {
    SettingCost row;
    row.time.p99 = time;
    row.depth.p99 = error;
    return row;
}

TEST(AccuracyPick, TakesTheSmallestErrorThatFitsAndTheFasterOfEquals) {
    // Truth: closed form. By hand: 2 fits 10 and errs least among those; 3 errs as much but is slower; 4 errs less but
    // takes 11.
    const std::vector<SettingCost> rows{rowAt(1, 90), rowAt(5, 40), rowAt(8, 7), rowAt(9, 7), rowAt(11, 1)};
    EXPECT_EQ(pickFinest(rows, 10.0), 2u);
    EXPECT_EQ(pickFinest(rows, 11.0), 4u);
    EXPECT_EQ(pickFinest(rows, 1.0), 0u);
    EXPECT_EQ(pickFinest(rows, 0.5), std::nullopt);
}

class BallOnCube : public ::testing::Test {
protected:
    BallOnCube() {
        scene_.parts.resize(2);
        scene_.parts[0].name = "cube";
        scene_.parts[0].geometry = shape::Box{0.004, 0.004, 0.004};
        scene_.parts[1].name = "ball";
        scene_.parts[1].geometry = shape::Sphere{0.002};
        scene_.parts[1].held = true;
    }
    Result<std::vector<SettingCost>> measure(const std::vector<double>& budgets) {
        return measureCandidates(
            {{&scene_, {contact_}}}, budgets, [](const std::string&, double) {}, nullptr);
    }
    scene::SceneSpec scene_;
    scene::ContactSpec contact_;
};

TEST_F(BallOnCube, MeasuresEverySpacingForALargeBudgetAndOnlyTheCoarsestForNone) {
    // Truth: invariant. Any query takes less than an hour and more than a picosecond: then no node budget is tried, or
    // every one at the first spacing, where it ends.
    const auto all = measure({3600.0});
    ASSERT_TRUE(all);
    const double coarsest = all->front().setting.spacing;
    EXPECT_EQ(std::count_if(all->begin(), all->end(), [](const auto& row) { return row.setting.budget_nodes > 0; }), 0);
    EXPECT_LT(all->back().setting.spacing, 0.2 * coarsest);
    EXPECT_LT(all->back().force.mean, all->front().force.mean);
    contact_.method = scene::ContactMethod::Penalty;
    const auto first = measure({1e-12});
    ASSERT_TRUE(first);
    for (const SettingCost& row : *first) EXPECT_EQ(row.setting.spacing, coarsest);
    EXPECT_GT(std::count_if(first->begin(), first->end(), [](const auto& row) { return row.setting.budget_nodes > 0; }),
              0);
    EXPECT_EQ(pickFinest(*first, 1e-12), std::nullopt);
    contact_.method = scene::ContactMethod::GodObject;  // its proxy would stop where a query ended early
    const auto whole = measure({1e-12});
    ASSERT_TRUE(whole);
    EXPECT_EQ(std::count_if(whole->begin(), whole->end(), [](const auto& row) { return row.setting.budget_nodes > 0; }),
              0);
}

TEST_F(BallOnCube, TwoWayContactFindsWhatPokesBetweenTheHeldPartsPoints) {
    // Truth: invariant. A rod of 0.1 mm and points about 0.3 mm apart on the held cube, of which hardly any meets it;
    // the rod's own corners do.
    scene_.parts[0].geometry = shape::Box{0.0001, 0.0001, 0.003};
    scene_.parts[1].geometry = shape::Box{0.004, 0.004, 0.004};
    const auto one_way = measure({1e-12});
    contact_.two_way = true;
    const auto two_way = measure({1e-12});
    ASSERT_TRUE(one_way && two_way);
    EXPECT_LT(two_way->front().depth.mean, 0.3 * one_way->front().depth.mean);
    EXPECT_LT(two_way->front().force.mean, one_way->front().force.mean);
}

TEST_F(BallOnCube, CountsTheTimeOfAllObstaclesAndTheErrorOfTheWorst) {
    // Truth: invariant. The cube twice: the same errors, and about twice the time.
    const auto once = measure({1e-12});
    ASSERT_TRUE(once);
    scene_.parts.push_back(scene_.parts[0]);
    scene_.parts.back().name = "another";
    const auto twice = measure({1e-12});
    ASSERT_TRUE(twice);
    ASSERT_EQ(twice->size(), once->size());
    double sum_once = 0.0, sum_twice = 0.0;
    for (std::size_t i = 0; i < once->size(); ++i) {
        EXPECT_EQ((*twice)[i].depth.max, (*once)[i].depth.max);
        sum_once += (*once)[i].time.median;
        sum_twice += (*twice)[i].time.median;
    }
    EXPECT_GT(sum_twice, 1.3 * sum_once);
}

}  // namespace
}  // namespace passung::truth
