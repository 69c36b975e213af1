#include "study/run/machine/auto_accuracy.h"

#include <gtest/gtest.h>

namespace passung::run {
namespace {

TEST(AutoAccuracy, WritesTheKeptPickIntoTheScenesThatAskForIt) {
    // Truth: invariant. SI from the units in the names; another protocol's pick, another budget and a fixed condition
    // do not count.
    plan::StudyPlan plan;
    plan.conditions.resize(2);
    plan.conditions[0].accuracy_budget = 50e-6;
    const scene::ContactSpec untouched = plan.conditions[1].scene.contact;
    store::AccuracyRow pick{.protocol_sha256 = "a",
                            .candidate = 0,
                            .mode = "linear",
                            .tolerance_um = 50.0,
                            .spacing_mm = 2.0,
                            .budget_nodes = 300,
                            .picked_for_us = {25.0}};
    EXPECT_FALSE(applyAccuracy("a", std::vector{pick}, plan));
    pick.picked_for_us.push_back(50.0);
    EXPECT_FALSE(applyAccuracy("another", std::vector{pick}, plan));
    ASSERT_TRUE(applyAccuracy("a", std::vector{pick}, plan));
    const scene::ContactSpec& contact = plan.conditions[0].scene.contact;
    EXPECT_NEAR(contact.tolerance, 50e-6, 1e-15);
    EXPECT_NEAR(contact.spacing, 2e-3, 1e-15);
    EXPECT_EQ(contact.mode, field::FieldMode::Linear);
    EXPECT_EQ(contact.budget_nodes, 300);
    EXPECT_NE(plan.conditions[0].params_json.find("\"budget_nodes\":300"), std::string::npos)
        << plan.conditions[0].params_json;
    EXPECT_EQ(plan.conditions[1].scene.contact.spacing, untouched.spacing);
    EXPECT_EQ(plan.conditions[1].params_json, "");
}

TEST(AutoAccuracy, APickIsFeltBothWaysWhereOneWayWouldMissAPin) {
    // Truth: closed form: a pin of 1 mm is thinner than the gap between points 1 mm apart to all sides; a post is not.
    plan::StudyPlan plan;
    plan.conditions.resize(2);
    const shape::Shape obstacles[] = {shape::Cylinder{0.001, 0.01}, shape::Box{0.02, 0.02, 0.02}};
    for (std::size_t i = 0; i < 2; ++i) {
        plan.conditions[i].accuracy_budget = 50e-6;
        plan.conditions[i].scene.contact.geometry = scene::Geometry::Field;  // as accuracy = "auto" is read
        auto& parts = plan.conditions[i].scene.parts;
        parts.resize(2);
        parts[0].name = "block";
        parts[0].held = true;
        parts[0].geometry = shape::Box{0.04, 0.02, 0.02};
        parts[1].name = "still";
        parts[1].geometry = obstacles[i];
    }
    const store::AccuracyRow pick{.protocol_sha256 = "a",
                                  .candidate = 0,
                                  .mode = "trilinear",
                                  .tolerance_um = 20.0,
                                  .spacing_mm = 1.0,
                                  .picked_for_us = {50.0}};
    ASSERT_TRUE(applyAccuracy("a", std::vector{pick}, plan));
    EXPECT_TRUE(plan.conditions[0].scene.contact.two_way);
    EXPECT_FALSE(plan.conditions[1].scene.contact.two_way);
}

TEST(AutoAccuracy, NamesThePicksThatThisMachineIsTooSlowFor) {
    // Truth: invariant. A query takes more than a picosecond and less than a minute.
    plan::StudyPlan plan;
    plan.conditions.resize(1);
    plan.conditions[0].accuracy_budget = 1e-6;
    auto& parts = plan.conditions[0].scene.parts;
    parts.resize(2);
    parts[0].name = "cube";
    parts[0].geometry = shape::Box{0.004, 0.004, 0.004};
    parts[1].name = "ball";
    parts[1].geometry = shape::Sphere{0.002};
    parts[1].held = true;
    const store::AccuracyRow pick{.protocol_sha256 = "a",
                                  .candidate = 0,
                                  .mode = "trilinear",
                                  .tolerance_um = 100.0,
                                  .spacing_mm = 0.2,
                                  .picked_for_us = {1e-6, 60e6}};
    const auto slow = tooSlowHere(plan, std::vector{pick}, nullptr);
    ASSERT_TRUE(slow);
    ASSERT_EQ(slow->size(), 1u);
    EXPECT_EQ(slow->front().rfind("accuracy_budget_us = 1e-06 is not kept on this machine", 0), 0u) << slow->front();
}

}  // namespace
}  // namespace passung::run
