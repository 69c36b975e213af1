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

/// A pin into a bore, a block onto a plate, a lid onto the block; 1 mm of tolerance for the pin, 3 mm for the others.
const std::string kStudy = R"(passung = 1

[study]
name = "three_parts"
version = "1"
seed = 1
participants = 2

[scene]
unit = "mm"

[[scene.part]]
name = "base"
shape = { kind = "bore_plate", width = 80, depth = 60, height = 20, bore_diameter = 10.4, bore_depth = 15, chamfer = 0.5 }

[[scene.part]]
name = "pin"
pickable = true
shape = { kind = "peg", diameter = 10, length = 40, chamfer = 0.5 }
pose = { position = [60, 40, 0] }

[[scene.part]]
name = "block"
pickable = true
shape = { kind = "box", width = 20, depth = 20, height = 10 }
pose = { position = [-60, 30, 10] }

[[scene.part]]
name = "lid"
pickable = true
shape = { kind = "box", width = 30, depth = 10, height = 8 }
pose = { position = [-60, -30, 10] }

[scene.contact]
method = "god_object"

[scene.device]
preset = "sigma7"

[scene.start_gate]
pose = { position = [0, 0, 60] }
position_tolerance_mm = 5
angle_tolerance_deg = 10
hold_ms = 200

[scene.effects.pick]
reach_mm = 5

[task]
type = "assembly"
timeout_s = 120

[[task.step]]
part = "pin"
into = "base"
position = [0, 0, -14.5]
insertion_mm = 14.5
symmetry = 0

[[task.step]]
part = "block"
position = [-25, 15, 5.5]
position_tolerance_mm = 3

[[task.step]]
part = "lid"
into = "block"
position = [0, 0, 9.5]
position_tolerance_mm = 3
after = ["block"]

[[factor]]
name = "stiffness"
key = "contact.stiffness_N_per_m"
levels = ["0.5 max", "max"]

[[block]]
name = "main"
order = "williams"
)";

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
    // Truth: where parts were left, from the recorded poses alone, against the goals of the text above; the tables say
    // the same. All bits again from the recorded inputs.
    run(kStudy);
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

TEST_F(AssemblyStudy, ThatCannotBeDoneIsNotDone) {
    // Truth: closed form: a pin of 10 mm does not go into a bore of 9.9 mm.
    std::string text = kStudy;
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

TEST_F(AssemblyStudy, OfWhichARecordedPartIsFalsifiedDoesNotReplay) {
    // Truth: a planted fault: one byte of the stream that tells which part is held.
    run(kStudy);
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
