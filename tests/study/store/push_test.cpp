#include "study/store/push.h"

#include <gtest/gtest.h>

#include <pqxx/pqxx>

#include "study/store/sqlite.h"
#include "tests/study/store/fake_study.h"
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
        if (server_ == nullptr) GTEST_SKIP() << "no PostgreSQL server is installed";
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
    Database(path, OpenMode::ReadWrite).execute("UPDATE attempt SET valid=0 WHERE attempt_id=1");
    const auto store = fake::openStore(path);
    const auto writer = fake::beginSession(*store, "S002", 1);
    const PushReport report = require(pushDatabase(path, server_->uri()));
    EXPECT_EQ(report.replaced, 1);
    EXPECT_EQ(report.unfinished, std::vector<std::string>{"S002, session 1"});
    EXPECT_STREQ(ask("SELECT sum(valid) FROM attempt")[0][0].c_str(), "1");
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
    EXPECT_NE(refused.errors()[0].message.find("SA001 stands for somebody else"), std::string::npos);
    other.execute("UPDATE participant SET created_utc='2000-01-01T00:00:00.000Z'; UPDATE attempt SET state_hash='00'");
    const auto trials = pushDatabase(folder_ / "c.db", server_->uri());
    ASSERT_FALSE(trials);
    EXPECT_NE(trials.errors()[0].message.find("other trials"), std::string::npos) << trials.errors()[0].message;
    EXPECT_EQ(count("attempt"), 4);
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
