#include "study/run/machine/tick_front.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/scene/contact_geometry.h"
#include "study/run/files/protocol_files.h"
#include "tests/support/temp_folder.h"
#include "tests/ui/cli/small_study.h"

namespace passung::run {
namespace {

plan::StudyPlan smallPlan() {
    const test::TempFolder folder;
    std::ofstream(folder / "study.toml") << test::fairStudy();
    auto plan = readProtocol(folder / "study.toml");
    if (!plan) throw std::runtime_error(toString(plan.errors().front()));
    return *std::move(plan);
}

TEST(HandPath, IsTheSameWayIntoTheBoreEachTime) {
    // Truth: closed form: a trial ends in success at nine tenths of 6 mm, 6 mm below the plate's mouth at most, where
    // the hand may press a little farther; it begins at the start pose, within the start gate.
    const plan::StudyPlan plan = smallPlan();
    scene::PartCache parts;
    const auto path = handPath(plan.conditions[1], parts, [](double) {});
    ASSERT_TRUE(path) << toString(path.errors().front());
    EXPECT_EQ(path->origin, HandPath::Origin::SimulatedHand);
    const Vec3 start(4e-3, 0.0, 8e-3);
    EXPECT_LT((path->X_WH.front().p - start).norm(), 5e-3);
    EXPECT_LT(path->X_WH.back().p.z(), -0.9 * 6e-3 + 1e-3);
    EXPECT_GT(path->X_WH.back().p.z(), -12e-3);
    for (std::size_t i = 1; i < path->X_WH.size(); ++i)
        EXPECT_LT((path->X_WH[i].p - path->X_WH[i - 1].p).norm(), 1e-3) << "faster than 1 m/s at " << i;
    const auto again = handPath(plan.conditions[1], parts, [](double) {});
    ASSERT_TRUE(again && again->X_WH.size() == path->X_WH.size());
    for (std::size_t i = 0; i < path->X_WH.size(); ++i) EXPECT_EQ(again->X_WH[i].p, path->X_WH[i].p);
}

TEST(HandPath, PressesWhereTheHandTouchesNothing) {
    // Truth: closed form: a goal 12 mm above the mouth is reached through free space; what lies nearest is below, so
    // that the pressed peg ends below the mouth.
    plan::Condition condition = smallPlan().conditions[1];
    condition.task.form = plan::FreePlacementTask{};
    std::get<plan::FreePlacementTask>(condition.task.form).X_WGoal = Pose{Quat::Identity(), Vec3(4e-3, 0.0, 12e-3)};
    scene::PartCache parts;
    const auto path = handPath(condition, parts, [](double) {});
    ASSERT_TRUE(path) << toString(path.errors().front());
    EXPECT_EQ(path->origin, HandPath::Origin::Pressed);
    EXPECT_LT(path->X_WH.back().p.z(), 0.0);
    condition.timed_by = plan::TimedBy::Experimenter;
    EXPECT_FALSE(handPath(condition, parts, [](double) {})) << "real parts have no contact to measure";
}

TEST(TickFront, MeasuresEverySettingTellsHowFarItIsAndKnowsTheStudysOwn) {
    // Truth: invariant: shares rise from 0 to 1; each setting is told of; one of the rows is what the condition says.
    const plan::StudyPlan plan = smallPlan();
    std::vector<double> shares;
    std::vector<const truth::TickSetting*> told;
    const auto front = measureFront(
        plan.conditions[0], {.repetitions = 1, .every = 200},
        [&](const FrontProgress& progress) {
            shares.push_back(progress.share);
            if (told.empty() || told.back() != progress.setting) told.push_back(progress.setting);
            return true;
        },
        nullptr);
    ASSERT_TRUE(front) << toString(front.errors().front());
    const auto& rows = front->measured.rows;
    EXPECT_EQ(told.size(), rows.size() + 2) << "before the first and after the last there is none";
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.front(), 0.0);
    EXPECT_EQ(shares.back(), 1.0);
    EXPECT_EQ(
        std::count_if(rows.begin(), rows.end(),
                      [&](const auto& row) { return isRenderedBy(plan.conditions[0].scene, *front, row.setting); }),
        1);
    const auto has = [&](scene::Geometry geometry) {
        return std::any_of(rows.begin(), rows.end(), [&](const auto& row) { return row.setting.geometry == geometry; });
    };
    EXPECT_TRUE(has(scene::Geometry::Field) && has(scene::Geometry::ClosedForm) && has(scene::Geometry::Surface));
    EXPECT_FALSE(front->left_out.empty()) << "the penalty has fields only";
}

TEST(TickFront, IsGivenUpWhereverItIsAsked) {
    // Truth: invariant, at each third moment up to the hundredth.
    const plan::StudyPlan plan = smallPlan();
    for (int last = 1; last < 100; last += 33) {
        int asked = 0;
        EXPECT_THROW((void)measureFront(
                         plan.conditions[0], {.repetitions = 1, .every = 200},
                         [&](const FrontProgress&) { return ++asked < last; }, nullptr),
                     MeasuringCancelled);
        EXPECT_EQ(asked, last);
    }
}

}  // namespace
}  // namespace passung::run
