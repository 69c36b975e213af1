#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include "analysis/export/export.h"
#include "core/base/random.h"
#include "study/store/read/verify.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/study/store/damaged_study.h"
#include "tests/support/length.h"

namespace passung::exporter {
namespace {

namespace fs = std::filesystem;
using fake::require;
using Files = std::map<std::string, std::string>;

std::string bytesOf(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

Files readFolder(const fs::path& folder) {
    Files files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = bytesOf(entry.path());
    return files;
}

class DamagedExport : public testing::Test {
protected:
    void SetUp() override {
        for (const char* code : {"S001", "S002"}) fake::performAsking(path_, code);
        bytes_ = bytesOf(path_);
        whole_ = *exported(true);
    }

    /// Nothing if the file cannot be exported at all.
    std::optional<Files> exported(bool samples) {
        const auto reader =
            store::StoreReader::open(path_, samples ? store::Damaged::LeftOutWithSamples : store::Damaged::LeftOut);
        if (!reader) return std::nullopt;
        damages_ = reader->damages();
        fs::remove_all(folder_ / "out");
        ExportOptions options;
        options.samples = samples;
        if (!exportAll(*reader, folder_ / "out", options)) return std::nullopt;
        return readFolder(folder_ / "out");
    }
    void change(const std::string& sql) {
        std::ofstream(path_, std::ios::binary) << bytes_;
        store::Database(path_, store::OpenMode::ReadWrite).execute("PRAGMA foreign_keys=OFF; " + sql);
    }
    std::string missing(const Files& files) { return files.count("missing.csv") == 0 ? "" : files.at("missing.csv"); }
    static std::size_t rowsOf(const Files& files, const std::string& file) {
        return fake::readCsv(files.at(file)).rows.size();
    }

    fake::TempFolder folder_;
    const std::string path_ = folder_ / "s.db";
    std::string bytes_;
    Files whole_;
    std::vector<store::DamageRow> damages_;
};

TEST_F(DamagedExport, HoldsWhatIsIntactAndListsTheRest) {
    // Truth: invariant: one planted damage each; all other rows are there byte for byte.
    EXPECT_EQ(whole_.count("missing.csv"), 0u);
    change("UPDATE sample_chunk SET data=zeroblob(9) WHERE stream_id=1 AND chunk_no=1");
    Files files = *exported(true);
    EXPECT_NE(missing(files).find("S001,1,0,1,\"trial 1, attempt 1, samples\",\"chunk of samples from tick 1000"),
              std::string::npos)
        << missing(files);
    EXPECT_EQ(files.at("trials.csv"), whole_.at("trials.csv"));
    EXPECT_EQ(files.at("questionnaire_items.csv"), whole_.at("questionnaire_items.csv"));
    EXPECT_EQ(files.at("samples/S001_1_t001_a1.csv.gz"), whole_.at("samples/S001_1_t001_a1.csv.gz"));
    EXPECT_NE(files.at("samples/S001_1_t000_a1.csv.gz"), whole_.at("samples/S001_1_t000_a1.csv.gz"));

    change("UPDATE item_response SET value_num=4 WHERE run_id=1 AND item='located'");
    files = *exported(false);
    EXPECT_NE(missing(files).find("\"form 1, item_response\""), std::string::npos) << missing(files);
    EXPECT_EQ(files.at("trials.csv"), whole_.at("trials.csv"));
    EXPECT_EQ(2 * rowsOf(files, "questionnaire_items.csv"), rowsOf(whole_, "questionnaire_items.csv"));

    change("UPDATE attempt_measure SET value_num=2 WHERE attempt_id=3 AND measure='peak_force_N'");
    files = *exported(false);
    EXPECT_NE(missing(files).find("S002,1,0,1,"), std::string::npos) << missing(files);
    EXPECT_EQ(rowsOf(files, "trials.csv") + 1, rowsOf(whole_, "trials.csv"));

    change("UPDATE event SET payload_json='{' WHERE attempt_id IS NULL");
    files = *exported(false);
    EXPECT_EQ(files.at("trials.csv"), whole_.at("trials.csv"));
    EXPECT_LT(rowsOf(files, "events.csv"), rowsOf(whole_, "events.csv"));

    change("UPDATE participant SET kind='real' WHERE participant_id='S001'");
    files = *exported(false);
    EXPECT_EQ(2 * rowsOf(files, "trials.csv"), rowsOf(whole_, "trials.csv"));
}

TEST_F(DamagedExport, KeepsAnEarlierExportThatMayHoldWhatIsDamaged) {
    // Truth: invariant: nothing that an earlier export holds and the database no longer has is lost; an export that
    // misses the same, or more, is replaced.
    const fs::path out = folder_ / "out", first = folder_ / "out.backup.1", second = folder_ / "out.backup.2";
    const auto exportOver = [&] {
        const auto reader = require(store::StoreReader::open(path_, store::Damaged::LeftOutWithSamples));
        return fs::path(require(exportAll(reader, out)).kept);
    };
    EXPECT_EQ(exportOver(), fs::path()) << "both are whole";
    const std::string answer = "UPDATE item_response SET value_num=4 WHERE run_id=1 AND item='located'; ";
    const std::string measure = "UPDATE attempt_measure SET value_num=2 WHERE attempt_id=3 AND measure='peak_force_N'";
    change(answer);
    EXPECT_EQ(exportOver(), first);
    EXPECT_TRUE(readFolder(first) == whole_);
    const Files lacks_answer = readFolder(out);
    EXPECT_EQ(exportOver(), fs::path()) << "both miss the same";
    change(answer + measure);
    EXPECT_EQ(exportOver(), second);
    EXPECT_TRUE(readFolder(second) == lacks_answer);
    change(answer);
    EXPECT_EQ(exportOver(), fs::path()) << "the new one has all that the earlier one has";
    change("");
    EXPECT_EQ(exportOver(), fs::path());
    EXPECT_TRUE(readFolder(out) == whole_);
    EXPECT_TRUE(readFolder(first) == whole_);
    // Samples that nobody looked at this time may be damaged too.
    const auto reader = require(store::StoreReader::open(path_, store::Damaged::LeftOut));
    ExportOptions without;
    without.samples = false;
    const fs::path third = folder_ / "out.backup.3";
    EXPECT_EQ(fs::path(require(exportAll(reader, out, without)).kept), third);
    EXPECT_TRUE(readFolder(third) == whole_);
    EXPECT_EQ(fs::path(require(exportAll(reader, out, without)).kept), fs::path());
}

TEST_F(DamagedExport, StatesNoTickThatTheSamplesLeftCannotTell) {
    // Truth: closed form: of 16 ticks the last one stands for 3 periods, so period 1150 is tick 16*63 + 15 = 1023;
    // without the first 1000 ticks nobody knows how many periods they took.
    const std::string missed =
        "DELETE FROM session_hash; UPDATE timing SET overruns=1; UPDATE event SET event='trial_started', "
        "t_ns=t_ns+1150000000 WHERE "
        "attempt_id=1; ";
    // The attempt ended at period 1200, which is tick 1068: 2 * 66 periods up to it had none.
    using Ticks = std::pair<std::string, std::string>;
    const auto ticks = [&] {
        const auto trials = fake::readCsv(exported(true)->at("trials.csv"));
        return Ticks(trials.at(0, "start_tick"), trials.at(0, "end_tick"));
    };
    change(missed);
    EXPECT_EQ(ticks(), Ticks("1023", "1068"));
    change(missed + "UPDATE sample_chunk SET data=zeroblob(9) WHERE stream_id=1 AND chunk_no=0");
    EXPECT_EQ(ticks(), Ticks("NA", "NA"));
}

/// The row as it says nothing of the rows before it, one of which may be missing.
std::vector<std::string> withoutPlace(const fake::CsvFile& csv, std::vector<std::string> row) {
    for (const char* column : {"order_position", "previous_condition"}) {
        const auto at = std::find(csv.header.begin(), csv.header.end(), column);
        if (at != csv.header.end()) row[static_cast<std::size_t>(at - csv.header.begin())] = "NA";
    }
    return row;
}

TEST_F(DamagedExport, EveryFlippedBitIsNoticedOrWithoutEffect) {
    // Truth: invariant: bits of a real file, wherever they lie; what verify does not notice changes no exported byte,
    // and no row of a table is exported that was not there before.
    const int flips = test::atFullLength() ? 1000 : 150;
    Random random(17);
    int unnoticed = 0, whole_exports = 0;
    for (int flip = 0; flip < flips; ++flip) {
        const auto at = static_cast<std::size_t>(random.below(bytes_.size()));
        const auto bit = static_cast<unsigned>(random.below(8));
        SCOPED_TRACE("byte " + std::to_string(at) + ", bit " + std::to_string(bit));
        std::string damaged = bytes_;
        damaged[at] = static_cast<char>(damaged[at] ^ (1u << bit));
        std::ofstream(path_, std::ios::binary) << damaged;
        const auto found = store::verifyDatabase(path_);
        const bool noticed = !found || !found->damages.empty();
        unnoticed += noticed ? 0 : 1;
        const auto files = exported(!noticed);
        if (!noticed) {
            ASSERT_TRUE(files);
            EXPECT_TRUE(*files == whole_);
        }
        if (!files) continue;
        ++whole_exports;
        if (std::any_of(damages_.begin(), damages_.end(), [](const auto& d) { return !d.session_ordinal; })) continue;
        for (const char* table : {"trials.csv", "questionnaire_items.csv", "events.csv", "notes.csv", "timing.csv"}) {
            if (files->count(table) == 0) continue;
            const auto before = fake::readCsv(whole_.at(table));
            std::set<std::vector<std::string>> known(before.rows.begin(), before.rows.end());
            for (const auto& row : before.rows) known.insert(withoutPlace(before, row));
            for (const auto& row : fake::readCsv(files->at(table)).rows)
                EXPECT_EQ(known.count(row), 1u) << table << ": " << testing::PrintToString(row);
        }
    }
    std::printf("%d of %d flips without effect, %d exports\n", unnoticed, flips, whole_exports);
    EXPECT_GT(whole_exports, flips / 2) << "one flipped bit does not stop an export";
}

}  // namespace
}  // namespace passung::exporter
