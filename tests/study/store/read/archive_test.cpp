#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <map>

#include "study/store/people/participant_records.h"
#include "study/store/schema/backup.h"
#include "study/store/schema/sqlite.h"
#include "study/store/transfer/restore.h"
#include "tests/study/store/fake_study.h"
#include "tests/study/store/first_revision.h"

// What a study leaves on a disk: nothing but the file when it is closed, nobody else's to read, and read without a
// change wherever it lies.

namespace passung::store {
namespace {

namespace fs = std::filesystem;
using fake::require;

constexpr uid_t kNobody = 65534;
constexpr std::size_t kTicks = 1200;

/// Name, mode and bytes of every file.
std::map<std::string, std::string> contentsOf(const fs::path& folder) {
    std::map<std::string, std::string> contents;
    for (const auto& entry : fs::directory_iterator(folder)) {
        struct stat file = {};
        stat(entry.path().c_str(), &file);
        std::ifstream stream(entry.path(), std::ios::binary);
        contents[entry.path().filename().string()] =
            std::to_string(file.st_mode) + ":" + std::string(std::istreambuf_iterator<char>(stream), {});
    }
    return contents;
}

std::vector<std::string> namesIn(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& [name, bytes] : contentsOf(folder)) names.push_back(name);
    return names;
}

void perform(const std::string& path, const std::string& code, std::int64_t trials = 2) {
    const auto store = fake::openStore(path);
    const auto writer = fake::beginSession(*store, code, trials);
    for (std::int64_t i = 0; i < trials; ++i) require(fake::writeAttempt(*writer, i, kTicks));
    require(writer->finishSession(true, 60'000'000'000));
}

/// A child begins a session, writes a trial and is killed: what it wrote lies in a log.
void performAndDie(const std::string& path, const std::string& code) {
    const pid_t child = fork();
    if (child == 0) {
        const auto store = fake::openStore(path);
        const auto writer = fake::beginSession(*store, code, 2);
        require(fake::writeAttempt(*writer, 0, kTicks));
        kill(getpid(), SIGKILL);
    }
    waitpid(child, nullptr, 0);
}

/// Runs `work` as somebody who owns nothing here, and says what it returned.
std::string asAnotherUser(const std::function<std::string()>& work) {
    int ends[2];
    if (pipe(ends) != 0) return "no pipe";
    const pid_t child = fork();
    if (child == 0) {
        if (geteuid() == 0 && (setgid(kNobody) != 0 || setuid(kNobody) != 0)) _exit(2);
        std::string text;
        try {
            text = work();
        } catch (const std::exception& error) {
            text = error.what();
        }
        _exit(write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()) ? 0 : 3);
    }
    close(ends[1]);
    std::string text(4000, '\0');
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(ends[0], text.data(), text.size()))));
    close(ends[0]);
    waitpid(child, nullptr, 0);
    return text;
}

/// What a reader finds: participants, then attempts with the ticks of each.
std::string found(const std::string& path) {
    const auto reader = StoreReader::open(path);
    if (!reader) return toString(reader.errors().front());
    std::string text = std::to_string(require(reader->participants()).size()) + " people";
    for (const AttemptRow& attempt : require(reader->attempts()))
        text += ", " + std::to_string(require(reader->records(attempt.attempt_id)).size());
    return text;
}

TEST(Archive, ASessionThatClosesLeavesNothingButTheFileWhoeverReadsMeanwhile) {
    // Truth: invariant (names in the folder). A reader with a snapshot holds the log until it ends.
    const test::TempFolder folder;
    const std::string path = folder / "s.db";
    perform(path, "S001");
    EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"s.db"});
    for (const bool reader_first : {true, false}) {
        auto store = fake::openStore(path);
        std::optional<StoreReader> reader = require(StoreReader::open(path));
        const std::string code = reader_first ? "S002" : "S003";
        {
            const auto writer = fake::beginSession(*store, code, 1);
            require(fake::writeAttempt(*writer, 0, kTicks));
            require(writer->finishSession(true, 60'000'000'000));
        }
        EXPECT_GT(namesIn(folder.path()).size(), 1u) << "the log, while it runs";
        if (reader_first) reader.reset();
        store.reset();
        reader.reset();
        EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"s.db"});
    }
    EXPECT_EQ(found(path), "3 people, 1200, 1200, 1200, 1200");
}

TEST(Archive, IsReadWithoutTheChangeOfAByteByItsOwnerAndByWhoMayOnlyRead) {
    // Truth: closed form (bytes, modes and names before and after) and invariant (what was stored is found).
    // Clean, with a killed session's log, and of an older program; the folder writable, then for nobody but root, as
    // whom nothing would be proven: another user reads there, in whose place files on a medium for reading only lie.
    struct Case {
        const char* name;
        std::function<void(const std::string&)> make;
        std::string found;
    };
    const std::vector<Case> cases = {
        {"clean", [](const std::string& path) { perform(path, "S001"); }, "1 people, 1200, 1200"},
        {"killed",
         [](const std::string& path) {
             perform(path, "S001");
             performAndDie(path, "S002");
             ASSERT_GT(fs::file_size(path + "-wal"), 0u);
         },
         "2 people, 1200, 1200, 1200"},
        {"older",
         [](const std::string& path) {
             fake::makeFirstRevision(path, "INSERT INTO participant VALUES('P001', 'real', 'enrolled', NULL, '')");
         },
         "1 people"}};
    for (const Case& each : cases) {
        SCOPED_TRACE(each.name);
        const test::TempFolder folder;
        const std::string path = folder / "a%b ?#.db";
        each.make(path);
        auto before = contentsOf(folder.path());
        EXPECT_EQ(found(path), each.found);
        auto after = contentsOf(folder.path());
        after.erase("a%b ?#.db-shm");  // an index into the log, which every reader may make anew
        before.erase("a%b ?#.db-shm");
        EXPECT_EQ(after, before);

        fs::remove(path + "-shm");
        fs::remove(path + ".lock");
        for (const auto& entry : fs::directory_iterator(folder.path())) fs::permissions(entry.path(), fs::perms(0444));
        fs::permissions(folder.path(), fs::perms(0555));
        before = contentsOf(folder.path());
        EXPECT_EQ(asAnotherUser([&] { return found(path); }), each.found);
        EXPECT_EQ(contentsOf(folder.path()), before);
        fs::permissions(folder.path(), fs::perms(0755));
    }
}

TEST(Archive, AReaderLeavesNoCopyBehind) {
    // Truth: invariant (names in the folder of temporary files)
    const test::TempFolder folder, temporary;
    const std::string path = folder / "s.db";
    fake::makeFirstRevision(path, "INSERT INTO participant VALUES('P001', 'real', 'enrolled', NULL, '')");
    setenv("TMPDIR", temporary.path().c_str(), 1);
    {
        const StoreReader reader = require(StoreReader::open(path));
        EXPECT_EQ(require(reader.participants()).size(), 1u);
        EXPECT_EQ(namesIn(temporary.path()), std::vector<std::string>{}) << "whatever becomes of this program";
    }
    unsetenv("TMPDIR");
}

/// Modes of all files of the folder but those that are named in `except`.
std::map<std::string, unsigned> modesIn(const fs::path& folder) {
    std::map<std::string, unsigned> modes;
    for (const auto& entry : fs::directory_iterator(folder)) {
        struct stat file = {};
        stat(entry.path().c_str(), &file);
        modes[entry.path().filename().string()] = file.st_mode & 0777;
    }
    return modes;
}

TEST(Archive, NobodyElseOpensADatabaseWhileItRunsOrLater) {
    // Truth: invariant (modes of the files; what another user gets to see). 022 is the usual mask.
    const mode_t mask = umask(022);
    const test::TempFolder folder;
    fs::permissions(folder.path(), fs::perms(0755));
    const std::string path = folder / "s.db";
    for (const bool group : {false, true}) {
        OpenOptions options = fake::options();
        options.group = group;
        const unsigned mode = group ? 0660 : 0600;
        const auto expectMode = [&](const std::vector<std::string>& names) {
            const auto modes = modesIn(folder.path());
            EXPECT_EQ(modes.size(), names.size());
            for (const std::string& name : names)
                EXPECT_EQ(modes.count(name) > 0 ? modes.at(name) : 0u, mode) << name << (group ? ", group" : "");
        };
        {
            const auto store = fake::openStore(path, options);
            const auto writer = fake::beginSession(*store, group ? "S002" : "S001", 2);
            require(fake::writeAttempt(*writer, 0, kTicks));
            require(store->backup());
            expectMode({"s.db", "s.db-wal", "s.db-shm", "s.db.lock", "s.db.backup", "s.db.backup.sha256"});
            if (geteuid() == 0) {
                EXPECT_NE(asAnotherUser([&] { return std::ifstream(path) ? "read" : "refused"; }), "read");
                EXPECT_NE(asAnotherUser([&] { return found(path); }).find("cannot be opened"), std::string::npos);
            }
            require(writer->finishSession(false, 60'000'000'000));
        }
        expectMode({"s.db", "s.db.backup", "s.db.backup.sha256"});
    }
    fake::openStore(path);
    EXPECT_EQ(modesIn(folder.path())["s.db"], 0660u) << "shared once is shared";
    for (const char* name : {"s.db", "s.db.backup"}) fs::permissions(folder / name, fs::perms(0664));
    fake::openStore(path);
    EXPECT_EQ(modesIn(folder.path())["s.db"], 0600u) << "of a program that left it open to all";
    EXPECT_EQ(modesIn(folder.path())["s.db.backup"], 0600u);
    umask(mask);
}

TEST(Archive, WhatIsNoFileKeepsItsMode) {
    // Truth: invariant: a pipe in the place of a database is refused, and who may use it is as before.
    const test::TempFolder folder;
    const std::string path = folder / "s.db";
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    fs::permissions(path, fs::perms(0666));
    EXPECT_FALSE(Store::open(path, fake::options()).store);
    EXPECT_EQ(fs::status(path).permissions(), fs::perms(0666));
    EXPECT_TRUE(fs::is_fifo(path));
}

TEST(Archive, AFileThatIsNotOursKeepsItsMode) {
    // Truth: invariant: another program's database and a text are refused, and who may use them is as before.
    const test::TempFolder folder;
    const std::string text = folder / "text.db", foreign = folder / "foreign.db";
    std::ofstream(text) << "somebody's words, which are no database at all, however long they are";
    Database(foreign, OpenMode::Create).execute("CREATE TABLE theirs(a)");
    for (const std::string& path : {text, foreign}) {
        fs::permissions(path, fs::perms(0644));
        EXPECT_FALSE(Store::open(path, fake::options()).store) << path;
        EXPECT_EQ(fs::status(path).permissions(), fs::perms(0644)) << path;
    }
}

TEST(Archive, ACircleOfLinksIsOneLine) {
    // Truth: invariant: whoever opens it for writing or reading is told the same.
    const test::TempFolder folder;
    const std::string path = folder / "s.db";
    fs::create_symlink("s.db", path);
    const auto written = Store::open(path, fake::options());
    ASSERT_EQ(written.errors.size(), 1u);
    const auto read = StoreReader::open(path);
    ASSERT_FALSE(read);
    const auto restored = restoreDatabase(path, path, fake::options());
    ASSERT_FALSE(restored);
    for (const Error& error : {written.errors.front(), read.errors().front(), restored.errors().front()})
        EXPECT_EQ(toString(error), path + ": error: is a symbolic link that leads round in a circle");
}

}  // namespace
}  // namespace passung::store
