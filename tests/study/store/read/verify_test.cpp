#include "study/store/read/verify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "study/store/people/participant_records.h"
#include "study/store/read/store_reader.h"
#include "study/store/schema/sqlite.h"
#include "study/store/transfer/merge.h"
#include "tests/study/store/damaged_study.h"

namespace passung::store {
namespace {

using fake::require;

class Verify : public testing::Test {
protected:
    void SetUp() override {
        for (const char* code : {"S001", "S002"}) fake::performAsking(path_, code, plan_);
    }
    std::vector<std::string> damages() const { return require(verifyDatabase(path_)).damages; }
    void change(const std::string& sql) const { Database(path_, OpenMode::ReadWrite).execute(sql); }
    /// The last session is resumed and ends.
    void goOn() const {
        const auto store = fake::openStore(path_);
        const Unfinished session = require(store->unfinished(""));
        SessionStart start;
        start.session_id = session.session_id;
        start.participant = session.participant;
        start.protocol_sha256 = session.protocol_sha256;
        start.seed = session.seed;
        start.device.name = "sigma7";
        const auto writer = require(store->resumeSession(start, session.used_ns));
        require(writer->addNote("e", "again", session.used_ns));
        require(writer->finishSession(false, session.used_ns + fake::kSecond));
    }
    void expectDamage(const std::string& line) const {
        const auto found = damages();
        EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                                [&](const auto& damage) { return damage.find(line) != std::string::npos; }))
            << line << " is not in:\n"
            << testing::PrintToString(found);
    }

    fake::TempFolder folder_;
    const std::string path_ = folder_ / "s.db";
    const plan::StudyPlan plan_ = fake::makeAskingPlan();
};

TEST_F(Verify, FindsNothingInWhatWasWritten) {
    // Truth: invariant
    const Verification found = require(verifyDatabase(path_));
    EXPECT_TRUE(found.damages.empty()) << testing::PrintToString(found.damages);
    EXPECT_TRUE(found.not_hashed.empty()) << testing::PrintToString(found.not_hashed);
    EXPECT_EQ(found.sessions, 2);
    EXPECT_EQ(found.chunks, 8);
}

TEST_F(Verify, NamesEveryValueThatIsNotAsItWasWritten) {
    // Truth: invariant: one planted change each, of every kind of value; the row and its place are named.
    const std::string whole = folder_ / "whole.db";
    Database(path_, OpenMode::ReadWrite).copyTo(whole);
    for (const fake::Planted& plant : fake::kPlanted) {
        SCOPED_TRACE(plant.sql);
        std::filesystem::copy_file(whole, path_, std::filesystem::copy_options::overwrite_existing);
        change(std::string("PRAGMA foreign_keys=OFF; ") + plant.sql);
        expectDamage(plant.line);
    }
}

TEST_F(Verify, WhatPeopleChangeLaterIsNoDamageButHasAHashOfItsOwn) {
    // Truth: invariant: an invalidation, a note, an exclusion, a readmission; each of them changed afterwards is found.
    {
        const auto store = fake::openStore(path_);
        require(store->invalidateAttempt(2, "was told"));
        require(store->addNote(3, "spoke"));
        require(ParticipantRecords(*store, {"e", "2001-02-03"}).exclude("S002", "asleep"));
        require(ParticipantRecords(*store, {"e", "2001-02-04"}).readmit("S002", "awake"));
        require(ParticipantRecords(*store, {"e", "2001-02-05"}).exclude("S002", "asleep again"));
    }
    EXPECT_EQ(damages(), std::vector<std::string>{});
    const std::string whole = folder_ / "whole.db";
    Database(path_, OpenMode::ReadWrite).copyTo(whole);
    for (const char* sql : {"UPDATE attempt SET valid=1, invalid_reason=NULL WHERE attempt_id=2",
                            "UPDATE attempt SET invalid_reason='?' WHERE attempt_id=2",
                            "UPDATE note SET text='sbroke' WHERE text='spoke'", "DELETE FROM note WHERE text='spoke'",
                            "UPDATE participant SET status='complete' WHERE participant_id='S002'",
                            "DELETE FROM event WHERE event='command_invalidate'",
                            "UPDATE audit SET detail_json=replace(detail_json, 'asleep again', 'asleep againn')"}) {
        SCOPED_TRACE(sql);
        std::filesystem::copy_file(whole, path_, std::filesystem::copy_options::overwrite_existing);
        change(sql);
        EXPECT_FALSE(damages().empty());
    }
}

TEST_F(Verify, HashesSurviveMergingWhateverNumbersTheRowsGet) {
    // Truth: invariant: sessions come to a file that has others, under new numbers, with notes of two copies.
    const std::string other = folder_ / "other.db", all = folder_ / "all.db";
    fake::performAsking(other, "S101", plan_);
    require(mergeDatabases({other, path_}, all, fake::options()));
    require(fake::openStore(path_)->addNote(1, "later"));
    require(fake::openStore(path_)->invalidateAttempt(1, "slept"));
    require(mergeDatabases({path_}, all, fake::options()));
    const Verification found = require(verifyDatabase(all));
    EXPECT_EQ(found.damages, std::vector<std::string>{});
    EXPECT_EQ(found.not_hashed, std::vector<std::string>{});
    EXPECT_EQ(found.sessions, 3);
}

TEST_F(Verify, ASessionThatWasCutOffIsHashedWhenItIsFound) {
    // Truth: invariant: until then it is said to have no hash, and no damage.
    {
        const auto store = fake::openStore(path_);
        const auto writer = fake::beginAskingSession(*store, plan_, "S003", 2);
        require(fake::writeAttempt(*writer, 0, 100));
        require(writer->startAttempt(fake::attemptStart(1)));
    }
    EXPECT_EQ(require(verifyDatabase(path_)).not_hashed, std::vector<std::string>{"S003, session 1"});
    EXPECT_EQ(damages(), std::vector<std::string>{});
    fake::openStore(path_);
    EXPECT_EQ(require(verifyDatabase(path_)).not_hashed, std::vector<std::string>{});
    EXPECT_EQ(damages(), std::vector<std::string>{});
    change("UPDATE attempt SET start_ns=start_ns+1 WHERE outcome='crashed'");
    expectDamage("S003, session 1, trial 2, attempt 1");
}

TEST_F(Verify, AnOlderDatabaseIsNotHashedAndHasNoDamage) {
    // Truth: invariant: without the tables' rows, as an upgrade leaves them, only checksums can be compared.
    change("DELETE FROM session_hash; DELETE FROM row_hash; DELETE FROM later_change");
    const Verification found = require(verifyDatabase(path_));
    EXPECT_EQ(found.damages, std::vector<std::string>{});
    EXPECT_EQ(found.not_hashed.size(), 3u);
    change("UPDATE sample_chunk SET crc32=crc32+1 WHERE chunk_no=2 AND stream_id=2");
    expectDamage("S002, session 1, trial 2, attempt 1, samples: chunk of samples from tick 0: checksum");
}

TEST_F(Verify, LaterColumnsWithTheirDefaultDoNotChangeAHash) {
    // Truth: invariant: what a later schema adds says nothing about older rows.
    change(
        "ALTER TABLE attempt ADD COLUMN mood TEXT; ALTER TABLE note ADD COLUMN kind INTEGER NOT NULL DEFAULT 7; ALTER "
        "TABLE condition ADD COLUMN hue TEXT NOT NULL DEFAULT 'red'; INSERT INTO schema_revision SELECT "
        "max(revision)+1, "
        "'later', 1, '' FROM schema_revision");
    EXPECT_EQ(damages(), std::vector<std::string>{});
    change("UPDATE attempt SET mood='good' WHERE attempt_id=1");
    expectDamage("S001, session 1, trial 1, attempt 1");
}

TEST_F(Verify, DamageStaysDamageWhateverIsWrittenAfterIt) {
    // Truth: invariant: a row that changes after a flip in it; a session that goes on after one.
    change("UPDATE participant SET created_utc='2000-01-01T00:00:00.001Z' WHERE participant_id='S002'");
    require(ParticipantRecords(*fake::openStore(path_), {"e", "2001-02-03"}).exclude("S002", "asleep"));
    expectDamage("participant S002");
    const std::string whole = folder_ / "whole.db";
    {
        const auto store = fake::openStore(path_);
        const auto writer = fake::beginAskingSession(*store, plan_, "S003", 2);
        require(writer->addNote("e", "spoke", fake::kSecond));
        require(writer->finishSession(false, 2 * fake::kSecond));
    }
    Database(path_, OpenMode::ReadWrite).copyTo(whole);
    const std::vector<std::pair<std::string, std::string>> flips = {
        {"UPDATE note SET text='sbroke' WHERE text='spoke'", "S003, session 1, note"},
        {"UPDATE session SET experimenter='x' WHERE participant_id='S003'", "S003, session 1, session"},
        {"UPDATE session_hash SET sha256='00' WHERE unit='plan' AND session_id=(SELECT session_id FROM session WHERE "
         "participant_id='S003')",
         "S003, session 1, the list of its hashes is damaged"}};
    for (const auto& [sql, line] : flips) {
        SCOPED_TRACE(sql);
        std::filesystem::copy_file(whole, path_, std::filesystem::copy_options::overwrite_existing);
        change(sql);
        goOn();
        expectDamage(line);
    }
    std::filesystem::copy_file(whole, path_, std::filesystem::copy_options::overwrite_existing);
    goOn();
    EXPECT_EQ(damages(), std::vector<std::string>{"participant S002: is not as it was written"});
}

TEST_F(Verify, AnUpgradedDatabaseIsHashedFromThenOn) {
    // Truth: invariant: rows of before are found changed; until it is opened for writing they are said to have no hash.
    fake::makeOlderThanHashes(path_);
    EXPECT_EQ(require(verifyDatabase(path_)).not_hashed.front(), "the study's own rows");
    fake::openStore(path_);
    for (const std::string& line : require(verifyDatabase(path_)).not_hashed)
        EXPECT_EQ(line.find("rows"), std::string::npos) << line;
    change("UPDATE measure SET formula='?' WHERE measure='peak_force_N'");
    expectDamage("measure peak_force_N");
}

TEST_F(Verify, CountsRowsWithoutAHashBesideOthersThatHaveOne) {
    // Truth: invariant
    change("DELETE FROM row_hash WHERE table_name='participant'");
    EXPECT_EQ(require(verifyDatabase(path_)).not_hashed, std::vector<std::string>{"2 of the study's own rows"});
}

TEST(DamagedIndex, IsToldAndWhatIsFoundThroughItIsWhatWasWritten) {
    // Truth: invariant: the intact file's events. One bit of the last cell of an index is flipped in the file's bytes;
    // a row of the plan is given to no session.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    fake::performAsking(path, "S001");
    const auto eventsOf = [&](const StoreReader& reader) {
        std::vector<std::string> events;
        for (const EventRow& row : require(reader.events())) events.push_back(row.event + row.payload_json);
        return events;
    };
    const auto whole = eventsOf(require(StoreReader::open(path, Damaged::LeftOut)));
    std::int64_t page = 0, size = 0;
    {
        const Database database(path, OpenMode::ReadOnly);
        page = database.integer("SELECT rootpage FROM sqlite_schema WHERE name='event_of_attempt'");
        size = database.integer("PRAGMA page_size");
    }
    {
        std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
        char last = 0;
        file.seekg(page * size - 1).get(last);
        file.seekp(page * size - 1).put(static_cast<char>(last ^ 1));
    }
    EXPECT_FALSE(require(verifyDatabase(path)).damages.empty());
    {
        const StoreReader reader = require(StoreReader::open(path, Damaged::LeftOut));
        EXPECT_FALSE(reader.damages().empty());
        EXPECT_EQ(eventsOf(reader), whole);
    }
    fake::performAsking(folder / "t.db", "S001");
    Database(folder / "t.db", OpenMode::ReadWrite)
        .execute("PRAGMA foreign_keys=OFF; UPDATE trial_plan SET session_id='?' WHERE trial_id=1");
    EXPECT_FALSE(require(StoreReader::open(folder / "t.db", Damaged::LeftOut)).damages().empty());
}

}  // namespace
}  // namespace passung::store
