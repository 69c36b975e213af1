#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "study/store/schema/sqlite.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

// A disk that is really full: a file system of so many kB in memory, mounted for one run in a name space of its own.

namespace passung::test {
namespace {

namespace fs = std::filesystem;

class FullDisk : public testing::Test {
protected:
    FullDisk() {
        writeText(folder_ / "study.toml", smallStudy());
        fs::create_directory(folder_ / "disk");
    }

    /// Runs the shell's `commands` in the test's folder; their exit code.
    int shell(const std::string& commands) const {
        const std::string line = "cd '" + folder_.path().string() + "' && " + commands;
        const int status = std::system(line.c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }

    /// `passung run` with its database on a disk of so many kB. What is there at the end is copied to `after/`.
    int runOn(int kilobytes) const {
        fs::remove_all(folder_ / "after");
        fs::create_directory(folder_ / "after");
        return shell("unshare -rm sh -c 'mount -t tmpfs -o size=" + std::to_string(kilobytes) +
                     "k disk disk && { " PASSUNG_PROGRAM
                     " run study.toml --db disk/s.db --no-backup --acknowledge-fd 3 3>acks >out 2>err; code=$?; "
                     "test -e disk/s.db && cp disk/s.db* after/; exit $code; }'");
    }

    std::set<std::string> acknowledged() const {
        const auto lines = linesOf(readText(folder_ / "acks"));
        return {lines.begin(), lines.end()};
    }

    /// "attempt outcome", as it is acknowledged, of every attempt that has ended.
    std::set<std::string> stored() const {
        std::set<std::string> lines;
        if (!fs::exists(folder_ / "after/s.db")) return lines;
        const store::Database database(folder_ / "after/s.db", store::OpenMode::ReadWrite);
        if (database.integer("SELECT count(*) FROM sqlite_master WHERE name='attempt'") == 0) return lines;
        auto row = database.prepare("SELECT attempt_id || ' ' || outcome FROM attempt WHERE end_ns IS NOT NULL");
        while (row.step()) lines.insert(row.text(0));
        EXPECT_EQ(database.text("PRAGMA integrity_check"), "ok");
        return lines;
    }

    TempFolder folder_;
};

TEST_F(FullDisk, SaysSoInALineAndLosesNothingFinished) {
    // Truth: invariant: what was acknowledged is there; with room the session goes on to its end. Sizes from one that
    // holds no database to one that holds all: the disk fills while tables are made, in a trial, at a commit.
    if (shell("unshare -rm mount -t tmpfs disk disk 2>/dev/null") != 0)
        GTEST_SKIP() << "this user or container may not mount a file system in memory";
    int full = 0, begun = 0;
    for (const int kilobytes : {60, 450, 600, 800, 1500, 16'000}) {
        SCOPED_TRACE(std::to_string(kilobytes) + " kB");
        const int code = runOn(kilobytes);
        const std::set<std::string> before = acknowledged(), there = stored();
        EXPECT_TRUE(std::includes(there.begin(), there.end(), before.begin(), before.end()))
            << "an acknowledged attempt is lost";
        if (code == 0) continue;
        ++full;
        EXPECT_EQ(code, 1);
        const auto lines = linesOf(readText(folder_ / "err"));
        ASSERT_EQ(lines.size(), 1u) << readText(folder_ / "err");
        EXPECT_EQ(lines[0].rfind("disk/s.db: error: ", 0), 0u) << lines[0];
        EXPECT_NE(lines[0].find("full"), std::string::npos) << lines[0];
        if (before.empty()) continue;
        ++begun;
        const Ended resumed = runProgram(folder_.path(), {"resume", "after/s.db"});
        EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
        const store::Database database(folder_ / "after/s.db", store::OpenMode::ReadOnly);
        EXPECT_EQ(database.integer("SELECT count(DISTINCT trial_id) FROM attempt WHERE valid"), 6);
    }
    EXPECT_GE(full, 3) << "else nothing was tested";
    EXPECT_GE(begun, 1) << "else no disk filled during a session";
    EXPECT_EQ(stored().size(), 6u) << "the last disk holds all";
}

TEST_F(FullDisk, ALimitOfTheFilesSizeIsAnErrorAndNoDeath) {
    // Truth: invariant: a limit of the shell (kB) would end the program by a signal before it could say why.
    EXPECT_EQ(shell("ulimit -f 200; " PASSUNG_PROGRAM " run study.toml --db s.db --no-backup >out 2>err"), 1);
    const auto lines = linesOf(readText(folder_ / "err"));
    ASSERT_EQ(lines.size(), 1u) << readText(folder_ / "err");
    EXPECT_EQ(lines[0], "s.db: error: the disk refuses it (disk I/O error)");
}

}  // namespace
}  // namespace passung::test
