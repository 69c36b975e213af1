#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "core/base/sanitizer.h"
#include "study/store/read/store_reader.h"
#include "study/store/read/verify.h"
#include "study/store/transfer/restore.h"
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

/// A whole study with its backup.
class SchemaText : public testing::Test {
protected:
    void SetUp() override {
        fake::performAsking(path_, "S001");
        Database(path_, OpenMode::ReadWrite).copyTo(backup_);
        // A statement that ALTER TABLE replaced still stands in its page's free room.
        Database(backup_, OpenMode::ReadWrite).execute("VACUUM");
        whole_ = fake::dump(path_);
    }

    fake::TempFolder folder_;
    const std::string path_ = folder_ / "s.db", backup_ = folder_ / "s.db.backup";
    std::vector<std::string> whole_;
};

TEST_F(SchemaText, EveryFlippedBitIsToldReadAroundAndHealed) {
    // Truth: invariant: the bits are flipped in the file's bytes, whatever SQLite says of it; afterwards every value
    // and every statement is what it was.
    const std::vector<std::size_t> places = placesOfSchema(backup_);
    ASSERT_GT(places.size(), 3000u);
    std::mt19937 random(7);
    const int flips = kSanitized ? 10 : 40;  // each runs the same code
    for (int flip = 0; flip < flips; ++flip) {
        std::string bytes = bytesOf(backup_);
        const std::size_t at = places[random() % places.size()];
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
        std::ofstream(path_, std::ios::binary) << bytes;
        SCOPED_TRACE(bytes.substr(at - 20, 40));
        EXPECT_FALSE(require(verifyDatabase(path_)).damages.empty());
        {
            const StoreReader reader = require(StoreReader::open(path_, Damaged::LeftOut));
            EXPECT_FALSE(reader.damages().empty());
            EXPECT_EQ(require(reader.attempts()).size(), 2u);
        }
        EXPECT_FALSE(StoreReader::open(path_));
        EXPECT_FALSE(Store::open(path_, fake::options()).store);
        const RestoreReport report = require(restoreDatabase(path_, backup_, fake::options()));
        EXPECT_FALSE(report.healed.empty());
        EXPECT_FALSE(report.anew);
        EXPECT_EQ(report.remaining, std::vector<std::string>{});
        EXPECT_TRUE(fake::dump(path_) == whole_);
        EXPECT_EQ(Database(path_, OpenMode::ReadOnly).text("SELECT group_concat(sql) FROM sqlite_schema"),
                  Database(backup_, OpenMode::ReadOnly).text("SELECT group_concat(sql) FROM sqlite_schema"));
    }
}

TEST_F(SchemaText, TwoDamagedStatementsAreNotTakenForAnOlderSchema) {
    // Truth: invariant: neighbours that came with one revision; and a last revision whose number grew is no newer one.
    for (const char* sql :
         {"PRAGMA writable_schema=ON; UPDATE sqlite_schema SET sql=replace(sql, 'sha256 TEXT', 'sha25v TEXT') WHERE "
          "name IN('row_hash','later_change')",
          "UPDATE schema_revision SET revision=revision+16 WHERE revision=(SELECT max(revision) FROM "
          "schema_revision)"}) {
        SCOPED_TRACE(sql);
        std::filesystem::copy_file(backup_, path_, std::filesystem::copy_options::overwrite_existing);
        Database(path_, OpenMode::ReadWrite).execute(sql);
        const auto damages = require(verifyDatabase(path_)).damages;
        EXPECT_FALSE(damages.empty());
        for (const std::string& line : damages) EXPECT_EQ(line.find("stream"), std::string::npos) << line;
        EXPECT_EQ(require(restoreDatabase(path_, backup_, fake::options())).remaining, std::vector<std::string>{});
        EXPECT_TRUE(fake::dump(path_) == whole_);
    }
}

TEST_F(SchemaText, WhatOthersAddIsNoDamage) {
    // Truth: invariant: an analyst's own index, view and table.
    Database(path_, OpenMode::ReadWrite)
        .execute("CREATE INDEX mine ON attempt(outcome); CREATE VIEW looked AS SELECT 1; ANALYZE");
    EXPECT_EQ(require(verifyDatabase(path_)).damages, std::vector<std::string>{});
    EXPECT_TRUE(Store::open(path_, fake::options()).store);
}

}  // namespace
}  // namespace passung::store
