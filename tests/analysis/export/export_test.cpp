#include "analysis/export/export.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>

#include "analysis/export/samples.h"
#include "analysis/export/status_bits.h"
#include "study/store/schema/sqlite.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/study/store/fake_study.h"

namespace passung::exporter {
namespace {

namespace fs = std::filesystem;
using fake::require;

std::string readFile(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Path in the folder → bytes.
std::map<std::string, std::string> readFolder(const std::string& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = readFile(entry.path());
    }
    return files;
}

/// What `command` prints, and then its exit code.
std::pair<std::string, int> shell(const std::string& command) {
    FILE* pipe = popen(command.c_str(), "r");
    std::string text;
    char buffer[4096];
    for (std::size_t n = 0; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, n);
    return {text, pclose(pipe)};
}

/// Two simulated participants with `trials` attempts each, an event with a hard text, and a third
/// participant whose only attempt is left running.
void writeStudy(const std::string& path, std::int64_t trials = 6, bool measured = false) {
    auto store = fake::openStore(path);
    for (const char* code : {"S001", "S002"}) {
        auto writer = fake::beginSession(*store, code, trials);
        writer->appendEvent({{}, 5, "experimenter", fake::kHardText, R"({"note": "a, \"b\""})"});
        for (std::int64_t trial = 0; trial < trials; ++trial) require(fake::writeAttempt(*writer, trial, 40, measured));
        require(writer->finishSession(true, 60'000'000'000));
    }
    auto writer = fake::beginSession(*store, "S003", 8);
    require(writer->startAttempt(fake::attemptStart(0)));
}

void exportTo(const std::string& database, const std::string& folder, const ExportOptions& options = {}) {
    const store::StoreReader reader = require(store::StoreReader::open(database));
    require(exportAll(reader, folder, options));
}

class Export : public ::testing::Test {
protected:
    void SetUp() override {
        writeStudy(folder_ / "s.db");
        exportTo(folder_ / "s.db", folder_ / "out");
        files_ = readFolder(folder_ / "out");
    }
    fake::CsvFile csv(const std::string& file) { return fake::readCsv(files_.at(file)); }

    fake::TempFolder folder_;
    std::map<std::string, std::string> files_;
};

TEST_F(Export, TrialsHaveOneRowPerAttemptWithFactorsAndMeasures) {
    // Truth: closed form (what the fake study wrote)
    const fake::CsvFile trials = csv("trials.csv");
    ASSERT_EQ(trials.rows.size(), 13u);
    const std::vector<std::string> leading = {"participant_id", "kind",        "group",         "session",
                                              "station",        "device",      "block_index",   "block",
                                              "phase",          "trial_index", "trial_in_block"};
    EXPECT_TRUE(std::equal(leading.begin(), leading.end(), trials.header.begin()));
    EXPECT_EQ(trials.at(7, "participant_id"), "S002");
    EXPECT_EQ(trials.at(7, "kind"), "simulated");
    EXPECT_EQ(trials.at(7, "trial_index"), "1");
    EXPECT_EQ(trials.at(7, "block"), "main, \"first\"");
    EXPECT_EQ(trials.at(7, "condition"), "penalty/0,5");
    EXPECT_EQ(trials.at(7, "method"), "penalty");
    EXPECT_EQ(trials.at(7, "clearance"), "0,5");
    EXPECT_EQ(trials.at(7, "start_s"), "10");
    EXPECT_EQ(trials.at(7, "duration_s"), "0.04");
    EXPECT_EQ(trials.at(7, "outcome"), "success");
    EXPECT_EQ(trials.at(7, "valid"), "1");
    EXPECT_EQ(trials.at(7, "invalid_reason"), "NA");
    EXPECT_EQ(trials.at(7, "completion_time_s"), "1.1");
    EXPECT_EQ(trials.at(7, "peak_force_N"), "0.3333333333333333");
    EXPECT_EQ(trials.at(7, "order_position"), "2");
    EXPECT_EQ(trials.at(7, "previous_condition"), "penalty/0.1");
    EXPECT_EQ(trials.at(6, "previous_condition"), "NA");
    EXPECT_EQ(trials.at(7, "counted"), "1");
    EXPECT_EQ(trials.at(7, "not_counted_because"), "NA");
    EXPECT_FALSE(trials.has("n_ticks")) << "it is in timing.csv";
    EXPECT_FALSE(trials.has("path_length_m")) << "the protocol does not name it";
}

TEST_F(Export, ARunningAttemptClaimsNothing) {
    // Truth: invariant (no row claims a result that did not happen)
    const fake::CsvFile trials = csv("trials.csv");
    EXPECT_EQ(trials.at(12, "participant_id"), "S003");
    EXPECT_EQ(trials.at(12, "outcome"), "running");
    EXPECT_EQ(trials.at(12, "valid"), "0");
    for (const char* column : {"duration_s", "completion_time_s", "peak_force_N"}) {
        EXPECT_EQ(trials.at(12, column), "NA") << column;
    }
    EXPECT_EQ(trials.at(12, "counted"), "0");
    EXPECT_EQ(trials.at(12, "not_counted_because"), "not valid: no reason is stored");
    EXPECT_EQ(csv("sessions.csv").at(2, "end_state"), "NA");
}

TEST_F(Export, CellsAreMeansOfTheCountedAttempts) {
    // Truth: closed form (completion times 1.0, 1.1 … 1.5 s; conditions 0, 1, 2, 3, 0, 1)
    const fake::CsvFile cells = csv("cells_long.csv");
    ASSERT_EQ(cells.rows.size(), 3u * 4u);
    EXPECT_EQ(cells.at(0, "condition"), "penalty/0.1");
    EXPECT_EQ(cells.at(0, "n_trials"), "2");
    EXPECT_EQ(cells.at(0, "success_share"), "1");
    EXPECT_NEAR(std::stod(cells.at(0, "completion_time_s.mean")), (1.0 + 1.4) / 2, 1e-12);
    EXPECT_NEAR(std::stod(cells.at(1, "completion_time_s.median")), (1.1 + 1.5) / 2, 1e-12);
    EXPECT_EQ(cells.at(2, "n_trials"), "1");
    EXPECT_EQ(cells.at(8, "participant_id"), "S003");
    EXPECT_EQ(cells.at(8, "n_trials"), "0");
    EXPECT_EQ(cells.at(8, "completion_time_s.mean"), "NA");
    EXPECT_EQ(cells.at(8, "success_share"), "NA");
}

TEST_F(Export, WideTablesHoldTheSameMeansOneRowAPerson) {
    // Truth: invariant (both shapes tell the same)
    const fake::CsvFile wide = csv("wide_completion_time_s.csv");
    const fake::CsvFile cells = csv("cells_long.csv");
    ASSERT_EQ(wide.rows.size(), 3u);
    const std::vector<std::string> parts = {"penalty_0.1", "penalty_0_5", "god_0.1", "god_0_5"};
    for (std::size_t person = 0; person < 3; ++person) {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            EXPECT_EQ(wide.at(person, "completion_time_s." + parts[i]),
                      cells.at(person * 4 + i, "completion_time_s.mean"));
        }
    }
}

TEST_F(Export, EventsKeepHardTexts) {
    // Truth: closed form (what the fake study wrote)
    const fake::CsvFile events = csv("events.csv");
    ASSERT_EQ(events.rows.size(), 14u);
    std::size_t note = 0;
    while (note < events.rows.size() && events.at(note, "source") != "experimenter") ++note;
    ASSERT_LT(note, events.rows.size());
    EXPECT_EQ(events.at(note, "event"), fake::kHardText);
    EXPECT_EQ(events.at(note, "trial_index"), "NA");
    for (std::size_t i = 0; i < events.rows.size(); ++i)
        EXPECT_EQ(events.at(i, "t_utc").substr(0, 10), "2000-01-01") << "by the epoch of virtual time";
}

TEST(ExportedSession, TellsEveryDeviceThatItRanOn) {
    // Truth: closed form: begun on a simulated sigma7, cut off, and resumed with a device that stands for the
    // preset which the condition names; of a mouse older files tell that by its name alone.
    for (const std::string device : {"mouse", "player"}) {
        const fake::TempFolder folder;
        {
            auto store = fake::openStore(folder / "s.db");
            auto writer = fake::beginSession(*store, "S001", 2);
            require(fake::writeAttempt(*writer, 0, 40));
            require(writer->finishSession(false, 40 * kTickNanoseconds));
            writer.reset();
            store::SessionStart start;
            start.protocol_sha256 = require(store->importProtocol(fake::makePlan()));
            require(store->assignSlot(start.protocol_sha256, "S001"));
            start.participant = "S001";
            start.seed = fake::makePlan().seed;
            start.session_id = store::sessionId("fake", "S001", 1, start.seed);
            start.device.name = device;
            start.device.stands_for_preset = true;
            start.device.simulated = false;
            writer = require(store->resumeSession(start, 40 * kTickNanoseconds));
            require(fake::writeAttempt(*writer, 1, 40));
            require(writer->finishSession(true, 60'000'000'000));
            const store::Database database(folder / "s.db", store::OpenMode::ReadWrite);
            database.execute("UPDATE attempt SET params_json=json_set(params_json, '$.device', 'omega7')");
            if (device == "mouse")
                database.execute("UPDATE segment SET device_json=json_remove(device_json, '$.stands_for_preset')");
        }
        exportTo(folder / "s.db", folder / "out");
        const fake::CsvFile sessions = fake::readCsv(readFile(folder / "out/sessions.csv"));
        EXPECT_EQ(sessions.at(0, "n_segments"), "2");
        EXPECT_EQ(sessions.at(0, "device"), "omega7;" + device);
        EXPECT_EQ(sessions.at(0, "segment_devices"), "sigma7;" + device);
        EXPECT_EQ(sessions.at(0, "device_simulated"), "0");
        const fake::CsvFile trials = fake::readCsv(readFile(folder / "out/trials.csv"));
        EXPECT_EQ(trials.at(0, "device"), "omega7");
        EXPECT_EQ(trials.at(1, "device"), device) << "as the trials say";
    }
}

TEST_F(Export, TheCodebookSaysWhatSessionTimeLeavesOut) {
    // Truth: invariant: study/session/session.h: session time is that of attempts and rests, and a resumed session goes
    // on where it was cut off.
    const fake::CsvFile book = csv("codebook.csv");
    for (std::size_t i = 0; i < book.rows.size(); ++i) {
        if (book.at(i, "file") == "events.csv" && book.at(i, "column") == "t_s") {
            for (const char* word : {"missed ones", "rests", "pauses", "questionnaires", "resume", "t_utc"})
                EXPECT_NE(book.at(i, "label").find(word), std::string::npos) << word;
        }
        if (book.at(i, "file") == "trials.csv" && book.at(i, "column") == "start_s") {
            EXPECT_NE(book.at(i, "label").find("t_s of events.csv"), std::string::npos);
        }
    }
}

TEST_F(Export, TheReadmeNamesNoFileThatIsNotThere) {
    // Truth: invariant (what stands in backquotes and ends in .csv, patterns apart)
    const std::string& text = files_.at("README.md");
    int named = 0;
    for (std::size_t at = 0; (at = text.find('`', at)) != std::string::npos;) {
        const std::size_t end = text.find('`', at + 1);
        const std::string name = text.substr(at + 1, end - at - 1);
        at = end + 1;
        if (!name.ends_with(".csv") || name.find_first_of("(\"*_ ") == 0 || name.starts_with("wide_MEASURE")) continue;
        ++named;
        EXPECT_TRUE(files_.contains(name)) << name;
    }
    EXPECT_GT(named, 10);
}

TEST_F(Export, SamplesUnpackToTheRecordedTicks) {
    // Truth: independent program (gzip) and invariant (numbers, read as doubles, are the recorded ones)
    const auto [text, code] = shell("gzip -dc '" + (folder_ / "out/samples/S001_1_t003_a1.csv.gz") + "'");
    ASSERT_EQ(code, 0);
    const fake::CsvFile samples = fake::readCsv(text);
    const std::vector<TickRecord> records = fake::makeRecords(3, 40);
    ASSERT_EQ(samples.rows.size(), records.size());
    for (std::size_t i = 0; i < records.size(); ++i) {
        const TickRecord& r = records[i];
        EXPECT_EQ(samples.at(i, "tick"), std::to_string(r.tick));
        EXPECT_EQ(std::stod(samples.at(i, "device_z_m")), r.device_position_m[2]);
        EXPECT_EQ(std::stod(samples.at(i, "device_qw")), r.device_quaternion[0]);
        EXPECT_EQ(std::stod(samples.at(i, "hand_qz")), r.hand_quaternion[3]);
        EXPECT_EQ(std::stod(samples.at(i, "proxy_x_m")), r.proxy_position_m[0]);
        EXPECT_EQ(std::stod(samples.at(i, "force_y_N")), r.force_N[1]);
        EXPECT_EQ(std::stod(samples.at(i, "torque_x_Nm")), r.torque_Nm[0]);
        EXPECT_EQ(std::stod(samples.at(i, "proxy_depth_m")), r.proxy_depth_m);
        EXPECT_EQ(samples.at(i, "status"), std::to_string(r.status));
        EXPECT_EQ(samples.at(i, "nodes_visited"), std::to_string(r.nodes_visited));
        EXPECT_EQ(std::stod(samples.at(i, "hand_energy_J")), r.hand_energy_J);
        EXPECT_EQ(std::stod(samples.at(i, "proxy_gap_m")), r.proxy_gap_m);
        EXPECT_EQ(samples.at(i, "suspended"), (r.status >> 18 & 1u) != 0 ? "1" : "0");
    }
    EXPECT_EQ(samples.at(14, "t_s"), "0.014");
    EXPECT_EQ(samples.at(15, "periods"), "3");  // two missed cycles
    EXPECT_EQ(samples.at(17, "t_s"), "0.019");
}

TEST_F(Export, EnergyIsToldOfEachAttemptAndObstacle) {
    // Truth: invariant: what the fake study hands over, two rows an attempt that ended.
    const fake::CsvFile energy = csv("contact_energy.csv");
    ASSERT_EQ(energy.rows.size(), 2 * csv("timing.csv").rows.size());
    EXPECT_EQ(energy.at(0, "obstacle"), "plate");
    EXPECT_EQ(std::stod(energy.at(0, "taken_in_J")), 1.0 / 3.0);
    EXPECT_EQ(energy.at(0, "least_J"), "-0.25");
    EXPECT_EQ(energy.at(1, "obstacle"), "NA");
    EXPECT_EQ(energy.at(3, "taken_in_J"), energy.at(3, "trial_index"));
}

TEST_F(Export, TrueOverlapsAreToldOfEachAttemptAndJudgedTick) {
    // Truth: invariant: what the fake study hands over, two rows an attempt that ended.
    const fake::CsvFile overlaps = csv("exact_overlap.csv");
    ASSERT_EQ(overlaps.rows.size(), 2 * csv("timing.csv").rows.size());
    EXPECT_EQ(overlaps.at(0, "tick"), "3");
    EXPECT_EQ(overlaps.at(0, "every_20th"), "1");
    EXPECT_EQ(overlaps.at(0, "largest_depth"), "0");
    EXPECT_EQ(overlaps.at(0, "largest_force"), "1");
    EXPECT_EQ(std::stod(overlaps.at(0, "overlap_m")), 1e-6);
    EXPECT_EQ(std::stod(overlaps.at(0, "bound_m")), 2e-6);
    EXPECT_EQ(overlaps.at(1, "largest_depth"), "1");
}

TEST_F(Export, PicturesAndSoundAreToldOfAttemptsThatAWindowShowed) {
    // Truth: invariant: what the fake study hands over.
    EXPECT_FALSE(files_.contains("presentation.csv")) << "no window showed it";
    const fake::TempFolder folder;
    writeStudy(folder / "s.db", 6, true);
    exportTo(folder / "s.db", folder / "out");
    const fake::CsvFile shown = fake::readCsv(readFile(folder / "out/presentation.csv"));
    ASSERT_EQ(shown.rows.size(), 12u);
    EXPECT_EQ(shown.at(2, "drawn_pose"), "proxy");
    EXPECT_EQ(shown.at(2, "n_frames"), "92");
    EXPECT_EQ(shown.at(2, "frame_age_median_us"), "20000.5");
    EXPECT_EQ(shown.at(2, "frame_age_p99_us"), "30000");
    EXPECT_EQ(shown.at(2, "frame_age_max_us"), "41000");
    EXPECT_EQ(shown.at(2, "sound_output"), "speakers");
    EXPECT_EQ(shown.at(2, "sound_delay_us"), "21333");
    EXPECT_EQ(shown.at(2, "cue_frames"), "7");
    EXPECT_EQ(shown.at(5, "cue_frames"), "NA") << "of a session whose pictures were not counted so";
    EXPECT_EQ(shown.at(5, "drawn_pose"), "device");
    EXPECT_EQ(shown.at(5, "sound"), "silent");
    for (const char* column : {"frame_age_median_us", "frame_age_max_us", "sound_output", "sound_delay_us"})
        EXPECT_EQ(shown.at(5, column), "NA") << column;
    const std::string book = readFile(folder / "out/codebook.csv");
    for (const std::string& column : shown.header)
        EXPECT_NE(book.find("presentation.csv," + column), std::string::npos) << column;
}

TEST_F(Export, NoMeasuredTimeReachesAnExportOfVirtualTime) {
    // Truth: invariant (the fake study hands over durations, means of 4711.25 µs and a wall clock of 2001)
    std::string all;
    for (const auto& [file, bytes] : files_) {
        if (file.ends_with(".gz")) {
            all += shell("gzip -dc '" + (folder_ / "out/") + file + "'").first;
        } else {
            all += bytes;
        }
    }
    for (const char* clue : {"4711.25", "4711.75", "2001-02-03"}) EXPECT_EQ(all.find(clue), std::string::npos) << clue;
    for (const TickRecord& record : fake::makeRecords(3, 40)) {
        EXPECT_EQ(all.find(std::to_string(record.duration_ns)), std::string::npos);
        EXPECT_EQ(all.find(std::to_string(record.processor_ns)), std::string::npos);
    }
    const fake::CsvFile timing = csv("timing.csv");
    for (const char* column : {"mean_us", "sd_us", "p99_us", "p999_us", "max_us", "processor_mean_us",
                               "processor_p99_us", "processor_p999_us", "processor_max_us"})
        EXPECT_EQ(timing.at(0, column), "NA");
    EXPECT_EQ(csv("sessions.csv").at(0, "started_utc"), "2000-01-01T00:00:00.000Z");
    EXPECT_EQ(csv("participants.csv").at(0, "created_utc"), "2000-01-01T00:00:00.000Z");
}

TEST_F(Export, EveryColumnOfEveryTableIsInTheCodebook) {
    // Truth: invariant
    const fake::CsvFile book = csv("codebook.csv");
    std::map<std::string, std::vector<std::string>> described;
    for (std::size_t i = 0; i < book.rows.size(); ++i) {
        described[book.at(i, "file")].push_back(book.at(i, "column"));
        EXPECT_FALSE(book.at(i, "label").empty()) << book.at(i, "column");
        EXPECT_EQ(book.at(i, "missing"), "NA");
    }
    int tables = 0;
    for (const auto& [file, bytes] : files_) {
        if (!file.ends_with(".csv")) continue;
        EXPECT_EQ(described[file], fake::readCsv(bytes).header) << file;
        ++tables;
    }
    EXPECT_EQ(tables, 12);
    EXPECT_TRUE(described.count("samples/*.csv.gz"));
    const store::Database sqlite(folder_ / "json.db", store::OpenMode::Create);
    store::Statement valid = sqlite.prepare("SELECT json_valid(?)");
    ASSERT_TRUE(valid.bind(files_.at("codebook.json")).step());
    EXPECT_EQ(valid.integer(0), 1) << "codebook.json is JSON";
}

TEST_F(Export, SumsAndProtocolNameAreRight) {
    // Truth: independent program (coreutils sha256sum)
    EXPECT_EQ(shell("cd '" + (folder_ / "out") + "' && sha256sum --strict --quiet -c SHA256SUMS").second, 0);
    const std::string sums = files_.at("SHA256SUMS");
    EXPECT_EQ(static_cast<std::size_t>(std::count(sums.begin(), sums.end(), '\n')), files_.size() - 1);
    const std::string sha = csv("trials.csv").at(0, "protocol_sha256");
    EXPECT_EQ(files_.at("protocol/" + sha + ".toml"), fake::makePlan().source_text);
}

TEST_F(Export, TheSameDatabaseGivesTheSameBytes) {
    // Truth: invariant (determinism rule)
    exportTo(folder_ / "s.db", folder_ / "again");
    EXPECT_EQ(readFolder(folder_ / "again"), files_);
}

TEST_F(Export, TheSameStudyRunAgainGivesTheSameBytes) {
    // Truth: invariant: another database, its wall clock another one, sessions stored in another order
    const std::string path = folder_ / "other.db";
    {
        store::OpenOptions later = fake::options();
        later.now_utc = "2031-02-03T04:05:06.000Z";
        auto store = fake::openStore(path, later);
        auto first = fake::beginSession(*store, "S001", 6);
        auto second = fake::beginSession(*store, "S002", 6);
        auto third = fake::beginSession(*store, "S003", 8);
        require(third->startAttempt(fake::attemptStart(0)));
        for (auto* writer : {second.get(), first.get()}) {
            writer->appendEvent({{}, 5, "experimenter", fake::kHardText, R"({"note": "a, \"b\""})"});
            for (std::int64_t trial = 0; trial < 6; ++trial) require(fake::writeAttempt(*writer, trial, 40));
            require(writer->finishSession(true, 60'000'000'000));
        }
    }
    exportTo(path, folder_ / "other");
    EXPECT_EQ(readFolder(folder_ / "other"), files_);
}

TEST_F(Export, SamplesCanBeLeftOut) {
    // Truth: invariant
    exportTo(folder_ / "s.db", folder_ / "small", {.samples = false, .progress = {}});
    auto expected = files_;
    const auto small = readFolder(folder_ / "small");
    for (const auto& [file, bytes] : small) EXPECT_FALSE(file.starts_with("samples")) << file;
    EXPECT_EQ(small.at("trials.csv"), expected.at("trials.csv"));
    EXPECT_EQ(small.at("README.md").find("samples"), std::string::npos);
    EXPECT_NE(small.at("README.md").find("every complete session"), std::string::npos);
}

TEST_F(Export, AnEarlierExportIsReplacedAsAWhole) {
    // Truth: invariant
    std::ofstream(folder_ / "out/trials.csv") << "spoilt";
    exportTo(folder_ / "s.db", folder_ / "out/");
    EXPECT_EQ(readFolder(folder_ / "out"), files_);
    for (const auto& entry : fs::directory_iterator(folder_ / "")) {
        EXPECT_EQ(entry.path().filename().string().find(".partial"), std::string::npos) << entry.path();
    }
}

TEST_F(Export, AStrangersFileInAnEarlierExportIsNamedAndKept) {
    // Truth: invariant
    std::ofstream(folder_ / "out/analysis.R") << "years of work";
    const store::StoreReader reader = require(store::StoreReader::open(folder_ / "s.db"));
    const auto refused = exportAll(reader, folder_ / "out");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.errors()[0].file, folder_ / "out/analysis.R");
    EXPECT_EQ(readFile(folder_ / "out/analysis.R"), "years of work");
}

TEST_F(Export, TheExportOfAnotherStudyIsRefusedAndLeftAlone) {
    // Truth: invariant (nobody's tables are replaced by those of another study)
    const auto rename = [&](const std::string& name) {
        store::Database(folder_ / "s.db", store::OpenMode::ReadWrite)
            .execute("UPDATE protocol_version SET name='" + name + "', source_text='[study]\nname = \"" + name +
                     "\"\n'");
    };
    rename("first");
    exportTo(folder_ / "s.db", folder_ / "out");
    const auto before = readFolder(folder_ / "out");
    rename("second");
    const store::StoreReader reader = require(store::StoreReader::open(folder_ / "s.db"));
    const auto refused = exportAll(reader, folder_ / "out");
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.errors()[0].message.find("another study, first"), std::string::npos);
    EXPECT_EQ(readFolder(folder_ / "out"), before);
}

TEST_F(Export, WhatAKilledExportLeftIsRemovedByTheNext) {
    // Truth: invariant (the names are those of mkdtemp; a folder that another program has locked is at work)
    const std::string left = folder_ / "out.partial.abc123", busy = folder_ / "out.partial.def456";
    const std::string other = folder_ / "out2.partial.abc123", notes = folder_ / "out.partial.notes.md";
    for (const std::string& path : {left, busy, other, notes}) fs::create_directories(path + "/new");
    const int lock = open(busy.c_str(), O_RDONLY | O_DIRECTORY);
    ASSERT_EQ(flock(lock, LOCK_EX | LOCK_NB), 0);
    exportTo(folder_ / "s.db", folder_ / "out");
    close(lock);
    EXPECT_FALSE(fs::exists(left));
    for (const std::string& path : {busy, other, notes}) EXPECT_TRUE(fs::exists(path)) << path;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "."), {}), 5) << "database, export and the other three";
}

TEST(StatusBits, TheCodebookExplainsEveryOne) {
    // Truth: closed form (core/base/tick_record.h)
    std::string formula;
    for (const Column& column : sampleColumns({}))
        if (column.name == "status") formula = column.formula;
    EXPECT_NE(formula.find("; 65536 = engaged: "), std::string::npos) << formula;
    EXPECT_NE(formula.find(": 1 = bad device input, the last good pose was used; 2 = "), std::string::npos) << formula;
    for (unsigned bit = 0; bit < 32; ++bit) {
        const bool used = bit <= 14 || (bit >= 16 && bit <= 21);
        const char* meaning = statusBitMeaning(static_cast<TickStatus>(1u << bit));
        EXPECT_EQ(meaning != nullptr, used) << bit;
        if (meaning == nullptr) continue;
        EXPECT_NE(formula.find(std::to_string(1u << bit) + " = " + meaning), std::string::npos);
    }
}

TEST_F(Export, AFolderWithSomethingElseIsRefusedAndLeftAlone) {
    // Truth: invariant
    const store::StoreReader reader = require(store::StoreReader::open(folder_ / "s.db"));
    fs::create_directory(folder_ / "mine");
    std::ofstream(folder_ / "mine/thesis.txt") << "years of work";
    std::ofstream(folder_ / "file") << "a file";
    for (const char* name : {"mine", "file"}) {
        const auto refused = exportAll(reader, folder_ / name);
        ASSERT_FALSE(refused) << name;
        EXPECT_EQ(refused.errors()[0].file, folder_ / name);
    }
    EXPECT_EQ(readFolder(folder_ / "mine"), (std::map<std::string, std::string>{{"thesis.txt", "years of work"}}));
    EXPECT_EQ(readFile(folder_ / "file"), "a file");
    EXPECT_FALSE(exportAll(reader, ""));
    EXPECT_FALSE(exportAll(reader, "."));
}

TEST_F(Export, ADamagedSampleLeavesNothingHalfWritten) {
    // Truth: invariant
    store::Database(folder_ / "s.db", store::OpenMode::ReadWrite)
        .execute("UPDATE sample_chunk SET crc32 = crc32 + 1 WHERE chunk_no = 4");
    const store::StoreReader reader = require(store::StoreReader::open(folder_ / "s.db"));
    EXPECT_FALSE(exportAll(reader, folder_ / "new"));
    EXPECT_FALSE(fs::exists(folder_ / "new"));
    EXPECT_FALSE(fs::exists(folder_ / "new.partial"));
    EXPECT_FALSE(exportAll(reader, folder_ / "out"));
    EXPECT_EQ(readFolder(folder_ / "out"), files_) << "the earlier export is still there";
}

TEST(ExportSamples, ColumnsAndChannelsAgree) {
    // Truth: invariant: as many cells as columns
    using store::Extra;
    const auto plain = fake::makeRecords(1, 2), moved = fake::withNavigation(3, plain),
               held = fake::withBodies(3, plain);
    const auto columnsOf = [](const std::vector<TickRecord>& records, const std::vector<Extra>& extras) {
        const fake::CsvFile samples = fake::readCsv(samplesCsv(records, {}));
        EXPECT_EQ(samples.header.size(), sampleColumns(extras).size());
        EXPECT_EQ(samples.rows.size(), 2u);
        return samples.header.size();
    };
    const std::size_t fewest = columnsOf(plain, {});
    EXPECT_EQ(columnsOf(moved, {Extra::Navigation}), fewest + 9);
    EXPECT_EQ(columnsOf(held, {Extra::Bodies}), fewest + 2);
    EXPECT_EQ(columnsOf(fake::withBodies(3, moved), {Extra::Navigation, Extra::Bodies}), fewest + 11);
    EXPECT_EQ(columnsOf(fake::withEffects(3, plain), {Extra::Effects}), fewest + 44);
}

}  // namespace
}  // namespace passung::exporter
