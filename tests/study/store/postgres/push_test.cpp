#include "study/store/postgres/push.h"

#include <gtest/gtest.h>

#include <pqxx/pqxx>
#include <thread>

#include "study/store/people/participant_records.h"
#include "study/store/postgres/pull.h"
#include "study/store/schema/person_identity.h"
#include "study/store/schema/sqlite.h"
#include "study/store/transfer/restore.h"
#include "tests/study/store/damaged_study.h"
#include "tests/study/store/postgres.h"

namespace passung::store {
namespace {

using fake::require;

constexpr std::size_t kTicks = 1200;

void perform(const std::string& path, const std::string& code) {
    const auto store = fake::openStore(path);
    const auto writer = fake::beginSession(*store, code, 2);
    for (int trial = 0; trial < 2; ++trial) require(fake::writeAttempt(*writer, trial, kTicks));
    require(writer->finishSession(true, 1'000'000'000));
}

/// One server for all tests of this file; each has a study, and so a schema, of its own.
class Push : public testing::Test {
protected:
    static void SetUpTestSuite() {
        if (fake::Postgres::installed()) server_ = new fake::Postgres;
    }
    static void TearDownTestSuite() {
        delete server_;
        server_ = nullptr;
    }
    void SetUp() override {
        if (!fake::Postgres::installed()) GTEST_SKIP() << "no PostgreSQL server is installed";
        ASSERT_NE(server_, nullptr) << "the server did not start";
        there_ = std::make_unique<pqxx::connection>(server_->uri());
        pqxx::nontransaction(*there_).exec("DROP SCHEMA IF EXISTS fake CASCADE");
    }

    pqxx::result ask(const std::string& sql) const {
        pqxx::nontransaction work(*there_);
        work.exec("SET search_path TO fake");
        return work.exec(sql);
    }
    std::int64_t count(const std::string& table) const {
        return ask("SELECT count(*) FROM " + table)[0][0].as<std::int64_t>();
    }

    static fake::Postgres* server_;
    std::unique_ptr<pqxx::connection> there_;
    fake::TempFolder folder_;
};

fake::Postgres* Push::server_ = nullptr;

TEST_F(Push, CopiesEveryBitAndTheSameAgainCopiesNothing) {
    // Truth: independent program (PostgreSQL's own answers beside SQLite's)
    const std::string path = folder_ / "s.db";
    perform(path, "S001");
    perform(path, "S002");
    const PushReport first = require(pushDatabase(path, server_->uri()));
    EXPECT_EQ(first.sessions, 2);
    const Database here(path, OpenMode::ReadWrite);
    for (const char* table : {"session", "segment", "trial_plan", "attempt", "attempt_measure", "event", "stream",
                              "sample_chunk", "timing", "participant", "condition", "factor", "measure"})
        EXPECT_EQ(count(table), here.integer(std::string("SELECT count(*) FROM ") + table)) << table;
    const auto chunks =
        ask("SELECT encode(data, 'hex'), crc32 FROM sample_chunk JOIN session USING(session_id) "
            "ORDER BY participant_id, chunk_no");
    Statement own = here.prepare(
        "SELECT lower(hex(data)), crc32 FROM sample_chunk JOIN stream USING(stream_id) JOIN segment USING(segment_id) "
        "JOIN session USING(session_id) ORDER BY participant_id, chunk_no");
    for (const auto& row : chunks) {
        ASSERT_TRUE(own.step());
        EXPECT_EQ(row[0].c_str(), own.text(0));
        EXPECT_EQ(row[1].as<std::int64_t>(), own.integer(1));
    }
    EXPECT_FALSE(own.step());
    const auto third = ask("SELECT DISTINCT value_num=1::float8/3 FROM attempt_measure WHERE measure='peak_force_N'");
    ASSERT_EQ(third.size(), 1u);
    EXPECT_STREQ(third[0][0].c_str(), "t") << "the same double";
    EXPECT_STREQ(ask("SELECT label FROM (SELECT stages_json label FROM attempt) s LIMIT 1")[0][0].c_str(),
                 here.text("SELECT stages_json FROM attempt LIMIT 1").c_str());
    EXPECT_STREQ(ask("SELECT condition FROM trial_plan ORDER BY trial_index DESC LIMIT 1")[0][0].c_str(),
                 "penalty/0,5");

    const PushReport again = require(pushDatabase(path, server_->uri()));
    EXPECT_EQ(again.sessions + again.replaced, 0);
    EXPECT_EQ(again.known, 2);
    perform(path, "S003");
    const PushReport later = require(pushDatabase(path, server_->uri()));
    EXPECT_EQ(later.sessions, 1);
    EXPECT_EQ(later.known, 2);
    EXPECT_EQ(count("attempt"), 6);
}

TEST_F(Push, BringsAChangedSessionUpToDateAndLeavesOutARunningOne) {
    // Truth: invariant
    const std::string path = folder_ / "s.db";
    perform(path, "S001");
    require(pushDatabase(path, server_->uri()));
    const auto store = fake::openStore(path);
    require(store->invalidateAttempt(1, "was told"));
    const auto writer = fake::beginSession(*store, "S002", 1);
    const PushReport report = require(pushDatabase(path, server_->uri()));
    EXPECT_EQ(report.replaced, 1);
    EXPECT_EQ(report.unfinished, std::vector<std::string>{"S002, session 1"});
    EXPECT_STREQ(ask("SELECT sum(valid) FROM attempt")[0][0].c_str(), "1");
}

TEST_F(Push, AnOlderCopyNeverTakesAwayWhatANewerOneBrought) {
    // Truth: invariant: a note and an invalidation, each made in the file after it was copied, stay there; the newest
    // file, and one with something of its own that lacks nothing, are pushed as ever.
    const std::string path = folder_ / "s.db", copy = folder_ / "copy.db";
    perform(path, "S001");
    perform(path, "S002");
    require(pushDatabase(path, server_->uri()));
    std::filesystem::copy_file(path, copy);
    require(fake::openStore(path)->addNote(1, "the screen flickered"));
    EXPECT_EQ(require(pushDatabase(path, server_->uri())).replaced, 1);
    const auto push_copy = [&] { return require(pushDatabase(copy, server_->uri())); };
    EXPECT_EQ(push_copy().newer_there, std::vector<std::string>{"S001, session 1"});
    EXPECT_EQ(push_copy().known, 1) << "the other one";
    EXPECT_EQ(count("note"), 1);
    require(fake::openStore(path)->invalidateAttempt(4, "was told"));
    EXPECT_EQ(require(pushDatabase(path, server_->uri())).replaced, 1);
    EXPECT_EQ(push_copy().newer_there.size(), 2u);
    EXPECT_EQ(ask("SELECT count(*) FROM attempt WHERE valid=0")[0][0].as<int>(), 1);
    require(fake::openStore(path)->addNote(4, "both"));
    EXPECT_TRUE(require(pushDatabase(path, server_->uri())).newer_there.empty());
    EXPECT_EQ(count("note"), 2);
}

TEST_F(Push, AnOlderCopyNeverTakesBackWhoWasExcluded) {
    // Truth: invariant: the exclusion and the place that it freed stay as the newer file left them.
    const std::string path = folder_ / "s.db", copy = folder_ / "copy.db";
    perform(path, "S001");
    require(pushDatabase(path, server_->uri()));
    std::filesystem::copy_file(path, copy);
    require(ParticipantRecords(*fake::openStore(path), {"e", "2001-02-01"}).exclude("S001", "asleep"));
    EXPECT_TRUE(require(pushDatabase(path, server_->uri())).newer_there.empty());
    EXPECT_EQ(require(pushDatabase(copy, server_->uri())).newer_there, std::vector<std::string>{"S001"});
    EXPECT_STREQ(ask("SELECT status FROM participant")[0][0].c_str(), "excluded");
    EXPECT_EQ(count("design_slot"), 0);
}

TEST_F(Push, TakesFilesOfSeveralStationsButNoCodeForTwoPeople) {
    // Truth: invariant. Rows of both files have the same numbers.
    perform(folder_ / "a.db", "SA001");
    perform(folder_ / "b.db", "SB001");
    perform(folder_ / "c.db", "SA001");
    const Database other(folder_ / "c.db", OpenMode::ReadWrite);
    other.execute("UPDATE participant SET created_utc='2001-01-01T00:00:00.000Z'");
    require(pushDatabase(folder_ / "a.db", server_->uri()));
    require(pushDatabase(folder_ / "b.db", server_->uri()));
    EXPECT_EQ(count("attempt"), 4);
    const auto refused = pushDatabase(folder_ / "c.db", server_->uri());
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.errors()[0].message.find("SA001 stands for two people"), std::string::npos);
    other.execute(
        "UPDATE participant SET created_utc='2000-01-01T00:00:00.000Z'; UPDATE attempt SET state_hash='00'; DELETE "
        "FROM session_hash");
    const auto trials = pushDatabase(folder_ / "c.db", server_->uri());
    ASSERT_FALSE(trials);
    EXPECT_NE(trials.errors()[0].message.find("other trials"), std::string::npos) << trials.errors()[0].message;
    EXPECT_EQ(count("attempt"), 4);
}

TEST_F(Push, APlaceThatWasGivenBackHasItsNewOwnerOnly) {
    // Truth: invariant: S001 is excluded, S004 takes the place.
    const std::string path = folder_ / "s.db";
    perform(path, "S001");
    require(pushDatabase(path, server_->uri()));
    require(ParticipantRecords(*fake::openStore(path), {"e", "2001-02-03"}).exclude("S001", "asleep"));
    perform(path, "S004");
    EXPECT_EQ(require(pushDatabase(path, server_->uri())).shared_places, std::vector<std::string>{});
    const auto slots = ask("SELECT participant_id, sequence_index, replicate FROM design_slot");
    ASSERT_EQ(slots.size(), 1u);
    EXPECT_STREQ(slots[0][0].c_str(), "S004");
    EXPECT_EQ(slots[0][1].as<int>() + slots[0][2].as<int>(), 0);
    // Another file whose S101 has the same place is told, not lost.
    perform(folder_ / "b.db", "S101");
    EXPECT_EQ(require(pushDatabase(folder_ / "b.db", server_->uri())).shared_places,
              std::vector<std::string>{"S004, S101"});
}

TEST_F(Push, WhoWasErasedHereIsGoneThereAndDoesNotComeBackFromACopy) {
    // Truth: independent program (PostgreSQL's own answers): no row of any table names them.
    const std::string path = folder_ / "s.db", copy = folder_ / "copy.db";
    perform(path, "S001");
    perform(path, "S002");
    {
        const auto store = fake::openStore(path);
        require(ParticipantRecords(*store, {"e", "2001-02-03"}).exclude("S001", "S001 slept"));
    }
    Database(path, OpenMode::ReadWrite).copyTo(copy);
    require(pushDatabase(path, server_->uri()));
    EXPECT_EQ(count("audit"), 1);
    require(ParticipantRecords(*fake::openStore(path), {"e", "2001-02-04"}).erase("S001"));
    const auto expectGone = [&] {
        for (const char* table : {"participant", "session", "design_slot", "audit"})
            EXPECT_EQ(
                ask(std::string("SELECT count(*) FROM ") + table + " t WHERE t::text LIKE '%S001%'")[0][0].as<int>(), 0)
                << table;
        EXPECT_EQ(count("attempt"), 2) << "S002's";
        EXPECT_EQ(count("audit"), 2);
    };
    EXPECT_EQ(require(pushDatabase(path, server_->uri())).erased_there, std::vector<std::string>{"S001"});
    expectGone();
    const PushReport again = require(pushDatabase(copy, server_->uri()));
    EXPECT_EQ(again.left_out, std::vector<std::string>{"S001"});
    EXPECT_EQ(again.known, 1);
    expectGone();
}

TEST_F(Push, RefusesWhatAMergeRefuses) {
    // Truth: invariant (rows of two designs could not be told apart)
    const std::string path = folder_ / "s.db";
    perform(path, "S001");
    require(pushDatabase(path, server_->uri()));
    const auto refusal = [&](const std::string& change) {
        const std::string other = folder_ / "other.db";
        std::filesystem::remove(other);
        perform(other, "S101");
        Database(other, OpenMode::ReadWrite).execute("PRAGMA foreign_keys=OFF; " + change);
        const auto pushed = pushDatabase(other, server_->uri());
        return pushed ? "" : pushed.errors()[0].message;
    };
    pqxx::nontransaction(*there_).exec("UPDATE fake.protocol_version SET expanded_json='{\"seed\": 7}'");
    EXPECT_NE(refusal("UPDATE protocol_version SET expanded_json='{\"seed\": 8}'").find("another seed"),
              std::string::npos);
    const std::string renamed = "UPDATE protocol_version SET protocol_sha256='00'; ";
    std::string references;
    for (const char* table : {"condition", "factor", "protocol_measure", "design_slot", "session"})
        references += std::string("UPDATE ") + table + " SET protocol_sha256='00'; ";
    EXPECT_NE(refusal(renamed + references).find("has another text"), std::string::npos);
    EXPECT_NE(refusal("UPDATE measure SET formula_version=99 WHERE measure='peak_force_N'").find("peak_force_N"),
              std::string::npos);
    const std::string mesh = "INSERT INTO mesh_file SELECT protocol_sha256, 'a.stl', 'HASH', 1 FROM protocol_version";
    const auto meshOf = [&](const char* hash) {
        std::string sql = mesh;
        return sql.replace(sql.find("HASH"), 4, hash);
    };
    pqxx::nontransaction(*there_).exec(
        "INSERT INTO fake.mesh_file SELECT protocol_sha256, 'a.stl', 'aa', 1 FROM fake.protocol_version");
    EXPECT_NE(refusal(meshOf("bb")).find("mesh a.stl"), std::string::npos);
    EXPECT_EQ(count("session"), 1) << "nothing of the refused files is there";
    EXPECT_EQ(
        refusal(meshOf("aa") + "; UPDATE protocol_version SET expanded_json='{\"seed\": 7}'; DELETE FROM row_hash"),
        "");
}

TEST_F(Push, ASessionArrivesWholeOrNotAtAll) {
    // Truth: invariant. PostgreSQL refuses the last rows of the second session; the first one stays, and when the
    // obstacle is gone, only the second is copied.
    const std::string path = folder_ / "s.db";
    perform(path, "S001");
    require(pushDatabase(path, server_->uri()));
    perform(path, "S002");
    ask("CREATE FUNCTION stop() RETURNS trigger LANGUAGE plpgsql AS 'BEGIN RAISE EXCEPTION ''no room''; END'");
    ask("CREATE TRIGGER stop BEFORE INSERT ON timing EXECUTE FUNCTION stop()");
    const auto stopped = pushDatabase(path, server_->uri());
    ASSERT_FALSE(stopped);
    EXPECT_NE(stopped.errors()[0].message.find("PostgreSQL: ERROR:  no room"), std::string::npos)
        << stopped.errors()[0].message;
    EXPECT_EQ(count("session"), 1);
    EXPECT_EQ(count("attempt"), 2);
    ask("DROP TRIGGER stop ON timing");
    EXPECT_EQ(require(pushDatabase(path, server_->uri())).sessions, 1);
    EXPECT_EQ(count("timing"), 4);
}

TEST_F(Push, SeveralFirstOnesAtOnceAllArrive) {
    // Truth: invariant. Three stations, and one file three times: each round begins with an empty server.
    std::vector<std::string> stations;
    for (const char* code : {"S001", "S101", "S201"}) {
        stations.push_back(folder_ / (std::string(code) + ".db"));
        perform(stations.back(), code);
    }
    const std::vector<std::string> same(3, stations.front());
    for (int round = 0; round < 2; ++round)
        for (const auto& files : {stations, same}) {
            pqxx::nontransaction(*there_).exec("DROP SCHEMA IF EXISTS fake CASCADE");
            std::vector<std::string> problems(files.size());
            std::vector<std::thread> pushes;
            for (std::size_t i = 0; i < files.size(); ++i)
                pushes.emplace_back([&, i] {
                    if (const auto done = pushDatabase(files[i], server_->uri()); !done)
                        problems[i] = done.errors()[0].message;
                });
            for (std::thread& push : pushes) push.join();
            EXPECT_EQ(problems, std::vector<std::string>(files.size()));
            EXPECT_EQ(count("session"), files == same ? 1 : 3);
        }
}

TEST_F(Push, WhoWasPushedBeforeThereWereIdentitiesIsErasedThereToo) {
    // Truth: independent program (PostgreSQL's own answers). An older program pushed no identity.
    const std::string path = folder_ / "s.db";
    perform(path, "S001");
    {
        const auto store = fake::openStore(path);
        ParticipantRecords desk(*store, {"e", "2001-02-03"});
        require(desk.enrol("P001", plan::ParticipantKind::Real, "2001-02-03"));
    }
    const std::string nonce =
        Database(path, OpenMode::ReadOnly)
            .text("SELECT json_extract(detail_json, '$.nonce') FROM audit WHERE detail_json LIKE '%P001%'");
    Database(path, OpenMode::ReadWrite).execute("UPDATE participant SET identity=''; DELETE FROM row_hash");
    giveIdentities(Database(path, OpenMode::ReadWrite), "main");  // as an upgrade does
    require(pushDatabase(path, server_->uri()));
    ask("UPDATE participant SET identity=NULL");
    require(ParticipantRecords(*fake::openStore(path), {"e", "2001-02-04"}).erase("P001"));
    EXPECT_EQ(require(pushDatabase(path, server_->uri())).erased_there, std::vector<std::string>{"P001"});
    for (const char* table : {"participant", "audit"})
        EXPECT_EQ(ask(std::string("SELECT count(*) FROM ") + table +
                      " t WHERE t::text LIKE '%P001%' OR t::text LIKE '%" + nonce + "%'")[0][0]
                      .as<int>(),
                  0)
            << table;
}

/// Everything that the server holds of the sessions, a line a row.
std::vector<std::string> contents(pqxx::connection& there) {
    std::vector<std::string> lines;
    pqxx::nontransaction work(there);
    for (const char* table : {"session", "segment", "trial_plan", "attempt", "attempt_measure", "event", "stream",
                              "sample_chunk", "timing", "contact_energy", "session_hash"})
        for (const auto& row : work.exec(std::string("SELECT t::text FROM fake.") + table + " t ORDER BY 1"))
            lines.push_back(table + std::string(": ") + row[0].c_str());
    return lines;
}

TEST_F(Push, WhatIsDamagedHereDoesNotTravel) {
    // Truth: independent program (PostgreSQL's own bytes): the intact copy there stays, bit for bit.
    const std::string path = folder_ / "s.db", whole = folder_ / "whole.db";
    perform(path, "S001");
    perform(path, "S002");
    require(pushDatabase(path, server_->uri()));
    perform(path, "S003");
    Database(path, OpenMode::ReadWrite).copyTo(whole);
    const auto before = contents(*there_);
    for (const char* sql : {"UPDATE sample_chunk SET data=zeroblob(length(data)) WHERE stream_id=1 AND chunk_no=0",
                            "UPDATE sample_chunk SET crc32=crc32+1 WHERE stream_id=1 AND chunk_no=0",
                            "UPDATE attempt_measure SET value_num=2 WHERE attempt_id=1 AND measure='peak_force_N'",
                            "UPDATE event SET payload_json='{ }' WHERE attempt_id=2"}) {
        SCOPED_TRACE(sql);
        std::filesystem::copy_file(whole, path, std::filesystem::copy_options::overwrite_existing);
        Database(path, OpenMode::ReadWrite).execute("DELETE FROM session WHERE participant_id='S003'");
        Database(path, OpenMode::ReadWrite).execute(sql);
        const PushReport report = require(pushDatabase(path, server_->uri()));
        ASSERT_EQ(report.damaged.size(), 1u) << testing::PrintToString(report.damaged);
        EXPECT_NE(report.damaged[0].find("S001, session 1, trial "), std::string::npos) << report.damaged[0];
        EXPECT_EQ(report.known, 1);
        EXPECT_EQ(report.replaced + report.healed, 0);
        EXPECT_TRUE(contents(*there_) == before);
    }
    std::filesystem::copy_file(whole, path, std::filesystem::copy_options::overwrite_existing);
    Database(path, OpenMode::ReadWrite).execute("UPDATE participant SET status_reason='?' WHERE participant_id='S003'");
    const PushReport person = require(pushDatabase(path, server_->uri()));
    EXPECT_EQ(person.damaged, std::vector<std::string>{"participant S003: is not as it was written"});
    EXPECT_EQ(person.sessions, 0);
    Database(path, OpenMode::ReadWrite).execute("UPDATE condition SET levels_json='{}'");
    const auto refused = pushDatabase(path, server_->uri());
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.errors()[0].message.find("is damaged, nothing was pushed"), std::string::npos);
}

TEST_F(Push, WhoIsDamagedHereAndErasedThereIsLeftOutOnce) {
    // Truth: independent program (PostgreSQL's own answers): everybody else's sessions arrive.
    const std::string path = folder_ / "s.db", copy = folder_ / "copy.db";
    perform(path, "S001");
    perform(path, "S002");
    Database(path, OpenMode::ReadWrite).copyTo(copy);
    require(pushDatabase(path, server_->uri()));
    require(ParticipantRecords(*fake::openStore(path), {"e", "2001-02-04"}).erase("S001"));
    require(pushDatabase(path, server_->uri()));
    perform(copy, "S003");
    Database(copy, OpenMode::ReadWrite).execute("UPDATE participant SET status_reason='?' WHERE participant_id='S001'");
    EXPECT_EQ(require(pushDatabase(copy, server_->uri())).sessions, 1);
    EXPECT_EQ(count("session"), 2);
}

TEST_F(Push, ADamagedAuditDoesNotTravel) {
    // Truth: independent program (PostgreSQL's own answers)
    const std::string path = folder_ / "s.db";
    perform(path, "S001");
    require(ParticipantRecords(*fake::openStore(path), {"e", "2001-02-04"}).exclude("S001", "asleep"));
    Database(path, OpenMode::ReadWrite)
        .execute("UPDATE audit SET detail_json=replace(detail_json, 'asleep', 'asleeq')");
    const auto refused = pushDatabase(path, server_->uri());
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.errors()[0].message.find("audit, row 1: its detail has been changed"), std::string::npos)
        << refused.errors()[0].message;
    EXPECT_EQ(pqxx::nontransaction(*there_).exec("SELECT 1 FROM pg_namespace WHERE nspname='fake'").size(), 0u);
}

TEST_F(Push, HealsWhatIsDamagedThere) {
    // Truth: independent program (PostgreSQL's own bytes)
    const std::string path = folder_ / "s.db";
    perform(path, "S001");
    perform(path, "S002");
    require(pushDatabase(path, server_->uri()));
    const auto before = contents(*there_);
    for (const char* sql : {"UPDATE sample_chunk SET data=set_byte(data, 40, get_byte(data, 40) # 1) WHERE chunk_no=0",
                            "UPDATE attempt_measure SET value_num=2 WHERE attempt_id=1 AND measure='peak_force_N'",
                            "DELETE FROM event"}) {
        SCOPED_TRACE(sql);
        ask(sql);
        EXPECT_FALSE(contents(*there_) == before);
        EXPECT_GE(require(pushDatabase(path, server_->uri())).healed, 1);
        EXPECT_TRUE(contents(*there_) == before);
    }
    EXPECT_EQ(require(pushDatabase(path, server_->uri())).known, 2);
}

TEST_F(Push, AFileIsHealedFromThere) {
    // Truth: invariant: every value of the file is what it was.
    const std::string path = folder_ / "s.db";
    perform(path, "S001");
    perform(path, "S002");
    perform(folder_ / "other.db", "S101");
    require(pushDatabase(folder_ / "other.db", server_->uri()));
    require(pushDatabase(path, server_->uri()));
    const auto whole = fake::dump(path);
    Database(path, OpenMode::ReadWrite)
        .execute(
            "UPDATE sample_chunk SET data=zeroblob(length(data)) WHERE stream_id=1 AND chunk_no=0; UPDATE "
            "attempt_measure SET value_num=2 WHERE attempt_id=4 AND measure='peak_force_N'; UPDATE condition SET "
            "levels_json='{}' WHERE position=1");
    const RestoreReport report = require(restoreDatabase(path, server_->uri(), fake::options(), pullSessions));
    EXPECT_EQ(report.remaining, std::vector<std::string>{});
    EXPECT_EQ(report.healed.size(), 3u) << testing::PrintToString(report.healed);
    EXPECT_TRUE(fake::dump(path) == whole);
}

TEST(PushWithoutServer, IsOneLine) {
    // Truth: invariant (nobody listens there)
    const fake::TempFolder folder;
    perform(folder / "s.db", "S001");
    const auto pushed = pushDatabase(folder / "s.db", "postgresql:///none?host=" + (folder / "nowhere"));
    ASSERT_FALSE(pushed);
    const std::string line = toString(pushed.errors().front());
    EXPECT_NE(line.find("PostgreSQL: "), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
}

}  // namespace
}  // namespace passung::store
