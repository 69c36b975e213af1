#include "ui/app/auto_accuracy.h"

#include <gtest/gtest.h>

namespace passung::app {
namespace {

TEST(AutoAccuracy, WritesTheKeptPickIntoTheScenesThatAskForIt) {
    // Truth: invariant. SI from the units in the names; another protocol's pick, another budget and a fixed condition
    // do not count.
    protocol::StudyPlan plan;
    plan.conditions.resize(2);
    plan.conditions[0].accuracy_budget = 50e-6;
    const model::ContactSpec untouched = plan.conditions[1].scene.contact;
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
    const model::ContactSpec& contact = plan.conditions[0].scene.contact;
    EXPECT_NEAR(contact.tolerance, 50e-6, 1e-15);
    EXPECT_NEAR(contact.spacing, 2e-3, 1e-15);
    EXPECT_EQ(contact.mode, model::FieldMode::Linear);
    EXPECT_EQ(contact.budget_nodes, 300);
    EXPECT_NE(plan.conditions[0].params_json.find("\"budget_nodes\":300"), std::string::npos)
        << plan.conditions[0].params_json;
    EXPECT_EQ(plan.conditions[1].scene.contact.spacing, untouched.spacing);
    EXPECT_EQ(plan.conditions[1].params_json, "");
}

}  // namespace
}  // namespace passung::app
