#include <gtest/gtest.h>

#include <cmath>

#include "core/base/tick_record.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

const std::vector<std::string> kColumns = {
    "tick",        "t_s",           "device_x_m",     "device_y_m",  "device_z_m", "device_qw",   "device_qx",
    "device_qy",   "device_qz",     "proxy_x_m",      "proxy_y_m",   "proxy_z_m",  "proxy_qw",    "proxy_qx",
    "proxy_qy",    "proxy_qz",      "force_x_N",      "force_y_N",   "force_z_N",  "torque_x_Nm", "torque_y_Nm",
    "torque_z_Nm", "proxy_depth_m", "device_depth_m", "contacts",    "quality",    "status",      "iterations",
    "tick_us",     "proxy_gap_m",   "suspended",      "tick_cpu_us", "proxy_lag_m"};

constexpr double kStiffness = 800.0;  // [N/m]
constexpr double kDepth = 2e-3;       // of the pressed block [m]
// The field's values at the block's flat face stem from a plane, which interpolation reproduces: what is left is the
// rounding of stored distances, below a tenth of the asked tolerance.
constexpr double kFieldError = 2e-6;  // [m]

/// A block of 20 mm over a table whose top is z = 0, without limits that act.
std::string pressScene(const std::string& method) {
    return R"(unit = "mm"

[[part]]
name = "block"
held = true
shape = { kind = "box", width = 20, depth = 20, height = 20 }
pose = { position = [0, 0, 11] }

[[part]]
name = "table"
shape = { kind = "box", width = 60, depth = 60, height = 30 }
pose = { position = [0, 0, -15] }

[contact]
method = ")" +
           method + R"("
stiffness_N_per_m = 800
cell_mm = 1
spacing_mm = 2
)";
}

/// Down into the table, pressed, a broken sensor from 0.1 s to 0.2 s, on as before.
constexpr const char* kPress = R"(t_s,x_m,y_m,z_m,qw,qx,qy,qz
0,0,0,0.011,1,0,0,0
0.05,0,0,0.008,1,0,0,0
0.1,0,0,0.008,1,0,0,0
0.15,nan,nan,nan,nan,nan,nan,nan
0.2,0,0,0.008,1,0,0,0
0.3,0,0,0.008,1,0,0,0
)";
constexpr std::size_t kTicks = 301, kPressed = 60, kLastGood = 100, kGoodAgain = 200;

class Simulate : public testing::Test {
protected:
    fake::CsvFile simulate(const std::string& scene, const std::string& path) {
        writeText(folder_ / "scene.toml", scene);
        writeText(folder_ / "path.csv", path);
        const Ended ended =
            runProgram(folder_.path(), {"simulate", "scene.toml", "--trajectory", "path.csv", "--out", "t.csv"});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        EXPECT_EQ(ended.out + ended.err, "");
        EXPECT_FALSE(std::filesystem::exists(folder_ / "t.csv.part"));
        fake::CsvFile ticks = fake::readCsv(readText(folder_ / "t.csv"));
        EXPECT_EQ(ticks.header, kColumns);
        return ticks;
    }

    static double number(const fake::CsvFile& csv, std::size_t row, const std::string& column) {
        return std::stod(csv.at(row, column));
    }

    static std::uint32_t status(const fake::CsvFile& csv, std::size_t row) {
        return static_cast<std::uint32_t>(std::stoul(csv.at(row, "status")));
    }

    TempFolder folder_;
};

TEST_F(Simulate, WritesARowForEveryMillisecondOfThePath) {
    // Truth: closed form (the path's own poses, linear between rows)
    const fake::CsvFile t = simulate(pressScene("penalty"), kPress);
    ASSERT_EQ(t.rows.size(), kTicks);
    for (std::size_t i = 0; i < kTicks; ++i) {
        EXPECT_EQ(number(t, i, "tick"), static_cast<double>(i));
        EXPECT_NEAR(number(t, i, "t_s"), static_cast<double>(i) * 1e-3, 1e-12);
        const double z = i < 50 ? 0.011 - 0.003 * static_cast<double>(i) / 50.0 : 0.008;
        EXPECT_NEAR(number(t, i, "device_z_m"), z, 1e-12) << i;
        EXPECT_EQ(number(t, i, "device_qw"), 1.0);
        EXPECT_EQ(number(t, i, "quality"), 1.0);
        EXPECT_GE(number(t, i, "tick_us"), 0.0);
        EXPECT_GE(number(t, i, "tick_cpu_us"), 0.0);
        EXPECT_EQ(t.at(i, "proxy_gap_m"), "NA") << "no field proves a gap";
        EXPECT_EQ(t.at(i, "suspended"), "0");
    }
}

TEST_F(Simulate, PressesButtonsOfThePathAndTellsOfNavigation) {
    // Truth: closed form: a hand in the air goes on by 0.2 mm a tick with the clutch held from 0.1 s to 0.2 s: the part
    // stays meanwhile, and lies behind the path by that way afterwards; the registration's scale of 2 makes the half of
    // it, a second scale of 1, from 0.3 s on. Columns of navigation follow the others, and only where the scene has it.
    writeText(folder_ / "scene.toml", pressScene("penalty") +
                                          "[registration]\nscale = 2\n[effects.clutch]\nbutton = 2\n"
                                          "[effects.position_scale]\nbutton = 3\nscale = 1\n");
    writeText(folder_ / "path.csv",
              "t_s,x_m,y_m,z_m,qw,qx,qy,qz,buttons\n0,0,0,0.1,1,0,0,0,0\n0.1,0.02,0,0.1,1,0,0,0,2\n"
              "0.2,0.04,0,0.1,1,0,0,0,0\n0.3,0.06,0,0.1,1,0,0,0,4\n0.4,0.08,0,0.1,1,0,0,0,4\n");
    const Ended ended =
        runProgram(folder_.path(), {"simulate", "scene.toml", "--trajectory", "path.csv", "--out", "t.csv"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const fake::CsvFile t = fake::readCsv(readText(folder_ / "t.csv"));
    auto columns = kColumns;
    for (const char* name : {"clutched", "scale", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"})
        columns.push_back(std::string("navigation_") + name);
    EXPECT_EQ(t.header, columns);
    for (std::size_t i = 0; i <= 400; ++i) {
        const double path = 2e-4 * static_cast<double>(i), held = std::clamp(path, 0.02, 0.04) - 0.02;
        const double slow = 0.5 * std::max(0.0, path - 0.0598);
        EXPECT_NEAR(number(t, i, "device_x_m"), path - held - slow, 1e-12) << i;
        EXPECT_EQ(t.at(i, "navigation_clutched"), i >= 100 && i < 200 ? "1" : "0") << i;
        EXPECT_EQ(number(t, i, "navigation_scale"), i >= 300 ? 0.5 : 1.0) << i;
        EXPECT_EQ(t.at(i, "navigation_qw"), "1");
    }
    EXPECT_NEAR(number(t, 299, "navigation_x_m"), -0.02, 1e-12);
}

TEST_F(Simulate, PicksPartsUpByTheButtonsOfThePath) {
    // Truth: closed form. Closed on at t = 0.1 s, the block goes with the hand from the next tick on; let go at 0.3 s,
    // it stays. A second hand takes it where it is then.
    const std::string scene =
        "[[part]]\nname = \"table\"\nshape = { kind = \"box\", width = 100, depth = 100, height = 10 }\n"
        "[[part]]\nname = \"block\"\npickable = true\npose = { position = [0, 0, 11] }\n"
        "shape = { kind = \"box\", width = 10, depth = 10, height = 10 }\n"
        "[contact]\nmethod = \"god_object\"\n[effects.pick]\nreach_mm = 3\n[[hand]]\nname = \"left\"\n";
    writeText(folder_ / "scene.toml", scene);
    writeText(folder_ / "right.csv",
              "t_s,x_m,y_m,z_m,qw,qx,qy,qz,buttons\n0,0,0,0.018,1,0,0,0,0\n0.1,0,0,0.018,1,0,0,0,1\n"
              "0.3,0.02,0,0.038,1,0,0,0,0\n0.5,0.1,0,0.1,1,0,0,0,0\n");
    writeText(folder_ / "left.csv",
              "t_s,x_m,y_m,z_m,qw,qx,qy,qz,buttons\n0,0.02,0.006,0.033,1,0,0,0,0\n0.4,0.02,0.006,0.033,1,0,0,0,1\n"
              "0.5,0.02,0.026,0.033,1,0,0,0,1\n");
    const Ended ended = runProgram(folder_.path(), {"simulate", "scene.toml", "--trajectory", "right.csv",
                                                    "--trajectory", "left.csv", "--out", "r.csv", "--out", "l.csv"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const fake::CsvFile right = fake::readCsv(readText(folder_ / "r.csv")),
                        left = fake::readCsv(readText(folder_ / "l.csv"));
    auto columns = kColumns;
    columns.push_back("held_part");
    EXPECT_EQ(right.header, columns);
    for (std::size_t i = 0; i <= 500; ++i) {
        EXPECT_EQ(right.at(i, "held_part"), i > 100 && i <= 300 ? "block" : "NA") << i;
        EXPECT_EQ(left.at(i, "held_part"), i > 400 ? "block" : "NA") << i;
        if (i <= 100 || i > 300) continue;
        EXPECT_NEAR(number(right, i, "proxy_x_m"), 1e-4 * static_cast<double>(i - 100), 1e-9) << i;
    }
    EXPECT_NEAR(number(right, 300, "proxy_z_m"), 0.031, 1e-9);
    EXPECT_NEAR(number(left, 401, "proxy_z_m"), 0.031, 1e-8);
    EXPECT_NEAR(number(left, 500, "proxy_y_m"), 0.02, 1e-8);
}

TEST_F(Simulate, PenaltyForceOnAPlaneIsStiffnessTimesDepth) {
    // Truth: closed form (|F| = K d, upwards; the block's sides are sampled at random places, so that what their points
    // press to the left and to the right cancels to 1 % only)
    const fake::CsvFile t = simulate(pressScene("penalty"), kPress);
    for (std::size_t i = 0; i <= kLastGood; ++i) {
        SCOPED_TRACE(i);
        const double depth = std::max(0.0, 0.010 - number(t, i, "device_z_m"));
        EXPECT_NEAR(number(t, i, "device_depth_m"), depth, kFieldError);
        const double x = number(t, i, "force_x_N"), y = number(t, i, "force_y_N"), z = number(t, i, "force_z_N");
        EXPECT_NEAR(std::hypot(x, y, z), kStiffness * depth, kStiffness * kFieldError);
        EXPECT_LE(std::hypot(x, y), 0.01 * z);
        EXPECT_LE(std::abs(number(t, i, "torque_z_Nm")), 0.01 * z * 0.01);
        for (const char* column : {"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"}) {
            EXPECT_EQ(t.at(i, std::string("proxy_") + column), t.at(i, std::string("device_") + column));
        }
        EXPECT_EQ(t.at(i, "proxy_depth_m"), t.at(i, "device_depth_m"));
    }
    EXPECT_GT(number(t, kPressed, "contacts"), 0.0);
}

TEST_F(Simulate, ABrokenSensorIsHeldForOneTickThenTheForceIsZero) {
    // Truth: invariant (the output stage's contract: one tick held, then zero, back with the first good sample)
    for (const std::string method : {"penalty", "god_object_heuristic"}) {
        SCOPED_TRACE(method);
        const fake::CsvFile t = simulate(pressScene(method), kPress);
        const auto force = [&](std::size_t i) { return number(t, i, "force_z_N"); };
        EXPECT_GT(force(kLastGood), 1.0);
        EXPECT_NEAR(force(kLastGood + 1), force(kLastGood), 1e-3 * force(kLastGood));
        EXPECT_EQ(status(t, kLastGood + 1) & (kInputHeld | kInputRejected), static_cast<std::uint32_t>(kInputHeld));
        for (std::size_t i = kLastGood + 2; i < kGoodAgain; ++i) {
            ASSERT_EQ(force(i), 0.0) << i;
            ASSERT_EQ(status(t, i) & (kInputHeld | kInputRejected), static_cast<std::uint32_t>(kInputRejected)) << i;
        }
        EXPECT_GT(force(kGoodAgain), 1.0);
        EXPECT_EQ(status(t, kGoodAgain) & (kInputHeld | kInputRejected), 0u);
        for (std::size_t row = 0; row < t.rows.size(); ++row) {
            for (const std::string& column : kColumns) {
                // No field proves a gap, and nothing but a proxy among fields tells its lag.
                if ((column == "proxy_gap_m" || column == "proxy_lag_m") && t.at(row, column) == "NA") continue;
                ASSERT_TRUE(std::isfinite(number(t, row, column))) << column << " " << row;
            }
        }
    }
}

TEST_F(Simulate, TheProxyStaysOnThePlaneAndTheSpringPullsBackToIt) {
    // Truth: closed form (F = K × what lies between hand and proxy; the proxy rests on z = 10 mm within a part of a
    // cell)
    const fake::CsvFile t = simulate(pressScene("god_object_heuristic"), kPress);
    const double proxy = number(t, kLastGood, "proxy_z_m"), hand = number(t, kLastGood, "device_z_m");
    EXPECT_NEAR(proxy, 0.010, 0.05e-3) << "5 % of the cell";
    EXPECT_NEAR(number(t, kLastGood, "force_z_N"), kStiffness * (proxy - hand), 1e-6);
    EXPECT_NEAR(number(t, kLastGood, "device_depth_m"), kDepth, kFieldError);
    EXPECT_LT(number(t, kLastGood, "proxy_depth_m"), 0.05e-3);
}

TEST_F(Simulate, TheSceneLimitsTheForce) {
    // Truth: closed form (1.6 N asked, 0.5 N allowed)
    const fake::CsvFile t = simulate(pressScene("penalty") + "\n[device]\nmax_force_N = 0.5\n", kPress);
    const auto force = [&](std::size_t i) {
        return std::hypot(number(t, i, "force_x_N"), number(t, i, "force_y_N"), number(t, i, "force_z_N"));
    };
    EXPECT_NEAR(force(kLastGood), 0.5, 1e-12);
    EXPECT_EQ(status(t, kLastGood) & kForceLimited, static_cast<std::uint32_t>(kForceLimited));
    for (std::size_t i = 0; i < kTicks; ++i) ASSERT_LE(force(i), 0.5 + 1e-12);
}

TEST_F(Simulate, ASheetThatItsCellsLoseIsRefusedByEachCommandThatRunsTheScene) {
    // Truth: closed form: half a millimetre lies within the diagonal of a cell of 1 mm; nothing is written.
    std::string scene = onFields(pressScene("god_object"));
    const std::string thick = "height = 30 }\npose = { position = [0, 0, -15] }";
    const std::size_t at = scene.find(thick);
    ASSERT_NE(at, std::string::npos);
    scene.replace(at, thick.size(), "height = 0.5 }\npose = { position = [0, 0, -0.25] }");
    writeText(folder_ / "scene.toml", scene);
    writeText(folder_ / "path.csv", kPress);
    for (const std::vector<std::string>& call :
         {std::vector<std::string>{"simulate", "scene.toml", "--trajectory", "path.csv", "--out", "t.csv"},
          {"explain", "scene.toml"}}) {
        const Ended ended = runProgram(folder_.path(), call);
        EXPECT_EQ(ended.exit_code, 1) << call[0];
        EXPECT_EQ(linesOf(ended.err).size(), 1u) << ended.err;
        EXPECT_EQ(ended.err.find("scene.toml:"), 0u) << ended.err;
        EXPECT_NE(ended.err.find("part.table"), std::string::npos) << ended.err;
        EXPECT_NE(ended.err.find("0.5 mm"), std::string::npos) << ended.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "t.csv"));
}

}  // namespace
}  // namespace passung::test
