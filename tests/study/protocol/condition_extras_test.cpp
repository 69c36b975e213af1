#include <gtest/gtest.h>

#include <set>

#include "core/base/json.h"
#include "study/plan/plan_warnings.h"
#include "study/protocol/protocol_reader.h"
#include "tests/study/protocol/fake_devices.h"

namespace passung::protocol {
namespace {

const std::vector<std::string> kMeasures = {"trial_time_s", "secondary_hit_rate"};

/// A study of one condition with these tables beside it.
Result<plan::StudyPlan> read(const std::string& tables, const std::string& task = "") {
    const std::string text = R"(passung = 1
study = { name = "extras", version = "1", seed = 1, participants = 2 }
[scene]
device = { preset = ")" + fakeDevices().front().name +
                             R"(" }
[[scene.part]]
name = "plate"
shape = { kind = "bore_plate", width = 60, depth = 60, height = 30, bore_diameter = 21, bore_depth = 25 }
[[scene.part]]
name = "peg"
held = true
shape = { kind = "peg", diameter = 20, length = 50 }
pose = { position = [0, 0, 30] }
[task]
type = "peg_in_hole"
target = "plate"
)" + task + "\n[[block]]\nname = \"main\"\norder = \"listed\"\n" +
                             tables;
    return readProtocolText(text, "extras.toml", fakeDevices(), kMeasures);
}

std::string faultOf(const Result<plan::StudyPlan>& plan) { return plan ? "" : toString(plan.errors().front()); }

TEST(Messages, OfFrictionUnderThePenaltySayThatItIsNotFelt) {
    // Truth: invariant: every condition is a penalty's, so that there is no other in which the friction acts.
    std::string rubs =
        "[[factor]]\nname = \"method\"\nkey = \"contact.method\"\nlevels = [\"penalty\", \"god_object\"]\n";
    rubs += "[[exclude]]\nmethod = \"god_object\"\n";
    for (const char* part : {"plate", "peg"})
        rubs += std::string("[[factor]]\nname = \"rub_") + part + "\"\nkey = \"part." + part +
                ".friction\"\nlevels = [0.2, 0.3]\n";
    const auto plan = read(rubs);
    ASSERT_TRUE(plan) << faultOf(plan);
    ASSERT_EQ(plan->warnings.size(), 1u);
    EXPECT_TRUE(plan->warnings[0].starts_with(
        "contact.method = \"penalty\" renders no friction: that of the parts is not felt; conditions: "))
        << plan->warnings[0];
    // PenaltyTool.SlidesAsIfThePartsHadNoFriction: nor does a tool.
    const auto tool = read(rubs + "[scene.contact]\ncoupling = \"quasi_static\"\n");
    ASSERT_TRUE(tool) << faultOf(tool);
    ASSERT_EQ(tool->warnings.size(), 1u);
    EXPECT_TRUE(tool->warnings[0].starts_with("contact.method = \"penalty\" renders no friction")) << tool->warnings[0];
}

TEST(Messages, SayWhichOfCellAndToleranceWins) {
    // Truth: invariant: with one of them there is nothing to say.
    for (const bool both : {false, true}) {
        const auto plan = read("[scene.contact]\ncell_mm = 0.5\n" + std::string(both ? "tolerance_um = 100\n" : ""));
        ASSERT_TRUE(plan) << faultOf(plan);
        ASSERT_EQ(plan->warnings.size(), both ? 1u : 0u);
        for (const std::string& warning : plan->warnings)
            EXPECT_EQ(
                warning,
                "scene.contact.cell_mm decides the cells of distance fields: tolerance_um beside it has no say in "
                "them");
    }
}

TEST(Messages, ALabelOfALevelStaysAsShortAsItWas) {
    // Truth: regression: labels are parts of orders and columns; only messages tell 1.0 from 1.
    const auto plan = read(
        "[scene.contact]\ngeometry = \"field\"\n"
        "[[factor]]\nname = \"spacing\"\nkey = \"contact.spacing_mm\"\nlevels = [1.0, 0.5]\n");
    ASSERT_TRUE(plan) << faultOf(plan);
    EXPECT_EQ(plan->conditions[0].name, "1");
    EXPECT_EQ(plan->conditions[1].name, "0.5");
}

TEST(Feedback, EveryCombinationIsAConditionOfItsOwn) {
    // Truth: closed form: 2 x 2 x 2 x 2 x 2; what is stored of each says which it is.
    std::set<std::string> stored;
    for (unsigned bits = 0; bits < 32; ++bits) {
        const auto on = [bits](unsigned bit) { return (bits >> bit & 1u) != 0; };
        std::string cues;
        for (unsigned bit = 0; bit < 3; ++bit)
            if (on(bit))
                cues += std::string(cues.empty() ? "" : ", ") +
                        std::array{"\"visual\"", "\"vibrotactile\"", "\"audio\""}[bit];
        const auto plan = read("[feedback]\ncues = [" + cues + "]\nkinesthetic = " + (on(3) ? "true" : "false") +
                               "\nmasking_noise = " + (on(4) ? "true" : "false") + "\n");
        ASSERT_TRUE(plan) << faultOf(plan);
        const plan::Condition& condition = plan->conditions.front();
        EXPECT_EQ(condition.cues.visual, on(0));
        EXPECT_EQ(condition.cues.vibrotactile, on(1));
        EXPECT_EQ(condition.cues.audio, on(2));
        EXPECT_EQ(condition.scene.display_wrench, on(3));
        EXPECT_EQ(condition.cues.masking_noise, on(4));
        const std::size_t masked = on(2) && on(4) ? 1 : 0, nowhere = on(1) ? 1 : 0;
        EXPECT_EQ(plan->warnings.size(), masked + nowhere) << "a sound that is masked, a vibration without actuator";
        EXPECT_EQ(plan::isForPeople(*plan), nowhere == 0);
        stored.insert(condition.params_json);
    }
    EXPECT_EQ(stored.size(), 32u);
}

TEST(Secondary, IsOffByDefaultAndKeepsItsNumbers) {
    // Truth: closed form
    const auto off = read("");
    ASSERT_TRUE(off) << faultOf(off);
    EXPECT_FALSE(off->conditions.front().secondary.any());
    EXPECT_EQ(off->measures, (std::vector<std::string>{"trial_time_s"})) << "it could have no other";
    EXPECT_EQ(off->conditions.front().params_json.find("secondary"), std::string::npos);
    const auto plan =
        read("[secondary]\nstimulus = \"visual\"\ninterval_max_s = 6\nresponse_max_ms = 2000\nbutton = 3\n");
    ASSERT_TRUE(plan) << faultOf(plan);
    const plan::SecondaryTask& task = plan->conditions.front().secondary;
    EXPECT_EQ(task.stimulus, plan::Stimulus::Visual);
    EXPECT_EQ(task.least_interval, 3.0);
    EXPECT_EQ(task.most_interval, 6.0);
    EXPECT_EQ(task.duration, 1.0);
    EXPECT_DOUBLE_EQ(task.earliest, 0.1);
    EXPECT_DOUBLE_EQ(task.latest, 2.0);
    EXPECT_EQ(task.button, 3);
    EXPECT_EQ(plan->measures, kMeasures);
    EXPECT_NE(plan->conditions.front().params_json.find("\"interval_max_s\""), std::string::npos);
}

TEST(Secondary, OfABlockAloneIsStoredToo) {
    // Truth: closed form: a block's own conditions are read after the others.
    const auto plan = read("set = { \"secondary.stimulus\" = \"audio\" }\n");
    ASSERT_TRUE(plan) << faultOf(plan);
    ASSERT_EQ(plan->conditions.size(), 2u);
    EXPECT_FALSE(plan->conditions[0].secondary.any());
    EXPECT_EQ(plan->conditions[1].secondary.stimulus, plan::Stimulus::Audio);
    EXPECT_EQ(plan->measures, kMeasures);
}

TEST(Secondary, ACueOfTheSameKindIsWarnedOf) {
    // Truth: invariant
    const std::string cue = "[feedback]\ncues = [\"vibrotactile\"]\n[secondary]\nstimulus = ";
    EXPECT_EQ(read(cue + "\"vibrotactile\"\n")->warnings.size(), 3u) << "of the same kind; neither has an output";
    EXPECT_EQ(read(cue + "\"audio\"\n")->warnings.size(), 1u) << "no output for the cue";
}

TEST(Secondary, AStimulusThatNothingGivesNamesItsConditions) {
    // Truth: invariant: windows play sound and draw no stimulus, no device vibrates.
    for (const char* stimulus : {"visual", "vibrotactile"}) {
        const auto plan = read(std::string("[secondary]\nstimulus = \"") + stimulus + "\"\n");
        ASSERT_TRUE(plan) << faultOf(plan);
        ASSERT_EQ(plan->warnings.size(), 1u);
        EXPECT_NE(plan->warnings[0].find(std::string("secondary.stimulus = \"") + stimulus), std::string::npos);
        EXPECT_NE(plan->warnings[0].find("conditions: " + plan->conditions.front().name), std::string::npos);
        EXPECT_FALSE(plan::isForPeople(*plan));
    }
    EXPECT_TRUE(plan::isForPeople(*read("[secondary]\nstimulus = \"audio\"\n")));
}

TEST(TimedBy, NeedsAConditionThatRendersNothing) {
    // Truth: invariant
    for (const char* who : {"experimenter", "clock"}) {
        const std::string task = std::string("timed_by = \"") + who + "\"";
        EXPECT_NE(faultOf(read("", task)).find("needs feedback.kinesthetic = false"), std::string::npos);
        const auto plan = read("[feedback]\nkinesthetic = false\n", task);
        ASSERT_TRUE(plan) << faultOf(plan);
        EXPECT_STREQ(plan::timedByName(plan->conditions.front().timed_by), who);
    }
    EXPECT_NE(faultOf(read("", "timed_by = \"nobody\"")), "");
    EXPECT_NE(faultOf(read("", "timed_by = 3")), "");
}

TEST(StudyTexts, AreThereInEveryLanguageAndForEveryClause) {
    // Truth: closed form
    const std::string both = "[text.en]\na = \"A\"\nb = \"B\"\n[text.de]\na = \"Ä\"\n";
    const auto plan = read(both + "b = \"B\"\n");
    ASSERT_TRUE(plan) << faultOf(plan);
    ASSERT_EQ(plan->texts.size(), 2u);
    EXPECT_EQ(plan->texts[0].languages[1], (std::pair<std::string, std::string>{"de", "Ä"}));
    EXPECT_NE(plan->expanded_json.find(jsonText("Ä")), std::string::npos);
    EXPECT_NE(faultOf(read(both)).find("text.de.b: the text is missing, which [text.en] has"), std::string::npos);
    const std::string clause = "[[consent]]\nclause = \"data\"\ntext = { en = \"Yes?\" }\n";
    EXPECT_NE(faultOf(read(both + "b = \"B\"\n" + clause)).find("clause data of [[consent]] has no text in \"de\""),
              std::string::npos);
    EXPECT_NE(faultOf(read("[text.english]\na = \"A\"\n")).find("two lower-case letters"), std::string::npos);
    EXPECT_NE(faultOf(read("[text.en]\na = 3\n")).find("must be a text"), std::string::npos);
}

TEST(ConditionExtras, TellOfButtonsThatTwoWouldAnswerTo) {
    // Truth: definition: the first two buttons answer a pair, the secondary task has its own.
    const std::string clutch = "[scene.effects.clutch]\nbutton = 2\n";
    EXPECT_TRUE(read(clutch)) << faultOf(read(clutch));
    const std::string second = "[secondary]\nstimulus = \"audio\"\nbutton = 2\n";
    EXPECT_TRUE(
        faultOf(read(clutch + second)).ends_with("scene.effects.clutch.button: 2: is that of the secondary task"))
        << faultOf(read(clutch + second));
    EXPECT_TRUE(read("[scene.effects.clutch]\nbutton = 3\n" + second));
    std::string text = "passung = 1\nstudy = { name = \"p\", version = \"1\", seed = 1, participants = 2 }\n[scene]\n";
    text += "device = { preset = \"" + fakeDevices().front().name + "\" }\n[[scene.part]]\nname = \"plate\"\n";
    text += "shape = { kind = \"box\", width = 60, depth = 60, height = 30 }\n[[scene.part]]\nname = \"ball\"\n";
    text += "held = true\nshape = { kind = \"sphere\", diameter = 20 }\npose = { position = [0, 0, 30] }\n";
    text += "[scene.effects.position_scale]\nbutton = 1\nscale = 0.5\n[task]\ntype = \"discrimination_pair\"\n";
    text += "target = \"plate\"\nquestion = \"stiffness\"\ncomparison = { \"contact.stiffness_N_per_m\" = 800 }\n";
    text += "[scene.contact]\nstiffness_N_per_m = 1000\n[[block]]\nname = \"main\"\norder = \"listed\"\n";
    const auto pair = readProtocolText(text, "pair.toml", fakeDevices(), kMeasures);
    ASSERT_FALSE(pair);
    bool told = false;
    for (const Error& error : pair.errors())
        told = told || toString(error).ends_with(
                           "scene.effects.position_scale.button: 1: must be 3 or above: the first two answer the pair");
    EXPECT_TRUE(told) << faultOf(pair);
}

}  // namespace
}  // namespace passung::protocol
