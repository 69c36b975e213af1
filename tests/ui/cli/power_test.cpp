#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "analysis/power/power_file.h"
#include "analysis/power/power_runs.h"
#include "core/base/folder_lock.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/r_scripts.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

class Power : public testing::Test {
protected:
    Power() { writeText(folder_ / "fair.toml", fairStudy()); }

    Ended power(Words more) const {
        more.insert(more.begin(), "power");
        return runProgram(folder_.path(), more);
    }
    Ended model(Words more) const {
        const Words job = {"fair.toml", "--effect", "chance:fair=+0.5", "--simulation", "model", "--repeats", "40"};
        more.insert(more.begin(), job.begin(), job.end());
        return power(more);
    }

    TempFolder folder_;
};

TEST_F(Power, ShardsMergeToTheBytesOfTheUnshardedRun) {
    // Truth: invariant, byte for byte
    const Ended whole = model({"--out", "whole.csv"});
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
    EXPECT_NE(whole.out.find("95 % interval"), std::string::npos) << whole.out;
    Words merge = {"--merge"};
    for (const std::string i : {"3", "1", "2"}) {
        ASSERT_EQ(model({"--shard", i + "/3", "--out", "s" + i + ".csv"}).exit_code, 0);
        merge.push_back("s" + i + ".csv");
    }
    merge.insert(merge.end(), {"--out", "merged.csv"});
    const Ended merged = power(merge);
    ASSERT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_EQ(readText(folder_ / "merged.csv"), readText(folder_ / "whole.csv"));
    EXPECT_EQ(merged.out, whole.out);
}

TEST_F(Power, RemovesWhatAKilledRunLeftAndNothingThatIsInUse) {
    // Truth: invariant: of three folders one is held by this test, one is empty as at its making.
    const fs::path temporary = folder_ / "tmp";
    for (const char* name : {"dead", "alive", "fresh"})
        fs::create_directories(temporary / (std::string("passung_power_") + name));
    for (const char* name : {"dead", "alive"})
        writeText(temporary / (std::string("passung_power_") + name) / "study.db", "left");
    const auto alive = FolderLock::take(temporary / "passung_power_alive");
    ASSERT_TRUE(alive);
    ASSERT_EQ(setenv("TMPDIR", temporary.c_str(), 1), 0);
    const Ended ended = power({"fair.toml", "--effect", "chance:fair=+0.5", "--repeats", "1", "--participants", "2"});
    ASSERT_EQ(unsetenv("TMPDIR"), 0);
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    std::set<std::string> left;
    for (const auto& entry : fs::directory_iterator(temporary)) left.insert(entry.path().filename());
    EXPECT_EQ(left, (std::set<std::string>{"passung_power_alive", "passung_power_fresh"}));
}

TEST_F(Power, AFinishedShardIsNotRunAgain) {
    // Truth: invariant: a row that only this test can have written survives.
    ASSERT_EQ(model({"--shard", "2/2", "--out", "s.csv"}).exit_code, 0);
    std::string text = readText(folder_ / "s.csv");
    const std::size_t row = text.find("\n1,4,") + 5;
    text.replace(row, text.find(',', row) - row, "123.5");
    writeText(folder_ / "s.csv", text);
    const Ended again = model({"--shard", "2/2", "--out", "s.csv"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_NE(again.out.find("nothing was run"), std::string::npos) << again.out;
    EXPECT_EQ(readText(folder_ / "s.csv"), text);
}

TEST_F(Power, AFileOfAnotherJobOrATornOneIsRefusedAndKept) {
    // Truth: invariant
    ASSERT_EQ(model({"--out", "s.csv"}).exit_code, 0);
    const std::string text = readText(folder_ / "s.csv");
    const Ended other = model({"--seed", "8", "--out", "s.csv"});
    EXPECT_EQ(other.exit_code, 1);
    EXPECT_EQ(other.err, "s.csv: error: --out: holds another job or shard; name another file\n");
    EXPECT_EQ(model({"--shard", "1/2", "--out", "s.csv"}).exit_code, 1);
    EXPECT_EQ(readText(folder_ / "s.csv"), text);
    writeText(folder_ / "s.csv", text.substr(0, text.size() / 2));
    EXPECT_EQ(model({"--out", "s.csv"}).exit_code, 1);
    EXPECT_EQ(power({"--merge", "s.csv"}).exit_code, 1);
    EXPECT_EQ(power({"--merge", "absent.csv"}).err, "absent.csv: error: cannot be opened\n");
}

TEST_F(Power, WrongUsageIsTwoAndWhatTheStudyLacksIsOne) {
    // Truth: invariant
    EXPECT_EQ(power({}).exit_code, 2);
    EXPECT_EQ(power({"fair.toml"}).exit_code, 2);
    EXPECT_EQ(model({"--shard", "1/2"}).exit_code, 2);
    for (const char* shard : {"0/2", "3/2", "1", "1/2x", "/"})
        EXPECT_EQ(model({"--shard", shard, "--out", "s.csv"}).exit_code, 2) << shard;
    EXPECT_EQ(power({"--merge", "s.csv", "--alpha", "0.1"}).exit_code, 2);
    EXPECT_EQ(model({"--merge", "s.csv"}).exit_code, 2);
    const Ended level = power({"fair.toml", "--effect", "chance:good=+1"});
    EXPECT_EQ(level.exit_code, 1);
    EXPECT_EQ(level.err, "error: --effect: good: must be a level of chance: none, fair\n");
    const Ended measure = model({"--measure", "peak_force_N"});
    EXPECT_EQ(measure.exit_code, 1);
    EXPECT_EQ(measure.err, "error: --measure: peak_force_N: the model has completion_time_s, time_s only\n");
    const Ended bounds = model({"--test", "equivalence"});
    EXPECT_EQ(bounds.exit_code, 1);
    EXPECT_NE(bounds.err.find("takes its bounds from the protocol"), std::string::npos) << bounds.err;
    EXPECT_EQ(model({"--drop-out", "1.5"}).exit_code, 2);
    EXPECT_EQ(model({"--test", "anova"}).exit_code, 2);
    EXPECT_FALSE(fs::exists(folder_ / "s.csv"));
}

TEST_F(Power, TheTestIsTheOneThatTheProtocolPlans) {
    // Truth: invariant; --test wins.
    std::string study = readText(folder_ / "fair.toml");
    study += "\n[[analysis]]\noutcome = \"time_s\"\nfactors = [\"chance\"]\ntest = \"wilcoxon\"\n";
    writeText(folder_ / "fair.toml", study);
    EXPECT_NE(model({}).out.find("compared with none by wilcoxon"), std::string::npos);
    EXPECT_NE(model({"--test", "rm_anova"}).out.find("compared with none by rm_anova"), std::string::npos);
}

TEST_F(Power, AModelOfRIsFittedOrTheLineThatInstallsItIsNamed) {
    // Truth: invariant: bytes do not hang on how many studies R gets at once.
    if (!hasReportPackages()) GTEST_SKIP() << kNoReportPackages;
    const Ended whole = model({"--test", "lmm", "--drop-out", "0.3", "--participants", "16", "--out", "whole.csv"});
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
    EXPECT_NE(whole.out.find("30 % leave before the end"), std::string::npos) << whole.out;
    EXPECT_NE(whole.out.find(" to 16 persons"), std::string::npos) << whole.out;
    Words merge = {"--merge"};
    for (const std::string i : {"1", "2"}) {
        ASSERT_EQ(model({"--test", "lmm", "--drop-out", "0.3", "--participants", "16", "--shard", i + "/2", "--out",
                         "s" + i + ".csv"})
                      .exit_code,
                  0);
        merge.push_back("s" + i + ".csv");
    }
    merge.insert(merge.end(), {"--out", "merged.csv"});
    ASSERT_EQ(power(merge).exit_code, 0);
    EXPECT_EQ(readText(folder_ / "merged.csv"), readText(folder_ / "whole.csv"));
    const WithoutPrograms alone;
    const Ended without = model({"--test", "lmm"});
    EXPECT_EQ(without.exit_code, 1);
    EXPECT_EQ(without.err,
              "error: --test: lmm: is computed by R, which lacks it here: apt install r-base-core r-cran-lmertest\n");
}

TEST_F(Power, AVirtualStudyIsARunAndItsExportWithTheEffectOnTop) {
    // Truth: independent path: the same seed through `run` and `export`; the means of cells_long.csv.
    const Ended planted = power({"fair.toml", "--effect", "chance:fair=+0.25", "--measure", "completion_time_s",
                                 "--participants", "2", "--repeats", "1", "--out", "p.csv"});
    ASSERT_EQ(planted.exit_code, 0) << planted.err;
    const auto result = power::readPowerText(readText(folder_ / "p.csv"), "p.csv");
    ASSERT_TRUE(result);

    plan::StudyPlan plan;
    plan.name = "small";
    plan.seed = 7;
    const std::string seed = std::to_string(power::runSeed(plan, 0));
    const Ended run =
        runProgram(folder_.path(), {"run", "fair.toml", "--simulated", "2", "--seed", seed, "--db", "s.db"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    ASSERT_EQ(runProgram(folder_.path(), {"export", "s.db", "--out", "e", "--no-samples"}).exit_code, 0);
    std::map<std::string, double> sums;  // level: sum over both participants
    const fake::CsvFile cells = fake::readCsv(readText(folder_.path() / "e" / "cells_long.csv"));
    for (std::size_t row = 0; row < cells.rows.size(); ++row)
        sums[cells.at(row, "chance")] += std::stod(cells.at(row, "completion_time_s.mean"));
    EXPECT_EQ(result->tests.front().test.n, 2u);
    EXPECT_NEAR(result->tests.front().test.mean, (sums.at("fair") - sums.at("none")) / 2.0 + 0.25, 1e-12);
}

}  // namespace
}  // namespace passung::test
