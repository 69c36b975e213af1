#include "study/store/write/store.h"

#include <gtest/gtest.h>

#include <fstream>
#include <thread>
#include <tuple>

#include "study/design/williams.h"
#include "study/store/schema/revisions.h"
#include "study/store/schema/sqlite.h"
#include "tests/study/store/fake_study.h"
#include "tests/study/store/first_revision.h"

namespace passung::store {
namespace {

using fake::require;

std::string rows(const Database& database, const std::string& sql) {
    std::string text;
    Statement statement = database.prepare(sql);
    while (statement.step()) text += statement.text(0) + "\n";
    return text;
}

void expectSound(const std::string& path) {
    const Database database(path, OpenMode::ReadOnly);
    EXPECT_EQ(database.text("PRAGMA integrity_check"), "ok");
    EXPECT_EQ(rows(database, "PRAGMA foreign_key_check"), "");
}

TEST(Store, NewFileHasASoundStrictSchemaOfTheCurrentRevision) {
    // Truth: independent program (SQLite's own checks)
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    EXPECT_EQ(Store::open(path, fake::options()).outcome, OpenOutcome::Created);
    EXPECT_EQ(Store::open(path, fake::options()).outcome, OpenOutcome::Current);
    EXPECT_FALSE(std::filesystem::exists(path + ".lock"));
    EXPECT_FALSE(std::filesystem::exists(path + "-wal"));
    expectSound(path);
    const Database database(path, OpenMode::ReadOnly);
    EXPECT_EQ(
        rows(database,
             "SELECT name FROM pragma_table_list WHERE schema='main' AND type='table' AND NOT strict AND name NOT LIKE "
             "'sqlite_%'"),
        "");
    EXPECT_EQ(database.text("PRAGMA journal_mode"), "wal");
    EXPECT_EQ(database.integer("SELECT max(revision) FROM schema_revision"), schemaNumber());
}

TEST(Store, TablesHoldEveryColumnOfTheDocumentedOutline) {
    // Truth: closed form (a sample of the documented names that outside programs read)
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    fake::openStore(path);
    const Database database(path, OpenMode::ReadOnly);
    for (const char* sql :
         {"SELECT attempt_id, trial_id, attempt_no, segment_id, start_ns, end_ns, outcome, valid, invalid_reason, "
          "params_json FROM attempt",
          "SELECT session_id, participant_id, protocol_sha256, ordinal, station, experimenter, language, seed, rng, "
          "started_utc, ended_utc, end_state FROM session",
          "SELECT trial_id, session_id, trial_index, block_index, block, trial_in_block, phase, condition_id FROM "
          "trial_plan",
          "SELECT stream_id, chunk_no, attempt_id, first_tick, n, t0_ns, crc32, data FROM sample_chunk",
          "SELECT attempt_id, loop, ticks, mean_us, sd_us, p99_us, p999_us, max_us, overruns, dropped_samples, "
          "hist_json FROM timing",
          "SELECT slot_id, protocol_sha256, between_group, sequence_index, replicate, station, state, participant_id "
          "FROM design_slot",
          "SELECT run_id, item, presented_index, value_num, value_text, skipped, rt_ms, changes FROM item_response",
          "SELECT audit_id, t_utc, actor, action, detail_json, prev_hash, hash FROM audit"}) {
        EXPECT_NO_THROW(database.prepare(sql)) << sql;
    }
}

TEST(Store, PicturesAndSoundOfAnAttemptAreReadAsTheyWereWritten) {
    // Truth: invariant: what the fake study hands over.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    {
        const auto store = fake::openStore(path);
        const auto writer = fake::beginSession(*store, "S001", 6, true);
        for (int trial = 0; trial < 6; ++trial) require(fake::writeAttempt(*writer, trial, 40, trial != 0));
        require(writer->finishSession(true, 60'000'000'000));
    }
    const auto attempts = require(require(StoreReader::open(path)).attempts());
    EXPECT_FALSE(attempts[0].presentation) << "no window showed it";
    ASSERT_TRUE(attempts[1].presentation);
    EXPECT_EQ(attempts[1].presentation->drawn_pose, "proxy");
    EXPECT_EQ(attempts[1].presentation->frames, 91);
    EXPECT_EQ(attempts[1].presentation->frame_age_p99_us, 30'000.0);
    EXPECT_EQ(attempts[1].presentation->sound_output, "speakers");
    EXPECT_EQ(attempts[1].presentation->sound_delay_us, 21'333.0);
    EXPECT_EQ(attempts[1].presentation->cue_frames, 7);
    EXPECT_EQ(attempts[5].presentation->cue_frames, std::nullopt) << "what was not counted is not 0";
    ASSERT_TRUE(attempts[5].presentation);
    EXPECT_EQ(attempts[5].presentation->sound, "silent");
    EXPECT_EQ(attempts[5].presentation->sound_output, "");
}

TEST(Store, ChunksBeginWhereTheMissedCyclesBeforeThemPutThem) {
    // Truth: closed form. Of the fake ticks every sixteenth comes after two missed cycles: 62 of the first 1000, so
    // that tick 1000 is at 1000 + 2 · 62 ms; 125 of the first 2000.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    {
        auto store = fake::openStore(path);
        auto writer = fake::beginSession(*store, "S001", 1);
        require(fake::writeAttempt(*writer, 0, 2345));
        require(writer->finishSession(true, 99'000'000'000));
    }
    const Database database(path, OpenMode::ReadOnly);
    EXPECT_EQ(rows(database, "SELECT first_tick || ' ' || t0_ns FROM sample_chunk ORDER BY first_tick"),
              "0 0\n1000 1124000000\n2000 2250000000\n");
}

TEST(Store, AProtocolKeepsTheMeshesThatItWasImportedWith) {
    // Truth: closed form (SHA-256 of "abc", FIPS 180-2) and invariant: one protocol, one geometry.
    const fake::TempFolder folder;
    std::ofstream(folder / "a.stl") << "abc";
    plan::StudyPlan plan = fake::makePlan();
    plan.meshes = {{"parts/a.stl", folder / "a.stl"}};
    const std::string path = folder / "s.db";
    auto store = fake::openStore(path);
    const std::string sha256 = require(store->importProtocol(plan));
    const auto meshes = require(require(StoreReader::open(path)).meshes());
    ASSERT_EQ(meshes.size(), 1u);
    EXPECT_EQ(meshes[0].protocol_sha256, sha256);
    EXPECT_EQ(meshes[0].mesh, "parts/a.stl");
    EXPECT_EQ(meshes[0].sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(meshes[0].bytes, 3);
    EXPECT_EQ(require(store->importProtocol(plan)), sha256) << "the same again is fine";
    std::ofstream(folder / "a.stl") << "abd";
    const auto changed = store->importProtocol(plan);
    ASSERT_FALSE(changed);
    EXPECT_NE(changed.errors()[0].message.find("parts/a.stl has changed"), std::string::npos);
    std::filesystem::remove(folder / "a.stl");
    EXPECT_FALSE(store->importProtocol(plan)) << "a mesh that is not there";
}

TEST(Store, AWholeSessionReadsBackAsItWasWritten) {
    // Truth: invariant (what goes in comes out)
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    {
        auto store = fake::openStore(path);
        auto writer = fake::beginSession(*store, "S001", 4);
        for (int trial = 0; trial < 4; ++trial) require(fake::writeAttempt(*writer, trial, 2345));
        require(writer->finishSession(true, 99'000'000'000));
    }
    expectSound(path);
    const StoreReader reader = require(StoreReader::open(path));
    const auto attempts = require(reader.attempts());
    ASSERT_EQ(attempts.size(), 4u);
    for (std::size_t i = 0; i < attempts.size(); ++i) {
        const AttemptRow& attempt = attempts[i];
        const auto index = static_cast<std::int64_t>(i);
        EXPECT_EQ(attempt.trial_index, index);
        EXPECT_EQ(attempt.outcome, "success");
        EXPECT_TRUE(attempt.counts());
        EXPECT_EQ(attempt.kind, "simulated");
        EXPECT_EQ(attempt.seed, fake::attemptStart(index).seed);
        EXPECT_EQ(attempt.state_hash, "0123456789abcdef");
        const std::vector<measures::TickOverlap> judged{{3, true, false, true, 1e-6, 2e-6},
                                                        {7, false, true, false, 0.0, 0.5e-6}};
        EXPECT_EQ(fake::require(reader.overlaps(attempt.attempt_id)), judged);
        ASSERT_EQ(attempt.contact_energy.size(), 2u);
        EXPECT_EQ(attempt.contact_energy[0].obstacle, "plate");
        EXPECT_EQ(attempt.contact_energy[0].taken_in_J, 1.0 / 3.0);
        EXPECT_EQ(attempt.contact_energy[0].least_J, -0.25);
        EXPECT_EQ(attempt.contact_energy[1].obstacle, "");
        EXPECT_EQ(attempt.contact_energy[1].taken_in_J, static_cast<double>(i));
        EXPECT_EQ(attempt.measures,
                  (std::map<std::string, double>{{"completion_time_s", 1.0 + 0.1 * static_cast<double>(i)},
                                                 {"peak_force_N", 1.0 / 3.0}}));
        EXPECT_TRUE(fake::sameStoredBits(require(reader.records(attempt.attempt_id)), fake::makeRecords(i, 2345)));
    }
    EXPECT_EQ(attempts[1].condition, "penalty/0,5");
    EXPECT_EQ(attempts[1].levels, (Levels{{"method", "penalty"}, {"clearance", "0,5"}}));
    const auto sessions = require(reader.sessions());
    ASSERT_EQ(sessions.size(), 1u);
    EXPECT_EQ(sessions[0].end_state, "complete");
    EXPECT_EQ(sessions[0].ended_utc, "2000-01-01T00:01:39.000Z");
    EXPECT_EQ(sessions[0].planned_trials, 4);
    EXPECT_EQ(require(reader.protocols())[0].source_text, fake::makePlan().source_text);
    EXPECT_EQ(require(reader.events()).size(), 4u);
    EXPECT_EQ(require(reader.participants())[0].status, "complete");
}

TEST(Store, ReadingChangesNothingAndLeavesNoFilesBehind) {
    // Truth: invariant
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    {
        auto store = fake::openStore(path);
        auto writer = fake::beginSession(*store, "S001", 1);
        require(fake::writeAttempt(*writer, 0, 100));
    }
    const auto bytes = [&path] {
        std::ifstream stream(path, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    const std::string before = bytes();
    {
        const StoreReader reader = require(StoreReader::open(path));
        EXPECT_EQ(require(reader.records(1)).size(), 100u);
        EXPECT_EQ(require(reader.attempts()).size(), 1u);
    }
    EXPECT_EQ(bytes(), before);
    for (const char* suffix : {"-wal", "-shm", ".lock"}) EXPECT_FALSE(std::filesystem::exists(path + suffix)) << suffix;
}

TEST(Store, VirtualTimeStoresNoMeasuredDuration) {
    // Truth: invariant (determinism rule: no clock reaches the data)
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    {
        auto store = fake::openStore(path);
        auto writer = fake::beginSession(*store, "S001", 1);
        require(fake::writeAttempt(*writer, 0, 100));
        require(writer->finishSession(true, 0));
    }
    const Database database(path, OpenMode::ReadOnly);
    EXPECT_EQ(rows(database, "SELECT stream FROM stream"), "tick\n");
    EXPECT_EQ(database.integer("SELECT count(*) FROM timing WHERE mean_us IS NULL AND max_us IS NULL AND hist_json IS "
                               "NULL AND ticks=100"),
              1);
}

TEST(Store, RealTimeStoresEveryTicksDuration) {
    // Truth: invariant
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    {
        auto store = fake::openStore(path);
        auto writer = fake::beginSession(*store, "S001", 1, true);
        require(fake::writeAttempt(*writer, 0, 1100, true));
    }
    const StoreReader reader = require(StoreReader::open(path));
    const auto attempts = require(reader.attempts());
    const auto records = require(reader.records(attempts[0].attempt_id));
    const auto expected = fake::makeRecords(0, 1100);
    ASSERT_EQ(records.size(), expected.size());
    for (std::size_t i = 0; i < records.size(); ++i) ASSERT_EQ(records[i].duration_ns, expected[i].duration_ns);
    EXPECT_EQ(attempts[0].timing->mean_us, 4711.25);
}

TEST(Store, DroppedTicksBeginANewChunkAndNothingIsInvented) {
    // Truth: invariant
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    std::vector<TickRecord> records = fake::makeRecords(9, 1500);
    for (std::size_t i = 700; i < records.size(); ++i) records[i].tick += 40;
    {
        auto store = fake::openStore(path);
        auto writer = fake::beginSession(*store, "S001", 1);
        const auto id = require(writer->startAttempt(fake::attemptStart(0)));
        writer->appendRecords(id, 0, records);
        require(writer->finishAttempt(id, fake::attemptEnd(0, 1540)));
    }
    const Database database(path, OpenMode::ReadOnly);
    EXPECT_EQ(rows(database, "SELECT first_tick || ' ' || n FROM sample_chunk ORDER BY chunk_no"), "0 700\n740 800\n");
    const StoreReader reader = require(StoreReader::open(path));
    EXPECT_TRUE(fake::sameStoredBits(require(reader.records(1)), records));
}

TEST(Store, ADamagedChunkIsReportedNotRead) {
    // Truth: invariant
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    {
        auto store = fake::openStore(path);
        auto writer = fake::beginSession(*store, "S001", 1);
        require(fake::writeAttempt(*writer, 0, 100));
    }
    Database(path, OpenMode::ReadWrite)
        .execute("UPDATE sample_chunk SET data = CAST(substr(data, 1, 500) || x'5A' || substr(data, 502) AS BLOB)");
    const StoreReader reader = require(StoreReader::open(path));
    const auto records = reader.records(1);
    ASSERT_FALSE(records);
    EXPECT_NE(records.errors()[0].message.find("checksum"), std::string::npos) << records.errors()[0].message;
}

TEST(Store, KeepsTheTicksOfEachHandInAStreamOfItsOwn) {
    // Truth: invariant, bit by bit; and a planted fault in the second hand's samples alone.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    const auto first = fake::withBodies(4, fake::makeRecords(1, 2500));
    const auto second = fake::withNavigation(3, fake::makeRecords(2, 2400));
    {
        auto store = fake::openStore(path);
        auto writer = fake::beginSession(*store, "S001", 1, true, fake::makePlan(), 2);
        const auto id = require(writer->startAttempt(fake::attemptStart(0)));
        for (std::size_t i = 0; i < 2500; i += 100) {
            writer->appendRecords(id, 0, std::span(first).subspan(i, 100));
            if (i < 2400) writer->appendRecords(id, 1, std::span(second).subspan(i, 100));
        }
        require(writer->finishAttempt(id, fake::attemptEnd(0, 2500)));
    }
    {
        const StoreReader reader = require(StoreReader::open(path));
        EXPECT_TRUE(fake::sameStoredBits(require(reader.records(1)), first));
        EXPECT_TRUE(fake::sameStoredBits(require(reader.records(1, 1)), second));
        EXPECT_TRUE(require(reader.records(1, 2)).empty());
        EXPECT_EQ(require(reader.records(1)).front().duration_ns, first.front().duration_ns);
    }
    const Database database(path, OpenMode::ReadWrite);
    EXPECT_EQ(rows(database, "SELECT stream FROM stream ORDER BY stream_id"),
              "tick\ntick_hand_2\ntick_timing\nbodies\nnavigation_hand_2\n")
        << "bodies and navigation only of the hand that has them";
    database.execute(
        "UPDATE sample_chunk SET data = CAST(substr(data, 1, 500) || x'5A' || substr(data, 502) AS BLOB) WHERE "
        "stream_id=(SELECT stream_id FROM stream WHERE stream='tick_hand_2')");
    const StoreReader reader = require(StoreReader::open(path));
    EXPECT_TRUE(fake::sameStoredBits(require(reader.records(1)), first));
    EXPECT_FALSE(reader.records(1, 1));
}

TEST(Store, SecondWriterIsRefusedWithAClearError) {
    // Truth: invariant (one process writes)
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    auto first = fake::openStore(path);
    const auto second = Store::open(path, fake::options());
    EXPECT_EQ(second.outcome, OpenOutcome::Failed);
    ASSERT_FALSE(second.errors.empty());
    EXPECT_NE(second.errors[0].message.find("another program"), std::string::npos);
    EXPECT_TRUE(StoreReader::open(path)) << "readers are welcome meanwhile";
    first.reset();
    EXPECT_TRUE(Store::open(path, fake::options()).store);
}

TEST(Store, FilesThatAreNotOursAreRefusedAndLeftAlone) {
    // Truth: invariant
    const fake::TempFolder folder;
    const std::string text = folder / "notes.txt";
    const std::string content(5000, 'x');
    std::ofstream(text) << content;
    const std::string other = folder / "other.db";
    Database(other, OpenMode::Create).execute("CREATE TABLE t(x)");
    for (const std::string& path : {text, other}) {
        const auto opened = Store::open(path, fake::options());
        EXPECT_EQ(opened.outcome, OpenOutcome::Failed);
        ASSERT_EQ(opened.errors.size(), 1u);
        EXPECT_NE(opened.errors[0].message.find("not a Passung database"), std::string::npos)
            << opened.errors[0].message;
        EXPECT_EQ(opened.errors[0].file, path);
        EXPECT_FALSE(StoreReader::open(path));
        EXPECT_FALSE(std::filesystem::exists(path + ".lock"));
    }
    std::ifstream again(text);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(again), {}), content);
    EXPECT_EQ(rows(Database(other, OpenMode::ReadOnly), "SELECT name FROM sqlite_master"), "t\n");
}

TEST(Store, AMissingFileIsNotCreatedUnlessAsked) {
    // Truth: invariant
    const fake::TempFolder folder;
    OpenOptions options = fake::options();
    options.create = false;
    EXPECT_EQ(Store::open(folder / "none.db", options).outcome, OpenOutcome::Failed);
    EXPECT_FALSE(StoreReader::open(folder / "none.db"));
    EXPECT_FALSE(std::filesystem::exists(folder / "none.db"));
    EXPECT_EQ(Store::open(folder / "no/such/folder.db", fake::options()).outcome, OpenOutcome::Failed);
}

std::vector<AccuracyRow> twoCandidates(const std::string& protocol_sha256) {
    AccuracyRow coarse{protocol_sha256, 0, "trilinear", 50.0, 2.0, 0, 900, 10.5, 21.25, 30.0, 40.0, 81.0, 90.0};
    AccuracyRow fine{protocol_sha256, 1, "linear", 20.0, 0.5, 300, 5000, 30.5, 47.25, 60.0, 5.0, 9.0, 11.0};
    coarse.picked_for_us = {25.0, 40.0};
    fine.force_error_p99_percent = 3.5;
    fine.direction_error_p99_deg = 0.25;
    fine.torque_error_p99_percent = 1.5;
    return {coarse, fine};
}

TEST(Store, KeepsWhatAutomaticAccuracyMeasuredAndPickedOnceAndForGood) {
    // Truth: invariant
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    const auto store = fake::openStore(path);
    const std::string sha256 = require(store->importProtocol(fake::makePlan()));
    EXPECT_TRUE(require(store->accuracy(sha256)).empty());
    require(store->keepAccuracy(twoCandidates(sha256)));
    const auto kept = require(store->accuracy(sha256));
    ASSERT_EQ(kept.size(), 2u);
    const std::vector<AccuracyRow> expected = twoCandidates(sha256);
    for (std::size_t i = 0; i < 2; ++i) {
        const auto all = [](const AccuracyRow& r) {
            return std::tie(r.protocol_sha256, r.candidate, r.mode, r.tolerance_um, r.spacing_mm, r.budget_nodes,
                            r.points, r.time_median_us, r.time_p99_us, r.time_max_us, r.error_mean_um, r.error_p99_um,
                            r.error_max_um, r.force_error_p99_percent, r.direction_error_p99_deg,
                            r.torque_error_p99_percent, r.picked_for_us);
        };
        EXPECT_EQ(all(kept[i]), all(expected[i])) << i;
    }
    EXPECT_FALSE(store->keepAccuracy(twoCandidates(sha256))) << "a second time";
    EXPECT_FALSE(store->keepAccuracy(twoCandidates("no such protocol")));
    EXPECT_TRUE(require(store->accuracy("no such protocol")).empty());
}

TEST(Store, KeepsTheStableStiffnessWithWhichAProtocolWasFirstImported) {
    // Truth: invariant; exact doubles, and a later import with others changes nothing.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    auto plan = fake::makePlan();
    plan.stable_stiffness = {{"arm", 1234.0 + 1.0 / 3.0, 0.1, "found here"}, {"stick", 1000.0, 0.0, "its maker"}};
    std::string sha256;
    {
        auto opened = Store::open(path, fake::options());
        ASSERT_TRUE(opened.store);
        sha256 = require(opened.store->importProtocol(plan));
        plan.stable_stiffness[0].linear = 9999.0;
        EXPECT_EQ(require(opened.store->importProtocol(plan)), sha256);
        EXPECT_EQ(require(opened.store->stableStiffness(sha256))[0].linear, 1234.0 + 1.0 / 3.0);
        EXPECT_TRUE(require(opened.store->stableStiffness("no such protocol")).empty());
    }
    const auto reader = StoreReader::open(path);
    ASSERT_TRUE(reader);
    const auto kept = require(reader->stableStiffness(sha256));
    ASSERT_EQ(kept.size(), 2u);
    EXPECT_EQ(kept[0].device, "arm");
    EXPECT_EQ(kept[0].linear, 1234.0 + 1.0 / 3.0);
    EXPECT_EQ(kept[0].rotational, 0.1);
    EXPECT_EQ(kept[0].origin, "found here");
    EXPECT_EQ(kept[1].device, "stick");
}

TEST(Store, MeasuresThatAFileDoesNotKnowYetAreAddedWhenItsProtocolRunsAgain) {
    // Truth: invariant; a database from before a measure was there can take its values.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    { require(Store::open(path, fake::options()).store->importProtocol(fake::makePlan())); }
    const auto count = [&] {
        return Database(path, OpenMode::ReadWrite)
            .integer("SELECT count(*) FROM measure WHERE measure='latched_ticks'");
    };
    {
        const Database older(path, OpenMode::ReadWrite);
        older.execute("DELETE FROM protocol_measure WHERE measure='latched_ticks'");
        older.execute("DELETE FROM measure WHERE measure='latched_ticks'");
    }
    ASSERT_EQ(count(), 0);
    { require(Store::open(path, fake::options()).store->importProtocol(fake::makePlan())); }
    EXPECT_EQ(count(), 1);
}

TEST(Store, AFileOfTheFirstRevisionIsUpgradedAndKeepsPicksThen) {
    // Truth: invariant. The first revision's own statement makes the file.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    fake::makeFirstRevision(path);
    auto opened = Store::open(path, fake::options());
    ASSERT_EQ(opened.outcome, OpenOutcome::Upgraded);
    const std::string sha256 = require(opened.store->importProtocol(fake::makePlan()));
    require(opened.store->keepAccuracy(twoCandidates(sha256)));
    EXPECT_EQ(require(opened.store->accuracy(sha256)).size(), 2u);
}

TEST(Store, NewerFilesFollowTheRuleOfTheOldestReader) {
    // Truth: closed form (a newer file is readable if its oldest reader is not newer than this program; never written)
    for (const bool compatible : {true, false}) {
        const fake::TempFolder folder;
        const std::string path = folder / "s.db";
        fake::openStore(path);
        const int newer = schemaNumber() + 1;
        Database(path, OpenMode::ReadWrite)
            .prepare("INSERT INTO schema_revision VALUES(?, 'from the future', ?, '')")
            .bind(newer, compatible ? schemaNumber() : newer)
            .run();
        const auto opened = Store::open(path, fake::options());
        EXPECT_EQ(opened.outcome, compatible ? OpenOutcome::NewerCompatible : OpenOutcome::NewerIncompatible);
        EXPECT_FALSE(opened.store);
        EXPECT_FALSE(opened.errors.empty());
        EXPECT_EQ(static_cast<bool>(StoreReader::open(path)), compatible);
    }
}

TEST(Store, SlotsGoRowByRowAndKindsDoNotShareThem) {
    // Truth: closed form (4 conditions: 4 rows; free slot with the lowest replicate, then row)
    const fake::TempFolder folder;
    auto store = fake::openStore(folder / "s.db");
    const std::string sha = require(store->importProtocol(fake::makePlan(4)));
    ASSERT_EQ(design::williamsRows(4), 4u);
    for (int i = 1; i <= 6; ++i) {
        const std::string code = require(store->nextCode(plan::ParticipantKind::Simulated));
        EXPECT_EQ(code, "S00" + std::to_string(i));
        EXPECT_TRUE(require(store->enrol(code, plan::ParticipantKind::Simulated, "")));
        EXPECT_FALSE(require(store->enrol(code, plan::ParticipantKind::Simulated, ""))) << "known already";
        const Slot slot = require(store->assignSlot(sha, code));
        EXPECT_EQ(slot.number, i - 1);
        EXPECT_EQ(slot.sequence_index, (i - 1) % 4);
        EXPECT_EQ(slot.replicate, (i - 1) / 4);
        EXPECT_EQ(require(store->assignSlot(sha, code)).number, slot.number) << "keeps its slot";
    }
    const std::string real = require(store->nextCode(plan::ParticipantKind::Real));
    EXPECT_EQ(real, "P001");
    require(store->enrol(real, plan::ParticipantKind::Real, ""));
    EXPECT_EQ(require(store->assignSlot(sha, real)).number, 0);
    EXPECT_FALSE(store->enrol("S001", plan::ParticipantKind::Real, "")) << "a simulated code never turns real";
    EXPECT_FALSE(store->enrol("Anna", plan::ParticipantKind::Real, ""));
    EXPECT_FALSE(store->assignSlot(sha, "P999"));
    EXPECT_FALSE(store->assignSlot("no such protocol", real));
}

TEST(Store, ASessionIsWrittenWholeOrNotAtAll) {
    // Truth: invariant
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    auto store = fake::openStore(path);
    const plan::StudyPlan plan = fake::makePlan();
    SessionStart start;
    start.protocol_sha256 = require(store->importProtocol(plan));
    start.session_id = "x";
    start.participant = "S001";
    require(store->enrol("S001", plan::ParticipantKind::Simulated, ""));
    auto trials = fake::makeTrials(plan, 8);
    trials.back().condition = 99;
    EXPECT_FALSE(store->createSession(start, trials));
    const Database database(path, OpenMode::ReadOnly);
    EXPECT_EQ(database.integer("SELECT count(*) FROM session"), 0);
    EXPECT_EQ(database.integer("SELECT count(*) FROM trial_plan"), 0);
    EXPECT_EQ(database.text("SELECT status FROM participant"), "enrolled");
}

TEST(Store, AFullDiskGivesAnErrorAndFinishedAttemptsRemain) {
    // Truth: invariant; the disk is SQLite's page limit
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    std::int64_t finished = 0;
    {
        OpenOptions options = fake::options();
        options.max_pages = 300;  // 1.2 MB: about three attempts of 2 000 ticks
        auto store = fake::openStore(path, options);
        auto writer = fake::beginSession(*store, "S001", 20);
        std::string message;
        while (finished < 20 && message.empty()) {
            const auto written = fake::writeAttempt(*writer, finished, 2000);
            if (written) {
                ++finished;
            } else {
                message = written.errors()[0].message;
            }
        }
        EXPECT_NE(message.find("full"), std::string::npos) << message;
        EXPECT_GE(finished, 2);
    }
    const auto opened = Store::open(path, fake::options());
    ASSERT_TRUE(opened.store);
    EXPECT_LE(opened.recovery.crashed_attempts.size(), 1u);
    EXPECT_EQ(opened.recovery.crashed_sessions, std::vector<std::string>{"S001, session 1"});
    expectSound(path);
    const StoreReader reader = require(StoreReader::open(path));
    std::int64_t complete = 0;
    for (const AttemptRow& attempt : require(reader.attempts())) {
        if (attempt.outcome != "success") {
            EXPECT_EQ(attempt.outcome, "crashed");
            EXPECT_FALSE(attempt.valid);
            EXPECT_TRUE(attempt.measures.empty());
            continue;
        }
        ++complete;
        EXPECT_TRUE(fake::sameStoredBits(require(reader.records(attempt.attempt_id)),
                                         fake::makeRecords(static_cast<std::uint64_t>(attempt.trial_index), 2000)));
    }
    EXPECT_EQ(complete, finished);
}

TEST(Store, ARunningAttemptIsNotValidAndIsCalledCrashedAtTheNextStart) {
    // Truth: invariant
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    {
        auto store = fake::openStore(path);
        auto writer = fake::beginSession(*store, "S001", 3);
        require(fake::writeAttempt(*writer, 0, 50));
        require(writer->startAttempt(fake::attemptStart(1)));
        const auto attempts = require(require(StoreReader::open(path)).attempts());
        ASSERT_EQ(attempts.size(), 2u);
        EXPECT_EQ(attempts[1].outcome, "running");
        EXPECT_FALSE(attempts[1].valid);
    }
    const auto opened = Store::open(path, fake::options());
    EXPECT_EQ(opened.recovery.crashed_attempts, std::vector<std::string>{"S001, session 1, trial 2, attempt 1"});
    EXPECT_TRUE(Store::open(path, fake::options()).recovery.empty());
    const StoreReader reader = require(StoreReader::open(path));
    EXPECT_EQ(require(reader.attempts())[1].outcome, "crashed");
    EXPECT_EQ(require(reader.sessions())[0].end_state, "crashed");
    EXPECT_EQ(require(reader.sessions())[0].ended_utc, std::nullopt);
}

TEST(Store, TwoSessionsAtOnceKeepTheirDataApart) {
    // Truth: invariant
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    {
        auto store = fake::openStore(path);
        auto one = fake::beginSession(*store, "S001", 10);
        auto two = fake::beginSession(*store, "S002", 10);
        std::thread other([&] {
            for (int trial = 0; trial < 10; ++trial) EXPECT_TRUE(fake::writeAttempt(*two, trial, 1700));
        });
        for (int trial = 0; trial < 10; ++trial) EXPECT_TRUE(fake::writeAttempt(*one, trial, 1700));
        other.join();
        require(one->finishSession(true, 0));
        require(two->finishSession(true, 0));
    }
    expectSound(path);
    const StoreReader reader = require(StoreReader::open(path));
    const auto attempts = require(reader.attempts());
    ASSERT_EQ(attempts.size(), 20u);
    for (const AttemptRow& attempt : attempts) {
        EXPECT_TRUE(fake::sameStoredBits(require(reader.records(attempt.attempt_id)),
                                         fake::makeRecords(static_cast<std::uint64_t>(attempt.trial_index), 1700)));
    }
}

TEST(Store, ACrashedOrIncompleteSessionGivesItsSlotBack) {
    // Truth: invariant (the next participant gets the same row of the square)
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    {
        auto store = fake::openStore(path);
        fake::beginSession(*store, "S001", 1);  // never ends
    }
    auto store = fake::openStore(path);
    auto writer = fake::beginSession(*store, "S002", 2);
    require(fake::writeAttempt(*writer, 0, 20));
    require(writer->finishSession(true, 0));  // one main trial lacks
    writer = fake::beginSession(*store, "S003", 1);
    require(fake::writeAttempt(*writer, 0, 20));
    require(writer->finishSession(true, 0));
    const Database database(path, OpenMode::ReadOnly);
    EXPECT_EQ(rows(database, "SELECT end_state FROM session ORDER BY participant_id"), "crashed\naborted\ncomplete\n");
    EXPECT_EQ(rows(database, "SELECT status FROM participant ORDER BY 1"), "complete\nenrolled\nenrolled\n");
    EXPECT_EQ(rows(database,
                   "SELECT participant_id || sequence_index || state FROM design_slot "
                   "WHERE participant_id NOT NULL"),
              "S0030complete\n");
}

TEST(Store, NobodyCompletesAProtocolTwiceAndItsSeedStays) {
    // Truth: invariant
    const fake::TempFolder folder;
    auto store = fake::openStore(folder / "s.db");
    auto writer = fake::beginSession(*store, "S001", 1);
    require(fake::writeAttempt(*writer, 0, 20));
    require(writer->finishSession(true, 0));
    EXPECT_THROW(fake::beginSession(*store, "S001", 1), std::runtime_error);
    plan::StudyPlan plan = fake::makePlan();
    EXPECT_FALSE(store->importProtocol(plan, {.seed = 8}));
    plan.seed = 8;
    EXPECT_FALSE(store->importProtocol(plan));
    EXPECT_TRUE(store->importProtocol(plan, {.seed = fake::makePlan().seed}));
    EXPECT_FALSE(store->enrol("P001", plan::ParticipantKind::Simulated, ""));
}

TEST(Store, ASymbolicLinkIsNoWayAroundTheLock) {
    // Truth: invariant (one process writes)
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    auto first = fake::openStore(path);
    std::filesystem::create_symlink(path, folder / "link.db");
    EXPECT_FALSE(Store::open(folder / "link.db", fake::options()).store);
    first.reset();
    std::filesystem::create_hard_link(path, folder / "hard.db");
    EXPECT_FALSE(Store::open(folder / "hard.db", fake::options()).store);
}

TEST(Store, ADatabaseHoldsOneStudyAndOneTextPerVersion) {
    // Truth: invariant (rows of two designs under one name and version could not be told apart)
    const fake::TempFolder folder;
    auto store = fake::openStore(folder / "s.db");
    require(store->importProtocol(fake::makePlan()));
    plan::StudyPlan changed = fake::makePlan();
    changed.source_text += "# changed\n";
    const auto same_version = store->importProtocol(changed);
    ASSERT_FALSE(same_version);
    EXPECT_NE(same_version.errors()[0].message.find("new version"), std::string::npos);
    changed.version = "1.1";
    EXPECT_TRUE(store->importProtocol(changed));
    changed.source_text += "# and another\n";
    changed.name = "another";
    const auto other_study = store->importProtocol(changed);
    ASSERT_FALSE(other_study);
    EXPECT_NE(other_study.errors()[0].message.find("holds the study fake, not another"), std::string::npos);
    EXPECT_TRUE(store->importProtocol(fake::makePlan())) << "what is stored already goes on";
    const auto code = store->enrol("s1", plan::ParticipantKind::Simulated, "");
    ASSERT_FALSE(code);
    EXPECT_NE(code.errors()[0].message.find("such as S001"), std::string::npos);
}

TEST(Store, AnotherFormulaUnderAnOldNameIsRefused) {
    // Truth: invariant (one column never means two things)
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    require(fake::openStore(path)->importProtocol(fake::makePlan()));
    Database(path, OpenMode::ReadWrite).execute("UPDATE measure SET formula_version=99 WHERE measure='peak_force_N'");
    plan::StudyPlan plan = fake::makePlan();
    plan.source_text += "# changed\n";
    plan.version = "1.1";
    const auto imported = fake::openStore(path)->importProtocol(plan);
    ASSERT_FALSE(imported);
    EXPECT_NE(imported.errors()[0].message.find("peak_force_N"), std::string::npos);
}

}  // namespace
}  // namespace passung::store
