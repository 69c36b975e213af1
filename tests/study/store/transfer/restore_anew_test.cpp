#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "study/store/people/participant_records.h"
#include "study/store/read/verify.h"
#include "study/store/transfer/restore.h"
#include "tests/study/store/damaged_study.h"
#include "tests/study/store/killed_file.h"

namespace passung::store {
namespace {

using fake::require;

namespace fs = std::filesystem;

constexpr std::size_t kPage = 4096;

std::string bytesOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Makes a file that holds S003 beside its backup's S001 and S002, with a page of S001's samples that nobody can read.
class RestoreAnew : public testing::Test {
protected:
    void SetUp() override {
        for (const char* code : {"S001", "S002"}) fake::performAsking(path_, code);
        Database(path_, OpenMode::ReadWrite).copyTo(backup_);
        fake::performAsking(path_, "S003");
    }
    /// Breaks the chain of pages that hold a chunk of S001's.
    void breakPage() const {
        std::string inside;
        {
            const Database database(path_, OpenMode::ReadWrite);
            Statement chunk = database.prepare("SELECT data FROM sample_chunk WHERE stream_id=1 AND chunk_no=0");
            chunk.step();
            const auto blob = chunk.blob(0);
            inside.assign(reinterpret_cast<const char*>(blob.data()) + 2 * kPage, 64);
        }
        const std::size_t at = bytesOf(path_).find(inside);
        ASSERT_NE(at, std::string::npos);
        std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
        file.seekp(static_cast<std::streamoff>(at / kPage * kPage));
        file << std::string(8, '\x5a');
    }
    /// The rest of the first page.
    void spoil(std::size_t from) const {
        std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
        file.seekp(static_cast<std::streamoff>(from));
        file << std::string(kPage - from, '\x5a');
    }
    void change(const std::string& sql) const { Database(path_, OpenMode::ReadWrite).execute(sql); }
    /// As a program before there were hashes left it.
    void makeOlder() const { fake::makeOlderThanHashes(path_); }
    RestoreReport restore() const { return require(restoreDatabase(path_, backup_, fake::options())); }
    std::int64_t sessionsOf(const std::string& code) const {
        return Database(path_, OpenMode::ReadOnly)
            .integer("SELECT count(*) FROM session WHERE participant_id='" + code + "'");
    }
    static bool tells(const std::vector<std::string>& lines, const std::string& what) {
        return std::any_of(lines.begin(), lines.end(),
                           [&](const std::string& line) { return line.find(what) != std::string::npos; });
    }

    fake::TempFolder folder_;
    const std::string path_ = folder_ / "s.db", backup_ = folder_ / "s.db.backup";
};

TEST_F(RestoreAnew, TakesOverWhatIsIntactAndNewer) {
    // Truth: invariant: a session that only the damaged file has is in the new one, and all of it is sound.
    breakPage();
    const RestoreReport report = restore();
    EXPECT_TRUE(report.anew);
    EXPECT_TRUE(fs::exists(report.kept));
    EXPECT_EQ(sessionsOf("S003"), 1) << testing::PrintToString(report.remaining);
    EXPECT_EQ(sessionsOf("S001"), 1);
    EXPECT_EQ(require(verifyDatabase(path_)).damages, std::vector<std::string>{});
    EXPECT_TRUE(tells(report.healed, "S001, session 1")) << testing::PrintToString(report.healed);
    EXPECT_EQ(report.remaining, std::vector<std::string>{});  // the source had all that was damaged
}

TEST_F(RestoreAnew, TakesOverWhatIsNewerBesideADamagedRowOfTheStudy) {
    // Truth: invariant: the row in the new file is the source's.
    change("UPDATE measure SET formula='?' WHERE measure='peak_force_N'");
    breakPage();
    const RestoreReport report = restore();
    EXPECT_EQ(sessionsOf("S003"), 1) << testing::PrintToString(report.remaining);
    EXPECT_TRUE(tells(report.healed, "measure peak_force_N")) << testing::PrintToString(report.healed);
    EXPECT_EQ(require(verifyDatabase(path_)).damages, std::vector<std::string>{});
}

TEST_F(RestoreAnew, TellsOfASessionThatHadNotEnded) {
    // Truth: invariant: as after a power cut.
    {
        const auto store = fake::openStore(path_);
        const auto writer = fake::beginAskingSession(*store, fake::makeAskingPlan(), "S004", 2);
        require(fake::writeAttempt(*writer, 0, 100));
    }
    breakPage();
    const RestoreReport report = restore();
    EXPECT_TRUE(tells(report.remaining, "S004, session 1")) << testing::PrintToString(report.remaining);
    EXPECT_EQ(sessionsOf("S003"), 1);
}

TEST_F(RestoreAnew, ReadsADamagedFileOfAnOlderSchema) {
    // Truth: invariant
    makeOlder();
    breakPage();
    const RestoreReport report = restore();
    EXPECT_TRUE(report.anew);
    EXPECT_EQ(sessionsOf("S003"), 1) << testing::PrintToString(report.remaining);
}

TEST_F(RestoreAnew, NeverReplacesAFileWhosePagesAreSound) {
    // Truth: invariant: a table in the way stops the upgrade; not a byte changes.
    makeOlder();
    change("CREATE TABLE row_hash(x)");
    const std::string before = bytesOf(path_);
    const auto report = restoreDatabase(path_, backup_, fake::options());
    ASSERT_FALSE(report);
    EXPECT_NE(report.errors()[0].message.find("row_hash"), std::string::npos) << report.errors()[0].message;
    EXPECT_TRUE(bytesOf(path_) == before);
    EXPECT_FALSE(fs::exists(path_ + ".damaged"));
}

TEST_F(RestoreAnew, NeverReplacesAFileByAnotherStudy) {
    // Truth: invariant
    plan::StudyPlan other = fake::makeAskingPlan();
    other.name = "another";
    other.source_text += "# another\n";
    fake::performAsking(folder_ / "other.db", "S001", other);
    breakPage();
    const std::string before = bytesOf(path_);
    const auto report = restoreDatabase(path_, folder_ / "other.db", fake::options());
    ASSERT_FALSE(report);
    EXPECT_NE(report.errors()[0].message.find("holds the study fake"), std::string::npos) << report.errors()[0].message;
    EXPECT_TRUE(bytesOf(path_) == before);
}

TEST_F(RestoreAnew, TellsWhatOnlyTheDamagedFileHad) {
    // Truth: invariant: a note that was made after the backup, in the session whose samples cannot be read.
    require(fake::openStore(path_)->addNote(1, "later"));
    breakPage();
    const RestoreReport report = restore();
    EXPECT_TRUE(tells(report.remaining, "S001, session 1")) << testing::PrintToString(report.remaining);
    for (const auto* lines : {&report.remaining, &report.healed, &report.told})
        EXPECT_FALSE(tells(*lines, ".part")) << testing::PrintToString(*lines);
}

TEST_F(RestoreAnew, TakesNoDamagedRowWhereSessionsCannotBeFound) {
    // Truth: invariant: a row that was changed is nowhere, though the index by which a person's sessions are found is
    // spoilt: neither of whom the source has nor of whom it has not.
    change("UPDATE participant SET status_reason='?' WHERE participant_id IN('S002','S003')");
    const std::int64_t page = Database(path_, OpenMode::ReadOnly)
                                  .integer(
                                      "SELECT rootpage FROM sqlite_schema WHERE tbl_name='session' AND "
                                      "type='index' AND name LIKE '%\\_2' ESCAPE '\\'");
    ASSERT_GT(page, 1);
    std::fstream(path_, std::ios::binary | std::ios::in | std::ios::out).seekp((page - 1) * 4096)
        << std::string(kPage, '\x5a');
    const RestoreReport report = restore();
    EXPECT_TRUE(report.anew);
    EXPECT_EQ(Database(path_, OpenMode::ReadOnly).integer("SELECT count(*) FROM participant WHERE status_reason='?'"),
              0)
        << testing::PrintToString(report.remaining);
    EXPECT_EQ(require(verifyDatabase(path_)).damages, std::vector<std::string>{});
}

TEST_F(RestoreAnew, AFileThatCannotSayItsStudyIsReplacedByNone) {
    // Truth: invariant: of the file no page but the first has its header.
    plan::StudyPlan other = fake::makeAskingPlan();
    other.name = "another";
    other.source_text += "# another\n";
    fake::performAsking(folder_ / "other.db", "S001", other);
    spoil(100);
    const std::string before = bytesOf(path_);
    const auto refused = restoreDatabase(path_, folder_ / "other.db", fake::options());
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.errors()[0].message.find("names the study of " + (folder_ / "other.db")), std::string::npos)
        << refused.errors()[0].message;
    EXPECT_TRUE(bytesOf(path_) == before);
    EXPECT_TRUE(restore().anew);  // its own: the protocol's hash stands further on
    EXPECT_EQ(require(verifyDatabase(path_)).damages, std::vector<std::string>{});
}

TEST_F(RestoreAnew, BringsNobodyBackWhoWasErasedAndSaysSoInTheAudit) {
    // Truth: invariant
    require(ParticipantRecords(*fake::openStore(path_), {"e", "2001-02-02"}).erase("S002"));
    breakPage();
    const RestoreReport report = restore();
    EXPECT_TRUE(report.anew);
    const Database anew(path_, OpenMode::ReadOnly);
    EXPECT_EQ(anew.integer("SELECT count(*) FROM participant WHERE participant_id='S002'"), 0);
    EXPECT_GE(anew.integer("SELECT count(*) FROM audit WHERE action='erase'"), 1);
    EXPECT_EQ(bytesOf(path_).find("S002"), std::string::npos);
    EXPECT_EQ(require(verifyDatabase(path_)).damages, std::vector<std::string>{});
}

TEST_F(RestoreAnew, HealsTheFileBehindALink) {
    // Truth: invariant: the link stays one; sound pages and damaged ones.
    const std::string link = folder_ / "link.db";
    fs::create_symlink("s.db", link);
    change("UPDATE note SET text='?' WHERE note_id=1");
    EXPECT_EQ(require(restoreDatabase(link, backup_, fake::options())).remaining, std::vector<std::string>{});
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(require(verifyDatabase(path_)).damages, std::vector<std::string>{});
    breakPage();
    EXPECT_TRUE(require(restoreDatabase(link, backup_, fake::options())).anew);
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(require(verifyDatabase(path_)).damages, std::vector<std::string>{});
}

TEST_F(RestoreAnew, LeavesTheSourceAsItIs) {
    // Truth: invariant: not a byte of it changes, nor of the log that a killed program left beside it.
    const fake::KilledFile killed(backup_, folder_ / "killed.db");
    change("UPDATE note SET text='?' WHERE note_id=1");
    EXPECT_EQ(require(restoreDatabase(path_, killed.path(), fake::options())).healed.size(), 1u);
    EXPECT_TRUE(killed.isUntouched());
}

}  // namespace
}  // namespace passung::store
