#include <gtest/gtest.h>

#include "study/store/schema/sqlite.h"
#include "tests/study/store/fake_questionnaire.h"

// Sessions in real time: session time rests in pauses and questionnaires, the wall clock does not.

namespace passung::store {
namespace {

constexpr std::int64_t kSecond = 1'000;            // [ms]
constexpr std::int64_t kNs = 1'000'000'000;        // of a second
constexpr std::int64_t kNoon = 1'709'208'000'000;  // 2024-02-29T12:00:00Z

std::string utc(std::int64_t seconds_after_noon) { return UtcClock::wall(kNoon + seconds_after_noon * kSecond).at(0); }

class Stamps : public testing::Test {
protected:
    UtcClock::Now now() {
        return [this] { return now_ms_; };
    }
    std::unique_ptr<Store> open() {
        OpenOptions options = fake::options();
        options.now_utc = UtcClock::wall(now_ms_).at(0);
        return fake::openStore(path_, options);
    }
    SessionStart startOf(const UtcClock& clock) const {
        SessionStart start;
        start.protocol_sha256 = sha256_;
        start.participant = "P001";
        start.seed = plan_.seed;
        start.session_id = "first";
        start.device.name = "sigma7";
        start.clock = clock;
        return start;
    }
    std::unique_ptr<SessionWriter> begin(Store& store) {
        sha256_ = fake::require(store.importProtocol(plan_));
        fake::require(store.enrol("P001", plan::ParticipantKind::Real, utc(0)));
        fake::require(store.assignSlot(sha256_, "P001"));
        return fake::require(store.createSession(startOf(UtcClock::running(now())), fake::makeTrials(plan_, 4)));
    }
    static void append(SessionWriter& writer, const char* event, std::int64_t t_ns, const std::string& payload = "{}") {
        writer.appendEvent({.attempt = {}, .t_ns = t_ns, .source = "session", .event = event, .payload_json = payload});
    }
    std::string text(const std::string& sql) const { return Database(path_, OpenMode::ReadOnly).text(sql); }

    const fake::TempFolder folder_;
    const std::string path_ = folder_ / "s.db";
    const plan::StudyPlan plan_ = fake::makeAskingPlan();
    std::string sha256_;
    std::int64_t now_ms_ = kNoon;
};

TEST_F(Stamps, CountPausesAndQuestionnaires) {
    // Truth: closed form: one trial of 1 s, then a pause of 20 min, a form of 90 s and a note 5 s later; session time
    // knows of the second only.
    {
        const auto store = open();
        const auto writer = begin(*store);
        now_ms_ += 1 * kSecond;
        append(*writer, "command_pause", 1 * kNs);
        now_ms_ += 1200 * kSecond;
        append(*writer, "command_continue", 1 * kNs);
        append(*writer, "questionnaire_shown", 1 * kNs, R"({"form": "1|"})");
        now_ms_ += 90 * kSecond;
        fake::require(fake::storeForm(*writer, plan_, {1, {}, {}, {}}, {34, 1, 2, 1, 0, 3, std::nullopt}, 1 * kNs));
        now_ms_ += 5 * kSecond;
        fake::require(writer->addNote("experimenter", "yawns", 1 * kNs));
        now_ms_ += 2 * kSecond;
        fake::require(writer->finishSession(false, 1 * kNs));
    }
    EXPECT_EQ(text("SELECT started_utc || ' ' || ended_utc FROM session"), utc(0) + " " + utc(1298));
    EXPECT_EQ(text("SELECT group_concat(t_utc, ' ') FROM event WHERE event GLOB 'command_*'"),
              utc(1) + " " + utc(1201));
    EXPECT_EQ(text("SELECT started_utc || ' ' || completed_utc FROM questionnaire_run"), utc(1201) + " " + utc(1291));
    EXPECT_EQ(text("SELECT t_utc FROM note"), utc(1296));
    const auto events = fake::require(fake::require(StoreReader::open(path_)).events());
    ASSERT_EQ(events.size(), 4u);
    EXPECT_EQ(events[1].t_utc, utc(1201));
}

TEST_F(Stamps, AnInvalidationAfterTheSessionIsOfWhenItWasSaid) {
    // Truth: closed form: a trial, a pause of 20 min that session time does not know of, and an hour later the word.
    {
        const auto store = open();
        const auto writer = begin(*store);
        now_ms_ += 1200 * kSecond;
        fake::require(fake::writeAttempt(*writer, 0, 50));
        fake::require(writer->finishSession(true, 1 * kNs));
    }
    now_ms_ += 3600 * kSecond;
    fake::require(open()->invalidateAttempt(1, "was told"));
    EXPECT_EQ(text("SELECT t_utc FROM event WHERE event='command_invalidate'"), utc(4800));
}

TEST_F(Stamps, OfVirtualTimeAreNotStored) {
    // Truth: invariant: the reader derives them from session time, which is the same on every machine.
    const auto store = open();
    {
        const auto writer = fake::beginSession(*store, "S001", 4);
        append(*writer, "command_pause", 90 * kNs);
    }
    EXPECT_EQ(text("SELECT count(*) FROM event WHERE t_utc IS NOT NULL"), "0");
    EXPECT_EQ(fake::require(fake::require(StoreReader::open(path_)).events()).at(0).t_utc, "2000-01-01T00:01:30.000Z");
}

TEST_F(Stamps, AgeCountsFromTheLastSignOfLife) {
    // Truth: closed form. Three hours of session time and pauses, the last event a second of session time before the
    // program was killed; reopened 10 s later.
    {
        const auto store = open();
        const auto writer = begin(*store);
        now_ms_ += 3 * 3600 * kSecond;
        append(*writer, "command_continue", 60 * kNs);
        fake::require(writer->startAttempt(fake::attemptStart(0)));
    }
    now_ms_ += 10 * kSecond;
    {
        const auto session = fake::require(open()->unfinished(""));
        EXPECT_NEAR(*session.age_s, 10.0, 1e-3);
        EXPECT_EQ(session.latest_utc, utc(3 * 3600));
    }
    {  // of an older program, which stored no such stamps: session time is all there is
        Database(path_, OpenMode::ReadWrite).execute("UPDATE event SET t_utc=NULL");
        const auto session = fake::require(open()->unfinished(""));
        EXPECT_NEAR(*session.age_s, 3 * 3600 + 10.0 - 60.0, 1e-3);
    }
}

TEST_F(Stamps, NeverGoBackwardsAndTellOfAClockThatDid) {
    // Truth: invariant, over a session that a resumed one goes on with; the clock is set back by an hour in both.
    {
        const auto store = open();
        const auto writer = begin(*store);
        append(*writer, "a", 0);
        now_ms_ -= 3600 * kSecond;
        append(*writer, "b", 1);
        append(*writer, "c", 2);
        now_ms_ += 3600 * kSecond + 1 * kSecond;
        append(*writer, "d", 3);
    }
    now_ms_ -= 3600 * kSecond;
    {
        const auto store = open();
        const auto session = fake::require(store->unfinished("first"));
        const auto clock = UtcClock::running(now(), session.used_ns, session.latest_utc);
        const auto writer = fake::require(store->resumeSession(startOf(clock), session.used_ns));
        append(*writer, "e", 4);
        fake::require(writer->finishSession(false, 5));
    }
    EXPECT_EQ(text("SELECT group_concat(event || ' ' || t_utc, ', ') FROM (SELECT * FROM event WHERE event<>"
                   "'clock_set_back' ORDER BY event_id)"),
              "a " + utc(0) + ", b " + utc(0) + ", c " + utc(0) + ", d " + utc(1) + ", e " + utc(1));
    EXPECT_EQ(text("SELECT group_concat((payload_json->>'machine_utc') || ' ' || (payload_json->>'utc'), ', ') FROM "
                   "(SELECT * FROM event WHERE event='clock_set_back' ORDER BY event_id)"),
              utc(-3600) + " " + utc(0) + ", " + utc(-3599) + " " + utc(1));
    EXPECT_EQ(text("SELECT group_concat(started_utc, ' ') FROM segment"), utc(0) + " " + utc(1));
    EXPECT_EQ(text("SELECT ended_utc FROM session"), utc(1));
}

}  // namespace
}  // namespace passung::store
