#include <gtest/gtest.h>

#include <thread>

#include "study/store/sqlite.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

TEST(Stations, RunApartAndAreMergedIntoOneDatabase) {
    // Truth: invariant. Two stations, one participant each: codes with their letters, places in different replicates.
    const TempFolder folder;
    writeText(folder / "study.toml", smallStudy());
    for (const std::string letter : {"A", "B"}) {
        const Ended run = runProgram(
            folder.path(), {"run", "study.toml", "--db", letter + ".db", "--station", letter, "--stations", "2"});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_NE(run.out.find("S" + letter + "001 (1 of 1): 6 trials"), std::string::npos) << run.out;
        EXPECT_TRUE(std::filesystem::exists(folder / (letter + ".db.backup.sha256")));
    }
    const std::vector<std::string> merge = {"merge", "A.db", "B.db", "--out", "ALL.db"};
    const Ended merged = runProgram(folder.path(), merge);
    EXPECT_EQ(merged.out, "ALL.db: 2 sessions added, 0 brought up to date, 0 known\n") << merged.err;
    EXPECT_EQ(runProgram(folder.path(), merge).out, "ALL.db: 0 sessions added, 0 brought up to date, 2 known\n");
    const auto list = linesOf(runProgram(folder.path(), {"participant", "list", "ALL.db"}).out);
    ASSERT_EQ(list.size(), 3u);
    EXPECT_NE(list[1].find("SA001        simulated  complete     1.1"), std::string::npos) << list[1];
    EXPECT_NE(list[2].find("SB001        simulated  complete     2.1"), std::string::npos) << list[2];
    EXPECT_EQ(runProgram(folder.path(), {"replay", "ALL.db"}).exit_code, 0);
}

TEST(Stations, AResumedSessionKeepsToItsStationsPlaces) {
    // Truth: invariant: of two stations the second has the odd replicates, before an interruption and after it.
    const TempFolder folder;
    writeText(folder / "study.toml", smallStudy());
    const std::vector<std::string> station = {"--station", "B", "--stations", "2"};
    {
        std::vector<std::string> run = {"run", "study.toml", "--db", "B.db", "--wait"};
        run.insert(run.end(), station.begin(), station.end());
        Program program(folder.path(), run, true);
        const auto waits = [&] {
            return std::filesystem::exists(folder / ".out") && program.out().find("waits for") != std::string::npos;
        };
        while (!waits()) std::this_thread::yield();
        program.killNow();
        ASSERT_EQ(program.wait(), -SIGKILL);
    }
    const Ended elsewhere = runProgram(folder.path(), {"resume", "B.db"});
    EXPECT_EQ(elsewhere.exit_code, 1);
    EXPECT_EQ(elsewhere.err,
              "B.db: error: SB001, session 1: ran at station B: name --station B and --stations, as for run\n");
    std::vector<std::string> resume = {"resume", "B.db"};
    resume.insert(resume.end(), station.begin(), station.end());
    const Ended resumed = runProgram(folder.path(), resume);
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    const store::Database database(folder / "B.db", store::OpenMode::ReadOnly);
    EXPECT_EQ(database.text("SELECT (replicate % 2) || station FROM design_slot WHERE participant_id='SB001'"), "1B");
}

TEST(Stations, WrongUsageAndWrongInputAreToldApart) {
    // Truth: invariant (the contract of the command line)
    const TempFolder folder;
    writeText(folder / "study.toml", smallStudy());
    const auto ends = [&](const std::vector<std::string>& arguments, int code) {
        const Ended ended = runProgram(folder.path(), arguments);
        EXPECT_EQ(ended.exit_code, code) << ended.err;
        return ended.err;
    };
    ends({"merge", "A.db"}, 2);
    ends({"push", "A.db"}, 2);
    ends({"run", "study.toml", "--station", "B"}, 2);
    ends({"run", "study.toml", "--station", "b", "--stations", "2"}, 2);
    EXPECT_NE(ends({"run", "study.toml", "--station", "C", "--stations", "2"}, 1).find("2 stations are A to B"),
              std::string::npos);
    EXPECT_NE(ends({"merge", "A.db", "--out", "ALL.db"}, 1).find("A.db: error: no such file"), std::string::npos);
    EXPECT_NE(ends({"merge", "A.db", "study.toml", "--out", "study.toml"}, 1).find("is an input"), std::string::npos);
    EXPECT_NE(ends({"push", "A.db", "--to", "postgresql:///x"}, 1).find("no such file"), std::string::npos);
}

}  // namespace
}  // namespace passung::test
