#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "study/protocol/protocol_reader.h"
#include "study/run/files/known_names.h"
#include "study/session/participant_order.h"
#include "study/store/read/store_reader.h"
#include "tests/ui/cli/program.h"

namespace passung::test {
namespace {

const std::string kStudy = std::string(PASSUNG_SOURCE_DIR) + "/protocols/rendering_methods/study.toml";

plan::StudyPlan shippedPlan() {
    auto plan = protocol::readProtocol(kStudy, run::presetDevices(), run::knownMeasures());
    EXPECT_TRUE(plan);
    return plan ? *plan : plan::StudyPlan{};
}

TEST(RenderingMethods, EveryConditionFollowsEveryOtherThreeTimesInEachExercise) {
    // Truth: closed form: three Williams squares of order 8: 24 people, each of the 8 · 7 successions three times, each
    // condition in each of the 8 positions three times.
    const plan::StudyPlan plan = shippedPlan();
    ASSERT_EQ(plan.participants, 24);
    using Pair = std::pair<std::size_t, std::size_t>;
    std::map<std::string, std::map<Pair, int>> successions, positions;
    for (const auto& place : session::firstPlaces(plan, 24)) {
        const auto trials = session::planTrials(plan, place, "", 1);
        ASSERT_TRUE(trials);
        for (std::size_t i = 0; i < trials->size(); ++i) {
            const design::PlannedTrial& trial = (*trials)[i];
            if (trial.phase != "main") continue;
            ++positions[trial.block][{trial.condition, static_cast<std::size_t>(trial.trial_in_block)}];
            if (trial.trial_in_block > 0) ++successions[trial.block][{(*trials)[i - 1].condition, trial.condition}];
        }
    }
    ASSERT_EQ(successions.size(), 3u) << "three exercises";
    for (const auto& [block, counts] : successions) {
        EXPECT_EQ(counts.size(), 56u) << block;
        for (const auto& [pair, count] : counts) EXPECT_EQ(count, 3) << block << pair.first << " " << pair.second;
        EXPECT_EQ(positions[block].size(), 64u);
        for (const auto& [pair, count] : positions[block]) EXPECT_EQ(count, 3) << block;
    }
}

TEST(RenderingMethods, StiffnessIsThatOfEachDevice) {
    // Truth: closed form: max is what the device displays stably, half is half of it, translation and rotation.
    const plan::StudyPlan plan = shippedPlan();
    std::set<std::string> devices;
    for (const plan::Condition& condition : plan.conditions) {
        const auto device = std::find_if(plan.stable_stiffness.begin(), plan.stable_stiffness.end(),
                                         [&](const auto& stable) { return stable.device == condition.device; });
        ASSERT_NE(device, plan.stable_stiffness.end());
        const double share = condition.name.find("/half") == std::string::npos ? 1.0 : 0.5;
        EXPECT_DOUBLE_EQ(condition.scene.contact.stiffness, share * device->linear) << condition.name;
        EXPECT_DOUBLE_EQ(condition.scene.contact.rotational_stiffness, share * device->rotational) << condition.name;
        devices.insert(condition.device);
    }
    EXPECT_EQ(devices, (std::set<std::string>{"hug", "sigma7"}));
}

/// The study on coarse fields, with time-outs that keep a trial short.
std::string reducedStudy() {
    std::string text = readText(kStudy);
    const auto replace = [&](const std::string& what, const std::string& by) {
        ASSERT_NE(text.find(what), std::string::npos) << what;
        text.replace(text.find(what), what.size(), by);
    };
    replace("cell_mm = 0.5 ", "cell_mm = 2.0 ");
    replace("spacing_mm = 1.0", "spacing_mm = 4.0");
    replace("timeout_s = 90", "timeout_s = 6");
    replace("position_tolerance_mm = 3", "position_tolerance_mm = 6");
    for (std::size_t at = text.find("../questionnaires"); at != std::string::npos; at = text.find("../questionnaires"))
        text.replace(at, 17, std::string(PASSUNG_SOURCE_DIR) + "/protocols/questionnaires");
    return text;
}

TEST(RenderingMethods, RunsToItsTablesAndSaysWhenDevicesAreSwapped) {
    // Truth: invariant: every planned trial has a row, on the device of its condition; between two trials on different
    // devices the swap is in the log, and nowhere else; a trial has columns of its own type only; replay gives the
    // bits.
    const TempFolder folder;
    writeText(folder / "study.toml", reducedStudy());
    const Ended run = runProgram(folder.path(), {"run", "study.toml", "--simulated", "1", "--db", "study.db"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto reader = store::StoreReader::open(folder / "study.db");
    ASSERT_TRUE(reader);
    const auto attempts = reader->attempts();
    const auto events = reader->events();
    ASSERT_TRUE(attempts && events);
    ASSERT_EQ(attempts->size(), 26u);
    int changes = 0, finished = 0;
    for (std::size_t i = 0; i < attempts->size(); ++i) {
        const store::AttemptRow& attempt = (*attempts)[i];
        SCOPED_TRACE(attempt.condition);
        EXPECT_TRUE(attempt.valid) << attempt.invalid_reason.value_or("");
        EXPECT_NE(attempt.condition.find("/" + attempt.device + "/"), std::string::npos);
        EXPECT_EQ(attempt.measures.count("contour_progress"), attempt.block == "line" ? 1u : 0u);
        EXPECT_EQ(attempt.measures.count("insertion_depth_m"), attempt.block == "line" ? 0u : 1u);
        changes += i > 0 && attempt.device != (*attempts)[i - 1].device ? 1 : 0;
        finished += attempt.outcome == "success" ? 1 : 0;
    }
    EXPECT_GT(finished, 0);
    const auto count = [&](const char* name) {
        return std::count_if(events->begin(), events->end(), [&](const auto& event) { return event.event == name; });
    };
    EXPECT_EQ(count("swap_device"), changes);
    EXPECT_EQ(count("device_swapped"), changes);
    ASSERT_EQ(runProgram(folder.path(), {"export", "study.db", "--out", "tables", "--no-samples"}).exit_code, 0);
    const auto lines = linesOf(readText(folder / "tables/trials.csv"));
    EXPECT_EQ(lines.size(), 27u);
    for (const char* column : {",insertion_depth_m,", ",contour_progress,"})
        EXPECT_NE(lines.front().find(column), std::string::npos) << column;
    for (const std::size_t i : {2u, 25u}) {
        const auto attempt = std::to_string((*attempts)[i].attempt_id);
        const Ended replay = runProgram(folder.path(), {"replay", "study.db", "--attempt", attempt});
        EXPECT_EQ(replay.exit_code, 0) << replay.out << replay.err;
    }
}

}  // namespace
}  // namespace passung::test
