#include "study/measures/tick_facts.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(TickFacts, WithoutADisplayedWrenchTheHandsDepthTellsOfContact) {
    // Truth: invariant: a proxy rests a hair above what it touches, so that no point of it is inside.
    TickRecord inside;
    inside.hand_depth_m = 1e-4f;
    EXPECT_FALSE(isContact(inside)) << "a force would tell";
    inside.status = kWrenchWithheld;
    EXPECT_TRUE(isContact(inside));
    inside.hand_depth_m = 0.0f;
    EXPECT_FALSE(isContact(inside));
}

TEST(TickFacts, WhatIsFeltInTheAirIsNoContact) {
    // Truth: closed form (definition): weight, viscosity and a guide
    for (const std::uint32_t in_air : {kWeighed, kAidedInAir}) {
        TickRecord hanging;
        hanging.force_N = {0.0f, 0.0f, -1.2f};
        hanging.torque_Nm = {0.01f, 0.0f, 0.0f};
        EXPECT_TRUE(isContact(hanging));
        hanging.status = in_air;
        EXPECT_FALSE(isContact(hanging));
        hanging.contacts = 1;
        EXPECT_TRUE(isContact(hanging));
    }
}

TEST(TickFacts, TipIsInTheBoreBelowTheMouthAndWithinTheClearanceAndTheWallsGive) {
    // Truth: closed form. Target's mouth at z = 0.25; 0.1 mm of clearance and 0.2 mm of give end 0.3 mm beside the
    // axis, diagonally at 0.212 mm each.
    Pose X_TW;
    X_TW.p.z() = -0.25;
    const auto depthAt = [&X_TW](double x, double y, double z, double clearance) {
        TickRecord record;
        record.proxy_position_m = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
        return tipDepthInBore(record, X_TW, clearance);
    };
    EXPECT_DOUBLE_EQ(depthAt(0.0, 0.0, 0.125, 1e-4).value(), 0.125);
    EXPECT_DOUBLE_EQ(depthAt(0.0, 0.0, 0.25, 1e-4).value(), 0.0);
    EXPECT_FALSE(depthAt(0.0, 0.0, 0.2501, 1e-4));
    EXPECT_TRUE(depthAt(0.00021, 0.00021, 0.125, 1e-4));
    EXPECT_FALSE(depthAt(0.00022, 0.00022, 0.125, 1e-4));
    EXPECT_FALSE(depthAt(0.0006, 0.0, 0.125, 1e-4));
    EXPECT_TRUE(depthAt(0.0006, 0.0, 0.125, 5e-4));
    EXPECT_FALSE(depthAt(0.0, std::nan(""), 0.125, 1e-4));
}

TEST(TickFacts, PartIsClearOfWallsUpToTheirGive) {
    // Truth: closed form (definition)
    TickRecord record;
    EXPECT_TRUE(isClearOfWalls(record));
    record.proxy_depth_m = 0.00019f;
    EXPECT_TRUE(isClearOfWalls(record));
    record.proxy_depth_m = 0.00021f;
    EXPECT_FALSE(isClearOfWalls(record));
    record.proxy_depth_m = std::nanf("");
    EXPECT_FALSE(isClearOfWalls(record));
}

}  // namespace
}  // namespace passung::measures
