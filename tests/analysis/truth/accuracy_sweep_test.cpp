#include "analysis/truth/accuracy_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/truth/accuracy_picture.h"
#include "analysis/truth/accuracy_tables.h"
#include "tests/support/named_part.h"

namespace passung::truth {
namespace {

SettingCost rowAt(double time, double depth, double force) {
    SettingCost row;
    row.time = {time, time, time, time};
    row.depth = {depth, depth, depth, depth};
    row.force = {force, force, force, force};
    return row;
}

TEST(AccuracyFront, HoldsExactlyTheRowsThatNoOtherBeatsInBoth) {
    // Truth: closed form. By hand: depth: (1, 9), (2, 5), (4, 1) are on the front; (3, 6) is beaten by (2, 5), (4,
    // 2) by (4, 1). Force has its own front; a row without a force is on none.
    std::vector<SettingCost> rows{rowAt(3, 6, 1), rowAt(1, 9, 8), rowAt(4, 2, 0.5), rowAt(2, 5, Spread::kNone),
                                  rowAt(4, 1, 0.7)};
    markFronts(rows);
    const std::vector<bool> depth{false, true, false, true, true}, force{true, true, true, false, false};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i].on_depth_front, depth[i]) << i;
        EXPECT_EQ(rows[i].on_force_front, force[i]) << i;
    }
}

/// A ball that is pressed into a cube by three depths, and once apart.
class BallOnCube : public ::testing::Test {
protected:
    const scene::PartSpec cube_ = test::namedPart("cube", shape::Box{0.04, 0.04, 0.04}),
                          ball_ = test::namedPart("ball", shape::Sphere{0.02});
    const AccuracySpace space_{.tolerances = {50e-6}, .spacings = {1e-3, 0.5e-3}, .budgets = {0, 30}, .repetitions = 1};

    std::vector<JudgedPose> poses() const {
        std::vector<Pose> poses;
        for (const double distance : {-1e-3, -0.5e-3, -0.2e-3, 1e-3})
            poses.push_back({rotationFromVector({0.3, 0.5, -0.2}), Vec3(0.001, 0.002, 0.03 + distance)});
        return judgePoses(*PairTruth::build(cube_, ball_), poses, [](double) {});
    }
    Result<AccuracyResult> sweep(const std::vector<JudgedPose>& poses) const {
        return sweepAccuracy(cube_, ball_, space_, poses, {}, 0.01, [](const std::string&, double) {});
    }
};

TEST_F(BallOnCube, ErrsByNoMoreThanTheSpacingAdmitsAndLessWithFinerPoints) {
    // Truth: closed form. A point is at most the cover radius c, about a spacing, from the deepest one, which costs
    // c² / 2r = 50 µm at 1 mm; the field adds its tolerance of 50 µm at most.
    const auto result = sweep(poses());
    ASSERT_TRUE(result);
    ASSERT_EQ(result->rows.size(), 20u);  // 5 modes x 2 spacings x 2 budgets
    EXPECT_TRUE(result->disagreements.empty()) << result->disagreements.front().what;
    EXPECT_EQ(result->compared, 20u * 4u);
    for (const SettingCost& row : result->rows) {
        if (row.setting.budget_nodes > 0) continue;
        // A layer is off by half a cell besides, and cells are at most 1/72 of the cube's side.
        const double layer = row.setting.mode == field::FieldMode::Layered ? 0.5 * 0.04 / 72 : 0.0;
        for (const Spread& error : {row.depth, row.distance})
            EXPECT_LE(error.max, row.setting.spacing * row.setting.spacing / 0.02 + 50e-6 + layer);
        EXPECT_GT(row.time.p99, 0.0);
        EXPECT_GT(row.distance_time.p99, 0.0);
        EXPECT_GT(row.field_bytes, 0.0);
    }
    const auto find = [&](double spacing) {
        return std::find_if(result->rows.begin(), result->rows.end(), [&](const SettingCost& row) {
            return row.setting.mode == field::FieldMode::Trilinear && row.setting.spacing == spacing &&
                   row.setting.budget_nodes == 0;
        });
    };
    EXPECT_LT(find(0.5e-3)->force.mean, find(1e-3)->force.mean);
    EXPECT_LT(find(1e-3)->force.max, 0.15);
}

TEST_F(BallOnCube, AsksAsTheTickOfTheContactMethodAsks) {
    // Truth: closed form. The ball's depth is 0.4 mm however it is turned. A tick of penalty contact follows the
    // surface between the points: the field's tolerance is left, and 1 um of steps that end. The god object's tick
    // takes points as they are, 3 mm apart: in some pose the nearest one is 1 mm aside, which costs 1 mm² / 2r = 50 um.
    const auto built = [](const scene::PartSpec& part, const scene::PartNeeds& needs) {
        return std::make_shared<const scene::Part>(*scene::buildPart(part, needs));
    };
    const auto cube = built(cube_, {.field = true, .tolerance = 20e-6});
    const auto ball = built(ball_, {.shell = true, .spacing = 3e-3});
    std::vector<JudgedPose> turned;
    for (int i = 0; i < 10; ++i) {
        turned.push_back({{rotationFromVector({0.3 * i, 0.5, -0.2 * i}), Vec3(0.001, 0.002, 0.03 - 0.4e-3)}, {}});
        turned.back().truth.distance = -0.4e-3;
    }
    const auto errorOf = [&](scene::ContactMethod method) {
        scene::ContactSpec contact;
        contact.method = method;
        return measureSetting({}, contact, cube, ball, turned, {}, 1, 0.01).depth.max;
    };
    EXPECT_LE(errorOf(scene::ContactMethod::Penalty), 20e-6 + 1e-6);
    EXPECT_GT(errorOf(scene::ContactMethod::GodObjectHeuristic), 50e-6);
}

TEST_F(BallOnCube, NamesThePoseWhereAnAnswerContradictsTheTruth) {
    // Truth: invariant. The truth of one pose is moved by 5 mm, more than any bound of contact states.
    std::vector<JudgedPose> wrong = poses();
    wrong[1].truth.distance -= 5e-3;
    const auto result = sweep(wrong);
    ASSERT_TRUE(result);
    ASSERT_EQ(result->disagreements.size(), 20u);
    EXPECT_EQ(result->disagreements.front().X_FS.p, wrong[1].X_FS.p);
    // And said to intersect although they are 1 mm apart.
    wrong = poses();
    wrong[3].truth.relation = Relation::SurfacesIntersect;
    wrong[3].truth.distance = Spread::kNone;
    EXPECT_FALSE(sweep(wrong)->disagreements.empty());
}

TEST_F(BallOnCube, TablesHaveACellForEveryColumnAndThePictureEveryFrontSetting) {
    // Truth: invariant
    const auto judged = poses();
    const auto result = sweep(judged);
    ASSERT_TRUE(result);
    for (const std::string& text : {accuracyCsv(result->rows), posesCsv(judged)}) {
        std::size_t begin = 0;
        const auto commas = [&](std::size_t end) {
            return std::count(text.begin() + static_cast<std::ptrdiff_t>(begin),
                              text.begin() + static_cast<std::ptrdiff_t>(end), ',');
        };
        const auto expected = commas(text.find('\n'));
        for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
            EXPECT_EQ(commas(end), expected);
        EXPECT_EQ(text.find(",,"), std::string::npos);
    }
    const std::string picture = accuracyPicture(result->rows, {"cube <1>", "ball", judged.size(), 3});
    for (const SettingCost& row : result->rows) {
        const bool shown = picture.find(settingText(row.setting) + "<") != std::string::npos;
        EXPECT_EQ(shown, row.on_depth_front || row.on_force_front) << settingText(row.setting);
    }
    EXPECT_EQ(picture.find("<1"), std::string::npos) << "a name must not become markup";
    EXPECT_EQ(picture.find("nan"), std::string::npos);
}

TEST(AccuracyDefaults, SpacingsAreRoundAndAboutAFiftiethOfTheLength) {
    // Truth: closed form. 50 mm / 50 = 1 mm; 0.15 m / 50 = 3 mm, nearer to 2 than to 5 by ratio.
    EXPECT_NEAR(defaultSpacings(0.05)[2], 1e-3, 1e-12);
    EXPECT_NEAR(defaultSpacings(0.15)[2], 2e-3, 1e-12);
    EXPECT_NEAR(defaultSpacings(0.05)[3], 0.5e-3, 1e-12);
}

}  // namespace
}  // namespace passung::truth
