#include "study/store/transfer/heal.h"

#include <gtest/gtest.h>

#include "study/store/people/participant_records.h"
#include "study/store/read/verify.h"
#include "study/store/transfer/merge.h"
#include "study/store/transfer/restore.h"
#include "tests/study/store/damaged_study.h"

namespace passung::store {
namespace {

using fake::require;

namespace fs = std::filesystem;

/// S001 with a note of the session and one that came later; `older_` is a copy from before the later one.
class Heal : public testing::Test {
protected:
    void SetUp() override {
        fake::performAsking(path_, "S001");
        Database(path_, OpenMode::ReadWrite).copyTo(older_);
        require(fake::openStore(path_)->addNote(1, "later"));
        require(ParticipantRecords(*fake::openStore(path_), {"e", "2001-02-02"}).exclude("S001", "asleep"));
        Database(path_, OpenMode::ReadWrite).copyTo(backup_);
    }
    static void change(const std::string& path, const std::string& sql) {
        Database(path, OpenMode::ReadWrite).execute(sql);
    }
    RestoreReport restoreFrom(const std::string& source) const {
        return require(restoreDatabase(path_, source, fake::options()));
    }
    std::int64_t notes(const std::string& where) const {
        return Database(path_, OpenMode::ReadOnly).integer("SELECT count(*) FROM note WHERE " + where);
    }

    fake::TempFolder folder_;
    const std::string path_ = folder_ / "s.db", older_ = folder_ / "older.db", backup_ = folder_ / "s.db.backup";
};

/// Flips in a note that came later, and in what is kept about it.
const std::vector<std::string> kOfALaterNote = {
    "UPDATE note SET text='latex' WHERE text='later'",
    "UPDATE later_change SET after_sha256='x' || substr(after_sha256, 2)",
    "UPDATE note SET text='latex' WHERE text='later'; UPDATE note SET text='?' WHERE note_id=1",
    "DELETE FROM note WHERE text='later'",
};

TEST_F(Heal, GivesBackWhatWasAddedLater) {
    // Truth: invariant: the source is a whole copy; every value is as it was.
    const auto whole = fake::dump(path_);
    for (const std::string& sql : kOfALaterNote) {
        SCOPED_TRACE(sql);
        fs::copy_file(backup_, path_, fs::copy_options::overwrite_existing);
        change(path_, sql);
        EXPECT_EQ(restoreFrom(backup_).remaining, std::vector<std::string>{});
        EXPECT_TRUE(fake::dump(path_) == whole);
    }
}

TEST_F(Heal, GivesBackTheFirstNoteOfASession) {
    // Truth: invariant: the run itself left none.
    {
        const auto store = fake::openStore(path_);
        const auto writer = fake::beginAskingSession(*store, fake::makeAskingPlan(), "S002", 1);
        require(writer->finishSession(false, fake::kSecond));
        require(store->addNote(0, "the first"));
    }
    Database(path_, OpenMode::ReadWrite).copyTo(folder_ / "newest.db");
    const auto whole = fake::dump(path_);
    change(path_, "UPDATE note SET text='the fizst' WHERE text='the first'");
    EXPECT_EQ(restoreFrom(folder_ / "newest.db").remaining, std::vector<std::string>{});
    EXPECT_TRUE(fake::dump(path_) == whole);
}

TEST_F(Heal, NeverTakesAwayWhatWasAddedLater) {
    // Truth: invariant: the source is a copy from before; the note stays, with its flip if it has one, and is named.
    for (std::size_t i = 0; i < 3; ++i) {
        SCOPED_TRACE(kOfALaterNote[i]);
        fs::copy_file(backup_, path_, fs::copy_options::overwrite_existing);
        change(path_, kOfALaterNote[i]);
        EXPECT_FALSE(restoreFrom(older_).remaining.empty());
        EXPECT_EQ(notes("text LIKE 'late_'"), 1);
    }
}

TEST_F(Heal, GivesBackWhatARowWasBeforeItWasChangedLater) {
    // Truth: invariant
    require(fake::openStore(path_)->invalidateAttempt(1, "was told"));
    Database(path_, OpenMode::ReadWrite).copyTo(folder_ / "newest.db");
    const auto whole = fake::dump(path_);
    change(path_, "UPDATE later_change SET before_sha256='00' WHERE before_sha256 IS NOT NULL");
    EXPECT_EQ(restoreFrom(folder_ / "newest.db").remaining, std::vector<std::string>{});
    EXPECT_TRUE(fake::dump(path_) == whole);
}

TEST_F(Heal, GivesRowsNumbersThatNobodyElseHas) {
    // Truth: invariant: B's notes have the numbers 2 to 4 in the file of all, and 1 to 3 in their own.
    const std::string b = folder_ / "b.db", all = folder_ / "all.db";
    const plan::StudyPlan plan = fake::makeAskingPlan();
    {
        const auto store = fake::openStore(b);
        const auto writer = fake::beginAskingSession(*store, plan, "S101", 2);
        for (int trial = 0; trial < 2; ++trial) require(fake::writeAttempt(*writer, trial, 100));
        for (const char* text : {"one", "two", "three"}) require(writer->addNote("e", text, 4 * fake::kSecond));
        require(writer->finishSession(true, 5 * fake::kSecond));
    }
    fake::performAsking(folder_ / "a.db", "S001");
    require(mergeDatabases({folder_ / "a.db", b}, all, fake::options()));
    const auto whole = fake::dump(all);
    change(all, "UPDATE note SET text='twa' WHERE text='two'; DELETE FROM event WHERE attempt_id=3");
    const RestoreReport report = require(restoreDatabase(all, b, fake::options()));
    EXPECT_EQ(report.remaining, std::vector<std::string>{});
    change(all, "UPDATE note SET text='twa' WHERE text='two'");
    EXPECT_EQ(require(restoreDatabase(all, b, fake::options())).remaining, std::vector<std::string>{});
    const Database database(all, OpenMode::ReadOnly);
    EXPECT_EQ(database.text("SELECT group_concat(note_id || text) FROM (SELECT * FROM note ORDER BY note_id)"),
              "1the lamp flickered,2one,3two,4three");
}

TEST_F(Heal, GivesBackRowsOfTheAudit) {
    // Truth: invariant: a flip in each column of a row; every value is as it was.
    const auto whole = fake::dump(path_);
    for (const char* sql : {"UPDATE audit SET detail_json=replace(detail_json, 'asleep', 'asleeq')",
                            "UPDATE audit SET t_utc='2001-02-03'", "UPDATE audit SET hash='00'",
                            "UPDATE audit SET detail_json=substr(detail_json, 2)",
                            "UPDATE audit SET detail_sha256='00'", "UPDATE audit SET prev_hash='00'"}) {
        SCOPED_TRACE(sql);
        fs::copy_file(backup_, path_, fs::copy_options::overwrite_existing);
        change(path_, std::string(sql) + " WHERE audit_id=(SELECT max(audit_id) FROM audit)");
        EXPECT_EQ(require(verifyDatabase(path_)).damages.empty(), false);
        const RestoreReport report = restoreFrom(backup_);
        EXPECT_EQ(report.remaining, std::vector<std::string>{});
        EXPECT_EQ(report.healed.size(), 1u) << testing::PrintToString(report.healed);
        EXPECT_TRUE(fake::dump(path_) == whole);
    }
}

TEST_F(Heal, BringsBackNoDetailAboutWhoWasErased) {
    // Truth: closed form (a search for the code's bytes): the source still holds the detail whose place is damaged.
    require(ParticipantRecords(*fake::openStore(path_), {"e", "2001-02-04"}).erase("S001"));
    change(path_, "UPDATE audit SET detail_json=replace(detail_json, 'erased', 'erasee') WHERE action='exclude'");
    EXPECT_EQ(restoreFrom(backup_).remaining, std::vector<std::string>{});
    for (const std::string& line : fake::dump(path_)) EXPECT_EQ(line.find("S001"), std::string::npos) << line;
}

TEST(Savepoint, EndsQuietlyWhereTheTransactionIsGone) {
    // Truth: documentation of SQLite: a full disk may roll the whole transaction back.
    const fake::TempFolder folder;
    const Database database(folder / "s.db", OpenMode::Create);
    const Transaction transaction(database);
    const Savepoint point(database);
    database.execute("ROLLBACK");
}

}  // namespace
}  // namespace passung::store
