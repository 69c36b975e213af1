#include <gtest/gtest.h>

#include <set>

#include "study/store/schema/sqlite.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

// The experimenter's second terminal: `passung session ...` while `passung run` goes on.

namespace passung::test {
namespace {

class SessionCommandsTest : public testing::Test {
protected:
    SessionCommandsTest() {
        std::string text = smallStudy();
        text.replace(text.find("repetitions = 3"), 15, "repetitions = 300");  // it never ends by itself
        writeText(folder_.path() / "study.toml", text);
    }

    Ended tell(std::vector<std::string> words) const {
        words.insert(words.begin(), "session");
        words.insert(words.begin() + 2, folder_ / "study.db");
        return runProgram(console_.path(), words);  // in a folder of its own: the running program writes in the other
    }
    void expectRefused(const std::vector<std::string>& words, const std::string& why) const {
        const Ended ended = tell(words);
        EXPECT_EQ(ended.exit_code, 1) << words.front();
        EXPECT_NE(ended.err.find(why), std::string::npos) << ended.err;
        EXPECT_EQ(linesOf(ended.err).size(), 1u) << ended.err;
    }
    void expectAccepted(const std::vector<std::string>& words, const std::string& what) const {
        const Ended ended = tell(words);
        EXPECT_EQ(ended.exit_code, 0) << words.front() << ": " << ended.err;
        EXPECT_NE(ended.out.find(what), std::string::npos) << ended.out;
    }
    /// Until the session takes commands.
    void waitForSession() const {
        for (int i = 0; i < 1000; ++i)
            if (tell({"pause"}).err.ends_with("study.db: error: pause: the session has not begun\n")) return;
        FAIL() << "no session";
    }

    TempFolder folder_, console_;
};

TEST_F(SessionCommandsTest, AreObeyedByTheRunningProgramAndStored) {
    // Truth: invariant: what was acknowledged is in the data.
    Program program(folder_.path(), {"run", "study.toml", "--db", "study.db", "--wait"}, true);
    waitForSession();
    expectAccepted({"note", "--text", "lights on"}, "noted");
    expectRefused({"note"}, "error: note: needs a text: --text");
    expectAccepted({"start"}, "the session begins");
    if (HasFailure()) return;  // it would wait for ever
    const std::string first = program.nextAcknowledgement();
    EXPECT_EQ(first.substr(0, 2), "1 ");
    expectAccepted({"stop", "--reason", "smoke"}, "motors are off, the session is paused");
    expectAccepted({"invalidate", "--attempt", "1", "--reason", "it's \"odd\""}, "no longer counts");
    expectAccepted({"continue"}, "goes on with trial");
    expectAccepted({"abort", "--reason", "enough"}, "the session is aborted");
    EXPECT_EQ(program.wait(), 1);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "study.db.socket"));

    // Nothing runs: what concerns finished attempts goes into the database itself.
    expectRefused({"continue"}, "study.db: error: no session runs on it");
    expectRefused({"invalidate", "--reason", "x"}, "which --attempt is meant?");
    expectRefused({"invalidate", "--attempt", "1", "--reason", "x"},
                  "attempt 1 is not valid already (" + first.substr(2) + ", invalidated by the experimenter: it's");
    expectAccepted({"note", "--text", "went home"}, "noted");

    const store::Database database(folder_ / "study.db", store::OpenMode::ReadOnly);
    EXPECT_EQ(database.text("SELECT group_concat(event || ' ' || (payload_json->>'accepted')) FROM (SELECT event, "
                            "payload_json FROM event WHERE source='experimenter' AND event<>'command_note' "
                            "ORDER BY event_id)"),
              "command_pause 0,command_start 1,command_stop 1,command_invalidate 1,command_continue 1,"
              "command_abort 1");
    EXPECT_EQ(database.text("SELECT invalid_reason FROM attempt WHERE attempt_id=1"),
              "invalidated by the experimenter: it's \"odd\"");
    // The stop may have come between two trials.
    EXPECT_LE(database.integer("SELECT count(*) FROM attempt WHERE invalid_reason='emergency stop: smoke'"), 1);
    EXPECT_EQ(database.text("SELECT group_concat(text) FROM note WHERE t_utc GLOB '2000-01-01T00:0*'"),
              "lights on,went home");

    ASSERT_EQ(runProgram(folder_.path(), {"export", "study.db", "--out", "out", "--no-samples"}).exit_code, 0);
    const auto notes = fake::readCsv(readText(folder_ / "out/notes.csv"));
    std::multiset<std::string> entries;
    for (std::size_t row = 0; row < notes.rows.size(); ++row) {
        EXPECT_EQ(notes.at(row, "author"), "experimenter");
        EXPECT_TRUE(row == 0 || notes.at(row - 1, "t_utc") <= notes.at(row, "t_utc"));
        entries.insert(notes.at(row, "entry") + " " + notes.at(row, "accepted") + " " + notes.at(row, "text"));
    }
    EXPECT_EQ(entries, (std::multiset<std::string>{"note 1 lights on", "note 1 went home", "pause 0 NA", "start 1 NA",
                                                   "stop 1 smoke", "invalidate 1 it's \"odd\"", "continue 1 NA",
                                                   "abort 1 enough"}));
}

TEST_F(SessionCommandsTest, AKilledProgramLeavesNoSessionToCommand) {
    // Truth: invariant: the socket that it leaves behind neither answers nor hinders the next run.
    {
        Program program(folder_.path(), {"run", "study.toml", "--db", "study.db"}, true);
        EXPECT_NE(program.nextAcknowledgement(), "");
    }
    EXPECT_TRUE(std::filesystem::exists(folder_ / "study.db.socket"));
    expectRefused({"pause"}, "no session runs on it");
    expectAccepted({"invalidate", "--attempt", "1", "--reason", "seen on video"}, "attempt 1 no longer counts");
    Program program(folder_.path(), {"run", "study.toml", "--db", "study.db", "--wait"}, true);
    waitForSession();
    expectAccepted({"abort"}, "the session is aborted");
    EXPECT_EQ(program.wait(), 1);
}

}  // namespace
}  // namespace passung::test
