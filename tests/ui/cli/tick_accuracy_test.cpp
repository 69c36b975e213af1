#include <gtest/gtest.h>

#include <set>

#include "tests/analysis/export/csv_reader.h"
#include "tests/ui/cli/program.h"

namespace passung::test {
namespace {

const std::string kScene = R"(unit = "mm"

[[part]]
name = "ball"
held = true
shape = { kind = "sphere", diameter = 20 }
pose = { position = [0, 0, 31] }

[[part]]
name = "table"
shape = { kind = "box", width = 60, depth = 60, height = 40 }

[contact]
method = "god_object"
stiffness_N_per_m = 800
rotational_stiffness_Nm_per_rad = 1
tolerance_um = 50
spacing_mm = 2
)";

/// 1 mm into the table within 50 ms, and held there.
constexpr const char* kPath = R"(t_s,x_m,y_m,z_m,qw,qx,qy,qz
0,0,0,0.031,1,0,0,0
0.05,0,0,0.029,1,0,0,0
0.1,0,0,0.029,1,0,0,0
)";

class TickAccuracy : public ::testing::Test {
protected:
    TickAccuracy() {
        writeText(folder_ / "scene.toml", kScene);
        writeText(folder_ / "path.csv", kPath);
    }
    Ended run(std::vector<std::string> more = {}) {
        std::vector<std::string> words{"accuracy",      "scene.toml", "--trajectory",  "path.csv", "--out", "out",
                                       "--repetitions", "1",          "--spacings-mm", "2"};
        words.insert(words.end(), more.begin(), more.end());
        return runProgram(folder_.path(), words);
    }
    /// One line on standard error that holds `why`, nothing left behind.
    void expectRefused(const Ended& ended, const std::string& why) {
        EXPECT_EQ(ended.exit_code, 1);
        EXPECT_EQ(linesOf(ended.err).size(), 1u) << ended.err;
        EXPECT_NE(ended.err.find(why), std::string::npos) << ended.err;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
    }
    TempFolder folder_;
};

TEST_F(TickAccuracy, WritesARowForEverySettingThatTheSceneCanHave) {
    // Truth: closed form: the ball is 1 mm in the table where the hand holds it, K times that is 0.8 N; no god object
    // on closed forms shows any of it. Two tolerances for each of three methods, two geometries more for two of them.
    const Ended ended = run();
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    const fake::CsvFile table = fake::readCsv(readText(folder_ / "out/accuracy.csv"));
    ASSERT_EQ(table.rows.size(), 3u * 2u + 2u * 2u);
    std::set<std::string> settings;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const auto number = [&](const char* column) { return std::stod(table.at(i, column)); };
        settings.insert(table.at(i, "method") + " " + table.at(i, "geometry") + " " + table.at(i, "tolerance_um"));
        EXPECT_EQ(table.at(i, "ticks"), "101");
        EXPECT_GT(number("referenced_ticks"), 0.0);
        EXPECT_GT(number("time_p999_us"), 0.0);
        EXPECT_LE(number("overlap_max_um"), number("overlap_bound_um"));
        if (table.at(i, "method") == "penalty") {
            EXPECT_NEAR(number("overlap_max_um"), 1000.0, 11.0);
        }
        if (table.at(i, "geometry") == "closed_form") {
            EXPECT_LE(number("overlap_bound_um"), 1.0);
            EXPECT_LE(number("force_error_max_N"), 800.0 * 3e-7);
            EXPECT_EQ(table.at(i, "spacing_mm"), "NA") << "points have no meaning there";
        }
    }
    EXPECT_EQ(settings.size(), table.rows.size());
    const std::string codebook = readText(folder_ / "out/codebook.csv");
    for (const std::string& name : table.header)
        EXPECT_NE(codebook.find("accuracy.csv," + name + ","), std::string::npos) << name;
    const std::string picture = readText(folder_ / "out/accuracy.svg");
    EXPECT_EQ(picture.rfind("<svg", 0), 0u);
    EXPECT_NE(picture.find("scene along path"), std::string::npos);
    EXPECT_NE(ended.out.find("left out: penalty: closed_form needs a god object"), std::string::npos) << ended.out;
}

TEST_F(TickAccuracy, MeasuresTheLevelsThatAreAskedFor) {
    // Truth: closed form: 1 method x 1 geometry x 1 mode x 2 budgets x 2 ways.
    const Ended ended = run({"--methods", "god_object", "--geometries", "field", "--modes", "linear", "--budgets",
                             "0,100", "--ways", "1,2", "--tolerances-um", "50"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(linesOf(readText(folder_ / "out/accuracy.csv")).size(), 1u + 4u);
    // Another path's results are not replaced.
    writeText(folder_ / "other.csv", kPath);
    const Ended other =
        runProgram(folder_.path(), {"accuracy", "scene.toml", "--trajectory", "other.csv", "--out", "out"});
    EXPECT_EQ(other.exit_code, 1);
    EXPECT_EQ(linesOf(other.err).size(), 1u) << other.err;
    EXPECT_NE(other.err.find("not of scene along other"), std::string::npos) << other.err;
}

TEST_F(TickAccuracy, RefusesBadInputInOneLine) {
    // Truth: invariant
    writeText(folder_ / "path.csv", "t_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,zero,1,0,0,0\n");
    expectRefused(run(), "path.csv");
    writeText(folder_ / "path.csv", kPath);
    expectRefused(run({"--methods", "penalty", "--geometries", "closed_form"}), "closed_form needs a god object");
    writeText(folder_ / "scene.toml", "unit = \"mm\"\n[[part]]\nname = \"ball\"\nshape = { kind = \"spere\" }\n");
    EXPECT_EQ(run().exit_code, 1);
    std::filesystem::remove(folder_ / "scene.toml");
    expectRefused(run(), "scene.toml");
}

TEST_F(TickAccuracy, RefusesOptionsOfTheOtherUse) {
    // Truth: the table of exit codes: wrong usage is 2.
    EXPECT_EQ(run({"--poses", "path.csv"}).exit_code, 2);
    EXPECT_EQ(run({"table.toml"}).exit_code, 2);
    EXPECT_EQ(runProgram(folder_.path(), {"accuracy", "scene.toml", "--out", "out"}).exit_code, 2);
    EXPECT_EQ(runProgram(folder_.path(), {"accuracy", "a.toml", "b.toml", "--out", "out", "--ways", "2"}).exit_code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

}  // namespace
}  // namespace passung::test
