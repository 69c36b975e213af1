#include "study/store/transfer/restore.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "study/store/people/participant_records.h"
#include "study/store/read/verify.h"
#include "study/store/transfer/merge.h"
#include "tests/study/store/damaged_study.h"

namespace passung::store {
namespace {

using fake::require;

namespace fs = std::filesystem;

class Restore : public testing::Test {
protected:
    void SetUp() override {
        for (const char* code : {"S001", "S002"}) fake::performAsking(path_, code);
        Database(path_, OpenMode::ReadWrite).copyTo(backup_);
    }
    RestoreReport restore() const { return require(restoreDatabase(path_, backup_, fake::options())); }
    static void change(const std::string& path, const std::string& sql) {
        Database(path, OpenMode::ReadWrite).execute(sql);
    }
    static std::vector<std::string> damages(const std::string& path) { return require(verifyDatabase(path)).damages; }

    /// Writes rubbish into the pages from `first` on.
    void spoilPages(int first) const {
        std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
        for (int page = first; page < 12; ++page) {
            file.seekp(4096 * page);
            file << std::string(200, '\x5a');
        }
    }

    fake::TempFolder folder_;
    const std::string path_ = folder_ / "s.db", backup_ = folder_ / "s.db.backup";
};

TEST_F(Restore, GivesBackEveryKindOfValueAndTouchesNothingElse) {
    // Truth: invariant: after one planted change each, every value of the file is what it was before it.
    const auto whole = fake::dump(path_);
    for (const fake::Planted& plant : fake::kPlanted) {
        SCOPED_TRACE(plant.sql);
        fs::copy_file(backup_, path_, fs::copy_options::overwrite_existing);
        change(path_, std::string("PRAGMA foreign_keys=OFF; ") + plant.sql);
        const RestoreReport report = restore();
        EXPECT_EQ(report.remaining, std::vector<std::string>{});
        EXPECT_FALSE(report.healed.empty());
        EXPECT_FALSE(report.anew);
        EXPECT_TRUE(fake::dump(path_) == whole);
    }
}

TEST_F(Restore, LeavesAloneWhatIsSound) {
    // Truth: invariant: not a byte changes.
    const auto bytes = [&] {
        std::ifstream file(path_, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    const std::string before = bytes();
    change(backup_, "UPDATE item_response SET value_num=1; UPDATE sample_chunk SET data=zeroblob(9)");
    const RestoreReport report = restore();
    EXPECT_TRUE(report.healed.empty() && report.remaining.empty());
    EXPECT_EQ(bytes(), before);
}

TEST_F(Restore, KeepsWhatCameAfterTheBackup) {
    // Truth: invariant: a session, a note and an invalidation that the backup lacks are there afterwards, and the
    // damage in one of the rows that was changed later is healed.
    fake::performAsking(path_, "S003");
    require(fake::openStore(path_)->invalidateAttempt(1, "was told"));
    require(fake::openStore(path_)->addNote(1, "later"));
    const auto whole = fake::dump(path_);
    change(path_,
           "UPDATE attempt SET start_ns=start_ns+64 WHERE attempt_id=1; UPDATE attempt_measure SET value_num=2 "
           "WHERE attempt_id=3 AND measure='peak_force_N'");
    EXPECT_EQ(damages(path_).size(), 3u) << testing::PrintToString(damages(path_));
    EXPECT_EQ(restore().remaining, std::vector<std::string>{});
    EXPECT_TRUE(fake::dump(path_) == whole);
}

TEST_F(Restore, HealsFromACopyThatIsDamagedElsewhereAndNamesWhatIsDamagedInBoth) {
    // Truth: invariant
    const std::string chunk = "UPDATE sample_chunk SET data=zeroblob(length(data)) WHERE stream_id=1 AND chunk_no=";
    const std::string answer = "UPDATE item_response SET value_num=1 WHERE run_id=1 AND item='located'";
    change(path_, chunk + "0; " + answer + "; " + chunk + "2");
    change(backup_, chunk + "1; " + chunk + "2; UPDATE note SET text='?' WHERE note_id=1");
    const RestoreReport report = restore();
    EXPECT_EQ(report.healed.size(), 2u) << testing::PrintToString(report.healed);
    ASSERT_EQ(report.remaining.size(), 1u) << testing::PrintToString(report.remaining);
    EXPECT_NE(report.remaining[0].find("trial 2, attempt 1, samples: chunk of samples from tick 0"), std::string::npos)
        << report.remaining[0];
    EXPECT_EQ(damages(path_), report.remaining);
}

TEST_F(Restore, HealsFromAFileWhereRowsHaveOtherNumbers) {
    // Truth: invariant: the file of one station heals the file of all.
    const std::string other = folder_ / "other.db", all = folder_ / "all.db";
    fake::performAsking(other, "S101");
    require(mergeDatabases({other, path_}, all, fake::options()));
    const auto whole = fake::dump(all);
    const std::string of_second =
        "(SELECT max(attempt_id) FROM attempt); UPDATE sample_chunk SET data=zeroblob(3) WHERE stream_id=3 AND "
        "chunk_no=1; UPDATE item_response SET value_num=1 WHERE run_id=3 AND item='located'; UPDATE trial_plan SET "
        "trial_index=9 WHERE trial_id=3";
    change(all, "UPDATE attempt SET outcome='failure' WHERE attempt_id=" + of_second);
    EXPECT_GE(damages(all).size(), 4u);
    EXPECT_EQ(require(restoreDatabase(all, path_, fake::options())).remaining, std::vector<std::string>{});
    EXPECT_TRUE(fake::dump(all) == whole);
}

TEST_F(Restore, AFileWhosePagesAreDamagedIsMadeAnewAndKeptBeside) {
    // Truth: invariant
    const auto whole = fake::dump(backup_);
    spoilPages(2);
    const RestoreReport report = restore();
    EXPECT_TRUE(report.anew);
    EXPECT_TRUE(fs::exists(report.kept));
    EXPECT_EQ(damages(path_), std::vector<std::string>{});
    EXPECT_TRUE(fake::dump(path_) == whole);
}

TEST_F(Restore, SharesTheFileWithTheGroupIfItWas) {
    // Truth: invariant: of whoever could open the damaged file.
    const auto modeOf = [&] { return fs::status(path_).permissions(); };
    for (const auto mode :
         {fs::perms::owner_read | fs::perms::owner_write,
          fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read | fs::perms::group_write}) {
        change(path_, "UPDATE note SET text='?' WHERE note_id=1");
        fs::permissions(path_, mode);
        EXPECT_FALSE(restore().healed.empty());
        EXPECT_EQ(modeOf(), mode);
    }
}

TEST_F(Restore, BringsNobodyBackWhoWasErased) {
    // Truth: invariant: the backup still holds them; not one row of theirs is in the healed file.
    require(ParticipantRecords(*fake::openStore(path_), {"e", "2001-02-02"}).erase("S002"));
    const auto erased = fake::dump(path_);
    change(path_, "UPDATE sample_chunk SET data=zeroblob(length(data)) WHERE stream_id=1 AND chunk_no=0");
    EXPECT_EQ(restore().healed.size(), 1u);
    EXPECT_TRUE(fake::dump(path_) == erased);
    spoilPages(3);
    const RestoreReport report = restore();
    EXPECT_TRUE(report.anew);
    const Database anew(path_, OpenMode::ReadOnly);
    EXPECT_EQ(anew.text("SELECT count(*) FROM participant WHERE participant_id='S002'"), "0")
        << testing::PrintToString(report.remaining);
}

TEST_F(Restore, ASourceThatIsNoneChangesNothing) {
    // Truth: invariant
    change(path_, "UPDATE note SET text='?' WHERE note_id=1");
    const auto before = fake::dump(path_);
    std::ofstream(folder_ / "text.db") << "no database";
    for (const std::string& from : {folder_ / "none.db", folder_ / "text.db"}) {
        const auto report = restoreDatabase(path_, from, fake::options());
        ASSERT_FALSE(report) << from;
        EXPECT_TRUE(fake::dump(path_) == before);
    }
    for (const auto& entry : fs::directory_iterator(folder_.path()))
        EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
}

}  // namespace
}  // namespace passung::store
