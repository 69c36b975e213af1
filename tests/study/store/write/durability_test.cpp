#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <set>

#include "core/base/digest.h"
#include "study/store/schema/backup.h"
#include "study/store/schema/revisions.h"
#include "study/store/schema/sqlite.h"
#include "tests/study/store/damaged_study.h"
#include "tests/study/store/fake_study.h"
#include "tests/study/store/faulty_disk.h"
#include "tests/study/store/first_revision.h"

// What a disk, another program or a kill can do to a database, each with one clear message and nothing finished lost.
// PASSUNG_KILLS: how many of the moments at which a process can die are tried; default 40, "all" for every one.

namespace passung::store {
namespace {

using fake::DiskFault;
using fake::DiskWork;
using fake::require;

namespace fs = std::filesystem;

constexpr std::size_t kTicks = 300;

bool isWrite(DiskWork work) { return work == DiskWork::Write || work == DiskWork::Commit; }

std::string bytesOf(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Opens the file as the next start does: every attempt in `finished` is there, complete, and the file is sound.
void expectFinished(const std::string& path, std::size_t finished, std::size_t at_most) {
    {
        const auto opened = Store::open(path, fake::options());
        ASSERT_TRUE(opened.store) << toString(opened.errors.front());
    }
    const Database database(path, OpenMode::ReadOnly);
    EXPECT_EQ(database.text("PRAGMA integrity_check"), "ok");
    EXPECT_EQ(database.integer("SELECT count(*) FROM pragma_foreign_key_check"), 0);
    const StoreReader reader = require(StoreReader::open(path));
    std::size_t found = 0;
    for (const AttemptRow& attempt : require(reader.attempts())) {
        if (attempt.outcome == "crashed") continue;
        EXPECT_EQ(attempt.trial_index, static_cast<std::int64_t>(found)) << "in the order of finishing";
        EXPECT_TRUE(attempt.timing);
        EXPECT_TRUE(fake::sameStoredBits(require(reader.records(attempt.attempt_id)),
                                         fake::makeRecords(static_cast<std::uint64_t>(found), kTicks)));
        ++found;
    }
    EXPECT_GE(found, finished) << "a finished attempt is lost";
    EXPECT_LE(found, at_most);
}

constexpr int kTrials = 3;

/// Creates a database and performs kTrials in it; `finished` hears of each when it is durable.
void perform(const std::string& path, const std::function<void(int)>& finished) {
    const auto store = fake::openStore(path);
    const auto writer = fake::beginSession(*store, "S001", kTrials);
    for (int trial = 0; trial < kTrials; ++trial) {
        require(fake::writeAttempt(*writer, trial, kTicks));
        finished(trial + 1);
    }
    require(writer->finishSession(true, 1'000'000'000));
}

/// Runs perform() in a child that is gone right before work number `last` on its files, after `share` of a write's
/// bytes. Returns how many trials it called finished; `ended` tells whether it came to its end.
int dieBefore(const std::string& path, std::int64_t last, double share, bool& ended) {
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        fake::FaultyDisk disk([&](DiskWork work, std::int64_t number) {
            if (number == last + 1) _exit(9);
            if (number == last && (!isWrite(work) || share == 0.0)) _exit(9);
            return number == last ? DiskFault{SQLITE_OK, share} : DiskFault{};
        });
        try {
            perform(path, [&](int trial) {
                const char byte = static_cast<char>(trial);
                if (write(ends[1], &byte, 1) != 1) _exit(2);
            });
        } catch (const std::exception&) {
            _exit(3);
        }
        _exit(0);
    }
    close(ends[1]);
    int finished = 0;
    for (char byte; read(ends[0], &byte, 1) == 1;) finished = byte;
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 9)) << status;
    ended = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    return finished;
}

TEST(Durability, DeathBeforeAnyWriteToTheDiskLosesNothingFinished) {
    // Truth: independent program (what the child had called finished, through a pipe). Every write, sync, truncation
    // and deletion of its files is a moment to die at, also in the middle of a write.
    const fake::TempFolder folder;
    std::int64_t works = 0;
    {
        fake::FaultyDisk disk([&](DiskWork, std::int64_t number) {
            works = number;
            return DiskFault{};
        });
        perform(folder / "whole.db", [](int) {});
    }
    ASSERT_GT(works, 100);
    const char* wanted = std::getenv("PASSUNG_KILLS");
    const std::int64_t kills = wanted == nullptr ? 40 : std::string(wanted) == "all" ? works : std::atoi(wanted);
    std::set<int> finished_at_death;
    for (std::int64_t i = 0; i < kills; ++i) {
        const std::int64_t last = 1 + i * works / kills;
        SCOPED_TRACE("death before work " + std::to_string(last) + " of " + std::to_string(works));
        const std::string path = folder / (std::to_string(i) + ".db");
        bool ended = false;
        const int finished = dieBefore(path, last, i % 2 == 0 ? 0.0 : 0.5, ended);
        EXPECT_FALSE(ended);
        finished_at_death.insert(finished);
        expectFinished(path, static_cast<std::size_t>(finished), static_cast<std::size_t>(finished) + 1);
        if (HasFatalFailure()) return;
        fs::remove(path);
    }
    for (int trials = 0; trials < kTrials; ++trials)
        EXPECT_TRUE(finished_at_death.count(trials)) << "no death with " << trials << " finished";
}

TEST(Durability, ALogThatIsCutOrSpoiltAnywhereKeepsWhatWasFinishedBefore) {
    // Truth: invariant. The log as it was after each finished trial is a beginning of the last one: cut or overwritten
    // behind that, all that was finished by then is there.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    std::vector<std::size_t> sizes;
    std::string database, log;
    {
        const auto store = fake::openStore(path);
        const auto writer = fake::beginSession(*store, "S001", kTrials);
        for (int trial = 0; trial < kTrials; ++trial) {
            require(fake::writeAttempt(*writer, trial, kTicks));
            sizes.push_back(fs::file_size(path + "-wal"));
        }
        database = bytesOf(path);
        log = bytesOf(path + "-wal");
    }
    ASSERT_EQ(log.size(), sizes.back());
    Random random(77);
    std::vector<std::size_t> lengths = sizes;
    for (const std::size_t size : sizes) lengths.push_back(size - 1);
    for (int i = 0; i < 14; ++i) lengths.push_back(sizes[0] + random.below(sizes.back() - sizes[0]));
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        SCOPED_TRACE("log of " + std::to_string(lengths[i]) + " of " + std::to_string(log.size()) + " bytes");
        std::string torn = log.substr(0, lengths[i]);
        if (i % 2 == 1) torn += std::string(log.size() - torn.size(), '\x5a');
        const std::string copy = folder / "torn.db";
        std::ofstream(copy, std::ios::binary) << database;
        std::ofstream(copy + "-wal", std::ios::binary) << torn;
        const auto finished = static_cast<std::size_t>(
            std::count_if(sizes.begin(), sizes.end(), [&](std::size_t size) { return size <= lengths[i]; }));
        expectFinished(copy, finished, finished + 1);
        if (HasFatalFailure()) return;
    }
}

TEST(Durability, ADamagedFileIsRefusedAndLeftAloneAndItsBackupNamed) {
    // Truth: invariant. The file is cut to half; its copy opens and holds every trial.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    perform(path, [](int) {});
    require(fake::openStore(path)->backup());
    const std::string whole = bytesOf(path);
    std::ofstream(path, std::ios::binary) << whole.substr(0, whole.size() / 2 / 4096 * 4096);
    const std::string damaged = bytesOf(path);
    const auto opened = Store::open(path, fake::options());
    ASSERT_FALSE(opened.store);
    ASSERT_EQ(opened.errors.size(), 1u);
    const std::string message = opened.errors[0].message;
    EXPECT_TRUE(message.starts_with("the database is damaged")) << message;
    EXPECT_NE(message.find(path + ".backup"), std::string::npos) << message;
    EXPECT_EQ(StoreReader::open(path).errors()[0].message, message);
    EXPECT_EQ(bytesOf(path), damaged);
    fs::copy_file(path + ".backup", path, fs::copy_options::overwrite_existing);
    expectFinished(path, kTrials, kTrials);
}

TEST(Durability, ABackupThatHasWhatTheDatabaseLacksIsKept) {
    // Truth: invariant: the bytes of the earlier copy are there after the next one, under another name; what has
    // nothing more than the new copy is replaced.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db", backup = path + ".backup";
    perform(path, [](int) {});
    EXPECT_EQ(require(fake::openStore(path)->backup()), "");
    EXPECT_EQ(require(fake::openStore(path)->backup()), "") << "the same again";
    const std::string sound = bytesOf(backup);
    Database(path, OpenMode::ReadWrite).execute("UPDATE sample_chunk SET data=zeroblob(length(data)) WHERE chunk_no=0");
    EXPECT_EQ(require(fake::openStore(path)->backup()), backup + ".1") << "damaged since";
    EXPECT_EQ(bytesOf(backup + ".1"), sound);
    EXPECT_EQ(require(fake::openStore(path)->backup()), "") << "the damage is there already";
    fs::rename(path, folder / "moved.db");
    fs::copy_file(backup + ".1", backup, fs::copy_options::overwrite_existing);
    fake::performAsking(path, "S009");
    EXPECT_EQ(require(fake::openStore(path)->backup()), backup + ".2") << "another database of that name";
    EXPECT_EQ(bytesOf(backup + ".2"), sound);
}

TEST(Durability, ABackupIsTheDatabaseWithItsSumAndReplacedAsAWhole) {
    // Truth: closed form (SHA-256) and invariant; the second copy fails for want of space and leaves the first.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    perform(path, [](int) {});
    const auto store = fake::openStore(path);
    require(store->backup());
    EXPECT_EQ(bytesOf(path + ".backup.sha256"), sha256Hex(bytesOf(path + ".backup")) + "  s.db.backup\n");
    const std::string first = bytesOf(path + ".backup");
    require(store->enrol("S002", plan::ParticipantKind::Simulated, ""));
    {
        // SQLite's writes to the copy only: the database itself is not written.
        fake::FaultyDisk disk([](DiskWork work, std::int64_t number) {
            return isWrite(work) && number > 20 ? DiskFault{SQLITE_FULL, 0.0} : DiskFault{};
        });
        const auto full = store->backup();
        ASSERT_FALSE(full);
        EXPECT_NE(full.errors()[0].message.find("no space left"), std::string::npos) << full.errors()[0].message;
    }
    EXPECT_EQ(bytesOf(path + ".backup"), first);
    EXPECT_EQ(bytesOf(path + ".backup.sha256"), sha256Hex(first) + "  s.db.backup\n");
    for (const auto& entry : fs::directory_iterator(fs::path(path).parent_path()))
        EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
    require(store->backup());
    EXPECT_NE(bytesOf(path + ".backup"), first);
    EXPECT_EQ(Database(path + ".backup", OpenMode::ReadWrite).integer("SELECT count(*) FROM participant"), 2);
}

TEST(Durability, ADiskThatFillsOrFailsAtAnyMomentSaysSoAndKeepsWhatWasFinished) {
    // Truth: invariant. From a chosen work on every write is refused, as by a full or a broken disk.
    const fake::TempFolder folder;
    std::int64_t works = 0;
    for (const int result : {SQLITE_FULL, SQLITE_IOERR_WRITE}) {
        for (int i = 0; i < 12; ++i) {
            const std::int64_t from = i == 0 ? 1'000'000 : 1 + i * works / 12;
            SCOPED_TRACE("refused from work " + std::to_string(from) + " with " + std::to_string(result));
            const std::string path = folder / (std::to_string(result) + "_" + std::to_string(i) + ".db");
            int finished = 0;
            std::int64_t works_at_end = 0;  // of the last trial
            std::atomic<std::int64_t> latest = 0;
            std::string message;
            {
                fake::FaultyDisk disk([&](DiskWork work, std::int64_t number) {
                    latest = number;
                    const bool refused = number >= from && isWrite(work);
                    return refused ? DiskFault{result, 0.0} : DiskFault{};
                });
                try {
                    perform(path, [&](int trial) {
                        finished = trial;
                        works_at_end = latest;
                    });
                    if (i == 0) works = works_at_end;
                } catch (const std::exception& error) {
                    message = error.what();
                }
            }
            EXPECT_EQ(message.empty(), i == 0) << message;
            const char* words = result == SQLITE_FULL ? "database or disk is full" : "disk I/O error";
            if (i > 0) {
                EXPECT_NE(message.find(words), std::string::npos) << message;
                EXPECT_EQ(message.find('\n'), std::string::npos) << message;
            }
            expectFinished(path, static_cast<std::size_t>(finished), static_cast<std::size_t>(finished) + 1);
            if (HasFatalFailure()) return;
        }
    }
}

TEST(Durability, AFileThatMayNotBeWrittenIsRefusedInOneLine) {
    // Truth: invariant. Root may write everything, so a child of another user tries.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    perform(path, [](int) {});
    const fs::path parent = fs::path(path).parent_path();
    fs::permissions(path, fs::perms(0444));
    const std::string before = bytesOf(path);
    for (const bool folder_too : {false, true}) {
        fs::permissions(parent, folder_too ? fs::perms(0555) : fs::perms(0777));
        int ends[2];
        ASSERT_EQ(pipe(ends), 0);
        const pid_t child = fork();
        if (child == 0) {
            if (geteuid() == 0 && setuid(65534) != 0) _exit(2);
            const auto opened = Store::open(path, fake::options());
            const std::string text = opened.store ? "opened" : toString(opened.errors.front());
            _exit(write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()) ? 0 : 3);
        }
        close(ends[1]);
        std::string text(1000, '\0');
        text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(ends[0], text.data(), text.size()))));
        close(ends[0]);
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_EQ(status, 0);
        EXPECT_TRUE(text.starts_with(path + ": error: cannot be ")) << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    }
    fs::permissions(parent, fs::perms(0755));
    EXPECT_EQ(bytesOf(path), before);
}

TEST(Durability, AFileThatAnotherProgramHoldsIsWaitedForAndThenRefused) {
    // Truth: invariant. The other program keeps a transaction open.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    OpenOptions options = fake::options();
    options.busy_timeout_ms = 50;
    const auto store = fake::openStore(path, options);
    const auto writer = fake::beginSession(*store, "S001", 2);
    require(fake::writeAttempt(*writer, 0, kTicks));
    {
        const Database other(path, OpenMode::ReadWrite);
        other.execute("BEGIN IMMEDIATE");
        const auto refused = writer->startAttempt(fake::attemptStart(1));
        ASSERT_FALSE(refused);
        EXPECT_NE(refused.errors()[0].message.find("another program is using the database"), std::string::npos);
    }
    require(fake::writeAttempt(*writer, 1, kTicks));
    require(writer->finishSession(true, 0));
    EXPECT_EQ(require(require(StoreReader::open(path)).sessions())[0].end_state, "complete");
}

TEST(Durability, AnUpgradeIsDoneAsAWholeOrNotAtAll) {
    // Truth: invariant. A table in the way stops the last revision; the file stays of the first.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    fake::makeFirstRevision(path, "CREATE TABLE consent_clause(x)");
    const auto opened = Store::open(path, fake::options());
    EXPECT_EQ(opened.outcome, OpenOutcome::Failed);
    ASSERT_EQ(opened.errors.size(), 1u);
    {
        const Database old(path, OpenMode::ReadWrite);
        EXPECT_EQ(fileSchemaNumber(old), 1);
        EXPECT_EQ(old.integer("SELECT count(*) FROM sqlite_master WHERE name='accuracy_candidate'"), 0);
        old.execute("DROP TABLE consent_clause");
    }
    EXPECT_EQ(Store::open(path, fake::options()).outcome, OpenOutcome::Upgraded);
    perform(path, [](int) {});
    expectFinished(path, kTrials, kTrials);
}

TEST(Durability, AClockThatGoesBackwardsIsToldAndChangesNoOrder) {
    // Truth: invariant. The second session starts a year before the first, by the wall clock.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    const auto perform_at = [&](std::int64_t unix_ms, const char* code) {
        OpenOptions options = fake::options();
        options.now_utc = UtcClock::wall(unix_ms).at(0);
        const auto opened = Store::open(path, options);
        SessionStart start;
        start.protocol_sha256 = require(opened.store->importProtocol(fake::makePlan()));
        require(opened.store->enrol(code, plan::ParticipantKind::Simulated, options.now_utc));
        require(opened.store->assignSlot(start.protocol_sha256, code));
        start.participant = code;
        start.seed = 7;
        start.session_id = code;
        start.device.name = "sigma7";
        start.clock = UtcClock::wall(unix_ms);
        const auto writer = require(opened.store->createSession(start, fake::makeTrials(fake::makePlan(), 1)));
        require(fake::writeAttempt(*writer, 0, kTicks));
        require(writer->finishSession(true, 60'000'000'000));
        return opened.recovery.later_utc;
    };
    constexpr std::int64_t kYear = 31'536'000'000;
    EXPECT_EQ(perform_at(40 * kYear, "S001"), "");
    EXPECT_EQ(perform_at(39 * kYear, "S002"), UtcClock::wall(40 * kYear).at(60'000'000'000));
    EXPECT_EQ(perform_at(41 * kYear, "S003"), "");
    const auto sessions = require(require(StoreReader::open(path)).sessions());
    ASSERT_EQ(sessions.size(), 3u);
    for (const SessionRow& session : sessions) EXPECT_EQ(session.end_state, "complete");
}

}  // namespace
}  // namespace passung::store
