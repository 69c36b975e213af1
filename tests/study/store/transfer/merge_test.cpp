#include "study/store/transfer/merge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <set>

#include "study/store/people/participant_records.h"
#include "study/store/schema/session_tables.h"
#include "study/store/schema/sqlite.h"
#include "tests/study/store/damaged_study.h"

namespace passung::store {
namespace {

using fake::require;
using plan::ParticipantKind;

namespace fs = std::filesystem;

constexpr std::size_t kTicks = 150;

std::string bytesOf(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// One place where the fake study runs with real participants.
class Place {
public:
    Place(std::string path, const Station& station, plan::StudyPlan plan = fake::makePlan()) : path_(std::move(path)) {
        OpenOptions options = fake::options();
        options.station = station;
        station_ = station.name;
        store_ = fake::openStore(path_, options);
        plan_ = std::move(plan);
        sha256_ = require(store_->importProtocol(plan_));
    }

    /// Somebody new with a whole session; returns the code.
    std::string perform(const std::string& created_utc) {
        const std::string code = require(store_->nextCode(ParticipantKind::Real));
        require(store_->enrol(code, ParticipantKind::Real, created_utc));
        const auto writer = begin(code, created_utc);
        for (int trial = 0; trial < 2; ++trial) require(fake::writeAttempt(*writer, trial, kTicks));
        require(writer->finishSession(true, 1'000'000'000));
        return code;
    }

    std::unique_ptr<SessionWriter> begin(const std::string& code, const std::string& started) {
        require(store_->assignSlot(sha256_, code));
        SessionStart start;
        start.protocol_sha256 = sha256_;
        start.participant = code;
        start.ordinal = require(store_->nextOrdinal(code));
        start.seed = plan_.seed;
        start.session_id = sessionId(plan_.name, code, start.ordinal, start.seed);
        start.station = station_;
        start.device.name = "sigma7";
        start.experimenter = started;
        return require(store_->createSession(start, fake::makeTrials(plan_, 2)));
    }

    Store& store() { return *store_; }

private:
    std::string path_, station_, sha256_;
    plan::StudyPlan plan_;
    std::unique_ptr<Store> store_;
};

const Station kA{"A", 0, 2}, kB{"B", 1, 2};

MergeReport merge(const std::vector<std::string>& sources, const std::string& out) {
    return require(mergeDatabases(sources, out, fake::options()));
}

std::string refusal(const std::vector<std::string>& sources, const std::string& out) {
    const auto report = mergeDatabases(sources, out, fake::options());
    return report ? "" : toString(report.errors().front());
}

/// By session id.
std::map<std::string, std::string> digests(const std::string& path) {
    const Database database(path, OpenMode::ReadWrite);
    std::map<std::string, std::string> all;
    Statement ids = database.prepare("SELECT session_id FROM session");
    while (ids.step()) all[ids.text(0)] = sessionDigest(database, sessionTables(database), "main", ids.text(0));
    return all;
}

/// Makes it a file of before there were hashes: else what a test plants in it is damage.
void unhash(const std::string& path) {
    Database(path, OpenMode::ReadWrite).execute("DELETE FROM session_hash; DELETE FROM row_hash");
}

void expectSound(const std::string& path) {
    const Database database(path, OpenMode::ReadWrite);
    EXPECT_EQ(database.text("PRAGMA integrity_check"), "ok");
    EXPECT_EQ(database.integer("SELECT count(*) FROM pragma_foreign_key_check"), 0);
    EXPECT_FALSE(fs::exists(path + ".part"));
}

TEST(Merge, PutsStationsTogetherWithoutLossAndTheSameAgainChangesNothing) {
    // Truth: invariant. Every session of every file is in the result with the same digest, every recorded bit too;
    // whole replicates of the square belong to one station, so that no place collides.
    const fake::TempFolder folder;
    const std::string a = folder / "A.db", b = folder / "B.db", all = folder / "ALL.db";
    std::set<std::string> codes;
    {
        Place one(a, kA), two(b, kB);
        for (int i = 0; i < 5; ++i) codes.insert(one.perform("2001-01-0" + std::to_string(i + 1)));
        for (int i = 0; i < 3; ++i) codes.insert(two.perform("2001-02-0" + std::to_string(i + 1)));
    }
    EXPECT_EQ(*codes.begin(), "PA001");
    EXPECT_EQ(codes.size(), 8u);
    const MergeReport first = merge({a, b}, all);
    EXPECT_EQ(first.sessions, 8);
    EXPECT_EQ(first.moved_places, std::vector<std::string>{});
    expectSound(all);
    auto expected = digests(a);
    expected.merge(digests(b));
    EXPECT_EQ(digests(all), expected);
    {
        const StoreReader reader = require(StoreReader::open(all));
        const auto attempts = require(reader.attempts());
        ASSERT_EQ(attempts.size(), 16u);
        for (const AttemptRow& attempt : attempts) {
            EXPECT_EQ(attempt.station, attempt.participant_id.substr(1, 1));
            EXPECT_EQ(attempt.measures.at("completion_time_s"), 1.0 + 0.1 * static_cast<double>(attempt.trial_index));
            EXPECT_TRUE(
                fake::sameStoredBits(require(reader.records(attempt.attempt_id)),
                                     fake::makeRecords(static_cast<std::uint64_t>(attempt.trial_index), kTicks)));
        }
        const auto people = require(reader.participants());
        ASSERT_EQ(people.size(), 8u);
        for (const ParticipantRow& person : people) {
            EXPECT_EQ(*person.replicate % 2, person.participant_id[1] == 'A' ? 0 : 1) << person.participant_id;
            EXPECT_EQ(person.status, "complete");
        }
    }
    for (const auto& again : {std::vector{a, b}, std::vector{b, a}, std::vector{b}}) {
        const MergeReport report = merge(again, all);
        EXPECT_EQ(report.sessions + report.replaced, 0);
        EXPECT_EQ(digests(all), expected);
    }
    const Database database(all, OpenMode::ReadWrite);
    EXPECT_EQ(database.integer("SELECT count(*) FROM design_slot WHERE participant_id NOT NULL"), 8);
}

TEST(Merge, AddsWhatIsNewAndBringsAChangedSessionUpToDate) {
    // Truth: invariant. A later merge brings a new session and a trial that was called invalid since; an older copy of
    // the same file, in which the last trial had not ended yet, takes nothing back.
    const fake::TempFolder folder;
    const std::string a = folder / "A.db", older = folder / "older.db", all = folder / "ALL.db";
    {
        Place one(a, kA);
        one.perform("2001-01-01");
        require(one.store().enrol("PA002", ParticipantKind::Real, "2001-01-02"));
        const auto writer = one.begin("PA002", "");
        require(fake::writeAttempt(*writer, 0, kTicks));
        unhash(a);
        Database(a, OpenMode::ReadWrite).copyTo(older);
        const MergeReport early = merge({a}, all);
        EXPECT_EQ(early.sessions, 1);
        EXPECT_EQ(early.unfinished, std::vector<std::string>{a + ": PA002, session 1"}) << "it runs";
        require(fake::writeAttempt(*writer, 1, kTicks));
        require(writer->finishSession(true, 1'000'000'000));
    }
    Database(older, OpenMode::ReadWrite).execute("UPDATE session SET end_state='aborted' WHERE end_state IS NULL");
    EXPECT_EQ(merge({older}, all).sessions, 1);
    Database(a, OpenMode::ReadWrite)
        .execute("UPDATE attempt SET valid=0, invalid_reason='the phone rang' WHERE attempt_id=1");
    const MergeReport later = merge({a}, all);
    EXPECT_EQ(later.sessions, 0);
    EXPECT_EQ(later.replaced, 2);
    EXPECT_EQ(digests(all), digests(a));
    EXPECT_EQ(merge({older}, all).known, 2) << "an older copy knows nothing of that and takes nothing back";
    EXPECT_EQ(digests(all), digests(a));
    Database(older, OpenMode::ReadWrite).execute("DELETE FROM session WHERE participant_id='PA001'");
    EXPECT_EQ(merge({older}, all).known, 1) << "one trial less than is there";
    EXPECT_EQ(digests(all), digests(a));
    expectSound(all);
}

/// Notes and invalid attempts, as the export would show them.
std::vector<std::string> remarks(const std::string& path) {
    const StoreReader reader = require(StoreReader::open(path));
    std::vector<std::string> lines;
    for (const NoteRow& note : require(reader.notes())) lines.push_back(note.entry + ": " + note.text.value_or(""));
    for (const AttemptRow& attempt : require(reader.attempts()))
        if (!attempt.valid) lines.push_back(*attempt.invalid_reason);
    std::sort(lines.begin(), lines.end());
    return lines;
}

TEST(Merge, KeepsWhatWasSaidInTheResultAndUnitesItWithWhatIsSaidAtTheStation) {
    // Truth: invariant. Notes and invalidations of both files are there after any order of merges, once each.
    const fake::TempFolder folder;
    const std::string a = folder / "A.db", all = folder / "ALL.db";
    Place(a, kA).perform("2001-01-01");
    merge({a}, all);
    {
        const auto store = fake::openStore(all);
        require(store->addNote(1, "looked at the video"));
        require(store->invalidateAttempt(1, "the phone rang"));
    }
    std::vector<std::string> said = {"invalidate: the phone rang", "invalidated by the experimenter: the phone rang",
                                     "note: looked at the video"};
    EXPECT_EQ(remarks(all), said);
    EXPECT_EQ(merge({a}, all).known, 1);
    EXPECT_EQ(remarks(all), said);
    {
        const auto store = fake::openStore(a);
        require(store->addNote(1, "the participant was tired"));
        require(store->invalidateAttempt(1, "a noise outside"));
        require(store->invalidateAttempt(2, "looked away"));
    }
    const MergeReport later = merge({a}, all);
    EXPECT_EQ(later.replaced, 1);
    ASSERT_EQ(later.conflicts.size(), 1u);
    EXPECT_EQ(later.conflicts[0], a + ": PA001, session 1, trial 1, attempt 1 does not count for two reasons: "
                                      "\"invalidated by the experimenter: the phone rang\" stays, \"invalidated by the "
                                      "experimenter: a noise outside\" is not kept");
    said.insert(said.end(), {"invalidate: a noise outside", "invalidate: looked away",
                             "invalidated by the experimenter: looked away", "note: the participant was tired"});
    std::sort(said.begin(), said.end());
    EXPECT_EQ(remarks(all), said);
    EXPECT_EQ(merge({a}, all).replaced, 0);
    EXPECT_EQ(remarks(all), said);
    expectSound(all);
}

TEST(Merge, ASessionThatGoesOnAtItsStationKeepsWhatWasSaidInTheResult) {
    // Truth: invariant. The older copy that was merged first had one trial less.
    const fake::TempFolder folder;
    const std::string a = folder / "A.db", older = folder / "older.db", all = folder / "ALL.db";
    {
        Place one(a, kA);
        require(one.store().enrol("PA001", ParticipantKind::Real, "2001-01-02"));
        const auto writer = one.begin("PA001", "");
        require(fake::writeAttempt(*writer, 0, kTicks));
        Database(a, OpenMode::ReadWrite).copyTo(older);
        require(fake::writeAttempt(*writer, 1, kTicks));
        require(writer->finishSession(true, 1'000'000'000));
    }
    Database(older, OpenMode::ReadWrite).execute("UPDATE session SET end_state='aborted' WHERE end_state IS NULL");
    merge({older}, all);
    {
        const auto store = fake::openStore(all);
        require(store->addNote(1, "looked at the video"));
        require(store->invalidateAttempt(1, "the phone rang"));
    }
    const auto said = remarks(all);
    ASSERT_EQ(said.size(), 3u);
    EXPECT_EQ(merge({a}, all).replaced, 1);
    EXPECT_EQ(remarks(all), said);
    EXPECT_EQ(Database(all, OpenMode::ReadOnly).integer("SELECT count(*) FROM attempt"), 2);
    EXPECT_EQ(Database(all, OpenMode::ReadOnly).text("SELECT end_state FROM session"), "complete");
    EXPECT_EQ(merge({older, a}, all).known, 2);
    EXPECT_EQ(remarks(all), said);
}

TEST(Merge, AFormFilledAfterTheLastTrialArrives) {
    // Truth: invariant. No attempt is new, but the session is now complete, with a form more.
    const fake::TempFolder folder;
    const std::string a = folder / "A.db", all = folder / "ALL.db";
    Place(a, kA).perform("2001-01-01");
    Database(a, OpenMode::ReadWrite).execute("UPDATE session SET end_state='aborted'");
    unhash(a);
    merge({a}, all);
    const Database database(a, OpenMode::ReadWrite);
    database.execute(
        "INSERT INTO questionnaire VALUES('q', 'sus', '1', 'en', 'free', '{}'); INSERT INTO "
        "questionnaire_run(session_id, questionnaire_sha256, moment, started_utc) SELECT session_id, 'q', "
        "'session_end', '2001-01-01' FROM session; UPDATE session SET end_state='complete'");
    EXPECT_EQ(merge({a}, all).replaced, 1);
    EXPECT_EQ(digests(all), digests(a));
}

TEST(Merge, GivesTheSecondOfOnePlaceTheSameRowInAFurtherReplicate) {
    // Truth: closed form (4 rows: with places 0 and 1 taken twice, the second ones have the same rows)
    const fake::TempFolder folder;
    const std::string a = folder / "A.db", b = folder / "B.db", all = folder / "ALL.db";
    const Station alone_a{"A", 0, 1}, alone_b{"B", 0, 1};
    {
        Place one(a, alone_a), two(b, alone_b);
        one.perform("2001-01-01");
        one.perform("2001-01-01");
        for (const char* code : {"P101", "P102"}) {
            require(two.store().enrol(code, ParticipantKind::Real, "2001-01-02"));
            require(two.begin(code, "")->finishSession(true, 0));
        }
        unhash(b);
        Database(b, OpenMode::ReadWrite).execute("UPDATE session SET end_state='complete'");
        const Database places(b, OpenMode::ReadWrite);
        places.execute(
            "UPDATE design_slot SET state='complete', participant_id='P101' WHERE sequence_index=0; "
            "UPDATE design_slot SET state='complete', participant_id='P102' WHERE sequence_index=1");
    }
    EXPECT_EQ(merge({a, b}, all).moved_places, (std::vector<std::string>{"P101", "P102"}));
    EXPECT_EQ(merge({a, b}, all).moved_places, std::vector<std::string>{});
    const auto people = require(require(StoreReader::open(all)).participants());
    ASSERT_EQ(people.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(people[i].sequence_index, static_cast<std::int64_t>(i % 2)) << people[i].participant_id;
        EXPECT_EQ(people[i].replicate, static_cast<std::int64_t>(i / 2)) << people[i].participant_id;
    }
}

TEST(Merge, AnExclusionReachesTheResultAndFreesThePlace) {
    // Truth: invariant
    const fake::TempFolder folder;
    const std::string a = folder / "A.db", all = folder / "ALL.db";
    Place one(a, kA);
    one.perform("2001-01-01");
    merge({a}, all);
    require(ParticipantRecords(one.store(), {"e", ""}).exclude("PA001", "asleep"));
    EXPECT_EQ(merge({a}, all).known, 1);
    const auto people = require(require(StoreReader::open(all)).participants());
    EXPECT_EQ(people.at(0).status, "excluded");
    EXPECT_FALSE(people.at(0).replicate);
}

AuditReport auditOf(const std::string& path) { return require(require(StoreReader::open(path)).audit()); }

ParticipantRow personOf(const std::string& path, const std::string& code) {
    for (const auto& person : require(require(StoreReader::open(path)).participants()))
        if (person.participant_id == code) return person;
    return {};
}

TEST(Merge, TheAuditsComeAlongAsUnbrokenChains) {
    // Truth: invariant. Each file's acts are there once, whatever is merged again, and tampering with one shows.
    const fake::TempFolder folder;
    const std::string a = folder / "A.db", b = folder / "B.db", all = folder / "ALL.db";
    Place one(a, kA), two(b, kB);
    one.perform("2001-01-01");
    two.perform("2001-01-02");
    require(ParticipantRecords(one.store(), {"e", "2001-02-01"}).exclude("PA001", "asleep"));
    require(ParticipantRecords(two.store(), {"e", "2001-02-01"}).enrol("PB002", ParticipantKind::Real, "2001-02-01"));
    merge({a, b}, all);
    require(ParticipantRecords(*fake::openStore(all), {"e", "2001-02-02"}).exclude("PB002", "ill"));
    require(ParticipantRecords(one.store(), {"e", "2001-02-03"}).readmit("PA001", "was awake"));
    for (int i = 0; i < 2; ++i) {
        merge({b, a}, all);
        const AuditReport report = auditOf(all);
        EXPECT_EQ(report.faults, std::vector<std::string>{});
        EXPECT_EQ(report.rows, 4);
        EXPECT_EQ(report.chains, 2);
    }
    Database(all, OpenMode::ReadWrite)
        .execute("DELETE FROM audit WHERE action='exclude' AND json_extract(detail_json, '$.participant')='PA001'");
    EXPECT_EQ(auditOf(all).faults.size(), 1u) << "what followed it";
    EXPECT_EQ(merge({all}, folder / "next.db").conflicts.size(), 1u);
}

TEST(Merge, TheNewestActDecidesWhoTakesPart) {
    // Truth: invariant: excluded at the station, readmitted in the result, excluded there anew, readmitted at the
    // station.
    const fake::TempFolder folder;
    const std::string a = folder / "A.db", all = folder / "ALL.db";
    Place one(a, kA);
    one.perform("2001-01-01");
    const auto desk = [](Store& store, const char* now) { return ParticipantRecords(store, {"e", now}); };
    require(desk(one.store(), "2001-02-01").exclude("PA001", "asleep"));
    merge({a}, all);
    EXPECT_EQ(personOf(all, "PA001").status, "excluded");
    EXPECT_TRUE(require(desk(*fake::openStore(all), "2001-02-02").readmit("PA001", "was awake")));
    EXPECT_EQ(personOf(all, "PA001").status, "complete");
    EXPECT_EQ(personOf(all, "PA001").replicate, 0) << "the place too";
    merge({a}, all);
    EXPECT_EQ(personOf(all, "PA001").status, "complete") << "the station's exclusion is older";
    EXPECT_EQ(personOf(all, "PA001").replicate, 0);
    require(desk(*fake::openStore(all), "2001-02-03").exclude("PA001", "asleep after all"));
    require(desk(one.store(), "2001-02-04").readmit("PA001", "the video says otherwise"));
    merge({a}, all);
    EXPECT_EQ(personOf(all, "PA001").status, "complete");
    EXPECT_EQ(personOf(all, "PA001").status_reason, "readmitted: the video says otherwise");
    EXPECT_EQ(personOf(all, "PA001").replicate, 0);
}

TEST(Merge, WhoWasErasedDoesNotComeBack) {
    // Truth: closed form (a search for the code's bytes in the result) and invariant
    const fake::TempFolder folder;
    const std::string a = folder / "A.db", all = folder / "ALL.db";
    Place one(a, kA);
    for (const char* date : {"2001-01-01", "2001-01-02"}) one.perform(date);
    ParticipantRecords station(one.store(), {"e", "2001-02-01"});
    require(station.enrol("PA003", ParticipantKind::Real, "2001-02-01"));
    require(station.exclude("PA003", "is PA003"));
    merge({a}, all);
    const auto erase = [&](const char* code) {
        require(ParticipantRecords(*fake::openStore(all), {"e", "2001-02-02"}).erase(code));
    };
    erase("PA003");
    erase("PA001");
    for (int i = 0; i < 2; ++i) {
        const MergeReport report = merge({a}, all);
        EXPECT_EQ(report.erased,
                  (std::vector<std::string>{a + ": PA001 was erased and is left out; this file still has them",
                                            a + ": PA003 was erased and is left out; this file still has them"}));
        EXPECT_EQ(report.known, 1);
        for (const char* code : {"PA001", "PA003"}) {
            EXPECT_EQ(personOf(all, code).participant_id, "");
            EXPECT_EQ(bytesOf(all).find(code), std::string::npos) << code;
        }
        EXPECT_EQ(auditOf(all).faults, std::vector<std::string>{});
        EXPECT_EQ(auditOf(all).erased, 2);
    }
    // A result that knows nothing yet is begun with the same audit: nobody comes back into it either.
    EXPECT_EQ(merge({all, a}, folder / "next.db").erased.size(), 2u);
    EXPECT_EQ(bytesOf(folder / "next.db").find("PA001"), std::string::npos);
    // Erased at the station only: the result tells.
    require(station.erase("PA002"));
    EXPECT_EQ(merge({a}, all).erased.back(), a + ": PA002 was erased there; the result still has them");
    EXPECT_EQ(personOf(all, "PA002").status, "complete");
    expectSound(all);
}

TEST(Merge, RefusesAnotherStudyTextSeedOrFormula) {
    // Truth: invariant (rows of two designs could not be told apart)
    const fake::TempFolder folder;
    const std::string a = folder / "A.db", all = folder / "ALL.db";
    Place(a, kA).perform("2001-01-01");
    merge({a}, all);
    const auto with = [&](const std::string& name, const std::function<void(plan::StudyPlan&)>& change) {
        plan::StudyPlan plan = fake::makePlan();
        change(plan);
        Place(folder / name, kB, plan).perform("2001-01-02");
        return folder / name;
    };
    const auto study = with("study.db", [](auto& plan) {
        plan.name = "another";
        plan.source_text += "# another\n";
    });
    EXPECT_NE(refusal({study}, all).find("holds the study another"), std::string::npos);
    const auto text = with("text.db", [](auto& plan) { plan.source_text += "# changed\n"; });
    EXPECT_NE(refusal({text}, all).find("has another text"), std::string::npos);
    const auto version = with("version.db", [](auto& plan) {
        plan.version = "2.0";
        plan.source_text += "# changed\n";
    });
    Database(version, OpenMode::ReadWrite)
        .execute("UPDATE measure SET formula_version=99 WHERE measure='peak_force_N'");
    EXPECT_NE(refusal({version}, all).find("peak_force_N"), std::string::npos);
    Database(version, OpenMode::ReadWrite)
        .execute(
            "UPDATE measure SET formula_version=(SELECT min(formula_version) FROM measure) "
            "WHERE measure='peak_force_N'");
    EXPECT_EQ(refusal({version}, all), "") << "a new version of the same study is fine";
    const auto conditionsOf = [](const std::string& path, const std::string& contact) {
        Database(path, OpenMode::ReadWrite)
            .execute("UPDATE protocol_version SET expanded_json=json_set(expanded_json, '$.conditions', json('[" +
                     contact + "]')); DELETE FROM row_hash");
        return path;
    };
    const auto began = with("began.db", [](auto&) {});
    conditionsOf(all, R"({"params": {"contact": {}}})");
    EXPECT_NE(refusal({conditionsOf(began, R"({"params": {"contact": {"geometry": "surface"}}})")}, all)
                  .find("was begun with another geometry of contact"),
              std::string::npos);
    EXPECT_EQ(refusal({conditionsOf(began, R"({"params": {"contact": {"geometry": "field"}}})")}, all).find("geometry"),
              std::string::npos)
        << "before it was written there was but this one";
    EXPECT_NE(refusal({folder / "none.db"}, all).find("no such file"), std::string::npos);
    expectSound(all);
}

TEST(Merge, RefusesOneCodeForTwoPeopleAndLeavesTheResultAsItWas) {
    // Truth: invariant. Without stations' letters both places call their first participant P001.
    const fake::TempFolder folder;
    const std::string a = folder / "A.db", b = folder / "B.db", all = folder / "ALL.db";
    Place(a, {}).perform("2001-01-01T10:00:00.000Z");
    Place(b, {}).perform("2001-01-01T10:00:00.001Z");
    merge({a}, all);
    const std::string before = bytesOf(all);
    EXPECT_NE(refusal({b}, all).find("participant code P001 stands for two people"), std::string::npos);
    EXPECT_EQ(bytesOf(all), before);
    EXPECT_FALSE(refusal({a, b}, folder / "new.db").empty());
    EXPECT_FALSE(fs::exists(folder / "new.db"));
    expectSound(all);
}

TEST(Merge, LeavesOutWhatIsDamagedAndHealsTheResult) {
    // Truth: invariant: a damaged session of a source stays out and is named; where the result is damaged and the
    // source is not, the result is healed, chunk by chunk, and the other way round nothing of the result changes.
    const fake::TempFolder folder;
    const std::string a = folder / "A.db", b = folder / "B.db", all = folder / "ALL.db", whole = folder / "whole.db";
    {
        Place one(a, kA), two(b, kB);
        for (int i = 0; i < 2; ++i) one.perform("2001-01-0" + std::to_string(i + 1));
        two.perform("2001-02-01");
    }
    const auto change = [](const std::string& path, const std::string& sql) {
        Database(path, OpenMode::ReadWrite).execute(sql);
    };
    const std::string chunk = "UPDATE sample_chunk SET data=zeroblob(length(data)) WHERE stream_id=1 AND chunk_no=";
    Database(a, OpenMode::ReadWrite).copyTo(whole);
    change(a, chunk + "0");
    const MergeReport first = merge({a, b}, all);
    EXPECT_EQ(first.sessions, 2);
    ASSERT_EQ(first.damaged.size(), 1u) << testing::PrintToString(first.damaged);
    EXPECT_NE(first.damaged[0].find("A.db: PA001, session 1, trial 1, attempt 1, samples: "), std::string::npos)
        << first.damaged[0];
    EXPECT_EQ(merge({whole, b}, all).sessions, 1);
    const auto expected = fake::dump(all);
    EXPECT_EQ(merge({a}, all).damaged.size(), 1u) << "the damaged copy again";
    EXPECT_TRUE(fake::dump(all) == expected);
    // Of PA002, whose stream has the least number in the result.
    change(all,
           "UPDATE sample_chunk SET data=zeroblob(length(data)) WHERE chunk_no=0; UPDATE attempt_measure SET "
           "value_num=2 WHERE measure='peak_force_N' AND attempt_id=1");
    const MergeReport healed = merge({whole}, all);
    EXPECT_GE(healed.healed.size(), 3u) << testing::PrintToString(healed.healed);
    EXPECT_EQ(healed.damaged.size(), 1u) << "of station B: " << testing::PrintToString(healed.damaged);
    EXPECT_EQ(merge({b}, all).damaged, std::vector<std::string>{});
    EXPECT_TRUE(fake::dump(all) == expected);
}

}  // namespace
}  // namespace passung::store
