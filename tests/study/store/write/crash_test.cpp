#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <set>

#include "study/store/schema/sqlite.h"
#include "tests/study/store/fake_study.h"

// A child process writes attempts and says through a pipe when one is about to end and when it has ended; it is killed
// without warning. Whatever it had called finished must be there, complete.

namespace passung::store {
namespace {

constexpr std::size_t kTicks = 2300;  // two whole chunks and a part
constexpr std::int64_t kTrials = 100'000;

enum class Moment { AboutToEnd, Ended };

struct Message {
    Moment moment;
    std::int64_t trial;
};

enum class Kill {
    AtARandomTime,
    AtTheCommit,      // as soon as the attempt is reported finished
    DuringTheCommit,  // soon after the attempt is reported about to end
};

std::size_t ticksOf(std::int64_t trial) { return kTicks + static_cast<std::size_t>(trial % 7) * 130; }

/// Never returns.
[[noreturn]] void writeUntilKilled(const std::string& path, const std::string& participant, int pipe) {
    const auto say = [pipe](Moment moment, std::int64_t trial) {
        const Message message{moment, trial};
        if (write(pipe, &message, sizeof message) != sizeof message) _exit(2);
    };
    try {
        auto store = fake::openStore(path);
        auto writer = fake::beginSession(*store, participant, 2000);
        for (std::int64_t trial = 0; trial < std::min<std::int64_t>(kTrials, 2000); ++trial) {
            const auto id = fake::require(writer->startAttempt(fake::attemptStart(trial)));
            writer->appendRecords(id, 0, fake::makeRecords(static_cast<std::uint64_t>(trial), ticksOf(trial)));
            say(Moment::AboutToEnd, trial);
            fake::require(writer->finishAttempt(id, fake::attemptEnd(trial, ticksOf(trial))));
            say(Moment::Ended, trial);
        }
    } catch (const std::exception& error) {
        fprintf(stderr, "child: %s\n", error.what());
    }
    _exit(3);
}

/// Some work of random length, so that a kill falls anywhere (no sleep: the length is not a time).
void spin(Random& random, std::uint64_t most) {
    std::uint64_t state = 1;
    for (std::uint64_t i = random.below(most); i > 0; --i) splitmix64(state);
    ASSERT_NE(state, 0u);
}

/// Trials that the child called finished before it was gone.
std::set<std::int64_t> killWriter(const std::string& path, const std::string& participant, Kill kill_at,
                                  Random& random) {
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        writeUntilKilled(path, participant, ends[1]);
    }
    close(ends[1]);
    std::set<std::int64_t> finished;
    const auto target = static_cast<std::int64_t>(1 + random.below(6));
    bool killed = false;
    Message message{};
    while (read(ends[0], &message, sizeof message) == static_cast<ssize_t>(sizeof message)) {
        const bool ended = message.moment == Moment::Ended;
        if (ended) finished.insert(message.trial);
        if (killed || message.trial < target || ended == (kill_at == Kill::DuringTheCommit)) continue;
        if (kill_at == Kill::AtARandomTime) spin(random, 20'000'000);
        if (kill_at == Kill::DuringTheCommit) spin(random, 1'000'000);
        kill(child, SIGKILL);
        killed = true;
    }
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "the child ended by itself";
    return finished;
}

void expectFinishedAreComplete(const std::string& path, const std::string& participant,
                               const std::set<std::int64_t>& finished) {
    const StoreReader reader = fake::require(StoreReader::open(path));
    std::set<std::int64_t> found;
    std::size_t crashed = 0;
    for (const AttemptRow& attempt : fake::require(reader.attempts())) {
        if (attempt.participant_id != participant) continue;
        if (attempt.outcome == "crashed") {
            ++crashed;
            continue;
        }
        EXPECT_EQ(attempt.outcome, "success");
        found.insert(attempt.trial_index);
        EXPECT_EQ(attempt.measures.size(), 2u);
        EXPECT_TRUE(attempt.timing);
        const auto expected =
            fake::makeRecords(static_cast<std::uint64_t>(attempt.trial_index), ticksOf(attempt.trial_index));
        EXPECT_TRUE(fake::sameStoredBits(fake::require(reader.records(attempt.attempt_id)), expected));
    }
    for (const std::int64_t trial : finished) EXPECT_TRUE(found.count(trial)) << "lost trial " << trial;
    EXPECT_LE(found.size(), finished.size() + 1) << "at most one was finished but not yet reported";
    EXPECT_LE(crashed, 1u) << "at most the running attempt is lost";
}

TEST(Crash, AKilledWriterLosesAtMostTheRunningAttempt) {
    // Truth: independent program (the acknowledgements that left the killed process through a pipe)
    const char* wanted = std::getenv("PASSUNG_KILLS");
    const int kills = wanted ? std::atoi(wanted) : 6;
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    Random random(20240601);
    std::size_t reported = 0;
    for (int i = 0; i < kills; ++i) {
        const std::string participant = plan::participantCode(plan::ParticipantKind::Simulated, i + 1);
        const auto finished = killWriter(path, participant, static_cast<Kill>(i % 3), random);
        reported += finished.size();
        const auto opened = Store::open(path, fake::options());
        ASSERT_TRUE(opened.store) << toString(opened.errors.front());
        EXPECT_EQ(opened.recovery.crashed_sessions, std::vector<std::string>{participant + ", session 1"});
        const Database database(path, OpenMode::ReadOnly);
        EXPECT_EQ(database.text("PRAGMA integrity_check"), "ok");
        EXPECT_EQ(database.integer("SELECT count(*) FROM pragma_foreign_key_check"), 0);
        expectFinishedAreComplete(path, participant, finished);
    }
    EXPECT_GE(reported, static_cast<std::size_t>(kills)) << "the kills came before anything was written";
}

}  // namespace
}  // namespace passung::store
