#include "study/store/people/participant_records.h"

#include <gtest/gtest.h>

#include <fstream>

#include "study/store/schema/sqlite.h"
#include "tests/study/store/fake_study.h"

namespace passung::store {
namespace {

using fake::require;
using plan::ParticipantKind;

const Actor kActor{"experimenter", "2001-02-03T04:05:06.000Z"};

plan::StudyPlan planWithConsent() {
    plan::StudyPlan plan = fake::makePlan();
    plan.consent = {{"data_use", true, {{"de", "Auswertung?"}, {"en", "Analysis?"}}},
                    {"photos", false, {{"de", "Fotos?"}, {"en", "Photos?"}}}};
    return plan;
}

/// A session of a participant of any kind, as far as its creation.
Result<std::unique_ptr<SessionWriter>> begin(Store& store, const std::string& sha256, const std::string& code,
                                             std::int64_t trials = 2) {
    SessionStart start;
    start.protocol_sha256 = sha256;
    start.participant = code;
    start.ordinal = require(store.nextOrdinal(code));
    start.seed = fake::makePlan().seed;
    start.session_id = sessionId("fake", code, start.ordinal, start.seed);
    start.device.name = "sigma7";
    return store.createSession(start, fake::makeTrials(fake::makePlan(), trials));
}

void completeSession(Store& store, const std::string& sha256, const std::string& code) {
    require(store.assignSlot(sha256, code));
    const auto writer = require(begin(store, sha256, code));
    for (int trial = 0; trial < 2; ++trial) require(fake::writeAttempt(*writer, trial, 100));
    require(writer->finishSession(true, 1'000'000'000));
}

template <class T>
std::string messageOf(const Result<T>& result) {
    return result ? "" : result.errors().front().message;
}

TEST(ParticipantRecords, EnrolsACodeOnceAndOfOneKindOnly) {
    // Truth: invariant
    const fake::TempFolder folder;
    const auto store = fake::openStore(folder / "s.db");
    ParticipantRecords desk(*store, kActor);
    require(desk.enrol("P001", ParticipantKind::Real, ""));
    EXPECT_EQ(messageOf(desk.enrol("P001", ParticipantKind::Real, "")), "participant P001 is already enrolled");
    EXPECT_NE(messageOf(desk.enrol("P002", ParticipantKind::Pilot, "")), "");
    EXPECT_NE(messageOf(store->enrol("P001", ParticipantKind::Simulated, "")), "") << "a run with a real code";
    EXPECT_EQ(require(store->nextCode(ParticipantKind::Real)), "P002");
}

TEST(ParticipantRecords, NobodyTakesPartWithoutTheRequiredConsentToTheProtocolsOwnWords) {
    // Truth: invariant. A yes in either language counts, the last decision wins, a changed text is asked anew.
    const fake::TempFolder folder;
    const auto store = fake::openStore(folder / "s.db");
    const std::string sha256 = require(store->importProtocol(planWithConsent()));
    ParticipantRecords desk(*store, kActor);
    for (const auto& [code, kind] :
         {std::pair("P001", ParticipantKind::Real), std::pair("T001", ParticipantKind::Pilot)}) {
        require(desk.enrol(code, kind, ""));
        const std::string refusal = messageOf(begin(*store, sha256, code));
        EXPECT_NE(refusal.find("requires: data_use"), std::string::npos) << refusal;
        EXPECT_EQ(refusal.find("photos"), std::string::npos) << "not required";
        EXPECT_FALSE(store->assignSlot(sha256, code)) << "no slot is used up";
    }
    EXPECT_EQ(require(desk.decide("P001", {"photos"}, "en", Consent::Yes)), std::vector<std::string>{"photos"});
    EXPECT_FALSE(begin(*store, sha256, "P001"));
    EXPECT_EQ(require(desk.decide("P001", {}, "de", Consent::Yes)), (std::vector<std::string>{"data_use", "photos"}));
    EXPECT_TRUE(begin(*store, sha256, "P001"));
    require(desk.decide("P001", {"data_use"}, "en", Consent::Withdrawn));
    EXPECT_FALSE(begin(*store, sha256, "P001")) << "the last decision was in the other language";
    require(desk.decide("P001", {}, "en", Consent::Yes));
    EXPECT_TRUE(begin(*store, sha256, "P001"));

    require(store->enrol("S001", ParticipantKind::Simulated, ""));
    EXPECT_TRUE(begin(*store, sha256, "S001")) << "simulated participants are not asked";

    plan::StudyPlan changed = planWithConsent();
    changed.version = "1.1";
    changed.source_text += "# changed\n";
    changed.consent[0].texts[1].second = "Analysis and publication?";
    changed.consent[0].texts[0].second = "Auswertung und Publikation?";
    const std::string next = require(store->importProtocol(changed));
    EXPECT_FALSE(begin(*store, next, "P001"));
    EXPECT_FALSE(desk.decide("P001", {"video"}, "en", Consent::Yes));
    EXPECT_FALSE(desk.decide("P001", {}, "fr", Consent::Yes));
    EXPECT_FALSE(desk.decide("P009", {}, "en", Consent::Yes));
}

TEST(ParticipantRecords, ExclusionFreesThePlaceAndCountsNowhereButKeepsEveryRow) {
    // Truth: invariant (the next participant gets the same row of the square)
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    const auto store = fake::openStore(path);
    const std::string sha256 = require(store->importProtocol(fake::makePlan()));
    ParticipantRecords desk(*store, kActor);
    for (const char* code : {"P001", "P002"}) {
        require(desk.enrol(code, ParticipantKind::Real, ""));
        completeSession(*store, sha256, code);
    }
    require(desk.exclude("P001", "did not hold the handle"));
    EXPECT_NE(messageOf(desk.exclude("P001", "again")), "");
    EXPECT_NE(messageOf(begin(*store, sha256, "P001")), "");
    require(desk.enrol("P003", ParticipantKind::Real, ""));
    EXPECT_EQ(require(store->assignSlot(sha256, "P003")).number, 0);
    const StoreReader reader = require(StoreReader::open(path));
    for (const AttemptRow& attempt : require(reader.attempts())) {
        EXPECT_EQ(attempt.counts(), attempt.participant_id == "P002");
        EXPECT_EQ(attempt.invalid_reason.value_or(""), attempt.counts() ? "" : "participant excluded");
    }
    EXPECT_EQ(Database(path, OpenMode::ReadOnly).integer("SELECT sum(valid) FROM attempt"), 4) << "raw data stays";
    EXPECT_EQ(require(reader.participants())[0].status_reason, "did not hold the handle");
}

TEST(ParticipantRecords, AnExclusionIsTakenBackWithDataStatusAndPlaceAsLongAsNobodyHasIt) {
    // Truth: invariant (the table before the exclusion), but for a place that has another owner by now.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    const auto store = fake::openStore(path);
    const std::string sha256 = require(store->importProtocol(fake::makePlan()));
    ParticipantRecords desk(*store, kActor);
    require(desk.enrol("P001", ParticipantKind::Real, ""));
    completeSession(*store, sha256, "P001");
    require(desk.exclude("P001", "mixed up with another one"));
    EXPECT_TRUE(require(desk.readmit("P001", "it was not them")));
    EXPECT_NE(messageOf(desk.readmit("P001", "again")).find("is not excluded"), std::string::npos);
    const auto standing = [&] { return require(require(StoreReader::open(path)).participants())[0]; };
    EXPECT_EQ(standing().status, "complete");
    EXPECT_EQ(standing().status_reason, "readmitted: it was not them");
    EXPECT_EQ(standing().sequence_index, 0);
    EXPECT_EQ(Database(path, OpenMode::ReadOnly).text("SELECT state FROM design_slot WHERE participant_id='P001'"),
              "complete");
    for (const AttemptRow& attempt : require(require(StoreReader::open(path)).attempts()))
        EXPECT_TRUE(attempt.counts());

    require(desk.exclude("P001", "it was them"));
    require(desk.enrol("P002", ParticipantKind::Real, ""));
    EXPECT_EQ(require(store->assignSlot(sha256, "P002")).number, 0);
    EXPECT_FALSE(require(desk.readmit("P001", "at last"))) << "its place is taken";
    EXPECT_FALSE(standing().sequence_index);
    EXPECT_EQ(standing().status, "complete");

    require(desk.exclude("P001", "asked for it", "withdraw"));
    EXPECT_NE(messageOf(desk.readmit("P001", "")).find("has withdrawn"), std::string::npos);
    EXPECT_NE(messageOf(desk.readmit("P009", "")).find("is not enrolled"), std::string::npos);
    EXPECT_TRUE(require(require(StoreReader::open(path)).audit()).faults.empty());
}

TEST(ParticipantRecords, WithdrawalThatOnlyStopsKeepsDataAndPlaceAndEndsEveryConsent) {
    // Truth: invariant
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    const auto store = fake::openStore(path);
    const std::string sha256 = require(store->importProtocol(planWithConsent()));
    ParticipantRecords desk(*store, kActor);
    require(desk.enrol("P001", ParticipantKind::Real, ""));
    require(desk.decide("P001", {}, "en", Consent::Yes));
    completeSession(*store, sha256, "P001");
    require(desk.withdraw("P001", ""));
    EXPECT_NE(messageOf(begin(*store, sha256, "P001")), "");
    const StoreReader reader = require(StoreReader::open(path));
    for (const AttemptRow& attempt : require(reader.attempts())) EXPECT_TRUE(attempt.counts());
    EXPECT_TRUE(require(reader.participants())[0].sequence_index);
    for (const ConsentRow& consent : require(reader.consents())) EXPECT_EQ(consent.decision, "withdrawn");
    EXPECT_EQ(Database(path, OpenMode::ReadOnly).integer("SELECT count(*) FROM consent"), 4) << "nothing is rewritten";
}

const std::string kMarker = "MARKER-7f3a";

/// Writes the marker into every text and blob that can hang on a participant.
void plantMarkers(const std::string& path, const std::string& code) {
    const Database database(path, OpenMode::ReadWrite);
    const std::string session = "(SELECT min(session_id) FROM session WHERE participant_id='" + code + "')";
    const std::string attempt =
        "(SELECT min(attempt_id) FROM attempt JOIN trial_plan USING(trial_id) WHERE session_id=" + session + ")";
    const std::string text = "'" + kMarker + "'";
    database.execute("INSERT INTO note(session_id, t_utc, author, text) VALUES(" + session + ", '', " + text + ", " +
                     text + "); UPDATE session SET experimenter=" + text + " WHERE session_id=" + session +
                     "; UPDATE segment SET host=" + text + " WHERE session_id=" + session);
    database.execute(
        "INSERT INTO event(segment_id, attempt_id, t_ns, source, event, payload_json) SELECT segment_id, "
        "attempt_id, 0, 's', 'e', '{\"x\":\"" +
        kMarker + "\"}' FROM attempt WHERE attempt_id=" + attempt + "; UPDATE attempt SET invalid_reason=" + text +
        ", params_json='{\"x\":\"" + kMarker + "\"}' WHERE attempt_id=" + attempt);
    database.execute(
        "INSERT INTO questionnaire VALUES('q', 'q', '1', 'en', '', '{}'); INSERT INTO questionnaire_run("
        "run_id, session_id, questionnaire_sha256, moment, trial_id, started_utc) SELECT 1, session_id, "
        "'q', 'after', trial_id, '' FROM trial_plan WHERE session_id=" +
        session +
        " LIMIT 1; "
        "INSERT INTO item_response(run_id, item, presented_index, value_text) VALUES(1, 'i', 1, " +
        text +
        "); INSERT INTO score VALUES(1, 's', 1.0, 1, 0, 1); INSERT INTO staircase_step(attempt_id, "
        "staircase, track, wanted_level, level, condition_id) VALUES(" +
        attempt + ", " + text + ", " + text + ", 1.0, 1.0, 1)");
    // Large enough for pages of its own.
    database.execute("UPDATE sample_chunk SET data=CAST(replace(hex(zeroblob(20000)), '00', " + text +
                     ") AS BLOB) WHERE attempt_id=" + attempt);
}

/// Files of the folder that hold the text, but for those whose name begins with `except`.
std::vector<std::string> filesWith(const std::filesystem::path& folder, const std::string& text) {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::ifstream stream(entry.path(), std::ios::binary);
        const std::string bytes(std::istreambuf_iterator<char>(stream), {});
        if (bytes.find(text) != std::string::npos) found.push_back(entry.path().filename().string());
    }
    return found;
}

TEST(ParticipantRecords, ErasureLeavesNoByteOfTheParticipantInAnyFile) {
    // Truth: closed form (a search for the bytes that were planted, while the database is open and after)
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    const std::filesystem::path parent = std::filesystem::path(path).parent_path();
    const std::string code = "PX-SECRET-7";
    {
        const auto store = fake::openStore(path);
        const std::string sha256 = require(store->importProtocol(planWithConsent()));
        ParticipantRecords desk(*store, kActor);
        for (const std::string& who : {code, std::string("P002")}) {
            require(desk.enrol(who, ParticipantKind::Real, ""));
            require(desk.decide(who, {}, "en", Consent::Yes));
            completeSession(*store, sha256, who);
        }
        require(desk.exclude(code, "says " + kMarker));
        plantMarkers(path, code);
        const std::string session = sessionId("fake", code, 1, fake::makePlan().seed);
        for (const std::string& text : {kMarker, code, session}) ASSERT_FALSE(filesWith(parent, text).empty()) << text;

        const std::string surrogate = require(desk.erase(code));
        for (const std::string& text : {kMarker, code, session})
            EXPECT_EQ(filesWith(parent, text), std::vector<std::string>{}) << text;
        EXPECT_FALSE(filesWith(parent, surrogate).empty()) << "the tombstone";
        EXPECT_FALSE(desk.erase(code));
        EXPECT_FALSE(begin(*store, sha256, code));
        require(store->enrol("P008", ParticipantKind::Real, ""));
        require(desk.decide("P008", {}, "en", Consent::Yes));
        EXPECT_EQ(require(store->assignSlot(sha256, "P008")).number, 0) << "the place is free again";
    }
    EXPECT_EQ(filesWith(parent, code), std::vector<std::string>{});
    const StoreReader reader = require(StoreReader::open(path));
    EXPECT_EQ(require(reader.attempts()).size(), 2u) << "the others' data stays";
    const AuditReport audit = require(reader.audit());
    EXPECT_EQ(audit.faults, std::vector<std::string>{});
    EXPECT_EQ(audit.erased, 4) << "enrolled, two decisions, excluded";
    const Database database(path, OpenMode::ReadOnly);
    EXPECT_EQ(database.text("PRAGMA integrity_check"), "ok");
    EXPECT_EQ(database.integer("SELECT count(*) FROM pragma_foreign_key_check"), 0);
    for (const char* table : {"note", "questionnaire_run", "item_response", "score", "staircase_step"})
        EXPECT_EQ(database.integer(std::string("SELECT count(*) FROM ") + table), 0) << table;
}

TEST(ParticipantRecords, ACodeThatAnErasedParticipantMayHaveHadIsNotGivenAgain) {
    // Truth: invariant
    const fake::TempFolder folder;
    const auto store = fake::openStore(folder / "s.db");
    ParticipantRecords desk(*store, kActor);
    for (const char* code : {"P001", "P002", "P003"}) require(desk.enrol(code, ParticipantKind::Real, ""));
    require(desk.erase("P002"));
    EXPECT_EQ(require(store->nextCode(ParticipantKind::Real)), "P004");
    EXPECT_NE(messageOf(desk.enrol("P002", ParticipantKind::Real, "")).find("number above 3"), std::string::npos);
    EXPECT_EQ(messageOf(store->enrol("P002", ParticipantKind::Real, "")),
              messageOf(desk.enrol("P002", ParticipantKind::Real, "")))
        << "a run with that code";
    EXPECT_FALSE(require(store->enrol("P001", ParticipantKind::Real, ""))) << "who is there stays who they are";
    EXPECT_EQ(require(store->nextCode(ParticipantKind::Pilot)), "T001");
}

TEST(ParticipantRecords, CodesOfSeveralStationsCarryTheirLetter) {
    // Truth: invariant. Else the stations' files could not be merged; who is there already stays who they are.
    const fake::TempFolder folder;
    require(fake::openStore(folder / "s.db")->enrol("P001", ParticipantKind::Real, ""));
    OpenOptions options = fake::options();
    options.station = {"B", 1, 2};
    const auto store = fake::openStore(folder / "s.db", options);
    ParticipantRecords desk(*store, kActor);
    for (const char* code : {"P002", "PA002", "TB001"}) {
        EXPECT_FALSE(desk.enrol(code, ParticipantKind::Real, "")) << code;
        EXPECT_FALSE(store->enrol(code, ParticipantKind::Real, "")) << code;
    }
    EXPECT_EQ(messageOf(desk.enrol("PA002", ParticipantKind::Real, "")),
              "participant code 'PA002': with 2 stations the codes of station B begin with PB, such as PB001");
    EXPECT_FALSE(require(store->enrol("P001", ParticipantKind::Real, "")));
    require(desk.enrol("PB002", ParticipantKind::Real, ""));
    require(desk.enrol("TB-7", ParticipantKind::Pilot, ""));
    EXPECT_EQ(require(store->nextCode(ParticipantKind::Real)), "PB001");
}

TEST(ParticipantRecords, TheAuditTellsWhereItWasTamperedWith) {
    // Truth: invariant (SHA-256 chain): a changed word, detail, missing row and a detail taken away without an erasure
    for (const char* tampering :
         {"UPDATE audit SET actor='nobody' WHERE audit_id=2",
          "UPDATE audit SET detail_json=json_set(detail_json, '$.participant', 'P009') WHERE audit_id=2",
          "DELETE FROM audit WHERE audit_id=2",
          "UPDATE audit SET detail_json='{\"erased\":\"00\"}' WHERE audit_id=2"}) {
        const fake::TempFolder folder;
        const std::string path = folder / "s.db";
        {
            const auto store = fake::openStore(path);
            ParticipantRecords desk(*store, kActor);
            for (const char* code : {"P001", "P002", "P003"}) require(desk.enrol(code, ParticipantKind::Real, ""));
        }
        const auto faults = [&] { return require(require(StoreReader::open(path)).audit()).faults; };
        EXPECT_TRUE(faults().empty());
        Database(path, OpenMode::ReadWrite).execute(tampering);
        ASSERT_EQ(faults().size(), 1u) << tampering;
        const std::string row = std::string(tampering).starts_with("DELETE") ? "row 3: " : "row 2: ";
        EXPECT_EQ(faults()[0].substr(0, row.size()), row) << tampering;
    }
}

}  // namespace
}  // namespace passung::store
