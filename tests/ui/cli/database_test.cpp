#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "study/store/schema/sqlite.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/r_scripts.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

/// What a Python script of this folder prints, with these arguments.
std::string askPython(const std::string& script, const std::string& arguments, int& code) {
    return ask("python3 '" PASSUNG_SOURCE_DIR "/tests/ui/cli/" + script + "' " + arguments, code);
}

/// A study whose factor has the name of a column of other studies, performed by three participants: one as planned, one
/// who is excluded later, one whose session is broken off in a trial.
class QueriedDatabase : public testing::Test {
protected:
    void SetUp() override {
        std::string text = fairStudy();
        const std::string factor = "name = \"chance\"";
        text.replace(text.find(factor), factor.size(), "name = \"level\"");
        writeText(folder_.path() / "study.toml", text);
        ASSERT_EQ(run({"run", "study.toml", "--db", "s.db", "--no-backup", "--simulated", "2"}), 0);
    }
    int run(const std::vector<std::string>& arguments) const { return runProgram(folder_.path(), arguments).exit_code; }
    void breakOff() const {
        Program program(folder_.path(), {"run", "study.toml", "--db", "s.db", "--no-backup", "--simulated", "50"},
                        true);
        EXPECT_NE(program.nextAcknowledgement(), "");
        program.send(SIGINT);
        EXPECT_EQ(program.wait(), 1);
    }
    /// A signal that comes between two trials breaks off none: another one then.
    void breakOffInATrial() const {
        for (int tries = 0; tries < 20 && abortedTrials() == 0; ++tries) breakOff();
        EXPECT_GT(abortedTrials(), 0);
    }
    std::int64_t abortedTrials() const {
        const store::Database database(folder_ / "s.db", store::OpenMode::ReadOnly);
        return database.integer("SELECT count(*) FROM attempt WHERE outcome='aborted'");
    }
    std::string path(const std::string& name) const { return "'" + (folder_.path() / name).string() + "' "; }

    TempFolder folder_;
};

TEST_F(QueriedDatabase, HasViewsThatSayWhatTheExportsTablesSay) {
    // Truth: independent program (Python's sqlite3 and csv) that compares two paths out of the database, SQL and
    // export; a value that is changed in one of them is found.
    breakOffInATrial();
    ASSERT_EQ(run({"participant", "exclude", "s.db", "S002", "--reason", "late"}), 0);
    ASSERT_EQ(run({"export", "s.db", "--out", "out", "--no-samples"}), 0);
    int code = 0;
    const std::string said = askPython("database_views.py", path("s.db") + path("out"), code);
    EXPECT_EQ(code, 0) << said;
    const std::string trials = readText(folder_ / "out/trials.csv");
    for (const char* word : {",level,", ",the participant is excluded,", ",aborted,"})
        EXPECT_NE(trials.find(word), std::string::npos) << word;
    const store::Database database(folder_ / "s.db", store::OpenMode::ReadWrite);
    database.execute(
        "UPDATE attempt_measure SET value_num=value_num*(1+1e-15) WHERE attempt_id=2 AND measure='time_s'");
    EXPECT_NE(askPython("database_views.py", path("s.db") + path("out"), code).find("v_trials"), std::string::npos);
    EXPECT_NE(code, 0);
}

TEST_F(QueriedDatabase, LeavesOutWhatTheProtocolsRulesLeaveOut) {
    // Truth: independent program, as above. The bounds lie between values that the same study has without rules: one
    // trial and one person of two are beyond them.
    std::vector<double> times;
    std::map<std::string, std::vector<double>> of_person;
    ASSERT_EQ(run({"export", "s.db", "--out", "before", "--no-samples"}), 0);
    const fake::CsvFile before = fake::readCsv(readText(folder_ / "before/trials.csv"));
    for (std::size_t row = 0; row < before.rows.size(); ++row) {
        if (before.at(row, "counted") != "1") continue;
        times.push_back(std::stod(before.at(row, "time_s")));
        of_person[before.at(row, "participant_id")].push_back(times.back());
    }
    std::sort(times.begin(), times.end());
    const double above = (times[times.size() - 1] + times[times.size() - 2]) / 2.0;
    std::vector<double> means;
    for (auto& [code, values] : of_person) {
        std::erase_if(values, [&](double time) { return time > above; });
        means.push_back(std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()));
    }
    ASSERT_EQ(means.size(), 2u);
    writeText(folder_ / "study.toml",
              readText(folder_ / "study.toml") +
                  "\n[[exclude]]\ndata = \"trials\"\nvalue = \"time_s\"\nabove = " + std::to_string(above) +
                  "\nreason = \"slow\"\n[[exclude]]\ndata = \"participants\"\nvalue = \"time_s\"\nabove = " +
                  std::to_string((means[0] + means[1]) / 2.0) + "\n");
    ASSERT_EQ(run({"run", "study.toml", "--db", "ruled.db", "--no-backup", "--simulated", "2"}), 0);
    ASSERT_EQ(run({"export", "ruled.db", "--out", "out", "--no-samples"}), 0);
    int code = 0;
    const std::string said = askPython("database_views.py", path("ruled.db") + path("out"), code);
    EXPECT_EQ(code, 0) << said;
    const std::string trials = readText(folder_ / "out/trials.csv");
    EXPECT_NE(trials.find("rule 2: time_s above "), std::string::npos);
    const store::Database database(folder_ / "ruled.db", store::OpenMode::ReadOnly);
    EXPECT_EQ(database.integer("SELECT count(DISTINCT participant_id) FROM v_cells"), 1);
    EXPECT_EQ(database.integer("SELECT count(DISTINCT participant_id) FROM v_trials WHERE counted"), 1);
    EXPECT_EQ(
        database.integer(
            "SELECT count(*) FROM v_trials WHERE not_counted_because LIKE 'rule 1: time_s above % (slow)'") +
            database.integer("SELECT count(*) FROM v_trials WHERE not_counted_because LIKE 'rule 2%' AND time_s>" +
                             std::to_string(above)),
        1);
}

TEST_F(QueriedDatabase, IsReadFromPythonAndRToTheLastBit) {
    // Truth: independent programs (Python's float of the exported text; readers written from the stream's own words).
    if (std::system("Rscript --vanilla -e 'library(RSQLite); library(jsonlite)' > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "R, r-cran-rsqlite or r-cran-jsonlite is not installed";
    ASSERT_EQ(run({"export", "s.db", "--out", "out"}), 0);
    int code = 0;
    const std::string said =
        askPython("database_readers.py", "'" PASSUNG_SOURCE_DIR "' " + path("s.db") + path("out") + "1 4", code);
    EXPECT_EQ(code, 0) << said;
    EXPECT_NE(said.find("compared "), std::string::npos) << said;
}

TEST_F(QueriedDatabase, HasMeasuresThatItsExportedSamplesGiveAgain) {
    // Truth: independent program (R 4, base): read.csv of the samples and the words of the codebook, to 1e-9.
    if (!hasR()) GTEST_SKIP() << "R (r-base-core) is not installed";
    ASSERT_EQ(run({"export", "s.db", "--out", "out"}), 0);
    int code = 0;
    const std::string said =
        askR(PASSUNG_SOURCE_DIR "/tests/ui/cli/measures_again.R " + path("out") + "0.002 0.001 0.001", code);
    EXPECT_EQ(code, 0) << said;
}

TEST_F(QueriedDatabase, IsExportedAsPsychDsToo) {
    // Truth: independent program (Python, by the rules of Psych-DS 0.4): names, headers, variableMeasured.
    ASSERT_EQ(run({"export", "s.db", "--out", "out", "--no-samples", "--format", "psych-ds"}), 0);
    int code = 0;
    const std::string said = askPython("psych_ds.py", path("out"), code);
    EXPECT_EQ(code, 0) << said;
    EXPECT_EQ(run({"export", "s.db", "--out", "other", "--format", "xlsx"}), 2) << "no such format";
}

TEST_F(QueriedDatabase, IsExportedForOthersThanTheLab) {
    // Truth: invariant: what is asked for is there or refused; simulated participants stay as they are.
    ASSERT_EQ(run({"export", "s.db", "--out", "open", "--no-samples"}), 0);
    ASSERT_EQ(run({"export", "s.db", "--out", "out", "--no-samples", "--anonymous"}), 0);
    EXPECT_EQ(readText(folder_ / "out/events.csv"), readText(folder_ / "open/events.csv"));
    EXPECT_NE(readText(folder_ / "out/codebook.csv").find("anonymity.csv,"), std::string::npos);
    EXPECT_EQ(run({"export", "s.db", "--out", "other", "--band", "a.b=10"}), 2) << "needs --anonymous";
    EXPECT_EQ(run({"export", "s.db", "--out", "other", "--anonymous", "--band", "a.b"}), 1);
    EXPECT_EQ(run({"export", "s.db", "--out", "other", "--anonymous", "--band", "a.b=10"}), 1) << "nobody was asked";
    EXPECT_FALSE(std::filesystem::exists(folder_ / "other"));
}

}  // namespace
}  // namespace passung::test
