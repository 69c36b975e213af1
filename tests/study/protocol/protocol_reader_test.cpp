#include "study/protocol/protocol_reader.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/study/protocol/fake_devices.h"

namespace passung::protocol {
namespace {

const std::vector<std::string> kMeasures{"completion_time_s", "peak_force_N"};

const std::string kHead = R"(passung = 1
[study]
name = "demo"
version = "2"
seed = 42
participants = 4
)";
const std::string kScene = R"([[scene.part]]
name = "plate"
shape = { kind = "bore_plate", width = 60, depth = 60, height = 30, bore_diameter = 21, bore_depth = 25 }
[[scene.part]]
name = "peg"
held = true
shape = { kind = "peg", diameter = 20, length = 50 }
[scene.device]
preset = "arm"
)";
const std::string kTask = R"([task]
type = "peg_in_hole"
target = "plate"
)";
const std::string kFactors = R"([[factor]]
name = "method"
key = "contact.method"
levels = ["penalty", "god_object_heuristic"]
[[factor]]
name = "stiffness"
unit = "N/m"
key = "contact.stiffness_N_per_m"
levels = [1000, { label = "stiff", value = "max" }]
)";
const std::string kBlock = "[[block]]\nname = \"main\"\n";

Result<StudyPlan> read(const std::string& text) {
    static const auto devices = fakeDevices();
    return readProtocolText(text, "p.toml", devices, kMeasures);
}

std::string errorsOf(const std::string& text) {
    const auto plan = read(text);
    std::string lines;
    if (plan) return lines;
    for (const auto& error : plan.errors()) {
        if (!lines.empty()) lines += '\n';
        lines += toString(error);
    }
    return lines;
}

TEST(ProtocolReader, CrossesFactorsWithTheFirstVaryingSlowest) {
    // Truth: closed form: 2 x 2 levels written out by hand; "max" of the fake device is 4000 N/m and 8 N·m/rad.
    const std::string text = kHead + kScene + kTask + kFactors + kBlock;
    const auto plan = read(text);
    ASSERT_TRUE(plan) << errorsOf(text);
    ASSERT_EQ(plan->conditions.size(), 4u);
    const std::vector<std::string> names{"penalty/1000", "penalty/stiff", "god_object_heuristic/1000",
                                         "god_object_heuristic/stiff"};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& condition = plan->conditions[i];
        EXPECT_EQ(condition.name, names[i]);
        EXPECT_EQ(condition.levels, (std::vector<std::size_t>{i / 2, i % 2}));
        EXPECT_EQ(condition.scene.contact.method,
                  i < 2 ? model::ContactMethod::Penalty : model::ContactMethod::GodObjectHeuristic);
        EXPECT_EQ(condition.scene.contact.stiffness, i % 2 == 0 ? 1000.0 : 4000.0);
        EXPECT_EQ(condition.scene.contact.rotational_stiffness, i % 2 == 0 ? 2.0 : 8.0);
        EXPECT_EQ(condition.device, "arm");
    }
    EXPECT_EQ(plan->conditions[1].levels_json, R"({"method":"penalty","stiffness":"stiff"})");
    EXPECT_EQ(plan->factors[1].unit, "N/m");
    EXPECT_EQ(plan->measures, kMeasures);
    EXPECT_EQ(plan->title, "demo");
    EXPECT_EQ(plan->seed, 42u);
    EXPECT_EQ(plan->source_text, text);
    EXPECT_TRUE(plan->warnings.empty());
}

TEST(ProtocolReader, LetsAnyKeyBeALevel) {
    // Truth: closed form: values by hand; several keys at once by `set`, positions, device, task and feedback.
    const auto plan = read(kHead + kScene + kTask + R"([[factor]]
name = "place"
key = "part.plate.pose.position"
levels = [{ label = "middle", value = [0, 0, 0] }, { label = "side", value = [5, 0, 0] }]
[[factor]]
name = "setup"
levels = [
  { label = "a", set = { "device.preset" = "stick", "task.timeout_s" = 10, "start_gate.hold_ms" = 250 } },
  { label = "b", set = { "part.peg.shape.diameter" = 19, "feedback.shown_pose" = "device" } },
]
)" + kBlock);
    ASSERT_TRUE(plan);
    ASSERT_EQ(plan->conditions.size(), 4u);
    EXPECT_EQ(plan->conditions[2].scene.parts[0].X_WP.p, Vec3(0.005, 0, 0));
    EXPECT_EQ(plan->conditions[0].device, "stick");
    EXPECT_EQ(plan->conditions[0].scene.contact.stiffness, 1000.0);
    EXPECT_EQ(plan->conditions[0].task.timeout, 10.0);
    EXPECT_EQ(plan->conditions[0].scene.start_gate.hold_ticks, 250);
    EXPECT_EQ(plan->conditions[0].shown, ShownPose::Proxy);
    EXPECT_EQ(plan->conditions[1].device, "arm");
    EXPECT_EQ(plan->conditions[1].task.timeout, 30.0);
    EXPECT_EQ(std::get<model::Peg>(std::get<model::Shape>(plan->conditions[1].scene.parts[1].geometry)).diameter,
              0.019);
    EXPECT_EQ(plan->conditions[1].shown, ShownPose::Device);
}

TEST(ProtocolReader, ReportsAWrongLevelOnceAtItsOwnLine) {
    // Truth: closed form: the level stands in line 22, whatever number of conditions reads it.
    EXPECT_EQ(errorsOf(kHead + kScene + kTask + R"([[factor]]
name = "method"
key = "contact.method"
levels = ["penalty",
  "voodoo"]
[[factor]]
name = "tolerance"
key = "contact.tolerance_um"
levels = [10, 20, 40]
)" + kBlock),
              "p.toml:23:3: error: scene.contact.method: \"voodoo\": must be \"penalty\" or \"god_object_heuristic\"");
}

TEST(ProtocolReader, RefusesFactorsThatCannotBe) {
    // Truth: closed form: one mistake each; the factor begins in line 19.
    const auto with = [](const std::string& factor) {
        return errorsOf(kHead + kScene + kTask + "[[factor]]\n" + factor + kBlock);
    };
    EXPECT_EQ(with("name = \"Method\"\nkey = \"contact.method\"\nlevels = [\"penalty\", \"god_object_heuristic\"]\n"),
              "p.toml:20:8: error: factor.name: \"Method\": must be lower-case letters, digits and _, beginning with a "
              "letter");
    EXPECT_EQ(with("name = \"outcome\"\nkey = \"contact.spacing_mm\"\nlevels = [1, 2]\n"),
              "p.toml:20:8: error: factor.outcome.name: \"outcome\": is a column of every export; choose another name");
    EXPECT_EQ(with("name = \"m\"\nkey = \"contact.spacing_mm\"\nlevels = [1]\n"),
              "p.toml:22:10: error: factor.m.levels: [1]: needs at least two levels");
    EXPECT_EQ(with("name = \"m\"\nkey = \"contact.spacing_mm\"\nlevels = [1, { label = \"\", value = 2 }]\n"),
              "p.toml:22:24: error: factor.m.levels.label: \"\": must not be empty");
    EXPECT_EQ(with("name = \"m\"\nkey = \"contact.spacing_mm\"\nlevels = [1, { label = \"a/b\", value = 2 }]\n"),
              "p.toml:22:14: error: factor.m.levels: \"a/b\": a label must not be empty nor contain \"/\"");
    EXPECT_EQ(with("name = \"m\"\nlevels = [1, 2]\n"),
              "p.toml:21:11: error: factor.m.levels: 1: a value needs the factor's key; without a key use set\n"
              "p.toml:21:14: error: factor.m.levels: 2: a value needs the factor's key; without a key use set");
    EXPECT_EQ(with("name = \"m\"\nkey = \"contact.spacing\"\nlevels = [1, 2]\n"),
              "p.toml:21:7: error: scene.contact.spacing: unknown key; did you mean \"spacing_mm\"?");
    EXPECT_EQ(with("name = \"m\"\nkey = \"contact.spacing_mm\"\nlevels = [1, 2]\n[[factor]]\nname = \"n\"\nlevels = "
                   "[{ label = \"x\", set = { contact = {} } }, { label = \"y\", set = { \"unit\" = \"mm\" } }]\n"),
              "p.toml:25:34: error: factor.n: contact: is also changed by factor m");
    EXPECT_EQ(with("name = \"m\"\nkey = \"contact.spacing_mm\"\nlevels = [1, 2]\nkind = \"between\"\n"),
              "p.toml:23:8: error: factor.m.kind: \"between\": must be \"within\"");
}

TEST(ProtocolReader, RefusesATaskThatCannotBeDone) {
    // Truth: closed form: the bore is 25 mm deep, the held part cannot be inserted into itself.
    const auto with = [](const std::string& task) {
        return errorsOf(kHead + kScene + "[task]\ntype = \"peg_in_hole\"\n" + task + kFactors + kBlock);
    };
    EXPECT_EQ(with("target = \"plate\"\ninsertion_depth_mm = 26\n"),
              "p.toml:19:22: error: task.insertion_depth_mm: 26: the bore is only 25 mm deep");
    EXPECT_EQ(with("target = \"peg\"\n"), "p.toml:18:10: error: task.target: \"peg\": must not be the held part");
    EXPECT_EQ(with("target = \"plate\"\nengagement_depth_mm = 19\n"),
              "p.toml:19:23: error: task.engagement_depth_mm: 19: must be less than the depth of success, 19 mm");
    EXPECT_EQ(with("target = \"plate\"\nhold_s = 5\ntimeout_s = 5\n"),
              "p.toml:19:10: error: task.hold_s: 5: must be less than timeout_s");
}

TEST(ProtocolReader, NeedsADevice) {
    // Truth: closed form.
    auto scene = kScene;
    scene.resize(scene.find("[scene.device]"));
    EXPECT_EQ(errorsOf(kHead + scene + kTask + kBlock + "order = \"listed\"\n"),
              "p.toml:7:1: error: device.preset: required in a study");
}

TEST(ProtocolReader, ReadsBlocks) {
    // Truth: closed form: defaults as the key table says.
    const auto plan = read(kHead + kScene + kTask + kFactors +
                           "[[block]]\nname = \"warm_up\"\nphase = \"practice\"\norder = \"random\"\ntrials = 2\n" +
                           kBlock + "repetitions = 3\n");
    ASSERT_TRUE(plan);
    ASSERT_EQ(plan->blocks.size(), 2u);
    EXPECT_EQ(plan->blocks[0].phase, Phase::Practice);
    EXPECT_EQ(plan->blocks[0].order, BlockOrder::Random);
    EXPECT_EQ(plan->blocks[0].trials, 2);
    EXPECT_EQ(plan->blocks[0].repetitions, 1);
    EXPECT_EQ(plan->blocks[1].phase, Phase::Main);
    EXPECT_EQ(plan->blocks[1].order, BlockOrder::Williams);
    EXPECT_EQ(plan->blocks[1].trials, 0);
    EXPECT_EQ(plan->blocks[1].repetitions, 3);
    EXPECT_EQ(errorsOf(kHead + kScene + kTask + kFactors + kBlock + "trials = 5\n"),
              "p.toml:30:10: error: block.main.trials: 5: must be at most the number of conditions, 4");
}

TEST(ProtocolReader, WarnsOfUnbalancedNumbers) {
    // Truth: closed form: four conditions need multiples of four; order "listed" needs none.
    auto head = kHead;
    head.replace(head.find("participants = 4"), 16, "participants = 6");
    const auto plan = read(head + kScene + kTask + kFactors + kBlock);
    ASSERT_TRUE(plan);
    ASSERT_EQ(plan->warnings.size(), 1u);
    EXPECT_EQ(
        plan->warnings[0],
        "study.participants = 6 is not a multiple of the 4 rows of the Williams square: orders will not be balanced");
    const auto listed = read(head + kScene + kTask + kFactors + kBlock + "order = \"listed\"\n");
    ASSERT_TRUE(listed);
    EXPECT_TRUE(listed->warnings.empty());
}

TEST(ProtocolReader, ReadsASceneFromItsOwnFile) {
    // Truth: invariant: errors name the file that holds the mistake; levels those of the study.
    const auto folder = std::filesystem::path(testing::TempDir()) / "passung_protocol_reader";
    std::filesystem::create_directories(folder);
    std::string scene = kScene;
    for (std::size_t at; (at = scene.find("scene.")) != std::string::npos;) scene.erase(at, 6);
    std::ofstream(folder / "scene.toml") << scene;
    const std::string study = kHead + "[scene]\nfile = \"scene.toml\"\n" + kTask + kFactors + kBlock;
    std::ofstream(folder / "study.toml") << study;
    const auto devices = fakeDevices();
    const auto plan = readProtocol((folder / "study.toml").string(), devices, kMeasures);
    ASSERT_TRUE(plan) << toString(plan.errors()[0]);
    EXPECT_EQ(plan->conditions[3].scene.contact.stiffness, 4000.0);

    std::ofstream(folder / "scene.toml", std::ios::app) << "max_forc_N = 3\n";
    const auto wrong = readProtocol((folder / "study.toml").string(), devices, kMeasures);
    ASSERT_FALSE(wrong);
    ASSERT_EQ(wrong.errors().size(), 1u);
    EXPECT_EQ(toString(wrong.errors()[0]), (folder / "scene.toml").string() +
                                               ":10:1: error: device.max_forc_N: unknown key; did you mean "
                                               "\"max_force_N\"?");
    std::filesystem::remove_all(folder);
    EXPECT_EQ(
        errorsOf(kHead + "[scene]\nfile = \"none.toml\"\nunit = \"mm\"\n" + kTask + kBlock + "order = \"listed\"\n"),
        "p.toml:8:8: error: scene.file: \"none.toml\": cannot be opened\n"
        "p.toml:9:1: error: scene.unit: cannot stand beside scene.file");
}

TEST(ProtocolReader, DescribesEveryNumberInDeterministicJson) {
    // Truth: invariant: same text, same bytes; shortest decimals, so that 20.2 mm is 0.0202 m.
    const std::string text = kHead + kScene + kTask + kFactors + kBlock;
    const auto first = read(text), second = read(text);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->expanded_json, second->expanded_json);
    const auto& params = first->conditions[1].params_json;
    for (const std::string part : {R"("device":"arm")", R"("stiffness_N_per_m":4000,)", R"("bore_diameter_m":0.021,)",
                                   R"("timeout_s":30,)", R"("position_m":[0,0,0],"quaternion_wxyz":[1,0,0,0])"})
        EXPECT_NE(params.find(part), std::string::npos) << part << " in " << params;
    EXPECT_NE(first->expanded_json.find(params), std::string::npos);
}

TEST(ProtocolReader, TellsOfAFileThatCannotBeOpened) {
    // Truth: closed form.
    const auto plan = readProtocol("no/such/file.toml", {}, {});
    ASSERT_FALSE(plan);
    EXPECT_EQ(toString(plan.errors()[0]), "no/such/file.toml: error: cannot be opened");
    EXPECT_FALSE(readProtocol(testing::TempDir(), {}, {})) << "a folder is no file";
}

}  // namespace
}  // namespace passung::protocol
