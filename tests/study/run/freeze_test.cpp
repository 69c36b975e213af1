#include "study/run/freeze.h"

#include <gtest/gtest.h>

#include "core/scene/contact_geometry.h"
#include "study/run/files/known_names.h"
#include "study/run/files/protocol_files.h"

namespace passung::run {
namespace {

plan::StudyPlan shippedStudy(const std::string& name = "study") {
    auto plan = readProtocol(PASSUNG_SOURCE_DIR "/protocols/peg_in_hole/" + name + ".toml");
    if (!plan) throw std::runtime_error(toString(plan.errors().front()));
    return *std::move(plan);
}

/// What a database keeps that began with half of the maxima.
KeptPlan halfAsStiff(const plan::StudyPlan& plan) {
    KeptPlan kept{"", plan.stable_stiffness, {}, {}};
    for (plan::StableStiffness& stable : kept.stable_stiffness) stable.linear *= 0.5;
    return kept;
}

TEST(Freeze, AFractionOfTheMaximumIsOneOfTheKeptMaximum) {
    // Truth: closed form: the protocol writes all stiffnesses as fractions of the maximum.
    const auto draft = shippedStudy();
    const auto frozen = freeze(draft, halfAsStiff(draft));
    ASSERT_TRUE(frozen);
    ASSERT_EQ((*frozen)->conditions.size(), draft.conditions.size());
    for (std::size_t i = 0; i < draft.conditions.size(); ++i) {
        EXPECT_DOUBLE_EQ((*frozen)->conditions[i].scene.contact.stiffness,
                         0.5 * draft.conditions[i].scene.contact.stiffness);
        EXPECT_NE((*frozen)->conditions[i].params_json, draft.conditions[i].params_json);
    }
    EXPECT_DOUBLE_EQ((*frozen)->stable_stiffness[0].linear, 0.5 * draft.stable_stiffness[0].linear);
}

TEST(Freeze, WhatDoesNotFollowFromMaximaIsTheDrafts) {
    // Truth: invariant: questionnaires' items are in files of their own, which a second reading does not open.
    const auto draft = shippedStudy();
    const auto frozen = freeze(draft, halfAsStiff(draft));
    ASSERT_TRUE(frozen);
    EXPECT_EQ((*frozen)->seed, draft.seed);
    EXPECT_EQ((*frozen)->consent.size(), draft.consent.size());
    ASSERT_EQ((*frozen)->questionnaires.size(), 2u);
    EXPECT_EQ((*frozen)->questionnaires[0].definition.items.size(), 6u);
}

TEST(Freeze, AGeometryThatTheTextLeavesOpenIsTheOneWithWhichTheStudyBegan) {
    // Truth: closed form: rows as an earlier program wrote them, when there was but one geometry.
    const auto draft = shippedStudy("hidden_offset");
    KeptPlan kept{"", draft.stable_stiffness, {}, {}};
    for (const plan::Condition& condition : draft.conditions) kept.geometry.push_back({condition.name, "field", ""});
    kept.geometry.pop_back();
    const auto frozen = freeze(draft, kept);
    ASSERT_TRUE(frozen);
    const auto geometryAt = [&](std::size_t i) { return scene::geometryOf((*frozen)->conditions[i].scene).geometry; };
    const std::size_t last = draft.conditions.size() - 1;
    EXPECT_EQ(scene::geometryOf(draft.conditions[last - 1].scene).geometry, scene::Geometry::ClosedForm);
    EXPECT_EQ(geometryAt(last - 1), scene::Geometry::Field);
    EXPECT_NE((*frozen)->conditions[last - 1].params_json.find("\"geometry\":\"field\""), std::string::npos);
    EXPECT_NE((*frozen)->expanded_json, draft.expanded_json);
    EXPECT_EQ(geometryAt(last), scene::Geometry::ClosedForm) << "nothing is kept of it";
}

TEST(Freeze, FieldsWithWhichAStudyBeganFollowTheFeaturesOfItsParts) {
    // Truth: closed form: a pin of 0.4 mm slips between points 1 mm apart, so that fields look both ways; no other
    // geometry asks for that. The kept rows are those of a program whose god object had fields alone.
    const auto text = [](const std::string& geometry) {
        return R"(
passung = 1
[study]
name = "pin"
version = "1"
seed = 1
participants = 1
[scene]
[[scene.part]]
name = "pin"
shape = { kind = "cylinder", diameter = 0.4, length = 10 }
[[scene.part]]
name = "block"
held = true
shape = { kind = "box", width = 50, depth = 50, height = 10 }
pose = { position = [0, 0, 30] }
[scene.contact]
method = "god_object"
stiffness_N_per_m = 1000
)" + geometry + R"([scene.device]
preset = "sigma7"
[task]
type = "free_placement"
position = [0, 0, 20]
[[block]]
name = "main"
order = "listed"
)";
    };
    const auto read = [&](const std::string& geometry) {
        auto plan = readBegunProtocol(text(geometry), "pin.toml", knownDevices());
        if (!plan) throw std::runtime_error(toString(plan.errors().front()));
        return *std::move(plan);
    };
    const auto draft = read("");
    ASSERT_EQ(scene::geometryOf(draft.conditions[0].scene).geometry, scene::Geometry::ClosedForm);
    EXPECT_FALSE(draft.conditions[0].scene.contact.two_way);
    const auto frozen = freeze(draft, {"", draft.stable_stiffness, {}, {{draft.conditions[0].name, "field", ""}}});
    ASSERT_TRUE(frozen) << toString(frozen.errors().front());
    const scene::ContactSpec& contact = (*frozen)->conditions[0].scene.contact;
    const auto sampled = read("geometry = \"field\"\n");
    EXPECT_TRUE(contact.two_way);
    EXPECT_EQ(contact.spacing, sampled.conditions[0].scene.contact.spacing);
    EXPECT_EQ(contact.tolerance, sampled.conditions[0].scene.contact.tolerance);
    EXPECT_EQ((*frozen)->conditions[0].params_json, sampled.conditions[0].params_json);
}

TEST(Freeze, ARunDecidesItsSeedAndWhetherOnlyTrialsRun) {
    // Truth: invariant; the kept maxima are others, so that conditions are read again: what the run decides stays.
    const auto draft = shippedStudy();
    ASSERT_FALSE(draft.consent.empty());
    ASSERT_FALSE(draft.questionnaires.empty());
    const auto frozen = freeze(draft, halfAsStiff(draft), {.seed = draft.seed + 1, .trials_only = true});
    ASSERT_TRUE(frozen);
    EXPECT_EQ((*frozen)->seed, draft.seed + 1);
    EXPECT_TRUE((*frozen)->consent.empty());
    EXPECT_TRUE((*frozen)->instructions.empty());
    EXPECT_TRUE((*frozen)->questionnaires.empty());
    EXPECT_EQ((*frozen)->conditions.size(), draft.conditions.size());
}

}  // namespace
}  // namespace passung::run
