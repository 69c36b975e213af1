#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <set>

#include "core/base/digest.h"
#include "core/base/json.h"
#include "study/store/people/participant_records.h"
#include "study/store/read/verify.h"
#include "study/store/rows/audit.h"
#include "study/store/schema/backup.h"
#include "study/store/schema/revisions.h"
#include "study/store/schema/sqlite.h"
#include "study/store/transfer/merge.h"
#include "tests/study/store/fake_study.h"

// Who a participant is in every copy of a study, and what is left of them where they were erased.

namespace passung::store {
namespace {

namespace fs = std::filesystem;
using fake::require;
using plan::ParticipantKind;

const Actor kActor{"e", "2001-02-03T04:05:06.000Z"};
const std::string kEnrolled = "2001-02-03T04:05:06.007Z";

std::string identityOf(const std::string& path, const std::string& code) {
    return Database(path, OpenMode::ReadOnly)
        .text("SELECT identity FROM participant WHERE participant_id='" + code + "'");
}

std::string tombstoneIn(const std::string& path) {
    return Database(path, OpenMode::ReadOnly).text("SELECT detail_json FROM audit WHERE action='erase'");
}

/// A study with so many people, the second of whom has a session.
void makeStudy(const std::string& path, int people) {
    const auto store = fake::openStore(path);
    require(store->importProtocol(fake::makePlan()));
    ParticipantRecords desk(*store, kActor);
    for (int i = 1; i <= people; ++i)
        require(desk.enrol(plan::participantCode(ParticipantKind::Real, i), ParticipantKind::Real, kEnrolled));
    const auto writer = fake::beginSession(*store, "S001", 1);
    require(fake::writeAttempt(*writer, 0, 100));
    require(writer->finishSession(true, 1'000'000'000));
}

void erase(const std::string& path, const std::string& code) {
    require(ParticipantRecords(*fake::openStore(path), kActor).erase(code));
}

std::string bytesOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Every text that whoever holds the file could hash to test whether `code` was erased: the code alone, and with each
/// of the tombstone's own texts and the audit's times, in the ways in which this program and the ones before it write.
std::vector<std::string> guesses(const std::string& code, const std::vector<std::string>& salts,
                                 const std::set<std::string>& times) {
    std::vector<std::string> texts = {code};
    for (const std::string& salt : salts) {
        texts.insert(texts.end(), {salt + code, code + salt, salt + "|" + code, code + "|" + salt});
        for (const std::string& time : times)
            texts.push_back(JsonObject().text("salt", salt).text("code", code).text("created_utc", time).str());
    }
    return texts;
}

/// The codes that a search through all of a person's codes finds behind the tombstone.
std::set<std::string> guessedFrom(const std::string& path) {
    const Database database(path, OpenMode::ReadOnly);
    std::vector<std::string> values;
    Statement each =
        database.prepare("SELECT v.atom FROM audit, json_tree(detail_json) v WHERE action='erase' AND v.type='text'");
    while (each.step()) values.push_back(each.text(0));
    std::set<std::string> times{kEnrolled};
    Statement time = database.prepare("SELECT t_utc FROM audit");
    while (time.step()) times.insert(time.text(0));
    std::set<std::string> found;
    for (int number = 1; number <= 999; ++number) {
        const std::string code = plan::participantCode(ParticipantKind::Real, number);
        for (const std::string& text : guesses(code, values, times)) {
            const std::string hash = sha256Hex(text);
            for (const std::string& value : values)
                if (value.size() >= 16 && hash.compare(0, value.size(), value) == 0) found.insert(code);
        }
    }
    return found;
}

TEST(PersonIdentity, NoSearchThroughAllCodesTellsWhoWasErased) {
    // Truth: closed form (brute force over 999 codes). The same search does find what an older program kept.
    const test::TempFolder folder;
    const std::string path = folder / "s.db", older = folder / "older.db";
    for (const std::string& file : {path, older}) makeStudy(file, 9);
    const std::string identity = identityOf(path, "P007");
    erase(path, "P007");
    EXPECT_NE(tombstoneIn(path).find(identity), std::string::npos);
    EXPECT_EQ(bytesOf(path).find("P007"), std::string::npos);
    EXPECT_EQ(guessedFrom(path), std::set<std::string>{});

    erase(older, "P007");
    const std::string salt = "0011223344556677";
    const std::string hash =
        sha256Hex(JsonObject().text("salt", salt).text("code", "P007").text("created_utc", kEnrolled).str());
    Database(older, OpenMode::ReadWrite)
        .prepare("UPDATE audit SET detail_json=? WHERE action='erase'")
        .bind(JsonObject().text("salt", salt).text("person", hash).str())
        .run();
    EXPECT_EQ(guessedFrom(older), std::set<std::string>{"P007"});
}

TEST(PersonIdentity, IsRandomOfPeopleAndTheSameOfEqualSimulatedOnesInEveryCopy) {
    // Truth: invariant. Two studies alike in everything, to the millisecond.
    const test::TempFolder folder;
    const std::string a = folder / "a.db", b = folder / "b.db", all = folder / "all.db";
    for (const std::string& path : {a, b}) makeStudy(path, 3);
    std::set<std::string> seen;
    for (const char* code : {"P001", "P002", "P003"})
        for (const std::string& path : {a, b}) {
            EXPECT_EQ(identityOf(path, code).size(), 32u);
            seen.insert(identityOf(path, code));
        }
    EXPECT_EQ(seen.size(), 6u);
    EXPECT_EQ(identityOf(a, "S001"), identityOf(b, "S001"));
    EXPECT_EQ(identityOf(a, "S001").size(), 32u);

    require(mergeDatabases({a}, all, fake::options()));
    require(fake::openStore(a)->backup());
    for (const std::string& copy : {all, backupPath(a)})
        for (const char* code : {"P001", "P003", "S001"}) EXPECT_EQ(identityOf(copy, code), identityOf(a, code));
    const auto refused = mergeDatabases({b}, all, fake::options());
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.errors()[0].message.find("P001 stands for two people"), std::string::npos);
}

/// The same file as a program would have written it that knew no identities.
void makeOlder(const std::string& path) {
    const Database database(path, OpenMode::Create);
    database.execute("PRAGMA application_id=" + std::to_string(kApplicationId));
    for (const Revision& revision : revisions()) {
        if (std::string(revision.sql).find("ADD COLUMN identity") != std::string::npos) break;
        database.execute(revision.sql);
        database.prepare("INSERT INTO schema_revision VALUES(?, ?, ?, '')")
            .bind(revision.number, revision.sentence, revision.oldest_reader)
            .run();
    }
    for (const char* code : {"P001", "P002"}) {
        database.prepare("INSERT INTO participant VALUES(?, 'real', 'enrolled', NULL, ?)").bind(code, kEnrolled).run();
        appendAudit(database, kActor, "enrol",
                    JsonObject().text("participant", std::string(code)).text("kind", std::string("real")));
    }
}

TEST(PersonIdentity, CopiesOfAnOlderFileAgreeOnItThoughNobodyCanGuessIt) {
    // Truth: invariant. Each copy is upgraded by itself; who is erased from one does not come back from the other.
    const test::TempFolder folder;
    const std::string a = folder / "a.db", b = folder / "b.db", other = folder / "other.db";
    makeOlder(a);
    fs::copy_file(a, b);
    makeOlder(other);
    for (const std::string& path : {a, b, other}) {
        const auto store = fake::openStore(path);
        require(store->importProtocol(fake::makePlan()));
    }
    EXPECT_EQ(identityOf(a, "P002"), identityOf(b, "P002"));
    EXPECT_NE(identityOf(a, "P002"), identityOf(a, "P001"));
    EXPECT_NE(identityOf(a, "P002"), identityOf(other, "P002")) << "equal in all but the random number in its audit";
    erase(a, "P002");
    EXPECT_EQ(guessedFrom(a), std::set<std::string>{});
    const MergeReport report = require(mergeDatabases({b}, a, fake::options()));
    EXPECT_EQ(report.erased.size(), 1u);
    EXPECT_EQ(identityOf(a, "P002"), "");
    EXPECT_EQ(identityOf(a, "P001"), identityOf(b, "P001"));
}

TEST(PersonIdentity, ErasingTakesTheBackupAlongAndNothingElseOfIt) {
    // Truth: closed form (a search for the code's bytes; the backup's own checksum) and invariant: what only the backup
    // still holds stays in it.
    const test::TempFolder folder;
    const std::string path = folder / "s.db", backup = backupPath(path);
    makeStudy(path, 2);
    require(fake::openStore(path)->backup());
    erase(path, "P002");
    ASSERT_NE(bytesOf(backup).find("P002"), std::string::npos) << "not asked to";
    {
        const auto store = fake::openStore(path);
        ParticipantRecords desk(*store, kActor);
        EXPECT_FALSE(desk.eraseFromBackup("P002")) << "unknown here";
        EXPECT_TRUE(require(desk.eraseFromBackup("P001")));
        EXPECT_FALSE(require(desk.eraseFromBackup("P001"))) << "held no more";
        require(desk.erase("P001"));
    }
    EXPECT_EQ(bytesOf(backup).find("P001"), std::string::npos);
    EXPECT_NE(bytesOf(backup).find("P002"), std::string::npos);
    EXPECT_EQ(bytesOf(backup + ".sha256"), sha256OfFile(backup) + "  s.db.backup\n");
    const StoreReader reader = require(StoreReader::open(backup));
    EXPECT_EQ(require(reader.attempts()).size(), 1u) << "S001's";
    EXPECT_EQ(require(reader.audit()).faults, std::vector<std::string>{});
    for (const auto& entry : fs::directory_iterator(folder.path()))
        EXPECT_EQ(entry.path().filename().string().substr(0, 4), "s.db");
}

TEST(PersonIdentity, ABackupIsSoundAfterErasingWhoHadAPlace) {
    // Truth: invariant
    const test::TempFolder folder;
    const std::string path = folder / "s.db";
    const auto store = fake::openStore(path);
    const auto writer = fake::beginSession(*store, "S001", 1);
    require(fake::writeAttempt(*writer, 0, 100));
    require(writer->finishSession(true, 1'000'000'000));
    require(store->backup());
    ASSERT_TRUE(require(ParticipantRecords(*store, kActor).eraseFromBackup("S001")));
    EXPECT_EQ(require(verifyDatabase(backupPath(path))).damages, std::vector<std::string>{});
}

}  // namespace
}  // namespace passung::store
