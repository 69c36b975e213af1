#include <gtest/gtest.h>

#include <algorithm>

#include "tests/ui/cli/program.h"

namespace passung::test {
namespace {

const std::string kBox = "[[part]]\nname = \"box\"\nshape = { kind = \"box\", width = 40, depth = 40, height = 40 }\n";
const std::string kBall = "[[part]]\nname = \"ball\"\nshape = { kind = \"sphere\", diameter = 20 }\n";

class Accuracy : public ::testing::Test {
protected:
    Accuracy() {
        writeText(folder_ / "box.toml", kBox);
        writeText(folder_ / "ball.toml", kBall);
        writeText(folder_ / "poses.csv",
                  "x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0.029,1,0,0,0\n0.001,0,0.0295,1,0,0,0\n0,0.002,0.031,1,0,0,0\n");
    }
    Ended run(std::vector<std::string> more) {
        std::vector<std::string> words{"accuracy", "box.toml", "ball.toml", "--out", "out"};
        words.insert(words.end(), more.begin(), more.end());
        return runProgram(folder_.path(), words);
    }
    TempFolder folder_;
};

TEST_F(Accuracy, WritesARowForEverySettingAndTheTruthOfEveryPose) {
    // Truth: closed form. 2 tolerances x 1 spacing x 2 budgets x 1 mode; the ball is 1 mm and 0.5 mm in the box's top
    // face and 1 mm above it, known to a micrometre.
    const Ended ended = run({"--poses", "poses.csv", "--tolerances-um", "100,50", "--spacings-mm", "2", "--budgets",
                             "0,50", "--modes", "trilinear", "--fcl-poses", "20", "--repetitions", "1"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    const auto lines = linesOf(readText(folder_ / "out/accuracy.csv"));
    EXPECT_EQ(lines.size(), 1u + 4u);
    const auto poses = linesOf(readText(folder_ / "out/poses.csv"));
    ASSERT_EQ(poses.size(), 4u);
    const double expected[] = {-1e-3, -0.5e-3, 1e-3};
    const auto cells = [](const std::string& line) {
        std::vector<std::string> words{""};
        for (const char c : line) {
            if (c == ',')
                words.emplace_back();
            else
                words.back() += c;
        }
        return words;
    };
    const auto header = cells(poses[0]);
    const auto column =
        static_cast<std::size_t>(std::find(header.begin(), header.end(), "true_signed_distance_m") - header.begin());
    ASSERT_LT(column, header.size());
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(std::stod(cells(poses[i + 1])[column]), expected[i], 1.5e-6);
    // Every column of both tables is in the codebook.
    const std::string codebook = readText(folder_ / "out/codebook.csv");
    for (const std::string& name : header)
        EXPECT_NE(codebook.find("poses.csv," + name + ","), std::string::npos) << name;
    for (const std::string& name : cells(lines[0]))
        EXPECT_NE(codebook.find("accuracy.csv," + name + ","), std::string::npos) << name;
    EXPECT_EQ(readText(folder_ / "out/accuracy.svg").rfind("<svg", 0), 0u);
    // Its poses are what query reads.
    const Ended query = runProgram(folder_.path(), {"query", "box.toml", "ball.toml", "--poses", "out/poses.csv",
                                                    "--out", "r.csv", "--spacing-mm", "2"});
    EXPECT_EQ(query.exit_code, 0) << query.err;
}

TEST_F(Accuracy, RefusesAFieldWithoutAnInsideInOneLine) {
    // Truth: invariant
    writeText(folder_ / "box.toml", "[[part]]\nname = \"s\"\nshape = { kind = \"sheet\", width = 40, depth = 40 }\n");
    const Ended ended = run({"--poses", "poses.csv"});
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_EQ(linesOf(ended.err).size(), 1u) << ended.err;
    EXPECT_NE(ended.err.find("watertight"), std::string::npos) << ended.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(Accuracy, ReplacesItsOwnResultsAndNoOthers) {
    // Truth: invariant
    const std::string small = "[[part]]\nname = \"ball\"\nshape = { kind = \"sphere\", diameter = 1 }\n";
    writeText(folder_ / "ball.toml", small);
    writeText(folder_ / "poses.csv", "x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0.0204,1,0,0,0\n");
    const std::vector<std::string> quick{
        "--poses", "poses.csv", "--tolerances-um", "100", "--spacings-mm", "4", "--budgets", "0",
        "--modes", "trilinear", "--fcl-poses",     "0",   "--repetitions", "1"};
    ASSERT_EQ(run(quick).exit_code, 0);
    const Ended again = run(quick);
    EXPECT_EQ(again.exit_code, 0) << again.err;
    const std::string before = readText(folder_ / "out/accuracy.csv");
    const auto refused = [&](const std::string& shell, const std::string& why) {
        std::vector<std::string> words{"accuracy", "box.toml", shell, "--out", "out"};
        words.insert(words.end(), quick.begin(), quick.end());
        const Ended ended = runProgram(folder_.path(), words);
        EXPECT_EQ(ended.exit_code, 1);
        EXPECT_EQ(linesOf(ended.err).size(), 1u) << ended.err;
        EXPECT_NE(ended.err.find(why), std::string::npos) << ended.err;
        EXPECT_EQ(readText(folder_ / "out/accuracy.csv"), before);
    };
    writeText(folder_ / "other.toml", small);
    refused("other.toml", "not of other against box");
    writeText(folder_ / "out/notes.txt", "mine");
    refused("ball.toml", "notes.txt");
}

}  // namespace
}  // namespace passung::test
