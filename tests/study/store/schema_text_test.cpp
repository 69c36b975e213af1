#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "study/store/restore.h"
#include "study/store/store_reader.h"
#include "study/store/verify.h"
#include "tests/study/store/damaged_study.h"

namespace passung::store {
namespace {

using fake::require;

std::string bytesOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Where in the file the statements stand that made its tables and indices.
std::vector<std::size_t> placesOfSchema(const std::string& path) {
    const std::string bytes = bytesOf(path);
    std::vector<std::size_t> places;
    const Database database(path, OpenMode::ReadOnly);
    Statement statements = database.prepare("SELECT sql FROM sqlite_schema WHERE sql IS NOT NULL");
    while (statements.step()) {
        // A longer one goes on in another page.
        const std::string text = statements.text(0).substr(0, 200);
        const std::size_t at = bytes.find(text);
        for (std::size_t i = 0; at != std::string::npos && i < text.size(); ++i) places.push_back(at + i);
    }
    return places;
}

TEST(SchemaText, EveryFlippedBitIsToldReadAroundAndHealed) {
    // Truth: invariant: the bits are flipped in the file's bytes, whatever SQLite says of it; afterwards every value
    // and every statement is what it was.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db", backup = folder / "s.db.backup";
    fake::performAsking(path, "S001");
    Database(path, OpenMode::ReadWrite).copyTo(backup);
    const auto whole = fake::dump(path);
    const std::vector<std::size_t> places = placesOfSchema(backup);
    ASSERT_GT(places.size(), 3000u);
    std::mt19937 random(7);
    for (int flip = 0; flip < 40; ++flip) {
        std::string bytes = bytesOf(backup);
        const std::size_t at = places[random() % places.size()];
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
        std::ofstream(path, std::ios::binary) << bytes;
        SCOPED_TRACE(bytes.substr(at - 20, 40));
        EXPECT_FALSE(require(verifyDatabase(path)).damages.empty());
        {
            const StoreReader reader = require(StoreReader::open(path, Damaged::LeftOut));
            EXPECT_FALSE(reader.damages().empty());
            EXPECT_EQ(require(reader.attempts()).size(), 2u);
        }
        EXPECT_FALSE(StoreReader::open(path));
        EXPECT_FALSE(Store::open(path, fake::options()).store);
        const RestoreReport report = require(restoreDatabase(path, backup, fake::options()));
        EXPECT_FALSE(report.healed.empty());
        EXPECT_FALSE(report.anew);
        EXPECT_EQ(report.remaining, std::vector<std::string>{});
        EXPECT_TRUE(fake::dump(path) == whole);
        EXPECT_EQ(Database(path, OpenMode::ReadOnly).text("SELECT group_concat(sql) FROM sqlite_schema"),
                  Database(backup, OpenMode::ReadOnly).text("SELECT group_concat(sql) FROM sqlite_schema"));
    }
}

TEST(SchemaText, TwoDamagedStatementsAreNotTakenForAnOlderSchema) {
    // Truth: invariant: neighbours that came with one revision; and a last revision whose number grew is no newer one.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db", backup = folder / "s.db.backup";
    fake::performAsking(path, "S001");
    Database(path, OpenMode::ReadWrite).copyTo(backup);
    const auto whole = fake::dump(path);
    for (const char* sql :
         {"PRAGMA writable_schema=ON; UPDATE sqlite_schema SET sql=replace(sql, 'sha256 TEXT', 'sha25v TEXT') WHERE "
          "name IN('row_hash','later_change')",
          "UPDATE schema_revision SET revision=revision+16 WHERE revision=(SELECT max(revision) FROM "
          "schema_revision)"}) {
        SCOPED_TRACE(sql);
        std::filesystem::copy_file(backup, path, std::filesystem::copy_options::overwrite_existing);
        Database(path, OpenMode::ReadWrite).execute(sql);
        const auto damages = require(verifyDatabase(path)).damages;
        EXPECT_FALSE(damages.empty());
        for (const std::string& line : damages) EXPECT_EQ(line.find("stream"), std::string::npos) << line;
        EXPECT_EQ(require(restoreDatabase(path, backup, fake::options())).remaining, std::vector<std::string>{});
        EXPECT_TRUE(fake::dump(path) == whole);
    }
}

TEST(SchemaText, WhatOthersAddIsNoDamage) {
    // Truth: invariant: an analyst's own index, view and table.
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    fake::performAsking(path, "S001");
    Database(path, OpenMode::ReadWrite)
        .execute("CREATE INDEX mine ON attempt(outcome); CREATE VIEW looked AS SELECT 1; ANALYZE");
    EXPECT_EQ(require(verifyDatabase(path)).damages, std::vector<std::string>{});
    EXPECT_TRUE(Store::open(path, fake::options()).store);
}

}  // namespace
}  // namespace passung::store
