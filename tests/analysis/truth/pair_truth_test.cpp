#include "analysis/truth/pair_truth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/truth/contact_path.h"
#include "tests/support/named_part.h"

namespace passung::truth {
namespace {

const auto kCube = shape::Box{0.1, 0.1, 0.1};
const auto kBall = shape::Sphere{0.02};

TEST(PairTruth, ABallOnACubeHasItsClosedFormDistanceAndForce) {
    // Truth: closed form. The ball's lowest point is `d` below or above the face; the penalty of the cap is κ V,
    // V = π d² (r - d/3), upright through the ball's middle, which is its origin: no torque. The ball's chords take at
    // most 0.25 µm of 1 mm, 0.1 % of the force.
    const auto truth = PairTruth::build(test::namedPart("cube", kCube), test::namedPart("ball", kBall));
    ASSERT_TRUE(truth);
    const double r = 0.01, d = 1e-3;
    const PoseTruth apart = truth->at({Quat::Identity(), Vec3(0.01, 0.02, 0.05 + r + d)});
    EXPECT_EQ(apart.relation, Relation::Apart);
    EXPECT_NEAR(apart.distance, d, apart.uncertainty + 1e-12);
    EXPECT_EQ(apart.wrench.force.norm(), 0.0);
    const PoseTruth pressed = truth->at({Quat::Identity(), Vec3(0.01, 0.02, 0.05 + r - d)});
    EXPECT_EQ(pressed.relation, Relation::SurfacesIntersect);
    EXPECT_NEAR(pressed.distance, -d, pressed.uncertainty + 1e-12);
    EXPECT_LE(pressed.uncertainty, 2e-6);
    const double force = kAreaStiffness * std::numbers::pi * d * d * (r - d / 3.0);
    EXPECT_NEAR(pressed.wrench.force.z(), force, 2e-3 * force);
    EXPECT_LT(pressed.wrench.torque.norm(), 1e-3 * force * r);
    EXPECT_LT(pressed.wrench_uncertainty, 2e-3);
}

TEST(PairTruth, BothWaysIsTheMeanOfTwoForcesThatActWhereTheyDo) {
    // Truth: closed form. F acts on SHELL at c in FIELD's frame: torque (c - p) x F about SHELL's origin p. What is
    // true of the way back is the reaction -F', about FIELD's origin, in SHELL's axes.
    const Pose X_FS{rotationFromVector({0.3, -0.5, 0.2}), Vec3(0.01, 0.02, 0.05)};
    const Vec3 c(0.02, 0.01, 0.03), force(1, 2, 3), other(0.5, 2.5, 2);
    PoseTruth there, back;
    there.distance = -1e-3;
    there.wrench = {force, (c - X_FS.p).cross(force)};
    back.distance = -2e-3;
    back.uncertainty = 1e-6;
    back.wrench = {X_FS.q.conjugate() * -other, X_FS.q.conjugate() * -c.cross(other)};
    const PoseTruth both = bothWays(there, back, X_FS);
    EXPECT_EQ(both.distance, -2e-3);
    EXPECT_EQ(both.uncertainty, 1e-6);
    EXPECT_LT((both.wrench.force - 0.5 * (force + other)).norm(), 1e-12);
    EXPECT_LT((both.wrench.torque - 0.5 * (c - X_FS.p).cross(force + other)).norm(), 1e-12);
}

TEST(PairTruth, NamesContainmentWhichFclCallsFree) {
    // Truth: closed form. A ball in the middle of the cube is 50 mm from its faces at its centre, 60 mm deep at the
    // far pole; the other way round the cube is nowhere inside the ball's surface.
    const auto in_cube = PairTruth::build(test::namedPart("cube", kCube), test::namedPart("ball", kBall));
    ASSERT_TRUE(in_cube);
    const PoseTruth inside = in_cube->at(Pose{});
    EXPECT_EQ(inside.relation, Relation::BInsideA);
    EXPECT_NEAR(inside.separation, 0.04, 1e-6);
    EXPECT_LE(inside.distance, -0.04);
    const auto around = PairTruth::build(test::namedPart("ball", kBall), test::namedPart("cube", kCube));
    ASSERT_TRUE(around);
    const PoseTruth outside = around->at(Pose{});
    EXPECT_EQ(outside.relation, Relation::AInsideB);
    EXPECT_NEAR(outside.distance, 0.04, 1e-6);
}

TEST(PairTruth, RefusesAFieldWithoutAnInside) {
    // Truth: invariant
    const auto truth =
        PairTruth::build(test::namedPart("sheet", shape::Sheet{0.05, 0.05}), test::namedPart("ball", kBall));
    ASSERT_FALSE(truth);
    EXPECT_NE(truth.errors().front().message.find("watertight"), std::string::npos);
}

TEST(ContactPath, HasTheSamePosesForTheSameSeedAndMeetsContactAtTheAskedDepths) {
    // Truth: invariant. 11 poses a path: apart, then as deep as asked (within 2 %, and what the search resolves), then
    // slid; depths are shares of the ball's 20 mm.
    const auto truth = PairTruth::build(test::namedPart("cube", kCube), test::namedPart("ball", kBall));
    ASSERT_TRUE(truth);
    const auto quiet = [](double) {};
    const auto poses = contactPath(*truth, 2, 7, quiet), again = contactPath(*truth, 2, 7, quiet);
    ASSERT_EQ(poses.size(), 22u);
    ASSERT_EQ(again.size(), poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
        EXPECT_EQ(poses[i].X_FS.p, again[i].X_FS.p);
        const double distance = poses[i].truth.distance;
        const std::size_t place = i % 11;
        EXPECT_EQ(distance > 0.0, place < 3) << i;
        if (place == 7) {
            EXPECT_NEAR(distance, -0.02 * 0.02, 0.03 * 0.02 * 0.02 + 4e-6) << i;
        }
    }
}

TEST(ContactPath, OfAPegIncludesPosesInItsBore) {
    // Truth: invariant. Every other path begins where the peg is free in the bore: there its middle is below the
    // mouth's plane or less than half the peg's length above, and its axis upright.
    const auto truth =
        PairTruth::build(test::namedPart("plate", shape::BorePlate{0.06, 0.06, 0.03, 0.021, 0.025, 0.5e-3}),
                         test::namedPart("peg", shape::Peg{0.02, 0.05, 0.5e-3}));
    ASSERT_TRUE(truth);
    int in_bore = 0;
    for (const JudgedPose& pose : contactPath(*truth, 2, 1, [](double) {})) {
        const bool over_the_bore = pose.X_FS.p.head<2>().norm() < 2.1e-3;
        in_bore += over_the_bore && pose.X_FS.q.isApprox(Quat::Identity()) && pose.X_FS.p.z() < 0.0 ? 1 : 0;
    }
    EXPECT_GE(in_bore, 5);
}

}  // namespace
}  // namespace passung::truth
