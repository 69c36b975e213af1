#include <gtest/gtest.h>

#include <map>

#include "tests/ui/cli/program.h"
#include "tests/ui/cli/r_scripts.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

namespace fs = std::filesystem;

/// The shipped studies that plan an analysis; those that take minutes only at full length.
std::vector<std::string> shippedStudies() {
    std::vector<std::string> studies = {"peg_in_hole/study.toml",        "peg_in_hole/hidden_offset.toml",
                                        "accuracy_threshold/study.toml", "designs/study.toml",
                                        "rendering_methods/study.toml",  "real_vs_virtual/study.toml",
                                        "narrow_passage/study.toml",     "shared_control/study.toml",
                                        "many_parts/study.toml",         "two_hands/study.toml"};
    if (std::getenv("PASSUNG_LONG") != nullptr)
        for (const char* study : {"gearbox_assembly/study.toml", "thesis_queries/study.toml", "thresholds/study.toml"})
            studies.push_back(study);
    return studies;
}

std::string plainName(std::string name) {
    for (char& c : name)
        if (!isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
}

/// Each run by three people, with contacts that are quick to compute and time-outs that some trials do not meet,
/// exported, and reported by one R for all.
class PlannedAnalyses : public testing::TestWithParam<std::string> {
protected:
    static void SetUpTestSuite() {
        if (!hasR()) return;
        folder_ = new TempFolder;
        fs::copy(fs::path(PASSUNG_SOURCE_DIR) / "protocols", *folder_ / "protocols", fs::copy_options::recursive);
        std::vector<std::string> reports;
        for (const std::string& study : shippedStudies()) {
            hasten(study);
            runs_[study] = runAndWrite(study);
            if (runs_[study].empty()) reports.push_back(folderOf(study) / "report");
        }
        if (hasReportPackages()) said_ = renderAll(reports, code_);
    }
    static void TearDownTestSuite() {
        delete folder_;
        folder_ = nullptr;
    }
    void SetUp() override {
        if (folder_ == nullptr) GTEST_SKIP() << "R (r-base-core) is not installed: no planned analysis was tried";
        ASSERT_EQ(runs_.at(GetParam()), "");
    }

    static fs::path folderOf(const std::string& study) { return *folder_ / plainName(study); }
    static fs::path fileOf(const std::string& study) { return fs::path(*folder_ / "protocols") / study; }

    static void hasten(const std::string& study) {
        std::string text = readText(fileOf(study));
        std::map<std::string, std::string> quicker = {
            {"cell_mm = 0.5", "cell_mm = 1.0"},  {"spacing_mm = 1.0", "spacing_mm = 3.0"},
            {"timeout_s = 30", "timeout_s = 5"}, {"timeout_s = 60", "timeout_s = 3"},
            {"timeout_s = 90", "timeout_s = 3"}, {"max_trials = 60", "max_trials = 10"}};
        // A secondary task needs its trials.
        if (text.find("[secondary]") == std::string::npos) quicker["repetitions = 2"] = "repetitions = 1";
        for (const auto& [from, to] : quicker)
            for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
                text.replace(at, from.size(), to);
        writeText(fileOf(study), text);
    }

    /// What failed; empty: nothing.
    static std::string runAndWrite(const std::string& study) {
        const fs::path folder = folderOf(study);
        fs::create_directory(folder);
        std::string failed;
        const auto tell = [&](const std::vector<std::string>& words) {
            const Ended ended = runProgram(folder, words);
            if (ended.exit_code != 0) failed += words[0] + ": " + ended.err;
        };
        tell({"run", fileOf(study).string(), "--simulated", "3", "--db", "s.db"});
        const WithoutPrograms alone;
        tell({"report", "s.db", "--out", "report"});
        return failed;
    }

    static TempFolder* folder_;
    static std::map<std::string, std::string> runs_;  // what failed, by study
    static std::string said_;                         // by R while it made the reports
    static int code_;
};

TempFolder* PlannedAnalyses::folder_ = nullptr;
std::map<std::string, std::string> PlannedAnalyses::runs_;
std::string PlannedAnalyses::said_;
int PlannedAnalyses::code_ = 0;

TEST_P(PlannedAnalyses, KeepEveryCountedPersonInR) {
    // Truth: independent program (R 4, base: aggregate, complete.cases, aov) on the tables of the report, which are
    // those of an export; of the database's views Python's sqlite3 and csv.
    const fs::path out = folderOf(GetParam()) / "report";
    int code = 0;
    const std::string views = ask("python3 '" PASSUNG_SOURCE_DIR "/tests/ui/cli/database_views.py' '" +
                                      (folderOf(GetParam()) / "s.db").string() + "' '" + out.string() + "'",
                                  code);
    EXPECT_EQ(code, 0) << views;
    const std::string said =
        askR(std::string(PASSUNG_SOURCE_DIR) + "/tests/ui/cli/planned_analyses.R '" + out.string() + "'", code);
    EXPECT_EQ(code, 0) << said;
    EXPECT_NE(said.find("kept 3 of 3"), std::string::npos) << said;
    // The exported protocol is the study itself: the program reads it with the questionnaires beside it.
    std::string protocol;
    for (const auto& entry : fs::directory_iterator(out / "protocol"))
        if (entry.is_regular_file()) protocol = entry.path().string();
    const Ended check = runProgram(out, {"check", protocol});
    if (readText(fileOf(GetParam())).find("picture = ") == std::string::npos) {
        EXPECT_EQ(check.exit_code, 0) << check.err;
    }
}

TEST_P(PlannedAnalyses, AreReportedWithEveryCountedPerson) {
    // Truth: invariant: each person who counts is in each analysis; R says nothing and leaves nothing out; every number
    // of the page has its id.
    if (!hasReportPackages()) GTEST_SKIP() << kNoReportPackages;
    ASSERT_EQ(code_, 0) << said_;
    EXPECT_EQ(said_, "");
    const fs::path report = folderOf(GetParam()) / "report";
    const std::string results = readText(report / "results.json");
    const std::size_t planned = linesOf(readText(report / "analyses.csv")).size() - 1;
    EXPECT_GT(planned, 0u);
    for (std::size_t i = 1; i <= planned; ++i)
        for (const char* of : {".n", ".n_counted"})
            EXPECT_NE(results.find("\"a" + std::to_string(i) + of + "\": 3,"), std::string::npos) << i << of;
    int code = 0;
    const std::string said = checkPage(report.string(), code);
    EXPECT_EQ(code, 0) << said;
}

INSTANTIATE_TEST_SUITE_P(Shipped, PlannedAnalyses, testing::ValuesIn(shippedStudies()),
                         [](const auto& test) { return plainName(test.param); });

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
