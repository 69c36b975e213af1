#include "study/measures/tick_facts.h"

#include <gtest/gtest.h>

namespace passung::measures {
namespace {

TEST(TickFacts, ForceOrTorqueOrAContactPointMakesContact) {
    // Truth: closed form (definition)
    EXPECT_FALSE(isContact(TickRecord{}));
    TickRecord force;
    force.force_N = {0.0f, 2e-6f, 0.0f};
    EXPECT_TRUE(isContact(force));
    TickRecord torque;
    torque.torque_Nm = {0.0f, 0.0f, -2e-9f};
    EXPECT_TRUE(isContact(torque));
    TickRecord point;
    point.contacts = 1;
    EXPECT_TRUE(isContact(point));
    TickRecord faint;
    faint.force_N = {0.0f, 5e-7f, 0.0f};
    faint.torque_Nm = {5e-10f, 0.0f, 0.0f};
    EXPECT_FALSE(isContact(faint));
}

TEST(TickFacts, TipDepthIsPositiveBelowTheMouthAndEmptyBesideTheBore) {
    // Truth: closed form. Target's mouth at z = 0.25; the neighbourhood ends 2 mm beside the axis, diagonally too.
    Pose X_TW;
    X_TW.p.z() = -0.25;
    TickRecord record;
    record.proxy_position_m = {0.0f, 0.0f, 0.125f};
    EXPECT_DOUBLE_EQ(tipDepthInBore(record, X_TW).value(), 0.125);
    record.proxy_position_m = {0.0013f, 0.0013f, 0.5f};
    EXPECT_DOUBLE_EQ(tipDepthInBore(record, X_TW).value(), -0.25);
    record.proxy_position_m = {0.0015f, 0.0015f, 0.125f};
    EXPECT_FALSE(tipDepthInBore(record, X_TW));
}

}  // namespace
}  // namespace passung::measures
