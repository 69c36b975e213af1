#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "core/base/random.h"
#include "study/store/read/store_reader.h"
#include "study/store/schema/sqlite.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

// One session, killed again and again and resumed each time, against the same session without interruption.

namespace passung::test {
namespace {

constexpr const char* kDatabase = "study.db";

/// As many as PASSUNG_KILLS says, else few enough for every day.
int wantedKills() {
    const char* wanted = std::getenv("PASSUNG_KILLS");
    return wanted != nullptr ? std::atoi(wanted) : 20;
}

/// A pass of the two conditions for every kill: a run that is to be killed ends one or two trials before.
std::string study(int passes = 12, const std::string& more = {}) {
    std::string text = smallStudy() + more;
    text.replace(text.find("repetitions = 3"), 15, "repetitions = " + std::to_string(passes));
    return text;
}

std::vector<store::AttemptRow> attemptsOf(const std::string& path) {
    const auto reader = store::StoreReader::open(path);
    if (!reader) throw std::runtime_error(toString(reader.errors().front()));
    auto attempts = reader->attempts();
    if (!attempts) throw std::runtime_error(toString(attempts.errors().front()));
    std::sort(attempts->begin(), attempts->end(),
              [](const auto& a, const auto& b) { return a.attempt_id < b.attempt_id; });
    return *std::move(attempts);
}

class Resume : public testing::Test {
protected:
    /// Kills the program after so many acknowledgements and a little more; true if it had ended before.
    bool runKilled(const std::vector<std::string>& arguments, std::size_t commits, std::chrono::nanoseconds later) {
        Program program(folder_.path(), arguments, true);
        for (std::size_t i = 0; i < commits; ++i) {
            const std::string line = program.nextAcknowledgement();
            if (line.empty()) break;
            note(line);
        }
        const auto end = std::chrono::steady_clock::now() + later;
        while (std::chrono::steady_clock::now() < end) {
        }
        program.killNow();
        for (std::string line; !(line = program.nextAcknowledgement()).empty();) note(line);
        const int code = program.wait();
        // The kill may have come after the session's end and before the program's.
        const bool over = code == 1 && program.err().find("no session that did not complete") != std::string::npos;
        EXPECT_TRUE(code == 0 || code == -SIGKILL || over) << program.err();
        return code == 0 || over;
    }
    void note(const std::string& line) {
        EXPECT_TRUE(acknowledged_.insert(std::stoll(line)).second) << "acknowledged twice: " << line;
    }
    Ended run(const std::vector<std::string>& arguments) const { return runProgram(folder_.path(), arguments); }

    TempFolder folder_;
    std::set<std::int64_t> acknowledged_;
};

TEST_F(Resume, AfterEveryKillTheSessionGoesOnAsIfNothingHadHappened) {
    // Truth: independent program (the uninterrupted run, and the acknowledgements that left the killed processes)
    const TempFolder whole;
    writeText(whole.path() / "study.toml", study(wantedKills()));
    writeText(folder_.path() / "study.toml", study(wantedKills()));
    ASSERT_EQ(runProgram(whole.path(), {"run", "study.toml", "--db", kDatabase}).exit_code, 0);
    const auto expected = attemptsOf(whole / kDatabase);

    Random random(20240917);
    int kills = 0;
    bool ended = runKilled({"run", "study.toml", "--db", kDatabase, "--no-backup"}, 1, std::chrono::nanoseconds(0));
    for (; !ended && kills < 10 * wantedKills(); ++kills) {
        // Alternately at the moment of a commit and somewhere in the next trial.
        const auto later = std::chrono::microseconds(kills % 2 == 0 ? 0 : random.below(40'000));
        ended = runKilled({"resume", kDatabase, "--no-backup"}, 1 + random.below(2), later);
    }
    ASSERT_TRUE(ended);
    EXPECT_GE(kills, wantedKills() * 2 / 3);

    std::size_t position = 0, crashed = 0;
    for (const store::AttemptRow& attempt : attemptsOf(folder_ / kDatabase)) {
        SCOPED_TRACE("attempt " + std::to_string(attempt.attempt_id));
        if (attempt.outcome == "crashed") {
            EXPECT_FALSE(attempt.valid);
            EXPECT_EQ(acknowledged_.count(attempt.attempt_id), 0u);
            ++crashed;
            continue;
        }
        ASSERT_LT(position, expected.size());
        const store::AttemptRow& same = expected[position++];
        EXPECT_EQ(attempt.trial_index, same.trial_index);
        EXPECT_EQ(attempt.condition, same.condition);
        EXPECT_TRUE(attempt.valid);
        acknowledged_.erase(attempt.attempt_id);
        if (attempt.attempt_no > 1) continue;  // a second attempt draws anew
        EXPECT_EQ(attempt.seed, same.seed);
        EXPECT_EQ(attempt.state_hash, same.state_hash);
        EXPECT_EQ(attempt.measures, same.measures);
    }
    EXPECT_EQ(position, expected.size());
    EXPECT_TRUE(acknowledged_.empty()) << "an acknowledged attempt is lost";
    const store::Database database(folder_ / kDatabase, store::OpenMode::ReadOnly);
    EXPECT_EQ(database.text("SELECT end_state FROM session"), "complete");
    EXPECT_EQ(database.text("SELECT state FROM design_slot WHERE participant_id='S001'"), "complete");
    EXPECT_EQ(database.integer("SELECT count(*) FROM segment"),
              database.integer("SELECT count(*) FROM event WHERE event='session_resumed'") + 1);
    std::printf("%d kills, %zu attempts crashed, %zu trials as in the uninterrupted run\n", kills + 1, crashed,
                position);
    EXPECT_EQ(run({"resume", kDatabase}).err, std::string("study.db: error: holds no session that did not complete\n"));
}

TEST_F(Resume, AsksWhatTheProtocolWasImportedWithEvenIfItsFileIsGone) {
    // Truth: closed form: one questionnaire at the end of the session, in the words that were stored.
    const auto asked = folder_.path() / "asked.toml";
    std::filesystem::copy_file(PASSUNG_SOURCE_DIR "/protocols/questionnaires/nasa_tlx_raw.toml", asked);
    writeText(folder_.path() / "study.toml",
              study(4, "\n[[questionnaire]]\nfile = \"asked.toml\"\nmoment = \"session_end\"\n"));
    ASSERT_FALSE(runKilled({"run", "study.toml", "--db", kDatabase}, 2, std::chrono::nanoseconds(0)));
    std::filesystem::remove(asked);
    const Ended resumed = run({"resume", kDatabase});
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_NE(resumed.out.find(" of them earlier, "), std::string::npos) << resumed.out;
    const store::Database database(folder_ / kDatabase, store::OpenMode::ReadOnly);
    EXPECT_EQ(database.integer("SELECT count(*) FROM questionnaire_run WHERE moment='session_end'"), 1);
}

TEST_F(Resume, ASessionOfAProgramThatKnewFewerMeasuresGoesOn) {
    // Truth: invariant: the measures that the file lacks are added before the first attempt has to be stored. No trial
    // of this study has response_time_s, so that taking it away is all that an older program would have left out.
    writeText(folder_.path() / "study.toml", study());
    runKilled({"run", "study.toml", "--db", kDatabase, "--no-backup"}, 2, {});
    {
        const store::Database database(folder_ / kDatabase, store::OpenMode::ReadWrite);
        database.execute("DELETE FROM attempt_measure WHERE measure='response_time_s'");
        database.execute("DELETE FROM measure WHERE measure='response_time_s'");
    }
    const Ended resumed = run({"resume", kDatabase});
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    const store::Database database(folder_ / kDatabase, store::OpenMode::ReadOnly);
    EXPECT_EQ(database.integer("SELECT count(*) FROM measure WHERE measure='response_time_s'"), 1);
}

TEST_F(Resume, TheProtocolMayWantItsBlockAnew) {
    // Truth: closed form: what the block had no longer counts, and every trial has one attempt that does.
    writeText(folder_.path() / "study.toml", study(12, "\n[resume]\nblock = \"restart\"\n"));
    ASSERT_FALSE(runKilled({"run", "study.toml", "--db", kDatabase}, 3, std::chrono::nanoseconds(0)));
    const Ended resumed = run({"resume", kDatabase});
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    const store::Database database(folder_ / kDatabase, store::OpenMode::ReadOnly);
    EXPECT_GE(database.integer("SELECT count(*) FROM attempt WHERE invalid_reason='done again after an interruption'"),
              3);
    EXPECT_EQ(database.integer("SELECT count(*) FROM attempt WHERE valid"), 24);
    EXPECT_EQ(database.integer("SELECT count(DISTINCT trial_id) FROM attempt WHERE valid"), 24);
}

TEST_F(Resume, TellsHowManyTrialsWereOverEarlierThoughItsFirstAttemptIsRepeated) {
    // Truth: independent program (SQLite counts trials before and after). Every attempt runs out of time, so that the
    // first one after the interruption finishes no trial.
    std::string text = study(6, "on_timeout = \"repeat_now\"\nmax_attempts = 2\n");
    const std::string fair = "\"task.timeout_s\" = 20,";
    text.replace(text.find(fair), fair.size(), "\"task.timeout_s\" = 0.4,");
    writeText(folder_.path() / "study.toml", text);
    ASSERT_FALSE(runKilled({"run", "study.toml", "--db", kDatabase}, 5, std::chrono::nanoseconds(0)));
    const auto over = [&] {
        return store::Database(folder_ / kDatabase, store::OpenMode::ReadOnly)
            .integer("SELECT count(DISTINCT trial_id) FROM order_step WHERE then_what='done'");
    };
    const auto earlier = over();
    ASSERT_GE(earlier, 2);
    const Ended resumed = run({"resume", kDatabase});
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_EQ(over(), 12);
    const std::string line = "12 trials, " + std::to_string(earlier) + " of them earlier, 0 succeeded";
    EXPECT_NE(resumed.out.find(line), std::string::npos) << resumed.out << "expected: " << line;
}

TEST_F(Resume, CountsWhatSucceededEarlierToo) {
    // Truth: independent program (SQLite counts what the whole session has in the end)
    writeText(folder_.path() / "study.toml", study(6));
    ASSERT_FALSE(runKilled({"run", "study.toml", "--db", kDatabase}, 6, std::chrono::nanoseconds(0)));
    const Ended resumed = run({"resume", kDatabase});
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    const store::Database database(folder_ / kDatabase, store::OpenMode::ReadOnly);
    const auto succeeded = database.integer("SELECT count(*) FROM attempt WHERE valid AND outcome='success'");
    EXPECT_GT(succeeded, 3);
    EXPECT_NE(resumed.out.find(" of them earlier, " + std::to_string(succeeded) + " succeeded"), std::string::npos)
        << resumed.out;
}

TEST_F(Resume, WhoHasBegunAnotherSessionSinceDoesNotGoOnWithTheOld) {
    // Truth: invariant
    writeText(folder_.path() / "study.toml", study());
    ASSERT_FALSE(runKilled({"run", "study.toml", "--db", kDatabase}, 1, std::chrono::nanoseconds(0)));
    std::string first;
    {
        const store::Database database(folder_ / kDatabase, store::OpenMode::ReadWrite);
        first = database.text("SELECT session_id FROM session");
    }
    ASSERT_FALSE(
        runKilled({"run", "study.toml", "--db", kDatabase, "--participant", "S001"}, 1, std::chrono::nanoseconds(0)));
    const Ended refused = run({"resume", kDatabase, "--session", first});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.err.find("S001, session 1: session 2 has begun since"), std::string::npos) << refused.err;
    EXPECT_EQ(run({"resume", kDatabase, "--session", "none"}).err,
              std::string("study.db: error: there is no session none\n"));
}

}  // namespace
}  // namespace passung::test
