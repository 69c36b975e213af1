#include "study/protocol/block_conditions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "study/design/trial_order.h"
#include "study/protocol/condition_table.h"
#include "study/protocol/protocol_reader.h"
#include "tests/study/protocol/fake_devices.h"
#include "tests/support/temp_folder.h"

namespace passung::protocol {
namespace {

const std::vector<std::string> kMeasures{"time_s", "peak_force_N", "correct", "answer"};

const std::string kStudy = R"(passung = 1
[study]
name = "demo"
version = "2"
seed = 42
participants = 6
[scene]
part = [
  { name = "plate", shape = { kind = "bore_plate", width = 60, depth = 60, height = 30, bore_diameter = 21, bore_depth = 25 } },
  { name = "peg", held = true, shape = { kind = "peg", diameter = 20, length = 50 }, pose = { position = [0, 0, 30] } },
]
[scene.device]
preset = "arm"
[scene.start_gate]
position_tolerance_mm = 3
angle_tolerance_deg = 5
hold_ms = 200
[task]
type = "peg_in_hole"
target = "plate"
insertion_depth_mm = 15
[[factor]]
name = "method"
key = "contact.method"
levels = ["penalty", "god_object_heuristic"]
[[factor]]
name = "depth"
key = "task.insertion_depth_mm"
levels = [10, 15, 20]
[[block]]
name = "main"
)";

/// Pairs of contacts that differ in stiffness: a trial type, and a scene, of the block's own.
const std::string kPairs = R"([[staircase]]
name = "stiffness"
block = "threshold"
key = "task.comparison.contact.stiffness_N_per_m"
levels = [500, 1000, 1500, 2000]
rule = "1_up_2_down"
step_down = 500
max_trials = 20
max_reversals = 8
tracks = [{ name = "one", start = 2000 }]
measure = "correct"
above = 0.5
)";

std::string thresholdBlock(const std::string& more) {
    return "[[block]]\nname = \"threshold\"\n" + more +
           "set = { \"task.type\" = \"discrimination_pair\", \"task.interval_s\" = 2, \"task.question\" = "
           "\"Stiffer?\", "
           "\"contact.stiffness_N_per_m\" = 400 }\n";
}

Result<plan::StudyPlan> read(const std::string& text, const std::string& path = "p.toml") {
    static const auto devices = fakeDevices();
    return readProtocolText(text, path, devices, kMeasures);
}

std::string errorsOf(const std::string& text) {
    const auto plan = read(text);
    std::string lines;
    if (plan) return lines;
    for (const auto& error : plan.errors()) lines += toString(error) + "\n";
    return lines;
}

std::vector<std::string> namesOf(const plan::StudyPlan& plan, const std::string& block) {
    std::vector<std::string> names;
    const auto trials = design::planSession(plan::designOf(plan), {plan.name, plan.seed, "P001", 0, 0, 1});
    for (const auto& trial : *trials)
        if (trial.block == block) names.push_back(plan.conditions[trial.condition].name);
    return names;
}

TEST(BlockConditions, AreChosenByNameOrByLevelsInTheirOrder) {
    // Truth: closed form: the conditions of three items written out by hand.
    const auto plan = read(kStudy +
                           "[[block]]\nname = \"some\"\norder = \"listed\"\n"
                           "conditions = [\"god_object_heuristic/15\", { depth = 10 }, { method = \"penalty\", depth = "
                           "\"20\" }]\n");
    ASSERT_TRUE(plan) << toString(plan.errors().front());
    EXPECT_EQ(namesOf(*plan, "some"), (std::vector<std::string>{"god_object_heuristic/15", "penalty/10",
                                                                "god_object_heuristic/10", "penalty/20"}));
    EXPECT_EQ(namesOf(*plan, "main").size(), 6u);
}

TEST(BlockConditions, OfABlockWithASetAreItsOwn) {
    // Truth: closed form: two of six; the study has no others of that block.
    const auto plan =
        read(kStudy + "[[block]]\nname = \"short\"\nconditions = [{ depth = 20 }]\nset = { \"task.timeout_s\" = 7 }\n");
    ASSERT_TRUE(plan) << toString(plan.errors().front());
    EXPECT_EQ(plan->conditions.size(), 8u);
    auto names = namesOf(*plan, "short");
    std::sort(names.begin(), names.end());
    EXPECT_EQ(names, (std::vector<std::string>{"god_object_heuristic/20@short", "penalty/20@short"}));
}

TEST(BlockConditions, MistakesAreToldByPlaceAndBlock) {
    // Truth: closed form: line 34 of the text is the block's third; the words are a regression.
    const auto errors = [](const std::string& conditions) {
        return errorsOf(kStudy + "[[block]]\nname = \"some\"\nconditions = " + conditions + "\n");
    };
    EXPECT_EQ(
        errors("[\"penalty/11\"]"),
        "p.toml:34:15: error: block.some.conditions: \"penalty/11\": the study has no condition of this name; did "
        "you mean \"penalty/10\"?\n");
    EXPECT_EQ(
        errors("[{ method = \"penalti\" }]"),
        "p.toml:34:26: error: block.some.conditions.method: \"penalti\": unknown level; did you mean \"penalty\"?\n");
    EXPECT_EQ(errors("[\"penalty/10\", { depth = 10 }]"),
              "p.toml:34:29: error: block.some.conditions: {...}: condition penalty/10 is listed twice\n");
    EXPECT_NE(errors("[]").find("names no condition"), std::string::npos);
    EXPECT_NE(errors("[3]").find("must be a condition's name, or a table of levels"), std::string::npos);
}

TEST(BlockConditions, AStaircaseStandsInAStudyAtOneReferenceWithoutDummyKeys) {
    // Truth: closed form: one track of 20 trials at one condition, not at six; no order, no comparison and none of the
    // keys of pegs in holes have to be written for it or taken away.
    const auto plan = read(kStudy + thresholdBlock("conditions = [\"penalty/15\"]\n") + kPairs);
    ASSERT_TRUE(plan) << toString(plan.errors().front());
    const auto names = namesOf(*plan, "threshold");
    EXPECT_EQ(names, std::vector<std::string>(20, "penalty/15@threshold"));
    ASSERT_EQ(plan->staircases.size(), 1u);
    EXPECT_EQ(plan->staircases[0].first_variant.size(), 1u);
    EXPECT_EQ(plan->conditions.size(), 6u + 1u + 4u);
    const auto& variant = plan->conditions[plan::variantOf(*plan, plan->staircases[0], 6, 2)];
    EXPECT_EQ(variant.name, "penalty/15@threshold@stiffness=1500");
    EXPECT_EQ(variant.comparison->contact.stiffness, 1500.0);
}

TEST(BlockConditions, WhatIsWrongInABlocksTrialsNamesTheBlock) {
    // Truth: closed form: the question is missing in that block only.
    std::string block = thresholdBlock("conditions = [\"penalty/15\"]\n");
    const std::string question = "\"task.question\" = \"Stiffer?\", ";
    block.erase(block.find(question), question.size());
    const std::string errors = errorsOf(kStudy + block + kPairs);
    EXPECT_NE(errors.find("; in the trials of block threshold"), std::string::npos) << errors;
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
}

TEST(ConditionTable, RowsOfACsvAreTheListAndPartOfTheText) {
    // Truth: closed form: rows out of order, a quoted label, a byte order mark, lines as Windows writes them.
    const test::TempFolder folder;
    std::ofstream(folder / "rows.csv", std::ios::binary)
        << "\xEF\xBB\xBFmethod, depth\r\n\"god_object_heuristic\",20\r\npenalty,10\r\n\r\n";
    const std::string path = folder / "p.toml";
    const auto plan =
        read(kStudy + "[[block]]\nname = \"some\"\norder = \"listed\"\nconditions = \"rows.csv\"\n", path);
    ASSERT_TRUE(plan) << toString(plan.errors().front());
    EXPECT_EQ(namesOf(*plan, "some"), (std::vector<std::string>{"god_object_heuristic/20", "penalty/10"}));
    // The stored text needs the table no more.
    const auto again = read(plan->source_text);
    ASSERT_TRUE(again);
    EXPECT_EQ(namesOf(*again, "some"), namesOf(*plan, "some"));
    EXPECT_EQ(again->source_text, plan->source_text);
}

TEST(ConditionTable, MistakesAreToldByTheTablesLine) {
    // Truth: closed form
    const test::TempFolder folder;
    const auto first = [&](const std::string& csv) {
        std::ofstream(folder / "rows.csv", std::ios::binary) << csv;
        const auto plan = read(kStudy + "[[block]]\nname = \"some\"\nconditions = \"rows.csv\"\n", folder / "p.toml");
        return plan ? std::string() : toString(plan.errors().front()).substr(folder.path().string().size() + 1);
    };
    EXPECT_EQ(first("method,depth\npenalty\n"), "rows.csv:2:1: error: conditions: has 1 cells, the first row 2");
    EXPECT_NE(first("method,depth\npenalty,10\npenalty,11\n").find("rows.csv:3:"), std::string::npos);
    EXPECT_NE(first("metod\npenalty\n").find("rows.csv:2:"), std::string::npos);
    EXPECT_NE(first("method\n\"penalty\n").find("a quoted cell does not end"), std::string::npos);
    EXPECT_NE(first("").find("is empty"), std::string::npos);
    EXPECT_NE(first("method\n").find("has no row of levels"), std::string::npos);
}

}  // namespace
}  // namespace passung::protocol
