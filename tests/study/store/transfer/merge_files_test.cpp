#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

#include "study/store/people/participant_records.h"
#include "study/store/read/verify.h"
#include "study/store/transfer/merge.h"
#include "tests/study/store/damaged_study.h"
#include "tests/study/store/killed_file.h"

namespace passung::store {
namespace {

using fake::require;

namespace fs = std::filesystem;

/// A station's file a.db with S001, and what became of them, all.db.
class MergeFiles : public testing::Test {
protected:
    void SetUp() override {
        fake::performAsking(a_, "S001");
        require(merge());
    }
    Result<MergeReport> merge(const OpenOptions& options = fake::options()) const {
        return mergeDatabases({a_}, all_, options);
    }
    void expectNothingLeft() const {
        for (const auto& entry : fs::directory_iterator(folder_.path()))
            EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
    }

    fake::TempFolder folder_;
    const std::string a_ = folder_ / "a.db", all_ = folder_ / "all.db";
};

TEST_F(MergeFiles, LeaveASourceAsItIsWithTheLogOfAKilledProgram) {
    // Truth: invariant: not a byte changes; what the log holds is merged.
    const fake::KilledFile killed(a_, folder_ / "killed.db");
    require(mergeDatabases({killed.path()}, all_, fake::options()));
    EXPECT_TRUE(killed.isUntouched());
    EXPECT_EQ(
        Database(all_, OpenMode::ReadOnly).integer("SELECT count(*) FROM participant WHERE participant_id='S009'"), 1);
    expectNothingLeft();
}

TEST_F(MergeFiles, ChangeTheFileBehindALink) {
    // Truth: invariant
    const std::string link = folder_ / "link.db";
    fs::create_symlink("all.db", link);
    fake::performAsking(a_, "S002");
    require(mergeDatabases({a_}, link, fake::options()));
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(Database(all_, OpenMode::ReadOnly).integer("SELECT count(*) FROM session"), 2);
}

TEST_F(MergeFiles, KeepTheGroupOfTheResult) {
    // Truth: invariant: with --group, which adds its bits, and afterwards without.
    if (geteuid() != 0) GTEST_SKIP() << "only root gives files to another group";
    ASSERT_EQ(chown(all_.c_str(), static_cast<uid_t>(-1), 12345), 0);
    for (const bool group : {true, false}) {
        OpenOptions options = fake::options();
        options.group = group;
        require(merge(options));
        struct stat file = {};
        ASSERT_EQ(stat(all_.c_str(), &file), 0);
        EXPECT_EQ(file.st_gid, 12345u) << group;
        EXPECT_EQ(file.st_mode & 0777u, 0660u);
    }
}

TEST_F(MergeFiles, LeaveNoCopyWhereAnotherProgramHasTheResultOpen) {
    // Truth: invariant: a copy would hold everybody's data.
    const Database other(all_, OpenMode::ReadWrite);
    other.execute("PRAGMA journal_mode=WAL; CREATE TABLE more(x)");
    const auto report = merge();
    ASSERT_FALSE(report);
    EXPECT_NE(report.errors()[0].message.find("another program"), std::string::npos) << report.errors()[0].message;
    expectNothingLeft();
}

TEST_F(MergeFiles, TakeNothingFromADamagedRowOfAPerson) {
    // Truth: invariant: the row of the result stays as it is, and fits its hash.
    const auto before = fake::dump(all_);
    Database(a_, OpenMode::ReadWrite).execute("UPDATE participant SET status='excluded', status_reason='?'");
    const MergeReport report = require(merge());
    EXPECT_EQ(report.damaged.size(), 1u) << testing::PrintToString(report.damaged);
    EXPECT_TRUE(fake::dump(all_) == before);
    // An act of the audit settles nothing by such a row either.
    Database(a_, OpenMode::ReadWrite).execute("UPDATE participant SET status='complete', status_reason=NULL");
    {
        const auto store = fake::openStore(a_);
        require(ParticipantRecords(*store, {"e", "2001-02-01"}).exclude("S001", "asleep"));
    }
    require(merge());
    require(ParticipantRecords(*fake::openStore(a_), {"e", "2001-02-02"}).readmit("S001", "awake"));
    Database(a_, OpenMode::ReadWrite).execute("UPDATE participant SET status='active'");
    require(merge());
    EXPECT_EQ(Database(all_, OpenMode::ReadOnly).text("SELECT status FROM participant"), "excluded");
    EXPECT_EQ(require(verifyDatabase(all_)).damages, std::vector<std::string>{});
}

}  // namespace
}  // namespace passung::store
