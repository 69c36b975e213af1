#include <gtest/gtest.h>

#include <map>

#include "tests/ui/cli/program.h"
#include "tests/ui/cli/r_scripts.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

namespace fs = std::filesystem;

/// The shipped studies that plan an analysis, with contacts that are quick to compute and time-outs that some trials do
/// not meet.
class PlannedAnalyses : public testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        if (!hasR()) GTEST_SKIP() << "R (r-base-core) is not installed: no planned analysis was tried";
        const fs::path shipped = fs::path(PASSUNG_SOURCE_DIR) / "protocols";
        fs::copy(shipped, folder_.path() / "protocols", fs::copy_options::recursive);
        std::string text = readText(study());
        std::map<std::string, std::string> quicker = {
            {"cell_mm = 0.5", "cell_mm = 1.0"},  {"spacing_mm = 1.0", "spacing_mm = 3.0"},
            {"timeout_s = 30", "timeout_s = 5"}, {"timeout_s = 60", "timeout_s = 3"},
            {"timeout_s = 90", "timeout_s = 3"}, {"max_trials = 60", "max_trials = 10"}};
        // A secondary task needs its trials.
        if (text.find("[secondary]") == std::string::npos) quicker["repetitions = 2"] = "repetitions = 1";
        for (const auto& [from, to] : quicker)
            for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
                text.replace(at, from.size(), to);
        writeText(study(), text);
    }

    fs::path study() const { return folder_.path() / "protocols" / GetParam(); }

    /// Whoever counts has a value, so nobody is left out; R says nothing and leaves nothing out.
    void expectReportOf(const std::string& database) const {
        if (!hasReportPackages()) GTEST_SKIP() << kNoReportPackages;
        const Ended report = runProgram(folder_.path(), {"report", database, "--out", "report", "--no-samples"});
        ASSERT_EQ(report.exit_code, 0) << report.err;
        EXPECT_EQ(report.err, "");
        const std::string results = readText(folder_ / "report/results.json");
        const std::size_t planned = linesOf(readText(folder_ / "report/analyses.csv")).size() - 1;
        EXPECT_GT(planned, 0u);
        for (std::size_t i = 1; i <= planned; ++i)
            for (const char* of : {".n", ".n_counted"})
                EXPECT_NE(results.find("\"a" + std::to_string(i) + of + "\": 4,"), std::string::npos) << i << of;
        int code = 0;
        const std::string said = checkPage(folder_ / "report", code);
        EXPECT_EQ(code, 0) << said;
    }

    TempFolder folder_;
};

TEST_P(PlannedAnalyses, KeepEveryCountedPersonInR) {
    // Truth: independent program (R 4, base: aggregate, complete.cases, aov) on the exported tables; in the report an
    // invariant: each person who counts is in each analysis. The database's views: Python's sqlite3 and csv.
    const Ended run = runProgram(folder_.path(), {"run", study().string(), "--simulated", "4", "--db", "s.db"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    ASSERT_EQ(runProgram(folder_.path(), {"export", "s.db", "--out", "out", "--no-samples"}).exit_code, 0);
    int code = 0;
    const std::string views = ask("python3 '" PASSUNG_SOURCE_DIR "/tests/ui/cli/database_views.py' '" +
                                      (folder_ / "s.db") + "' '" + (folder_ / "out") + "'",
                                  code);
    EXPECT_EQ(code, 0) << views;
    const std::string said = askR(std::string(PASSUNG_SOURCE_DIR) + "/tests/ui/cli/planned_analyses.R '" +
                                      (folder_.path() / "out").string() + "'",
                                  code);
    EXPECT_EQ(code, 0) << said;
    EXPECT_NE(said.find("kept 4 of 4"), std::string::npos) << said;
    // The exported protocol is the study itself: the program reads it with the questionnaires beside it.
    const Ended check = runProgram(
        folder_.path() / "out", {"check", [&] {
                                     for (const auto& entry : fs::directory_iterator(folder_.path() / "out/protocol"))
                                         if (entry.is_regular_file()) return entry.path().string();
                                     return std::string();
                                 }()});
    if (readText(study()).find("picture = ") == std::string::npos) {
        EXPECT_EQ(check.exit_code, 0) << check.err;
    }
    expectReportOf("s.db");
}

std::string nameOf(const testing::TestParamInfo<const char*>& test) {
    std::string name = test.param;
    for (char& c : name)
        if (!isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(Shipped, PlannedAnalyses,
                         testing::Values("peg_in_hole/study.toml", "peg_in_hole/hidden_offset.toml",
                                         "accuracy_threshold/study.toml", "designs/study.toml",
                                         "rendering_methods/study.toml", "real_vs_virtual/study.toml",
                                         "narrow_passage/study.toml", "shared_control/study.toml",
                                         "many_parts/study.toml"),
                         nameOf);

TEST(PlannedTest, RunsInRAsTheTableWritesIt) {
    // Truth: independent program (R 4, base): every test of the key table, each on factors that it is for.
    if (!hasR()) GTEST_SKIP() << "R (r-base-core) is not installed";
    const TempFolder folder;
    std::string text = fairStudy();
    text.replace(text.find("participants = 4"), 16, "participants = 8");
    text.replace(text.find("repetitions = 3"), 15, "repetitions = 1");
    text +=
        "[[factor]]\nname = \"push\"\nkey = \"contact.stiffness_N_per_m\"\nlevels = [\"0.5 max\", \"0.7 max\", "
        "\"max\"]\n"
        "[[factor]]\nname = \"side\"\nkind = \"between\"\nkey = \"part.peg.pose.position\"\n"
        "levels = [{ label = \"right\", value = [4, 0, 8] }, { label = \"left\", value = [-4, 0, 8] }]\n";
    const auto plan = [&text](const std::string& test, const std::string& factors) {
        text += "[[analysis]]\noutcome = \"path_length_m\"\ntest = \"" + test + "\"\n";
        if (!factors.empty()) text += "factors = [" + factors + "]\n";
    };
    const std::string chance = "\"chance\"", push = "\"push\"", side = "\"side\"";
    for (const char* test : {"paired_t", "wilcoxon"}) plan(test, chance);
    for (const char* test : {"welch_t", "mann_whitney"}) plan(test, side);
    plan("friedman", push);
    plan("rm_anova", chance + ", " + push);
    plan("mixed_anova", chance + ", " + side);
    plan("lmm", chance);
    plan("mean", "");
    writeText(folder / "study.toml", text);
    const Ended run = runProgram(folder.path(), {"run", "study.toml", "--simulated", "8", "--db", "s.db"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    ASSERT_EQ(runProgram(folder.path(), {"export", "s.db", "--out", "out", "--no-samples"}).exit_code, 0);
    int code = 0;
    const std::string said =
        askR(std::string(PASSUNG_SOURCE_DIR) + "/tests/ui/cli/planned_analyses.R '" + (folder / "out") + "'", code);
    EXPECT_EQ(code, 0) << said;
    std::size_t kept = 0;
    for (std::size_t at = 0; (at = said.find("kept 8 of 8", at)) != std::string::npos; ++at) ++kept;
    EXPECT_EQ(kept, 9u) << said;
}

TEST(ExportedNumbers, OfFourBytesAreInRWhatWasStoredToTheLastBit) {
    // Truth: independent program (R's own reading of numbers): a value that four bytes held survives four bytes. The
    // columns named here are such by the codebook.
    if (!hasR()) GTEST_SKIP() << "R (r-base-core) is not installed";
    const TempFolder folder;
    writeText(folder / "study.toml", smallStudy());
    ASSERT_EQ(runProgram(folder.path(), {"run", "study.toml", "--simulated", "1", "--db", "s.db"}).exit_code, 0);
    ASSERT_EQ(runProgram(folder.path(), {"export", "s.db", "--out", "out"}).exit_code, 0);
    writeText(
        folder / "read.R",
        "samples <- list.files(file.path(commandArgs(TRUE)[1], 'samples'), 'csv.gz', full.names = TRUE)\n"
        "kept <- function(x) identical(readBin(writeBin(x, raw(), size = 4), 'numeric', length(x), size = 4), x)\n"
        "columns <- c('hand_x_m', 'force_z_N', 'torque_y_Nm', 'hand_depth_m')\n"
        "rows <- do.call(rbind, lapply(samples, read.csv))\n"
        "stopifnot(all(columns %in% names(rows)), any(rows$force_z_N != 0))\n"
        "for (column in columns) if (!kept(as.numeric(rows[[column]]))) cat(column, 'is not kept\\n')\n"
        "cat(nrow(rows), 'rows\\n')\n");
    int code = 0;
    const std::string said = askR("'" + (folder / "read.R") + "' '" + (folder / "out") + "'", code);
    EXPECT_EQ(code, 0) << said;
    EXPECT_EQ(said.find("is not kept"), std::string::npos) << said;
    EXPECT_NE(said.find(" rows"), std::string::npos) << said;
}

}  // namespace
}  // namespace passung::test
