#include "study/run/log/study_log.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <utility>

#include "tests/support/temp_folder.h"

namespace passung::run {
namespace {

namespace fs = std::filesystem;

class StudyLogTest : public testing::Test {
protected:
    StudyLogTest() { std::ofstream(database_) << "a database"; }

    std::unique_ptr<StudyLog> open() {
        auto log = std::make_unique<StudyLog>(database_, "test",
                                              [this](const std::string& what) { warnings_.push_back(what); });
        log->begin();
        return log;
    }
    static unsigned modeOf(const std::string& path) {
        struct stat file = {};
        return stat(path.c_str(), &file) == 0 ? file.st_mode & 0777 : 0;
    }

    const test::TempFolder folder_;
    const std::string database_ = folder_ / "s.db", log_ = database_ + ".log";
    std::vector<std::string> warnings_;
};

TEST_F(StudyLogTest, LinesWaitForAStudysDatabaseAndBesideAnotherFileIsNoLog) {
    // Truth: closed form; where a log is already, nothing waits.
    StudyLog(database_, "refused", {}).tell("never");
    EXPECT_FALSE(fs::exists(log_));
    const auto log = std::make_unique<StudyLog>(database_, "test", nullptr);
    log->tell("before");
    EXPECT_FALSE(fs::exists(log_));
    log->begin();
    log->fail("after",
              {{.message = "must be odd", .file = "a.toml", .line = 3, .column = 4, .key = "k", .value = "8"}});
    const std::string text = logText(database_);
    EXPECT_EQ(text.find("test " PASSUNG_VERSION " starts; numerics "), sizeof "2026-01-01T00:00:00.000Z info:");
    EXPECT_LT(text.find(" info: before\n"), text.find(" error: after: a.toml:3:4: error: k: must be odd\n"));
    EXPECT_TRUE(text.ends_with("must be odd\n")) << text;
    StudyLog(database_, "later", {}).tell("at once");
    EXPECT_TRUE(logText(database_).ends_with(" info: at once\n"));
}

TEST_F(StudyLogTest, IsBoundedInSizeAndCountAndKeepsTheNewest) {
    // Truth: closed form: 50 000 lines of more than 100 bytes are more than three files hold.
    fs::permissions(database_, fs::perms(0660));
    const auto log = open();
    for (int i = 1; i <= 50'000; ++i) log->tell("line " + std::to_string(i) + std::string(80, '.'));
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
        EXPECT_LE(entry.file_size(), kLogBytes) << entry.path();
        EXPECT_EQ(modeOf(entry.path()), 0660u) << entry.path();
        ++files;
    }
    EXPECT_EQ(files, 4u) << "the database and three of the log";
    const std::string text = logText(database_);
    EXPECT_GT(text.size(), 2 * kLogBytes);
    EXPECT_TRUE(text.ends_with("line 50000" + std::string(80, '.') + "\n"));
    EXPECT_LT(text.find("line 40000."), text.find("line 49999.")) << "the oldest line first";
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(StudyLogTest, HasTheModeOfItsDatabaseAndIsNeverOpenToAll) {
    // Truth: closed form, with a mask that lets everybody read
    const mode_t mask = umask(022);
    for (const auto& [database, log] : {std::pair(0644u, 0600u), {0600u, 0600u}, {0660u, 0660u}}) {
        fs::permissions(database_, fs::perms(database));
        open()->tell("x");
        EXPECT_EQ(modeOf(log_), log);
    }
    umask(mask);
}

TEST_F(StudyLogTest, WhereItCannotBeWrittenOneWarningSaysSo) {
    // Truth: invariant: a folder, a pipe without a reader (which must not be waited for) and a link are left as they
    // are.
    const auto make = [this](int kind) {
        if (kind == 0) return fs::create_directory(log_);
        if (kind == 1) return mkfifo(log_.c_str(), 0600) == 0;
        fs::create_symlink(folder_ / "elsewhere", log_);
        return true;
    };
    for (int kind = 0; kind < 3; ++kind) {
        ASSERT_TRUE(make(kind));
        const auto log = open();
        for (int i = 0; i < 3; ++i) log->tell("x");
        ASSERT_EQ(warnings_.size(), 1u) << kind;
        EXPECT_EQ(warnings_.front().find("no log is kept beside the database: "), 0u);
        EXPECT_EQ(logText(database_), "");
        EXPECT_FALSE(fs::exists(folder_ / "elsewhere"));
        fs::remove(log_);
        warnings_.clear();
    }
}

/// This process as a user who may read the folder and write nothing in it.
class WithoutRights {
public:
    explicit WithoutRights(const fs::path& folder) : folder_(folder) {
        fs::permissions(folder_, fs::perms(0555));
        fs::permissions(folder_ / "s.db", fs::perms(0644));
        if (geteuid() == 0 && seteuid(65534) != 0) throw std::runtime_error("cannot become another user");
    }
    ~WithoutRights() {
        if (getuid() == 0 && seteuid(0) != 0) std::abort();
        fs::permissions(folder_, fs::perms(0755));
    }
    WithoutRights(const WithoutRights&) = delete;
    WithoutRights& operator=(const WithoutRights&) = delete;

private:
    fs::path folder_;
};

TEST_F(StudyLogTest, AFolderWithoutRightsIsOneWarning) {
    // Truth: closed form
    const WithoutRights rights(folder_.path());
    const auto log = open();
    log->tell("x");
    EXPECT_EQ(warnings_, std::vector<std::string>{"no log is kept beside the database: cannot be opened (Permission "
                                                  "denied)"});
    EXPECT_FALSE(fs::exists(log_));
}

TEST_F(StudyLogTest, RightsThatAreLostBeforeItRotatesAreOneWarning) {
    // Truth: invariant: what was written stays within its bound.
    const auto log = open();
    {
        const WithoutRights rights(folder_.path());
        for (int i = 0; i < 20'000; ++i) log->tell(std::string(100, '.'));
    }
    EXPECT_EQ(warnings_.size(), 1u);
    EXPECT_LE(fs::file_size(log_), kLogBytes);
    EXPECT_FALSE(fs::exists(database_ + ".1.log"));
}

}  // namespace
}  // namespace passung::run
