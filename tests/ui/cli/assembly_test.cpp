#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "study/store/read/store_reader.h"
#include "study/store/schema/sqlite.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/ui/cli/program.h"

// A study of assembly as users meet it: its trials, their replay, its tables.

namespace passung::test {
namespace {

/// The study of the page: a pin into a bore, 1 mm of tolerance; a block onto a plate and a lid onto the block, 3 mm.
std::string studyOfThePage() {
    const std::string page = readText(PASSUNG_SOURCE_DIR "/protocols/ASSEMBLY.md"), fence = "```toml\n";
    const std::size_t begin = page.find(fence) + fence.size();
    return page.substr(begin, page.find("```", begin) - begin);
}

/// Where a part was left, by the samples alone: the proxy in the last row with it in the hand.
std::map<int, Vec3> leftAt(const std::vector<TickRecord>& records) {
    std::map<int, Vec3> left;
    for (const TickRecord& r : records)
        if (r.held >= 0) left[r.held] = Vec3(r.proxy_position_m[0], r.proxy_position_m[1], r.proxy_position_m[2]);
    return left;
}

class AssemblyStudy : public testing::Test {
protected:
    Ended program(const std::vector<std::string>& arguments) const { return runProgram(folder_.path(), arguments); }
    void run(const std::string& text) {
        writeText(folder_ / "study.toml", text);
        const Ended ended = program({"run", "study.toml", "--simulated", "1", "--db", "study.db"});
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
        const Ended exported = program({"export", "study.db", "--out", "out"});
        ASSERT_EQ(exported.exit_code, 0) << exported.err;
    }
    fake::CsvFile table(const std::string& name) const { return fake::readCsv(readText(folder_ / ("out/" + name))); }

    TempFolder folder_;
};

TEST_F(AssemblyStudy, IsDoneByASimulatedPersonReplaysAndTellsOfEachStep) {
    // Truth: where parts were left, from the recorded poses alone, against the goals of the study; the tables say
    // the same. All bits again from the recorded inputs.
    run(studyOfThePage());
    auto reader = store::StoreReader::open(folder_ / "study.db");
    ASSERT_TRUE(reader);
    const auto attempts = reader->attempts();
    ASSERT_TRUE(attempts);
    ASSERT_EQ(attempts->size(), 2u);
    const fake::CsvFile steps = table("assembly_steps.csv"), trials = table("trials.csv");
    ASSERT_EQ(steps.rows.size(), 6u);
    for (std::size_t i = 0; i < attempts->size(); ++i) {
        const store::AttemptRow& attempt = (*attempts)[i];
        EXPECT_EQ(attempt.outcome, "success");
        EXPECT_EQ(trials.at(i, "steps_done"), "3");
        EXPECT_LE(std::stod(trials.at(i, "max_exact_overlap_m")), 1e-6);
        const auto records = reader->records(attempt.attempt_id);
        ASSERT_TRUE(records);
        const std::map<int, Vec3> left = leftAt(*records);
        const Vec3 block = left.at(2);
        const double errors[] = {(left.at(1) - Vec3(0, 0, -0.0145)).norm(),
                                 (block - Vec3(-0.025, 0.015, 0.0055)).norm(),
                                 (left.at(3) - block - Vec3(0, 0, 0.0095)).norm()};
        for (std::size_t step = 0; step < 3; ++step) {
            EXPECT_LE(errors[step], step == 0 ? 0.001 : 0.003);
            // The lid's goal is turned with the block, by 5 degrees at most.
            EXPECT_NEAR(std::stod(steps.at(3 * i + step, "position_error_m")), errors[step], step == 2 ? 9e-4 : 1e-9);
            EXPECT_EQ(steps.at(3 * i + step, "done"), "1");
        }
        EXPECT_LT(std::stod(steps.at(3 * i + 1, "done_s")), std::stod(steps.at(3 * i + 2, "done_s")));
        const Ended replayed = program({"replay", "study.db", "--attempt", std::to_string(attempt.attempt_id)});
        EXPECT_EQ(replayed.exit_code, 0) << replayed.out;
        EXPECT_NE(replayed.out.find("every recorded bit and every measure the same"), std::string::npos)
            << replayed.out;
    }
}

/// Way of a part's origin while it is in the hand, from where it starts, by the samples alone.
double wayOf(const std::vector<TickRecord>& records, int part, Vec3 p) {
    double way = 0.0;
    for (const TickRecord& r : records) {
        if (r.held != part) continue;
        const Vec3 now(r.proxy_position_m[0], r.proxy_position_m[1], r.proxy_position_m[2]);
        way += (now - p).norm();
        p = now;
    }
    return way;
}

TEST_F(AssemblyStudy, ComparesTheWayOfEachPartWithAFreePath) {
    // Truth: the ways by the samples alone, over the numbers that the study writes: 150 mm and 60 mm, the lid has none.
    std::string text = studyOfThePage();
    for (const auto& [part, path] : {std::pair("pin", "150"), std::pair("block", "60")}) {
        const std::string key = std::string("part = \"") + part + "\"\n";
        text.replace(text.find(key), key.size(), key + "path_mm = " + path + "\n");
    }
    run(text);
    auto reader = store::StoreReader::open(folder_ / "study.db");
    ASSERT_TRUE(reader);
    const auto attempts = reader->attempts();
    ASSERT_TRUE(attempts);
    const fake::CsvFile steps = table("assembly_steps.csv"), trials = table("trials.csv");
    ASSERT_EQ(attempts->size(), 2u);
    ASSERT_EQ(steps.rows.size(), 6u);
    for (std::size_t i = 0; i < 2; ++i) {
        const auto records = reader->records((*attempts)[i].attempt_id);
        ASSERT_TRUE(records);
        const double pin = wayOf(*records, 1, Vec3(0.060, 0.040, 0)),
                     block = wayOf(*records, 2, Vec3(-0.06, 0.03, 0.01));
        EXPECT_NEAR(std::stod(steps.at(3 * i, "path_ratio")), pin / 0.150, 1e-6);
        EXPECT_NEAR(std::stod(steps.at(3 * i + 1, "path_ratio")), block / 0.060, 1e-6);
        EXPECT_EQ(steps.at(3 * i + 1, "free_path_m"), "0.06");
        EXPECT_EQ(steps.at(3 * i + 2, "path_ratio"), "NA");
        EXPECT_EQ(steps.at(3 * i + 2, "free_path_m"), "NA");
        EXPECT_NEAR(std::stod(trials.at(i, "path_ratio")), (pin + block) / 0.210, 1e-6);
        const Ended replayed = program({"replay", "study.db", "--attempt", std::to_string((*attempts)[i].attempt_id)});
        EXPECT_EQ(replayed.exit_code, 0) << replayed.out;
    }
}

TEST_F(AssemblyStudy, TellsOfEachHintWhenItCameUpAndCountsThem) {
    // Truth: by hand from events.csv alone: a hint comes up 0.4 s after the trial began or a step was done, unless the
    // next one is done before; first to the pin, then to the block, which the lid waits for, then to the lid.
    std::string text = studyOfThePage();
    const std::string task = "type = \"assembly\"\n";
    text.replace(text.find(task), task.size(), task + "hint_after_s = 0.4\nhints = false\n");
    run(text);
    const fake::CsvFile events = table("events.csv"), steps = table("assembly_steps.csv"), trials = table("trials.csv");
    ASSERT_EQ(trials.rows.size(), 2u);
    std::map<std::string, std::vector<std::string>> told;  // by trial: names of steps that hints led to
    double since = 0.0;
    bool shown = false;
    for (std::size_t i = 0; i < events.rows.size(); ++i) {
        const std::string event = events.at(i, "event"), payload = events.at(i, "payload_json");
        const double now = std::stod(events.at(i, "t_s"));
        if (event == "trial_started" || payload.find("locked") != std::string::npos) {
            if (event != "trial_started") {
                EXPECT_EQ(shown, now - since >= 0.4 - 1e-9) << now;
            }
            since = now;
            shown = false;
        }
        if (event != "hint_shown") continue;
        EXPECT_NEAR(now - since, 0.4, 1e-9);
        EXPECT_FALSE(shown);
        shown = true;
        told[events.at(i, "trial_index")].push_back(payload);
    }
    ASSERT_EQ(told.size(), 2u);
    std::size_t trial = 0;
    for (const auto& [index, payloads] : told) {
        std::map<std::string, int> count;
        for (const std::string& payload : payloads) ++count[payload];
        for (std::size_t step = 0; step < 3; ++step)
            EXPECT_EQ(std::stoi(steps.at(3 * trial + step, "hints")),
                      count["{\"step\":\"" + steps.at(3 * trial + step, "step_name") + "\"}"]);
        EXPECT_EQ(std::stod(trials.at(trial, "hints")), static_cast<double>(payloads.size()));
        EXPECT_NE(payloads[0].find("pin"), std::string::npos);
        ++trial;
    }
    EXPECT_EQ(program({"replay", "study.db", "--attempt", "1"}).exit_code, 0);
    const Ended explained = program({"explain", "study.toml"});
    EXPECT_NE(explained.out.find("after 0.4 s without a step done"), std::string::npos) << explained.out;
}

TEST_F(AssemblyStudy, ThatCannotBeDoneIsNotDone) {
    // Truth: closed form: a pin of 10 mm does not go into a bore of 9.9 mm.
    std::string text = studyOfThePage();
    const std::string bore = "bore_diameter = 10.4", symmetric = "timeout_s = 120";
    text.replace(text.find(bore), bore.size(), "bore_diameter = 9.9");
    text.replace(text.find(symmetric), symmetric.size(), "timeout_s = 40");
    writeText(folder_ / "study.toml", text);
    const Ended checked = program({"check", "study.toml"});
    if (checked.exit_code != 0) {
        EXPECT_NE(checked.err.find("task.step.position"), std::string::npos) << checked.err;
        return;
    }
    run(text);
    const fake::CsvFile trials = table("trials.csv");
    for (std::size_t i = 0; i < trials.rows.size(); ++i) {
        EXPECT_EQ(trials.at(i, "outcome"), "timeout");
        EXPECT_LT(std::stoi(trials.at(i, "steps_done")), 3);
    }
}

TEST_F(AssemblyStudy, TheShippedGearboxIsPutTogetherByTwoHands) {
    // Truth: the rule of success, and exact geometry: nothing that was shown overlaps. One participant of the shipped
    // study.
    run(readText(PASSUNG_SOURCE_DIR "/protocols/gearbox_assembly/study.toml"));
    const fake::CsvFile trials = table("trials.csv");
    ASSERT_GE(trials.rows.size(), 4u);
    for (std::size_t i = 0; i < trials.rows.size(); ++i) EXPECT_EQ(trials.at(i, "outcome"), "success");
    const fake::CsvFile overlaps = table("exact_overlap.csv");
    EXPECT_GT(overlaps.rows.size(), 100u);
    for (std::size_t i = 0; i < overlaps.rows.size(); ++i)
        EXPECT_LE(std::stod(overlaps.at(i, "overlap_m")), 1e-5) << overlaps.at(i, "tick");
    bool other_hand = false;
    const fake::CsvFile steps = table("assembly_steps.csv");
    ASSERT_EQ(steps.rows.size(), 12 * trials.rows.size());
    for (std::size_t i = 0; i < steps.rows.size(); ++i) {
        other_hand = other_hand || std::stoi(steps.at(i, "hands")) > 1;
        // What either hand felt at a step it felt in the trial.
        EXPECT_LE(std::stod(steps.at(i, "peak_force_N")), std::stod(trials.at(i / 12, "peak_force_N"))) << i;
    }
    EXPECT_TRUE(other_hand);
    EXPECT_EQ(program({"replay", "study.db", "--attempt", "1"}).exit_code, 0);
}

TEST_F(AssemblyStudy, OfWhichARecordedPartIsFalsifiedDoesNotReplay) {
    // Truth: a planted fault: one byte of the stream that tells which part is held.
    run(studyOfThePage());
    auto reader = store::StoreReader::open(folder_ / "study.db");
    ASSERT_TRUE(reader);
    auto records = reader->records(1);
    ASSERT_TRUE(records);
    const bool told = std::any_of(records->begin(), records->end(), [](const auto& r) { return r.held >= 0; });
    EXPECT_TRUE(told);
    store::Database(folder_ / "study.db", store::OpenMode::ReadWrite)
        .execute(
            "UPDATE sample_chunk SET data = CAST(substr(data, 1, 20) || x'5A' || substr(data, 22) AS BLOB) WHERE "
            "stream_id=(SELECT stream_id FROM stream WHERE stream='bodies')");
    EXPECT_EQ(program({"verify", "study.db"}).exit_code, 1);
    EXPECT_EQ(program({"replay", "study.db", "--attempt", "1"}).exit_code, 1);
}

}  // namespace
}  // namespace passung::test
