#include "devices/scripted/trajectory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace passung {
namespace {

constexpr const char* kHeader = "t_s,x_m,y_m,z_m,qw,qx,qy,qz\n";

Result<scripted::Trajectory> read(const std::string& rows, const std::string& header = kHeader) {
    const auto path = std::filesystem::temp_directory_path() / ("passung_path_" + std::to_string(getpid()) + ".csv");
    std::ofstream(path) << header << rows;
    return scripted::Trajectory::read(path.string());
}

TEST(Trajectory, InterpolatesLinearlyAndAlongTheGreatCircle) {
    // Truth: closed form. Half way: the middle, and half of a quarter turn about z.
    const auto path = read("0,0,0,0,1,0,0,0\n0.1,0.2,0,-0.4,0.7071067811865476,0,0,0.7071067811865476\n");
    ASSERT_TRUE(path);
    EXPECT_EQ(path->lastTick(), 100);
    const Pose middle = path->at(50);
    EXPECT_LT((middle.p - Vec3(0.1, 0, -0.2)).norm(), 1e-12);
    EXPECT_NEAR(middle.q.z(), std::sin(3.14159265358979 / 8), 1e-9);
    EXPECT_LT((path->at(100).p - Vec3(0.2, 0, -0.4)).norm(), 1e-12);
}

TEST(Trajectory, IsBrokenBetweenRowsOfWhichOneIsNan) {
    // Truth: invariant. The rows themselves are what they say.
    const auto path = read("0,0,0,0,1,0,0,0\n0.010,1,0,0,1,0,0,0\n0.020,nan,0,0,1,0,0,0\n0.030,3,0,0,1,0,0,0\n");
    ASSERT_TRUE(path);
    EXPECT_TRUE(isFinite(path->at(10)));
    for (int tick = 11; tick < 30; ++tick) EXPECT_FALSE(isFinite(path->at(tick))) << tick;
    EXPECT_EQ(path->at(30).p.x(), 3.0);
}

TEST(Trajectory, NamesTheLineOfABadRowAlsoBelowEmptyLines) {
    // Truth: closed form (header, row, two empty lines, the row whose time does not rise).
    const auto path = read("0,0,0,0,1,0,0,0\n\n\n0,0,0,0,1,0,0,0\n");
    ASSERT_FALSE(path);
    EXPECT_EQ(path.errors().front().line, 5);
}

TEST(Trajectory, RefusesTimesThatDoNotRiseAndRotationsThatAreNone) {
    // Truth: invariant.
    EXPECT_FALSE(read("0,0,0,0,1,0,0,0\n0,0,0,0,1,0,0,0\n"));
    EXPECT_FALSE(read("0,0,0,0,1,0,0,0\nnan,0,0,0,1,0,0,0\n"));
    EXPECT_FALSE(read("0,0,0,0,0.5,0,0,0\n"));
    EXPECT_FALSE(read("0,nan,0,0,1,0,0,0\n"));
    EXPECT_TRUE(read("0,0,0,0,1,0,0,0\n"));
}

TEST(Trajectory, PressesTheButtonsOfARowUpToTheNext) {
    // Truth: closed form: as written from a row's own tick on; without the column none; before the first row its own.
    const std::string header = "t_s,x_m,y_m,z_m,qw,qx,qy,qz,note,buttons\n";
    const auto path = read("0.002,0,0,0,1,0,0,0,a,0\n0.3,0,0,0,1,0,0,0,b,5\n0.5,0,0,0,1,0,0,0,c,0\n", header);
    ASSERT_TRUE(path);
    for (int tick = 0; tick < 600; ++tick)
        EXPECT_EQ(path->buttonsAt(tick), tick >= 300 && tick < 500 ? 5u : 0u) << tick;
    EXPECT_EQ(read("0,0,0,0,1,0,0,0\n")->buttonsAt(0), 0u);
    for (const char* wrong : {"-1", "1.5", "x", "", "16777216"}) {
        const auto refused = read(std::string("0,0,0,0,1,0,0,0,a,") + wrong + "\n", header);
        ASSERT_FALSE(refused) << wrong;
        EXPECT_EQ(refused.errors().front().key, "buttons");
        EXPECT_EQ(refused.errors().front().line, 2);
        EXPECT_EQ(refused.errors().front().value, wrong);
    }
}

TEST(Trajectory, TellsTheFirstBadRowsAndHowManyMoreThereAre) {
    // Truth: closed form: eight rotations that are none; a line each for five.
    std::string rows;
    for (int i = 0; i < 8; ++i) rows += std::to_string(i) + ",0,0,0,0.5,0,0,0\n";
    const auto path = read(rows);
    ASSERT_FALSE(path);
    ASSERT_EQ(path.errors().size(), 5u);
    EXPECT_EQ(path.errors()[0].message, "the quaternion's length must be 1 ± 0.001");
    EXPECT_EQ(path.errors()[4].message, "the quaternion's length must be 1 ± 0.001; 3 more rows are wrong");
}

}  // namespace
}  // namespace passung
