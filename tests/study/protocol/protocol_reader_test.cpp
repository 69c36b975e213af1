#include "study/protocol/protocol_reader.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <span>

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
const std::string kScene = R"([scene]
part = [
  { name = "plate", shape = { kind = "bore_plate", width = 60, depth = 60, height = 30, bore_diameter = 21, bore_depth = 25 } },
  { name = "peg", held = true, shape = { kind = "peg", diameter = 20, length = 50 }, pose = { position = [0, 0, 30] } },
]

# The device is a table of its own, so that a test can leave it out.
[scene.device]
preset = "arm"
)";
const std::string kTask = R"([task]
type = "peg_in_hole"
target = "plate"
)";
// Points have a spacing on fields alone.
const std::string kOnFields = "[scene.contact]\ngeometry = \"field\"\n";
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

Result<plan::StudyPlan> read(const std::string& text, std::span<const std::string> measures = kMeasures) {
    static const auto devices = fakeDevices();
    return readProtocolText(text, "p.toml", devices, measures);
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
                  i < 2 ? scene::ContactMethod::Penalty : scene::ContactMethod::GodObjectHeuristic);
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
    EXPECT_EQ(plan->conditions[0].shown, plan::ShownPose::Proxy);
    EXPECT_EQ(plan->conditions[1].device, "arm");
    EXPECT_EQ(plan->conditions[1].task.timeout, 30.0);
    EXPECT_EQ(std::get<shape::Peg>(std::get<shape::Shape>(plan->conditions[1].scene.parts[1].geometry)).diameter,
              0.019);
    EXPECT_EQ(plan->conditions[1].shown, plan::ShownPose::Device);
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
              "p.toml:23:3: error: scene.contact.method: \"voodoo\": must be \"penalty\", \"god_object_heuristic\" or "
              "\"god_object\"");
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
    EXPECT_EQ(with("name = \"m\"\nkey = \"contact.spacing_mm\"\nlevels = [1, 2]\nkind = \"outside\"\n"),
              "p.toml:23:8: error: factor.m.kind: \"outside\": must be \"within\", \"between\" or \"nuisance\"");
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
    EXPECT_EQ(plan->blocks[0].phase, plan::Phase::Practice);
    EXPECT_EQ(plan->blocks[0].order, plan::BlockOrder::Random);
    EXPECT_EQ(plan->blocks[0].trials, 2);
    EXPECT_EQ(plan->blocks[0].repetitions, 1);
    EXPECT_EQ(plan->blocks[1].phase, plan::Phase::Main);
    EXPECT_EQ(plan->blocks[1].order, plan::BlockOrder::Williams);
    EXPECT_EQ(plan->blocks[1].trials, 0);
    EXPECT_EQ(plan->blocks[1].repetitions, 3);
    EXPECT_EQ(errorsOf(kHead + kScene + kTask + kFactors + kBlock + "trials = 5\n"),
              "p.toml:30:10: error: block.main.trials: 5: must be at most the number of conditions, 4");
}

TEST(ProtocolReader, UnderstandsALatinSquare) {
    // Truth: closed form: a Williams square is a Latin square, and the one that is offered.
    const std::string text = kHead + kScene + kTask + kFactors + kBlock;
    for (const char* word : {"williams", "latin_square"}) {
        const auto plan = read(text + "order = \"" + word + "\"\n");
        ASSERT_TRUE(plan) << word;
        EXPECT_EQ(plan->blocks[0].order, plan::BlockOrder::Williams) << word;
    }
    EXPECT_EQ(errorsOf(text + "order = \"latin\"\n").find("p.toml:"), 0u);
}

TEST(ProtocolReader, APegInHoleOfOtherPartsSaysItsPlayAndWhereTheMouthIs) {
    // Truth: the rules of KEYS.md; millimetres to metres, by hand.
    const auto mesh = std::filesystem::path(testing::TempDir()) / ("passung_peg_" + std::to_string(getpid()) + ".off");
    std::ofstream(mesh) << "OFF\n4 4 0\n0 0 0\n20 0 0\n0 20 0\n0 0 20\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    const auto scene = [&](const std::string& target) {
        return R"([scene]
part = [
  { name = "plate", shape = )" +
               target + R"( },
  { name = "peg", held = true, mesh = ")" +
               mesh.string() + R"(", pose = { position = [0, 0, 60] } },
]
[scene.device]
preset = "arm"
)";
    };
    const std::string bore =
        "{ kind = \"bore_plate\", width = 60, depth = 60, height = 30, bore_diameter = 41, bore_depth = 25 }";
    const std::string box =
        "{ kind = \"square_bore_plate\", width = 80, depth = 80, height = 30, pocket_width = 42, "
        "pocket_depth = 42, bore_depth = 25 }";
    const auto told = [&](const std::string& target, const std::string& keys) {
        return errorsOf(kHead + scene(target) + kTask + keys + kFactors + kBlock);
    };
    const auto has = [](const std::string& errors, const char* what) { return errors.find(what) != std::string::npos; };
    EXPECT_TRUE(has(told(bore, ""), "task.clearance_mm: required: only of a `peg` in a `bore_plate`"))
        << told(bore, "");
    EXPECT_TRUE(has(told(bore, "clearance_mm = 0.5\nmouth = { position = [0, 0, 1] }\n"), "task.mouth"));
    const auto plan =
        read(kHead + scene(box) + kTask + "clearance_mm = 0.5\nmouth = { position = [1, 2, 3] }\n" + kFactors + kBlock);
    std::filesystem::remove(mesh);
    ASSERT_TRUE(plan) << toString(plan.errors().front());
    const plan::Task& task = plan->conditions.front().task;
    const auto& peg = std::get<plan::PegInHoleTask>(task.form);
    EXPECT_DOUBLE_EQ(peg.clearance, 0.5e-3);
    EXPECT_LT((peg.X_TMouth.p - Vec3(0.001, 0.002, 0.003)).norm(), 1e-15);
    EXPECT_LT((plan::judgedFrame(task, {Quat::Identity(), Vec3(0, 0, 1)}).p - Vec3(0.001, 0.002, 1.003)).norm(), 1e-15);
}

TEST(ProtocolReader, WarnsOfPenaltiesThatNoStiffnessLimits) {
    // Truth: invariant: raw and area_weighted are allowed, but nobody holds them below the device's stable maximum.
    EXPECT_TRUE(read(kHead + kScene + kTask + kFactors + kBlock)->warnings.empty());
    const std::string method = "[scene.contact]\nmethod = \"penalty\"\nvariant = ";
    for (const std::string variant : {"raw", "area_weighted"}) {
        const auto plan =
            read(kHead + kScene + method + '"' + variant + "\"\n" + kTask + kBlock + "order = \"listed\"\n");
        ASSERT_TRUE(plan);
        ASSERT_EQ(plan->warnings.size(), 1u);
        EXPECT_TRUE(plan->warnings[0].starts_with("contact.variant = \"" + variant + "\"")) << plan->warnings[0];
        EXPECT_TRUE(plan->warnings[0].ends_with("conditions: single")) << plan->warnings[0];
    }
    const auto coupled = read(kHead + kScene + method + "\"raw\"\ncoupling = \"quasi_static\"\n" + kTask + kBlock +
                              "order = \"listed\"\n");
    ASSERT_TRUE(coupled);
    EXPECT_TRUE(coupled->warnings.empty()) << "the coupling's stiffness is the most that is felt";
    const auto god =
        read(kHead + kScene + "[scene.contact]\nvariant = \"raw\"\n" + kTask + kBlock + "order = \"listed\"\n");
    ASSERT_TRUE(god);
    EXPECT_TRUE(god->warnings.empty()) << "the god object does not use the variant";
}

TEST(ProtocolReader, WarnsOfMainBlocksThatDoNotRepeatWhatDoesNotCount) {
    // Truth: invariant: a whole session needs an attempt that counts at every main trial, and at none of practice.
    const std::string text = kHead + kScene + kTask + kFactors + kBlock;
    EXPECT_EQ(read(text)->blocks[0].on_invalid, plan::Repeat::AtBlockEnd) << "unless the protocol says otherwise";
    const auto never = read(text + "on_invalid = \"never\"\n");
    ASSERT_TRUE(never);
    ASSERT_EQ(never->warnings.size(), 1u);
    EXPECT_TRUE(never->warnings[0].starts_with("block.on_invalid = \"never\"")) << never->warnings[0];
    EXPECT_TRUE(never->warnings[0].ends_with("block: main")) << never->warnings[0];
    const auto practice = read(text + "[[block]]\nname = \"warm_up\"\nphase = \"practice\"\non_invalid = \"never\"\n");
    ASSERT_TRUE(practice);
    EXPECT_TRUE(practice->warnings.empty());
}

TEST(ProtocolReader, WarnsOfMainBlocksThatRepeatTimeOutsWhileTimeIsMeasured) {
    // Truth: invariant: of a trial that is repeated only the last attempt counts, so that its time is no longer
    // censored.
    const std::string own = kHead + kScene + kTask + kFactors + kBlock;
    const std::string text = "measures = [\"time_s\"]\n" + own;
    const std::vector<std::string> timed = {"time_s", "search_time_s"};
    const auto warnings = [&](const std::string& more) { return read(text + more, timed)->warnings; };
    for (const char* repeated : {"on_timeout = \"repeat_at_block_end\"\n", "on_failure = \"repeat_now\"\n"}) {
        ASSERT_EQ(warnings(repeated).size(), 1u) << repeated;
        EXPECT_TRUE(warnings(repeated)[0].starts_with("block.on_timeout repeats trials")) << warnings(repeated)[0];
        EXPECT_TRUE(warnings(repeated)[0].ends_with("block: main")) << warnings(repeated)[0];
    }
    EXPECT_TRUE(warnings("on_failure = \"repeat_now\"\non_timeout = \"never\"\n").empty());
    EXPECT_TRUE(
        read("measures = [\"search_time_s\"]\n" + own + "on_timeout = \"repeat_now\"\n", timed)->warnings.empty())
        << "no such time is measured";
    EXPECT_TRUE(read(own + "on_timeout = \"repeat_now\"\n", timed)->warnings.empty()) << "all are, whoever needs them";
    const std::string analysis = "[[analysis]]\noutcome = \"time_s\"\nfactors = [\"method\"]\ntest = \"rm_anova\"\n";
    const auto outcome = read(own + "on_timeout = \"repeat_now\"\n" + analysis, timed);
    ASSERT_TRUE(outcome) << toString(outcome.errors().front());
    ASSERT_EQ(outcome->warnings.size(), 1u);
    EXPECT_TRUE(outcome->warnings[0].starts_with("block.on_timeout repeats trials")) << outcome->warnings[0];
    std::string pairs = text;
    pairs.replace(pairs.find(kTask), kTask.size(),
                  "[task]\ntype = \"discrimination_pair\"\ntarget = \"plate\"\nquestion = \"Which?\"\n"
                  "comparison = { \"contact.stiffness_N_per_m\" = 500 }\n"
                  "[scene.start_gate]\nposition_tolerance_mm = 3\nhold_ms = 200\n");
    const auto paired = read(pairs + "on_timeout = \"repeat_now\"\n", timed);
    ASSERT_TRUE(paired) << toString(paired.errors().front());
    EXPECT_TRUE(paired->warnings.empty()) << paired->warnings[0];
    EXPECT_TRUE(warnings("[[block]]\nname = \"warm_up\"\nphase = \"practice\"\non_timeout = \"repeat_now\"\n").empty());
}

TEST(ProtocolReader, CountsTheLettersOfNamesAndLabelsNotTheirBytes) {
    // Truth: closed form: 100 letters are allowed; each of these takes two bytes. What began with more goes on.
    for (const std::string letter : {"a", "\u00e4"})
        for (const int letters : {100, 101}) {
            std::string label;
            for (int i = 0; i < letters; ++i) label += letter;
            for (const bool version : {false, true}) {
                std::string text = kHead + kScene + kTask + kFactors + kBlock;
                const std::string from = version ? "version = \"2\"" : "\"stiff\"";
                ASSERT_NE(text.find(from), std::string::npos);
                text.replace(text.find(from), from.size(), (version ? "version = \"" : "\"") + label + "\"");
                const auto plan = read(text);
                EXPECT_EQ(static_cast<bool>(plan), letters == 100) << letter << version;
                if (!plan) {
                    EXPECT_NE(toString(plan.errors()[0]).find("at most 100 letters"), std::string::npos);
                }
                const auto begun = readBegunProtocol(text, "p.toml", fakeDevices(), kMeasures);
                EXPECT_TRUE(begun) << toString(begun.errors()[0]);
            }
        }
}

TEST(ProtocolReader, WarnsOfFrictionThatThePenaltyDoesNotRender) {
    // Truth: invariant: a key without effect is told, and only where it has none.
    std::string rough = kScene;
    for (std::size_t at = 0; (at = rough.find("name = ", at)) != std::string::npos; at += 20)
        rough.insert(at, "friction = 0.3, ");
    for (const std::string method : {"penalty", "god_object_heuristic"}) {
        const auto plan = read(kHead + rough + "[scene.contact]\nmethod = \"" + method + "\"\n" + kTask + kBlock +
                               "order = \"listed\"\n");
        ASSERT_TRUE(plan);
        EXPECT_EQ(plan->conditions[0].scene.parts[0].sliding_friction, 0.3);
        ASSERT_EQ(plan->warnings.size(), method == "penalty" ? 1u : 0u);
        for (const auto& warning : plan->warnings) EXPECT_NE(warning.find("no friction"), std::string::npos);
    }
}

TEST(ProtocolReader, WarnsOfFrictionThatOnlyOneSideHas) {
    // Truth: closed form: the geometric mean of any coefficient and 0 is 0.
    std::string rough = kScene;
    rough.insert(rough.find("name = "), "friction = 0.3, ");
    for (const std::string method : {"penalty", "god_object"}) {
        const auto plan = read(kHead + rough + "[scene.contact]\nmethod = \"" + method + "\"\n" + kTask + kBlock +
                               "order = \"listed\"\n");
        ASSERT_TRUE(plan);
        ASSERT_EQ(plan->warnings.size(), 1u);
        EXPECT_NE(plan->warnings[0].find("one side only"), std::string::npos);
    }
}

TEST(ProtocolReader, TakesTheShareOfCyclesThatMayBeMissed) {
    // Truth: closed form: the documented default, a value, and one out of range.
    const std::string text = kHead + kScene + kTask + kFactors + kBlock;
    EXPECT_EQ(read(text)->max_missed_share, 0.01);
    EXPECT_EQ(read(text + "[loop]\nmax_missed_share = 0.05\n")->max_missed_share, 0.05);
    EXPECT_EQ(errorsOf(text + "[loop]\nmax_missed_share = 1.5\n"),
              "p.toml:31:20: error: loop.max_missed_share: 1.5: must be from 0 to 1");
}

TEST(ProtocolReader, ListsTheMeshFilesThatItNames) {
    // Truth: closed form: names as the protocol writes them, paths from here, each file once.
    const auto folder = std::filesystem::path(testing::TempDir()) / ("passung_meshes_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder / "parts");
    std::ofstream(folder / "parts/b.off")
        << "OFF\n4 4 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    const std::string scene = R"([scene]
part = [
  { name = "plate", shape = { kind = "bore_plate", width = 60, depth = 60, height = 30, bore_diameter = 21, bore_depth = 25 } },
  { name = "wall", mesh = "parts/../parts/b.off", pose = { position = [90, 0, 0] } },
  { name = "peg", held = true, shape = { kind = "peg", diameter = 20, length = 50 }, pose = { position = [0, 0, 30] } },
]
[scene.device]
preset = "arm"
)";
    const auto plan = readProtocolText(kHead + scene + kTask + kFactors + kBlock, (folder / "p.toml").string(),
                                       fakeDevices(), kMeasures);
    ASSERT_TRUE(plan) << toString(plan.errors().front());
    ASSERT_EQ(plan->meshes.size(), 1u);
    EXPECT_EQ(plan->meshes[0].name, "parts/b.off");
    EXPECT_EQ(plan->meshes[0].path, (folder / "parts/b.off").string());
    std::filesystem::remove_all(folder);
}

TEST(ProtocolReader, HoldsItsSceneItself) {
    // Truth: closed form: a scene of another file would not be in the stored text; not by way of a factor either.
    const std::string rest = kTask + kBlock + "order = \"listed\"\n";
    EXPECT_EQ(errorsOf(kHead + "[scene]\nfile = \"scene.toml\"\n" + rest),
              "p.toml:8:1: error: scene.file: \"scene.toml\": a study holds its scene itself, so that the stored text "
              "is all of it");
    const auto lines =
        errorsOf(kHead + kScene + kTask +
                 "[[factor]]\nname = \"f\"\nkey = \"file\"\nlevels = [\"a.toml\", \"b.toml\"]\n" + kBlock);
    EXPECT_TRUE(lines.starts_with("p.toml:21:7: error: scene.file: unknown key")) << lines;
}

TEST(ProtocolReader, RefusesConditionsThatAreTheSame) {
    // Truth: closed form: 1 and 1.0 are one number, and a part's name is nothing that can be felt.
    const auto with = [](const std::string& factor) {
        return errorsOf(kHead + kScene + kTask + kFactors + "[[factor]]\n" + factor + kBlock + kOnFields);
    };
    EXPECT_EQ(with("name = \"s\"\nkey = \"contact.spacing_mm\"\nlevels = [1, { label = \"one\", value = 1.0 }]\n"),
              "p.toml:28:1: error: factor.s: conditions \"penalty/1000/1\" and \"penalty/1000/one\" are the same in "
              "everything but their labels");
    EXPECT_EQ(with("name = \"s\"\nkey = \"part.peg.name\"\nlevels = [\"peg\", \"pin\"]\n"),
              "p.toml:28:1: error: factor.s: conditions \"penalty/1000/peg\" and \"penalty/1000/pin\" are the same in "
              "everything but their labels");
    EXPECT_EQ(with("name = \"s\"\nkey = \"contact.spacing_mm\"\nlevels = [1, 2]\n"), "");
}

TEST(ProtocolReader, NeedsAMainBlock) {
    // Truth: closed form: the only block, in line 28, is practice.
    EXPECT_EQ(errorsOf(kHead + kScene + kTask + kFactors + kBlock + "phase = \"practice\"\n"),
              "p.toml:28:1: error: block: a study needs a block with phase = \"main\": analyses leave practice out");
}

TEST(ProtocolReader, RefusesNamesThatExportsCouldNotTellApart) {
    // Truth: closed form: columns of the exported tables, and their mark of a missing value.
    const auto with = [](const std::string& name, const std::string& level) {
        return errorsOf(kHead + kScene + kTask + "[[factor]]\nname = \"" + name +
                        "\"\nkey = \"contact.spacing_mm\"\nlevels = [1, { label = \"" + level + "\", value = 2 }]\n" +
                        kBlock + kOnFields);
    };
    for (const std::string name : {"n_trials", "n_success", "success_share", "dropped_samples", "n_ticks"})
        EXPECT_EQ(with(name, "x"), "p.toml:20:8: error: factor." + name + ".name: \"" + name +
                                       "\": is a column of every export; choose another name");
    EXPECT_EQ(with("m", "NA"), "p.toml:22:14: error: factor.m.levels: \"NA\": stands for a missing value in exports");
    EXPECT_EQ(with("m", "na"), "");
}

TEST(ProtocolReader, StartsTheClockBeforeTheHoleIsReached) {
    // Truth: closed form: from 30 mm above the mouth to 20 mm below it are 50 mm.
    const auto with = [](const std::string& radius) {
        return errorsOf(kHead + kScene + kTask + "leave_radius_mm = " + radius + "\n" + kFactors + kBlock);
    };
    EXPECT_EQ(with("51"),
              "p.toml:19:19: error: task.leave_radius_mm: 51: must be less than the way from the start to "
              "full depth, 50 mm");
    EXPECT_EQ(with("49"), "");
}

TEST(ProtocolReader, DescribesEveryNumberInDeterministicJson) {
    // Truth: invariant: same text, same bytes; shortest decimals, so that 20.2 mm is 0.0202 m.
    const std::string text = kHead + kScene + kTask + kFactors + kBlock;
    const auto first = read(text), second = read(text);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->expanded_json, second->expanded_json);
    const auto& params = first->conditions[1].params_json;
    for (const std::string part :
         {R"("device":"arm")", R"("stiffness_N_per_m":4000,)", R"("bore_diameter_m":0.021,)", R"("timeout_s":30,)",
          R"("clearance_m":0.000500000000)", R"("position_m":[0,0,0],"quaternion_wxyz":[1,0,0,0])"})
        EXPECT_NE(params.find(part), std::string::npos) << part << " in " << params;
    EXPECT_NE(first->expanded_json.find(params), std::string::npos);
}

/// One line of a study and what makes it wrong.
struct Fault {
    std::string sound, wrong;
};

std::string withFaults(std::string text, const std::vector<Fault>& faults) {
    for (const Fault& fault : faults) {
        const auto place = text.find(fault.sound);
        EXPECT_NE(place, std::string::npos) << fault.sound;
        text.replace(place, fault.sound.size(), fault.wrong);
    }
    return text;
}

TEST(ProtocolReader, TellsOfEveryFaultAtOnce) {
    // Truth: invariant: a fault that is found when it stands alone is found beside others that it does not follow from.
    const std::string text = kHead + "max_session_minutes = 60\n" + kScene + "[scene.contact]\ntolerance_um = 20\n" +
                             kTask + kFactors + kBlock + R"(set = { "contact.spacing_mm" = 1 }
constraints = [{ rule = "max_run", factor = "stiffness", count = 3 }]
order = "shuffled"
[[block]]
name = "threshold"
[[staircase]]
name = "coarse"
block = "threshold"
key = "contact.proxy_filter_hz"
levels = [5, 10, 20]
rule = "1_up_2_down"
step_down = 6
measure = "completion_time_s"
above = 5
max_trials = 4
tracks = [{ name = "only", start = 20 }]
[[analysis]]
outcome = "completion_time_s"
factors = ["method"]
test = "paired_t"
[text.en]
hello = "Hello"
[[instruction]]
moment = "session_start"
text = "hello"
)";
    ASSERT_EQ(errorsOf(text), "");
    const std::vector<Fault> faults{{"preset = \"arm\"", "preset = \"armm\""},
                                    {"tolerance_um = 20", "tolerance_um = -2"},
                                    {"levels = [\"penalty\",", "levels = [\"penalti\","},
                                    {"\"contact.spacing_mm\" = 1 ", "\"contact.spacing_mm\" = 0 "},
                                    {"count = 3", "count = 0"},
                                    {"levels = [5, 10, 20]", "levels = [5, 10, -1]"},
                                    {"factors = [\"method\"]", "factors = [\"metho\"]"},
                                    {"target = \"plate\"", "target = \"plat\""},
                                    {"text = \"hello\"", "text = \"hallo\""},
                                    {"seed = 42", "seed = -42"}};
    std::vector<std::string> alone;
    for (const Fault& fault : faults) {
        alone.push_back(errorsOf(withFaults(text, {fault})));
        EXPECT_FALSE(alone.back().empty()) << fault.wrong;
        EXPECT_EQ(std::count(alone.back().begin(), alone.back().end(), '\n'), 0) << alone.back();
    }
    const std::string together = errorsOf(withFaults(text, faults));
    for (const std::string& line : alone) EXPECT_NE(together.find(line), std::string::npos) << line << "\n" << together;
    EXPECT_EQ(std::count(together.begin(), together.end(), '\n') + 1, static_cast<std::ptrdiff_t>(faults.size()))
        << together;
    // Each of these beside a device that is not known, as they hide nothing from each other.
    const Fault device = faults.front();
    for (const Fault& fault : {Fault{"max_session_minutes = 60", "max_session_minutes = 0.1"},
                               Fault{"pose = { position = [0, 0, 30] }", "pose = { position = [0, 0, -9] }"},
                               Fault{"order = \"shuffled\"", "order = \"shuffled\"\ncatch_trials = 2"}}) {
        const std::string line = errorsOf(withFaults(text, {fault}));
        const std::string both = errorsOf(withFaults(text, {fault, device}));
        EXPECT_NE(both.find(line), std::string::npos) << line << "\n" << both;
        EXPECT_NE(both.find("device.preset"), std::string::npos) << both;
    }
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
