#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "core/base/digest.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/r_scripts.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSource = PASSUNG_SOURCE_DIR "/tests/ui/cli/";

/// A factor of a random study.
struct RandomFactor {
    std::string name, table;  // table: its lines in the protocol
    int levels;
    bool between;
    std::string first = {}, contrast = {};  // its first level; a difference that may be planned, not in its order
};

/// A study that nobody wrote, and what it plans as the second path reads it.
struct RandomStudy {
    std::string protocol, excluded;
    std::string spec =
        "analysis,outcome,block,test,horizon_s,factors,within,between,transform,contrast,low,high,family,covariate\n";
    std::string rules = "data,value,below,above\n";
    int participants = 0;
};

/// What a planned analysis has beside outcome, factors and test.
struct Planned {
    std::string transform = {}, contrast = {}, low = {}, high = {}, family = {}, covariate = {};
    std::string outcome = {}, block = "main";  // outcome: empty: drawn
};

class StudyMaker {
public:
    explicit StudyMaker(unsigned seed) : random_(seed) {}

    RandomStudy make() {
        chooseFactors();
        RandomStudy study;
        const int groups = between_.size() == 2 ? 4 : between_.size() == 1 ? 2 : 1;
        study.participants = groups == 1 ? 5 + upTo(2) : groups * 3 + upTo(3);
        const std::string timeout = std::vector<std::string>{"3.3", "3.6", "6"}[static_cast<std::size_t>(upTo(2))];
        study.protocol = smallStudy("random");
        const auto replace = [&](const std::string& from, const std::string& to, const std::string& by) {
            const std::size_t begin = study.protocol.find(from), end = study.protocol.find(to, begin);
            study.protocol.replace(begin, end - begin, by);
        };
        std::string factors;
        for (const RandomFactor& factor : within_) factors += factor.table;
        for (const RandomFactor& factor : between_) factors += factor.table;
        if (upTo(1) == 0) {
            factors +=
                "[[factor]]\nname = \"gate\"\nkey = \"start_gate.hold_ms\"\nlevels = [{ label = \"short\", value = 20 "
                "}, "
                "{ label = \"long\", value = 25, catch = true }]\n";
            study.protocol += "catch_trials = 1\n";
        }
        replace("[[factor]]", "[task]", factors);
        replace("timeout_s = 20", "\n", "timeout_s = " + timeout);
        replace("participants = 4", "\n", "participants = " + std::to_string(study.participants));
        replace("repetitions = 3", "\n", "repetitions = " + std::to_string(within_.size() > 1 ? 1 : 1 + upTo(1)));
        replace("order = \"williams\"", "\n", "order = \"random\"");
        study.protocol +=
            "\n[[block]]\nname = \"again\"\norder = \"random\"\nconditions = [{ " + within_.front().name + " = " +
            within_.front().first + " }]\n" + (upTo(1) == 0 ? "session = 2\n" : "") +
            "\n[[questionnaire]]\nfile = \"" PASSUNG_SOURCE_DIR
            "/protocols/questionnaires/nasa_tlx_raw.toml\"\nmoment = \"after_condition\"\nblock = \"main\"\n";
        plan(study, timeout);
        rule(study, "trials", "contact_onsets", "", upTo(1) == 0 ? "40" : "12");
        rule(study, "participants", "success", "0.1", "");
        if (upTo(1) == 0) study.excluded = "S00" + std::to_string(1 + upTo(4));
        return study;
    }

private:
    /// From 0, evenly; by the remainder, which is the same everywhere.
    int upTo(int most) { return static_cast<int>(random_() % static_cast<unsigned>(most + 1)); }

    static void rule(RandomStudy& study, const std::string& data, const std::string& value, const std::string& below,
                     const std::string& above) {
        study.protocol += "\n[[exclude]]\ndata = \"" + data + "\"\nvalue = \"" + value + "\"\n";
        if (!below.empty()) study.protocol += "below = " + below + "\n";
        if (!above.empty()) study.protocol += "above = " + above + "\n";
        study.rules += data + "," + value + "," + below + "," + above + "\n";
    }

    void chooseFactors() {
        const std::vector<RandomFactor> within = {
            {"method",
             "[[factor]]\nname = \"method\"\nkey = \"contact.method\"\nlevels = [\"penalty\", \"god_object\"]\n", 2,
             false, "\"penalty\"", "method: god_object - penalty"},
            {"push",
             "[[factor]]\nname = \"push\"\nkey = \"contact.stiffness_N_per_m\"\nlevels = [\"0.5 max\", \"0.7 max\", "
             "\"max\"]\n",
             3, false, "\"0.5 max\"", "push: max - 0.5 max"},
            {"deep", "[[factor]]\nname = \"deep\"\nkey = \"task.insertion_depth_mm\"\nlevels = [6, 7]\n", 2, false,
             "\"6\"", "deep: 7 - 6"}};
        const std::vector<RandomFactor> between = {
            {"side",
             "[[factor]]\nname = \"side\"\nkind = \"between\"\nkey = \"part.peg.pose.position\"\nlevels = [{ label = "
             "\"right\", value = [4, 0, 8] }, { label = \"left\", value = [-4, 0, 8] }]\n",
             2, true},
            {"hold", "[[factor]]\nname = \"hold\"\nkind = \"between\"\nkey = \"task.hold_s\"\nlevels = [0.05, 0.1]\n",
             2, true}};
        const int first = upTo(2), count = 1 + upTo(2);
        for (int i = 0; i < count; ++i) within_.push_back(within[static_cast<std::size_t>((first + i) % 3)]);
        const int groups = upTo(2);
        for (int i = 0; i < groups; ++i) between_.push_back(between[static_cast<std::size_t>(i)]);
    }

    static std::string namesOf(const std::vector<RandomFactor>& factors, const char* quote, const char* parted) {
        std::string text;
        for (const RandomFactor& factor : factors) text += (text.empty() ? "" : parted) + (quote + factor.name) + quote;
        return text;
    }

    /// One analysis in both texts.
    void planOne(RandomStudy& study, const std::string& test, const std::string& timeout,
                 const std::vector<RandomFactor>& within, const std::vector<RandomFactor>& between,
                 const Planned& more = {}) {
        const std::string outcome =
            !more.outcome.empty()
                ? more.outcome
                : std::vector<std::string>{"time_s", "path_length_m"}[static_cast<std::size_t>(upTo(1))];
        const bool blocks = !within.empty() && within.front().name == "block";
        std::vector<RandomFactor> all = within;
        all.insert(all.end(), between.begin(), between.end());
        study.protocol += "\n[[analysis]]\noutcome = \"" + outcome + "\"\ntest = \"" + test + "\"\n";
        const auto key = [&](const char* name, const std::string& value) {
            if (!value.empty()) study.protocol += name + (" = " + value) + "\n";
        };
        if (!blocks && !more.block.empty()) key("block", "\"" + more.block + "\"");
        if (!more.transform.empty()) key("transform", "\"" + more.transform + "\"");
        if (!more.contrast.empty()) key("contrasts", "[\"" + more.contrast + "\"]");
        if (!more.low.empty()) key("equivalence_bounds", "[" + more.low + ", " + more.high + "]");
        if (!more.family.empty()) key("family", "\"" + more.family + "\"");
        if (!more.covariate.empty()) key("covariates", "[\"" + more.covariate + "\"]");
        if (!all.empty()) study.protocol += "factors = [" + namesOf(all, "\"", ", ") + "]\n";
        study.spec += std::to_string(++analyses_) + "," + outcome + "," + (blocks ? "" : more.block) + "," + test +
                      "," + timeout + "," + namesOf(all, "", ";") + "," + namesOf(within, "", ";") + "," +
                      namesOf(between, "", ";") + "," + more.transform + "," + more.contrast + "," + more.low + "," +
                      more.high + "," + more.family + "," + more.covariate + "\n";
    }

    /// Every test that these factors allow.
    void plan(RandomStudy& study, const std::string& timeout) {
        const RandomFactor& one = within_[static_cast<std::size_t>(upTo(static_cast<int>(within_.size()) - 1))];
        planOne(study, "rm_anova", timeout, within_, {});
        planOne(study, "lmm", timeout, {one}, between_);
        planOne(study, "mean", timeout, {}, {});
        if (!between_.empty()) planOne(study, "mixed_anova", timeout, within_, between_);
        for (const RandomFactor& group : between_) {
            planOne(study, "welch_t", timeout, {}, {group});
            planOne(study, "mann_whitney", timeout, {}, {group});
        }
        for (const RandomFactor& factor : within_)
            for (const char* test : {"paired_t", "wilcoxon", "friedman"})
                if ((factor.levels > 2) == (std::string(test) == "friedman"))
                    planOne(study, test, timeout, {factor}, {}, {.family = "ranks"});
        planOne(study, "rm_anova", timeout, within_, {},
                {.transform = "log", .contrast = one.contrast, .outcome = "path_length_m"});
        planOne(study, "lmm", timeout, {one}, {}, {.covariate = "order_position", .outcome = "path_length_m"});
        planOne(study, "survival", timeout, within_, {}, {.outcome = "time_s"});
        planOne(study, "paired_t", timeout, {{"block", "", 2, false}}, {}, {.outcome = "path_length_m"});
        planOne(study, "mean", timeout, {}, {}, {.outcome = "nasa_tlx_raw.workload"});
        if (one.levels == 2)
            planOne(study, "equivalence", timeout, {one}, {},
                    {.low = "-0.01", .high = "0.02", .outcome = "path_length_m"});
        if (!between_.empty())
            planOne(study, "equivalence", timeout, {}, {between_.front()},
                    {.low = "-0.01", .high = "0.02", .outcome = "path_length_m"});
    }

    std::mt19937 random_;
    std::vector<RandomFactor> within_, between_;
    int analyses_ = 0;
};

/// Studies of all seeds, run and written, and their reports by one R.
class RandomProtocols : public testing::TestWithParam<unsigned> {
protected:
    struct Made {
        RandomStudy study;
        TempFolder folder;
        std::string failed;
    };

    static unsigned seeds() { return std::getenv("PASSUNG_LONG") != nullptr ? 200 : 12; }

    static void SetUpTestSuite() {
        if (!hasReportPackages()) return;
        std::vector<std::string> folders;
        for (unsigned seed = 1; seed <= seeds(); ++seed) {
            made_.push_back(std::make_unique<Made>());
            make(seed, *made_.back());
            if (made_.back()->failed.empty()) folders.push_back(made_.back()->folder / "out");
        }
        said_ = renderAll(folders, code_);
    }
    static void TearDownTestSuite() { made_.clear(); }

    static void make(unsigned seed, Made& made) {
        made.study = StudyMaker(seed).make();
        const RandomStudy& study = made.study;
        writeText(made.folder / "study.toml", study.protocol);
        writeText(made.folder / "spec.csv", study.spec);
        writeText(made.folder / "rules.csv", study.rules);
        const auto tell = [&](const std::vector<std::string>& words) {
            const Ended ended = runProgram(made.folder.path(), words);
            if (ended.exit_code != 0) made.failed += words[0] + ": " + ended.err;
        };
        tell({"run", "study.toml", "--simulated", std::to_string(study.participants), "--db", "s.db"});
        if (!study.excluded.empty() && seed % 2 == 0)
            tell({"participant", "exclude", "s.db", study.excluded, "--reason", "late"});
        if (!study.excluded.empty() && seed % 2 != 0)
            tell({"participant", "withdraw", "s.db", study.excluded, "--scope", "exclude"});
        const WithoutPrograms alone;
        tell({"report", "s.db", "--out", "out"});
        if (made.failed.empty()) leaveOutExploratory(made.folder / "out/analysis.Rmd");
    }

    /// Which the second path does not look at.
    static void leaveOutExploratory(const fs::path& file) {
        std::string text = readText(file);
        const std::size_t begin = text.find("# Exploratory\n"), end = text.find("```{r results,");
        writeText(file, text.substr(0, begin) + text.substr(end));
    }

    void SetUp() override {
        if (made_.empty()) GTEST_SKIP() << kNoReportPackages;
    }

    static std::vector<std::unique_ptr<Made>> made_;
    static std::string said_;  // by R while it made the reports
    static int code_;
};

std::vector<std::unique_ptr<RandomProtocols::Made>> RandomProtocols::made_;
std::string RandomProtocols::said_;
int RandomProtocols::code_ = 0;

TEST_P(RandomProtocols, AreTestedInTheReportAsInBaseR) {
    // Truth: independent program (R 4, base): report_oracle.R, written from the definitions of the statistics, on
    // trials.csv and codebook.csv alone; 1e-8, likelihoods 1e-4.
    const Made& made = *made_[GetParam() - 1];
    ASSERT_EQ(made.failed, "") << made.study.protocol;
    ASSERT_EQ(code_, 0) << said_;
    EXPECT_EQ(said_, "");
    int code = 0;
    const std::string said =
        askR(std::string(kSource) + "report_oracle.R '" + (made.folder / "out") + "' '" + (made.folder / "spec.csv") +
                 "' '" + (made.folder / "rules.csv") + "' '" + made.study.excluded + "'",
             code);
    EXPECT_EQ(code, 0) << said << made.study.protocol;
    EXPECT_NE(said.find(" numbers compared, 0 wrong"), std::string::npos) << said;
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomProtocols,
                         testing::Range(1u, std::getenv("PASSUNG_LONG") != nullptr ? 201u : 13u));

/// A small study with six people, of whom one is excluded, and its report. Title and levels look like R and Markdown.
class Report : public testing::Test {
protected:
    static void SetUpTestSuite() {
        if (!hasReportPackages()) return;
        folder_ = new TempFolder;
        std::string text = smallStudy();
        const std::size_t factor = text.find("[[factor]]");
        text.replace(factor, text.find("[task]") - factor, R"([[factor]]
name = "method"
key = "contact.method"
levels = [{ label = '"a" <i> \ & ü', value = "penalty" }, { label = '`r stop(2)` *b*', value = "god_object" }]
[[factor]]
name = "push"
key = "contact.stiffness_N_per_m"
levels = ["0.5 max", "max"]

)");
        text.replace(text.find("timeout_s = 20"), 14, "timeout_s = 3.5");
        text.insert(text.find("version = "), "title = 'A \"study\" of `r stop(1)` & <b> *more* $x$'\n");
        text.replace(text.find("repetitions = 3"), 15, "repetitions = 1");
        text += "[[analysis]]\noutcome = \"time_s\"\nfactors = [\"method\", \"push\"]\ntest = \"rm_anova\"\n";
        writeText(*folder_ / "study.toml", text);
        runProgram(folder_->path(), {"run", "study.toml", "--simulated", "6", "--db", "s.db"});
        runProgram(folder_->path(), {"participant", "exclude", "s.db", "S002", "--reason", "late"});
        report_ = runProgram(folder_->path(), {"report", "s.db", "--out", "out"});
    }
    static void TearDownTestSuite() {
        delete folder_;
        folder_ = nullptr;
    }
    void SetUp() override {
        if (folder_ == nullptr) GTEST_SKIP() << kNoReportPackages;
        ASSERT_EQ(report_.exit_code, 0) << report_.err;
    }

    static fs::path out() { return folder_->path() / "out"; }
    /// A copy of the report's folder at a place of its own.
    static fs::path copyTo(const TempFolder& place) {
        fs::copy(out(), place.path() / "copy", fs::copy_options::recursive);
        return place.path() / "copy";
    }
    static std::string renderAlone(const fs::path& folder, int& code) {
        return askR("-e 'setwd(\"" + folder.string() + "\"); rmarkdown::render(\"analysis.Rmd\", quiet = TRUE)'", code);
    }

    static TempFolder* folder_;
    static Ended report_;
};

TempFolder* Report::folder_ = nullptr;
Ended Report::report_;

TEST_F(Report, ShowsEveryNumberWithItsEntryOfTheResults) {
    // Truth: closed form (a number that is shown is the stored one, rounded), read from the page's bytes.
    int code = 0;
    const std::string said = checkPage(out().string(), code);
    EXPECT_EQ(code, 0) << said;
    EXPECT_EQ(report_.err, "");
    const std::string page = readText(out() / "report.html");
    EXPECT_NE(page.find("Simulated participants"), std::string::npos);
    EXPECT_NE(page.find("&quot;study&quot; of `r stop(1)` &amp; &lt;b&gt; *more* $x$</title>"), std::string::npos);
    EXPECT_NE(page.find("`r stop(2)` *b*"), std::string::npos);
}

TEST_F(Report, IsMadeAgainByRAloneWithTheSameResults) {
    // Truth: invariant (the folder's bytes decide the results).
    const TempFolder place;
    const fs::path copy = copyTo(place);
    const std::string before = readText(copy / "results.json");
    fs::remove(copy / "results.json");
    fs::remove(copy / "report.html");
    int code = 0;
    const std::string said = renderAlone(copy, code);
    ASSERT_EQ(code, 0) << said;
    EXPECT_EQ(readText(copy / "results.json"), before);
}

TEST_F(Report, StopsAtOneChangedCell) {
    // Truth: invariant (a table that is not the written one has another SHA-256).
    const TempFolder place;
    const fs::path copy = copyTo(place);
    std::string text = readText(copy / "cells_long.csv");
    const std::size_t digit = text.find_last_of("123456789");
    text[digit] = text[digit] == '1' ? '2' : '1';
    writeText(copy / "cells_long.csv", text);
    fs::remove(copy / "results.json");
    int code = 0;
    const std::string said = renderAlone(copy, code);
    EXPECT_NE(code, 0);
    EXPECT_NE(said.find("cells_long.csv: is not the file that was written into this folder"), std::string::npos)
        << said;
    EXPECT_FALSE(fs::exists(copy / "results.json"));
}

TEST_F(Report, NamesWhomCompleteCasesLeaveOut) {
    // Truth: independent program (R 4: reshape, complete.cases), 200 times.
    int code = 0;
    const std::string said = askR(std::string(kSource) + "report_left_out.R '" + out().string() + "' 200", code);
    EXPECT_EQ(code, 0) << said;
    EXPECT_NE(said.find("200 of 200 times"), std::string::npos) << said;
}

TEST_F(Report, SaysDifferOfTimesThatTimeOutsCutOffWhereTheyDo) {
    // Truth: closed form (the shares of time-outs are drawn by the script): studies that differ, and such that do not;
    // 200 and 2 000, or 40 and 200.
    int code = 0;
    const std::string said = askR(std::string(kSource) + "report_censored.R '" + out().string() +
                                      (std::getenv("PASSUNG_LONG") != nullptr ? "' 200 2000" : "' 40 200"),
                                  code);
    EXPECT_EQ(code, 0) << said;
}

TEST_F(Report, ComputesModelsAndFunctionsOfDrawnDataAsTheirDefinitionsSay) {
    // Truth: closed forms and drawn data: report_models.R.
    int code = 0;
    const std::string said = askR(std::string(kSource) + "report_models.R '" + out().string() +
                                      (std::getenv("PASSUNG_LONG") != nullptr ? "' 1000" : "' 6"),
                                  code);
    EXPECT_EQ(code, 0) << said;
}

TEST_F(Report, ShowsTicksAsTheyWereRecorded) {
    // Truth: invariant (`passung export` with all ticks of the same data): report_courses.R.
    ASSERT_EQ(runProgram(folder_->path(), {"export", "s.db", "--out", "all"}).exit_code, 0);
    int code = 0;
    const std::string said =
        askR(std::string(kSource) + "report_courses.R '" + out().string() + "' '" + (*folder_ / "all") + "'", code);
    EXPECT_EQ(code, 0) << said;
}

TEST_F(Report, ListsAnEditedTextAndATestThatIsNoLongerThere) {
    // Truth: invariant (the text was edited here).
    const TempFolder place;
    const fs::path copy = copyTo(place);
    const std::string text = readText(copy / "analysis.Rmd");
    writeText(copy / "analysis.Rmd", text.substr(0, text.find("# Balance of positions\n")));
    int code = 0;
    const std::string said = renderAlone(copy, code);
    ASSERT_EQ(code, 0) << said;
    const std::string page = readText(copy / "analysis.html");
    EXPECT_NE(page.find("was edited after it was written"), std::string::npos);
    EXPECT_NE(page.find("no longer has the test that was planned"), std::string::npos);
    EXPECT_EQ(readText(out() / "report.html").find("was edited after it was written"), std::string::npos);
}

TEST_F(Report, HasTheTablesOfAnExportAndNoPlaceOfTheMachine) {
    // Truth: invariant (`passung export` of the same data).
    ASSERT_EQ(runProgram(folder_->path(), {"export", "s.db", "--out", "tables", "--no-samples"}).exit_code, 0);
    std::size_t tables = 0;
    for (const auto& entry : fs::directory_iterator(folder_->path() / "tables")) {
        const std::string name = entry.path().filename();
        if (!entry.is_regular_file() || name == "README.md" || name == "SHA256SUMS" || name == "codebook.json")
            continue;
        if (name == "codebook.csv") {  // has a file more
            const std::string more = readText(out() / name);
            for (const std::string& line : linesOf(readText(entry.path())))
                EXPECT_NE(more.find(line + "\n"), std::string::npos) << line;
            continue;
        }
        EXPECT_EQ(readText(entry.path()), readText(out() / name)) << name;
        ++tables;
    }
    EXPECT_GT(tables, 10u);
    for (const char* name : {"analysis.Rmd", "report.R", "report.html", "results.json"})
        EXPECT_EQ(readText(out() / name).find(folder_->path().string()), std::string::npos) << name;
    std::string sums = readText(out() / "SHA256SUMS");
    for (const std::string& line : linesOf(sums))
        EXPECT_EQ(line.substr(0, 64), sha256Hex(readText(out() / line.substr(66)))) << line;
    EXPECT_NE(sums.find("  results.json\n"), std::string::npos);
}

TEST_F(Report, KeepsATextThatSomebodyEdited) {
    // Truth: invariant (no edited byte is lost).
    const std::string edited = readText(out() / "analysis.Rmd") + "\nMine.\n";
    const TempFolder place;
    const fs::path copy = copyTo(place);
    writeText(copy / "analysis.Rmd", edited);
    const WithoutPrograms alone;
    const Ended again = runProgram(place.path(), {"report", (folder_->path() / "s.db").string(), "--out", "copy"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_NE(again.err.find("kept as"), std::string::npos) << again.err;
    EXPECT_EQ(readText(place.path() / "copy.backup.1" / "analysis.Rmd"), edited);
    EXPECT_EQ(readText(copy / "analysis.Rmd"), readText(out() / "analysis.Rmd"));
}

TEST(ReportOfNothing, SaysWhatRCouldNotComputeAndGoesOn) {
    // Truth: closed form (all trials end at their time-out: cells are alike, and differences of them are 0).
    if (!hasReportPackages()) GTEST_SKIP() << kNoReportPackages;
    const TempFolder folder;
    std::string text = smallStudy();
    text.replace(text.find("\"task.timeout_s\" = 20"), 21, "\"task.timeout_s\" = 0.4");
    text.replace(text.find("repetitions = 3"), 15, "repetitions = 1");
    text += "[[analysis]]\noutcome = \"time_s\"\nfactors = [\"chance\"]\ntest = \"wilcoxon\"\n";
    writeText(folder / "study.toml", text);
    ASSERT_EQ(runProgram(folder.path(), {"run", "study.toml", "--simulated", "4", "--db", "s.db"}).exit_code, 0);
    const Ended report = runProgram(folder.path(), {"report", "s.db", "--out", "out"});
    EXPECT_EQ(report.exit_code, 0) << report.err;
    EXPECT_NE(report.err.find("not computed: a1: all pairwise differences equal zero"), std::string::npos)
        << report.err;
    EXPECT_NE(readText(folder / "out/results.json").find("\"a1.n\": 4,"), std::string::npos);
}

TEST(ReportWithoutR, IsCompleteButForThePageAndNamesTheLineThatInstallsIt) {
    // Truth: invariant (a search path without programs has no R).
    const TempFolder folder;
    writeText(folder / "study.toml",
              smallStudy() + "[[analysis]]\noutcome = \"time_s\"\nfactors = [\"chance\"]\ntest = \"paired_t\"\n");
    ASSERT_EQ(runProgram(folder.path(), {"run", "study.toml", "--simulated", "1", "--db", "s.db"}).exit_code, 0);
    const WithoutPrograms alone;
    const Ended report = runProgram(folder.path(), {"report", "s.db", "--out", "out"});
    EXPECT_EQ(report.exit_code, 0) << report.err;
    EXPECT_NE(report.out.find("apt install r-base-core pandoc r-cran-rmarkdown"), std::string::npos) << report.out;
    EXPECT_NE(report.out.find("r-cran-effectsize r-cran-survival"), std::string::npos) << report.out;
    for (const char* name : {"analysis.Rmd", "report.R", "report.css", "trials.csv", "SHA256SUMS"})
        EXPECT_TRUE(fs::exists(folder.path() / "out" / name)) << name;
    for (const char* name : {"report.html", "results.json"})
        EXPECT_FALSE(fs::exists(folder.path() / "out" / name)) << name;
    fs::create_directory(folder / "mine");
    writeText(folder / "mine/notes.txt", "mine");
    const Ended refused = runProgram(folder.path(), {"report", "s.db", "--out", "mine"});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.err.find("mine: error: "), std::string::npos) << refused.err;
    EXPECT_EQ(readText(folder / "mine/notes.txt"), "mine");
}

}  // namespace
}  // namespace passung::test
