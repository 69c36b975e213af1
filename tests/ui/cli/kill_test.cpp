#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/base/random.h"
#include "study/measures/measures.h"
#include "study/store/read/store_reader.h"
#include "study/store/schema/sqlite.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

// The program is killed without warning, again and again, in the middle of a study. What it had acknowledged through
// the pipe must be in the database, complete, and the next start must say what was lost.

namespace passung::test {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr auto kLatestKill = 600ms;
constexpr const char* kDatabase = "study.db";

/// PASSUNG_KILLS, else few; about half of them at commits.
int killCount() {
    const char* wanted = std::getenv("PASSUNG_KILLS");
    return wanted != nullptr ? std::max(4, std::atoi(wanted)) : 22;
}

using Acknowledged = std::map<std::int64_t, std::string>;  // attempt, outcome

void note(const std::string& line, Acknowledged& acknowledged) {
    const std::size_t blank = line.find(' ');
    ASSERT_NE(blank, std::string::npos) << line;
    const bool added = acknowledged.emplace(std::stoll(line.substr(0, blank)), line.substr(blank + 1)).second;
    EXPECT_TRUE(added) << "acknowledged twice: " << line;
}

struct KilledRun {
    Acknowledged acknowledged;
    std::string out;
};

/// Far more participants than it can finish, so that it never ends by itself.
const std::vector<std::string> kEndlessRun = {"run", "study.toml", "--simulated", "60", "--db", kDatabase};

KilledRun endKilled(Program& program, KilledRun run) {
    program.killNow();
    // What was written before the signal came is still in the pipe.
    for (std::string line; !(line = program.nextAcknowledgement()).empty();) note(line, run.acknowledged);
    EXPECT_EQ(program.wait(), -SIGKILL) << program.err();
    run.out = program.out();
    return run;
}

KilledRun killAfter(const fs::path& folder, std::chrono::nanoseconds time) {
    Program program(folder, kEndlessRun, true);
    const auto end = std::chrono::steady_clock::now() + time;
    KilledRun run;
    for (std::string line; !(line = program.nextAcknowledgement(end - std::chrono::steady_clock::now())).empty();) {
        note(line, run.acknowledged);
    }
    return endKilled(program, std::move(run));
}

KilledRun killAtCommit(const fs::path& folder, std::size_t commit, std::chrono::nanoseconds later) {
    Program program(folder, kEndlessRun, true);
    KilledRun run;
    while (run.acknowledged.size() < commit) {
        const std::string line = program.nextAcknowledgement();
        if (line.empty()) break;
        note(line, run.acknowledged);
    }
    EXPECT_EQ(run.acknowledged.size(), commit) << program.err();
    const auto end = std::chrono::steady_clock::now() + later;
    while (std::chrono::steady_clock::now() < end) {
    }
    return endKilled(program, std::move(run));
}

/// The database as the killed process left it, copied, so that looking does not repair it for the next start.
std::string copyOf(const fs::path& folder) {
    const fs::path copy = folder / "copy";
    fs::remove_all(copy);
    fs::create_directory(copy);
    for (const char* suffix : {"", "-wal", "-journal"}) {
        const fs::path file = folder / (std::string(kDatabase) + suffix);
        if (fs::exists(file)) fs::copy_file(file, copy / file.filename());
    }
    return (copy / kDatabase).string();
}

std::string nameOf(const store::AttemptRow& attempt) {
    return attempt.participant_id + ", session " + std::to_string(attempt.session_ordinal) + ", trial " +
           std::to_string(attempt.trial_index + 1) + ", attempt " + std::to_string(attempt.attempt_no);
}

void expectComplete(const store::StoreReader& reader, const store::Database& database,
                    const store::AttemptRow& attempt) {
    EXPECT_TRUE(attempt.valid) << attempt.invalid_reason.value_or("");
    EXPECT_TRUE(attempt.end_ns);
    EXPECT_EQ(attempt.state_hash.size(), 16u);
    const auto of_attempt = " WHERE attempt_id=" + std::to_string(attempt.attempt_id);
    EXPECT_EQ(database.integer("SELECT count(*) FROM attempt_measure" + of_attempt),
              static_cast<std::int64_t>(measures::definitions().size()));
    EXPECT_EQ(database.integer("SELECT count(*) FROM event" + of_attempt + " AND event='" + attempt.outcome + "'"), 1);
    ASSERT_TRUE(attempt.timing);
    const auto records = reader.records(attempt.attempt_id);
    ASSERT_TRUE(records) << toString(records.errors().front());
    ASSERT_EQ(static_cast<std::int64_t>(records->size()), attempt.timing->ticks);
    for (std::size_t i = 0; i < records->size(); ++i) ASSERT_EQ((*records)[i].tick, static_cast<std::int64_t>(i));
}

/// What is known of the database from outside, and what was found in it.
struct History {
    Acknowledged acknowledged;                    // by all runs so far
    std::set<std::int64_t> attempts;              // all that were ever found
    std::map<std::int64_t, std::string> running;  // found running and not yet found marked: attempt, name
    std::size_t crashed = 0, unreported = 0;
};

/// Finds every acknowledged attempt of `run` complete, every earlier one unchanged, and at most one unfinished.
void inspect(const std::string& path, const KilledRun& run, History& history) {
    history.acknowledged.insert(run.acknowledged.begin(), run.acknowledged.end());
    const auto reader = store::StoreReader::open(path);
    if (!reader && history.acknowledged.empty()) return;  // killed before there was anything to lose
    ASSERT_TRUE(reader) << toString(reader.errors().front());
    const store::Database database(path, store::OpenMode::ReadWrite);
    EXPECT_EQ(database.text("PRAGMA integrity_check"), "ok");
    EXPECT_EQ(database.integer("SELECT count(*) FROM pragma_foreign_key_check"), 0);

    const auto attempts = reader->attempts();
    ASSERT_TRUE(attempts) << toString(attempts.errors().front());
    std::map<std::int64_t, std::string> running;
    std::size_t unreported = 0, crashed = 0, found = 0;
    for (const store::AttemptRow& attempt : *attempts) {
        SCOPED_TRACE(nameOf(attempt));
        const bool is_new = history.attempts.insert(attempt.attempt_id).second;
        const auto known = history.acknowledged.find(attempt.attempt_id);
        if (known != history.acknowledged.end()) {
            ++found;
            EXPECT_EQ(attempt.outcome, known->second);
            if (is_new) expectComplete(*reader, database, attempt);
        } else if (attempt.outcome == "running") {
            EXPECT_FALSE(attempt.valid);
            running.emplace(attempt.attempt_id, nameOf(attempt));
        } else if (attempt.outcome == "crashed") {
            EXPECT_FALSE(attempt.valid);
            EXPECT_FALSE(is_new) << "only the next start can mark it";
            ++crashed;
        } else if (is_new) {
            expectComplete(*reader, database, attempt);
            ++unreported;
        }
    }
    EXPECT_EQ(found, history.acknowledged.size()) << "an acknowledged attempt is lost";
    EXPECT_LE(running.size(), 1u);
    EXPECT_LE(unreported, 1u) << "at most one ended but the kill came before its acknowledgement";
    for (const auto& [id, name] : history.running) {
        if (running.count(id)) {
            EXPECT_TRUE(run.acknowledged.empty()) << name << " was not marked";
            continue;
        }
        EXPECT_EQ(reader->attempt(id)->outcome, "crashed") << name;
        if (run.acknowledged.empty()) continue;  // may have been killed between marking and saying
        EXPECT_NE(run.out.find(name + ": was running when an earlier run was killed"), std::string::npos) << run.out;
    }
    history.running = std::move(running);
    history.crashed = crashed;
    history.unreported += unreported;
}

TEST(Kill, LosesAtMostTheRunningTrial) {
    // Truth: independent program (the acknowledgements that left the killed process through a pipe)
    const TempFolder folder;
    writeText(folder / "study.toml", smallStudy());
    Random random(20240611);
    History history;
    std::size_t unfinished = 0;
    const int kills = killCount();
    for (int i = 0; i < kills; ++i) {
        SCOPED_TRACE("kill " + std::to_string(i + 1));
        // The first two hit an empty folder at a random time; then the two kinds take turns.
        const bool at_commit = i >= 2 && i % 2 == 0;
        KilledRun run;
        if (at_commit) {
            const auto later = std::chrono::microseconds(i % 4 == 0 ? 0 : random.below(2001));
            run = killAtCommit(folder.path(), 1 + random.below(14), later);
        } else {
            run = killAfter(folder.path(), std::chrono::microseconds(random.below(kLatestKill / 1us)));
        }
        const std::set<std::int64_t> before = history.attempts;
        inspect(copyOf(folder.path()), run, history);
        if (HasFatalFailure()) return;
        for (const auto& [id, name] : history.running) unfinished += before.count(id) ? 0 : 1;
    }

    const Ended last = runProgram(folder.path(), {"run", "study.toml", "--simulated", "1", "--db", kDatabase});
    EXPECT_EQ(last.exit_code, 0) << last.err;
    for (const auto& [id, name] : history.running) EXPECT_NE(last.out.find(name + ": was running"), std::string::npos);
    const auto reader = store::StoreReader::open(folder / kDatabase);
    ASSERT_TRUE(reader);
    const auto attempts = reader->attempts();
    ASSERT_TRUE(attempts);
    const store::Database database(folder / kDatabase, store::OpenMode::ReadOnly);
    std::size_t crashed = 0;
    for (const store::AttemptRow& attempt : *attempts) {
        crashed += attempt.outcome == "crashed" ? 1 : 0;
        const auto known = history.acknowledged.find(attempt.attempt_id);
        if (known == history.acknowledged.end()) continue;
        EXPECT_EQ(attempt.outcome, known->second);
        expectComplete(*reader, database, attempt);
    }
    EXPECT_EQ(crashed, unfinished);
    EXPECT_EQ(database.integer("SELECT count(*) FROM attempt WHERE outcome='running'"), 0);
    EXPECT_EQ(database.integer("SELECT count(*) FROM session WHERE end_state IS NULL"), 0);
    EXPECT_EQ(database.text("PRAGMA integrity_check"), "ok");
    EXPECT_GE(history.acknowledged.size(), static_cast<std::size_t>(kills / 2 - 1));
    std::printf("%d kills: %zu acknowledged attempts, all there; %zu more ended, %zu were lost while running\n", kills,
                history.acknowledged.size(), history.unreported, crashed);

    // Truth: invariant (what is kept of a lost trial is as it was rendered, but nothing vouches for it as a whole)
    const Ended replayed = runProgram(folder.path(), {"replay", kDatabase});
    EXPECT_EQ(replayed.exit_code, crashed > 0 ? 1 : 0) << replayed.out << replayed.err;
    std::size_t unproven = 0;
    for (const std::string& line : linesOf(replayed.out)) {
        EXPECT_EQ(line.find("DIFFERS"), std::string::npos) << line;
        if (line.find(": NOT PROVEN: ") == std::string::npos) continue;
        EXPECT_TRUE(line.ends_with("(crashed)")) << line;
        ++unproven;
    }
    EXPECT_EQ(unproven, crashed);
}

TEST(Kill, ASecondProgramMayNotWriteTheSameDatabase) {
    // Truth: invariant (one writer; the first goes on undisturbed)
    const TempFolder folder;
    const TempFolder other;
    writeText(folder / "study.toml", smallStudy());
    Program first(folder.path(), kEndlessRun, true);
    ASSERT_EQ(first.nextAcknowledgement().substr(0, 2), "1 ");
    const Ended second = runProgram(other.path(), {"run", folder / "study.toml", "--db", folder / kDatabase});
    EXPECT_EQ(second.exit_code, 1);
    EXPECT_NE(second.err.find("another program is writing this database"), std::string::npos) << second.err;
    EXPECT_EQ(linesOf(second.err).size(), 1u) << second.err;
    for (int i = 0; i < 8; ++i) EXPECT_NE(first.nextAcknowledgement(), "");
}

}  // namespace
}  // namespace passung::test
