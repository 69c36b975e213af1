#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

// The log beside a study's database, and the report that takes it along.

namespace passung::test {
namespace {

namespace fs = std::filesystem;

class LogTest : public testing::Test {
protected:
    LogTest() {
        setenv("XDG_DATA_HOME", (folder_ / "data").c_str(), 1);  // logs of the windows would be found there
        std::string study = smallStudy();
        study.replace(study.find("repetitions = 3"), 15, "repetitions = 1");
        writeText(folder_ / "study.toml", study);
    }

    Ended run(const std::vector<std::string>& arguments) const { return runProgram(folder_.path(), arguments); }
    std::string log() const { return readText(folder_ / "s.db.log"); }
    unsigned modeOf(const char* name) const {
        struct stat file = {};
        return stat((folder_ / name).c_str(), &file) == 0 ? file.st_mode & 0777 : 0;
    }
    static void expectHolds(const std::string& text, const std::vector<std::string>& parts) {
        std::size_t at = 0;
        for (const std::string& part : parts) {
            const std::size_t found = text.find(part, at);
            ASSERT_NE(found, std::string::npos) << part << " in\n" << text.substr(at);
            at = found + part.size();
        }
    }

    TempFolder folder_;
};

TEST_F(LogTest, OfARunTellsWhatRanOnWhatAndHowWell) {
    // Truth: closed form, in this order: two trials in virtual time, of which no time is measured
    ASSERT_EQ(run({"run", "study.toml", "--db", "s.db", "--no-backup"}).exit_code, 0);
    expectHolds(
        log(),
        {"info: passung " PASSUNG_VERSION " starts; numerics ", "info: run of protocol ", "info: store created\n",
         "info: participant 1 of 1\n", "info: session begins: virtual time, 2 trials, device sigma7 (Force Dimension",
         "info: attempt 1 begins: trial ", "info: attempt 1 stored: loop virtual, ", " ticks, 0 records dropped\n",
         "info: attempt 2 stored: ", "info: session complete\n", "info: run complete\n"});
    EXPECT_EQ(modeOf("s.db.log"), 0600u);
    ASSERT_EQ(run({"run", "study.toml", "--db", "s.db", "--no-backup", "--group", "--real-time"}).exit_code, 0);
    expectHolds(log(), {"run complete\n", "store opened\n", "session begins: real time", ": loop real-time ",
                        " cycles missed, computed in mean ", "run complete\n"});
    EXPECT_EQ(modeOf("s.db.log"), 0660u);
    ASSERT_EQ(run({"export", "s.db", "--out", "out"}).exit_code, 0);
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path() / "out"))
        EXPECT_EQ(entry.path().string().find(".log"), std::string::npos) << entry.path();
}

TEST_F(LogTest, OfARefusedInputHasItsPlaceAndNotItsValue) {
    // Truth: closed form; where no study ran, none is begun.
    std::string study = readText(folder_ / "study.toml");
    study.replace(study.find("preset = \"sigma7\""), 17, "preset = \"zaubernuss\"");
    writeText(folder_ / "bad.toml", study);
    const auto refused = [&] { return run({"run", "bad.toml", "--db", "s.db", "--no-backup"}); };
    EXPECT_NE(refused().err.find("zaubernuss"), std::string::npos);
    EXPECT_FALSE(fs::exists(folder_ / "s.db.log"));
    ASSERT_EQ(run({"run", "study.toml", "--db", "s.db", "--no-backup"}).exit_code, 0);
    EXPECT_EQ(refused().exit_code, 1);
    expectHolds(log(), {"run complete\n", "error: protocol refused: bad.toml:", ": error: ", "preset: "});
    EXPECT_EQ(log().find("zaubernuss"), std::string::npos);
}

TEST_F(LogTest, OfAnErrorAndOfAnEarlierKillHasThem) {
    // Truth: closed form
    ASSERT_EQ(run({"run", "study.toml", "--db", "s.db", "--no-backup", "--participant", "S001"}).exit_code, 0);
    const Ended again = run({"run", "study.toml", "--db", "s.db", "--no-backup", "--participant", "S001"});
    EXPECT_EQ(again.exit_code, 1);
    expectHolds(again.err, {"S001 has completed"});
    expectHolds(log(), {"run complete\n", "error: run failed: s.db: error: ", "… has completed"});
    EXPECT_EQ(log().find("S001"), std::string::npos);
    {
        Program program(folder_.path(), {"run", "study.toml", "--db", "s.db", "--wait"});
        while (log().find("session ready") == std::string::npos) std::this_thread::yield();
        program.killNow();
        program.wait();
    }
    ASSERT_EQ(run({"run", "study.toml", "--db", "s.db", "--no-backup"}).exit_code, 0);
    expectHolds(log(), {"warning: an earlier run was cut off: 0 attempts, 1 sessions\n", "run complete\n"});
}

/// A study with a questionnaire that takes words, conducted with notes and reasons.
class PrivateLog : public LogTest {
protected:
    PrivateLog() {
        writeText(folder_ / "ask.toml", R"(questionnaire = "ask"
version = "1.0"
languages = ["en"]
licence = "ours"
citation = "ours"
title = { en = "After the trials" }
instruction = { en = "Please answer." }
[[response]]
name = "words"
kind = "text"
[[response]]
name = "many"
kind = "rating"
low = 0
high = 987654321
[[item]]
id = "remarks"
response = "words"
text = { en = "Anything else?" }
[[item]]
id = "number"
response = "many"
text = { en = "How many?" }
low_anchor = { en = "none" }
high_anchor = { en = "all" }
[[scale]]
name = "number"
label = "Number"
items = ["number"]
[[golden]]
answers = ["NA", 3]
scores = { number = 3 }
)");
        std::string study = readText(folder_ / "study.toml");
        // A command comes while a trial runs.
        study.replace(study.find("hold_s = 0.05"), 13, "hold_s = 3");
        study.replace(study.find("\"task.timeout_s\" = 0.4"), 21, "\"task.timeout_s\" = 6");
        writeText(folder_ / "study.toml",
                  study + "[[questionnaire]]\nfile = \"ask.toml\"\nmoment = \"session_start\"\n");
    }
    void tell(std::vector<std::string> words) const {
        words.insert(words.begin(), "session");
        words.insert(words.begin() + 2, folder_ / "s.db");
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        for (Ended told = runProgram(console_.path(), words); told.exit_code != 0;
             told = runProgram(console_.path(), words))
            if (std::chrono::steady_clock::now() > end) throw std::runtime_error(words[1] + ": " + told.err);
    }

    TempFolder console_;
};

TEST_F(PrivateLog, NeverHoldsWhoTookPartOrWhatAnybodySaid) {
    // Truth: closed form: a search for the bytes, which the database holds.
    writeText(folder_ / ".in", "wort-der-person\n876543219\n\n\n");
    {
        Program program(folder_.path(), {"run", "study.toml", "--db", "s.db", "--participant", "S4711", "--answers",
                                         "participant", "--wait", "--real-time"});
        tell({"note", "--text", "notiz \"der\" leitung"});
        tell({"start"});
        tell({"invalidate", "--reason", "grund-der-leitung"});
        EXPECT_EQ(program.wait(), 0) << program.err() << log();
    }
    // Where the command came after the trial, that one is made again first.
    for (int tries = 0;
         tries < 3 && run({"run", "study.toml", "--db", "s.db", "--participant", "S4711"}).exit_code == 0; ++tries) {
    }
    EXPECT_EQ(run({"run", "study.toml", "--db", "s.db", "--participant", "S4711"}).exit_code, 1);
    EXPECT_EQ(run({"run", "study.toml", "--db", "s.db", "--participant", "karla"}).exit_code, 1);
    ASSERT_EQ(run({"doctor", "--seconds", "0.1", "--report", "report.txt"}).exit_code, 0);
    const std::string data = readText(folder_ / "s.db"), report = readText(folder_ / "report.txt");
    expectHolds(log(), {"event command_note (experimenter)", "event command_start (experimenter)",
                        "event command_invalidate (experimenter)"});
    EXPECT_NE(report.find(log()), std::string::npos);
    for (const char* secret : {"S4711", "wort-der-person", "der\" leitung", "grund-der-leitung"})
        EXPECT_NE(data.find(secret), std::string::npos) << secret << ": the search would find nothing";
    for (const char* secret : {"4711", "wort-der", "876543219", "notiz", "leitung", "grund", "karla"})
        EXPECT_EQ(report.find(secret), std::string::npos) << secret << " in\n" << report;
    EXPECT_EQ(report.find(folder_.path().string()), std::string::npos) << report;
}

TEST_F(LogTest, ADiskThatTakesNoLogCostsAWarningAndNothingElse) {
    // Truth: invariant: tables equal byte for byte those of a study with its log. No file may grow beyond 2000 blocks
    // of 512 bytes: the log is there already, the database has room.
    ASSERT_EQ(run({"run", "study.toml", "--db", "with.db", "--no-backup"}).exit_code, 0);
    writeText(folder_ / "s.db.log", std::string(1'024'000, '.'));
    const std::string limited = "cd '" + folder_.path().string() +
                                "' && ulimit -f 2000 && " PASSUNG_PROGRAM
                                " run study.toml --db s.db --no-backup >out.txt 2>err.txt";
    ASSERT_EQ(std::system(limited.c_str()), 0) << readText(folder_ / "err.txt");
    const auto lines = linesOf(readText(folder_ / "err.txt"));
    ASSERT_EQ(lines.size(), 1u) << readText(folder_ / "err.txt");
    EXPECT_EQ(lines[0].find("s.db: warning: no log is kept beside the database: "), 0u) << lines[0];
    for (const char* database : {"with.db", "s.db"})
        ASSERT_EQ(run({"export", database, "--out", std::string(database) + ".out"}).exit_code, 0);
    EXPECT_EQ(
        std::system(("diff -r '" + folder_ / "with.db.out" + "' '" + folder_ / "s.db.out" + "' >/dev/null").c_str()),
        0);
}

TEST_F(LogTest, TheReportHasWhatDoctorSaysAndTheLogsThatAreMeant) {
    // Truth: closed form
    for (const char* database : {"a.db", "b.db"})
        ASSERT_EQ(run({"run", "study.toml", "--db", database, "--no-backup"}).exit_code, 0);
    fs::create_directories(folder_ / "data/passung/studies");
    writeText(folder_ / "data/passung/studies/w.db.log", "a line of the windows\n");
    const auto report = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"doctor", "--seconds", "0.1", "--report", "r.txt"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        const std::string text = readText(folder_ / "r.txt");
        EXPECT_EQ(text.substr(0, text.find("\nlog of ")), ended.out.substr(0, ended.out.rfind("report: ")));
        return text;
    };
    const std::string a = readText(folder_ / "a.db.log"), b = readText(folder_ / "b.db.log");
    expectHolds(report({}),
                {"versions\n", "  spdlog ", "  machine ", "devices: ", "loop\n", "log of ", "log of ", "log of "});
    for (const std::string& log : {a, b, std::string("a line of the windows\n")})
        EXPECT_NE(report({}).find(log), std::string::npos);
    const std::string one = report({"--db", "b.db", "--db", "none.db"});
    expectHolds(one, {"\nlog of b.db\n" + b + "\nlog of none.db\nnone\n"});
    EXPECT_EQ(one.find(a), std::string::npos);
    const Ended refused = run({"doctor", "--seconds", "0.1", "--report", "a.db"});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.err.find("is a database and would be lost"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace passung::test
