#include <gtest/gtest.h>

#include <thread>

#include "study/store/schema/sqlite.h"
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
    const std::string balance =
        "\nslots of version 1.0, simulated: 2 participants; all rows and groups meet equally often with multiples of "
        "2.\n  conditions, Williams square of 2 (2 rows): position counts 1, neighbour counts 1\n";
    EXPECT_EQ(merged.out, "ALL.db: 2 sessions added, 0 brought up to date, 0 known\n" + balance) << merged.err;
    EXPECT_EQ(runProgram(folder.path(), merge).out,
              "ALL.db: 0 sessions added, 0 brought up to date, 2 known\n" + balance);
    const auto list = linesOf(runProgram(folder.path(), {"participant", "list", "ALL.db"}).out);
    ASSERT_EQ(list.size(), 6u);
    EXPECT_NE(list[1].find("SA001        simulated  complete     1.1 1.0 "), std::string::npos) << list[1];
    EXPECT_NE(list[2].find("SB001        simulated  complete     2.2 1.0 "), std::string::npos) << list[2];
    EXPECT_EQ(list[3] + "\n" + list[4] + "\n" + list[5] + "\n", balance);
    EXPECT_EQ(runProgram(folder.path(), {"replay", "ALL.db"}).exit_code, 0);
}

TEST(Stations, AChangedVersionCountsItsSlotsApartAndTheListSaysSo) {
    // Truth: invariant: two people in slot 1.1, of different protocols.
    const TempFolder folder;
    std::string study = smallStudy();
    writeText(folder / "study.toml", study);
    const std::vector<std::string> run = {"run", "study.toml", "--db", "s.db", "--no-backup"};
    ASSERT_EQ(runProgram(folder.path(), run).exit_code, 0);
    EXPECT_EQ(runProgram(folder.path(), {"participant", "list", "s.db"}).out.find("warning"), std::string::npos);
    study.replace(study.find("\"1.0\""), 5, "\"1.1\"");
    writeText(folder / "study.toml", study);
    ASSERT_EQ(runProgram(folder.path(), run).exit_code, 0);
    const std::string list = runProgram(folder.path(), {"participant", "list", "s.db"}).out;
    EXPECT_NE(list.find("S001         simulated  complete     1.1 1.0 "), std::string::npos) << list;
    EXPECT_NE(list.find("S002         simulated  complete     1.1 1.1 "), std::string::npos) << list;
    EXPECT_NE(list.find("warning: versions 1.0, 1.1 of the protocol count their slots apart"), std::string::npos)
        << list;
}

TEST(Stations, ExplainShowsTheOrdersOfSeveral) {
    // Truth: closed form: two rows; what one station shows as 1st and 2nd, two stations show too.
    const TempFolder folder;
    writeText(folder / "study.toml", smallStudy());
    const auto explain = [&](const std::string& stations) {
        return runProgram(folder.path(), {"explain", "study.toml", "--participants", "2", "--stations", stations}).out;
    };
    const std::string one = explain("1"), two = explain("2");
    const auto order = [](const std::string& text, const std::string& code) {
        const auto at = text.find("  " + code + "  ");
        return at == std::string::npos ? code + " is missing" : text.substr(at + 4 + code.size(), 3);
    };
    EXPECT_EQ(order(one, "P001"), order(two, "PA001"));
    EXPECT_EQ(order(one, "P002"), order(two, "PB001"));
    EXPECT_NE(two.find("position counts 1, neighbour counts 1\n"), std::string::npos) << two;
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
