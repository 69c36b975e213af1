#include "analysis/truth/force_reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/base/random.h"
#include "tests/support/scenes.h"

namespace passung::truth {
namespace {

constexpr double kStiffness = 2000.0;  // [N/m]
constexpr double kTurn = 1.0;          // [N m/rad]

scene::SceneSpec sceneOf(const shape::Shape& held, const shape::Shape& fixed, const Pose& X_WF = {}) {
    auto spec = test::scene(held, Pose{}, fixed, X_WF, scene::ContactMethod::GodObject);
    spec.contact.stiffness = kStiffness;
    spec.contact.rotational_stiffness = kTurn;
    return spec;
}

TEST(ForceReference, OfABallOnABoxIsStiffnessTimesDepth) {
    // Truth: closed form, sphere and plane: depth d of the ball below the face, F = K d along the face's normal.
    const Pose X_WF{rotationFromVector({0.4, -0.2, 0.9}), Vec3(0.3, 0.1, -0.2)};
    const ForceReference reference(sceneOf(shape::Sphere{0.02}, shape::Box{0.06, 0.06, 0.04}, X_WF));
    ASSERT_EQ(reference.missing(), "");
    for (const double depth : {1e-6, 1e-4, 3e-3}) {
        const Pose hand{Quat::Identity(), X_WF * Vec3(0.004, -0.003, 0.03 - depth)};
        const Pose shown{Quat::Identity(), X_WF * Vec3(0.00405, -0.003, 0.03)};
        const auto force = reference.at(shown, hand);
        ASSERT_TRUE(force) << depth;
        EXPECT_LE((*force - kStiffness * depth * (X_WF.q * Vec3::UnitZ())).norm(), 1e-5) << depth;
    }
    const Pose free{Quat::Identity(), X_WF * Vec3(0, 0, 0.031)};
    EXPECT_EQ(*reference.at(free, free), Vec3::Zero());
    // A proxy that has to go farther than kSnap in a tick.
    EXPECT_FALSE(reference.at({Quat::Identity(), X_WF * Vec3(0.0042, -0.003, 0.03)},
                              {Quat::Identity(), X_WF * Vec3(0.004, -0.003, 0.029)}));
}

TEST(ForceReference, OfTwoBallsPointsAlongTheirCentres) {
    // Truth: closed form: F = K (r + R - d) from centre to centre, from wherever on the other ball the search begins.
    const ForceReference reference(sceneOf(shape::Sphere{0.02}, shape::Sphere{0.05}));
    Random random(7);
    for (int i = 0; i < 50; ++i) {
        const auto part = [&] { return random.uniform(-1.0, 1.0); };
        const Vec3 n = Vec3(part(), part(), 1.2 + part()).normalized();
        const double depth = random.uniform(1e-5, 4e-3);
        const Vec3 beside = (n + 0.001 * Vec3(part(), part(), part())).normalized();
        const auto force = reference.at({Quat::Identity(), 0.035 * beside}, {Quat::Identity(), (0.035 - depth) * n});
        ASSERT_TRUE(force) << i;
        EXPECT_LE((*force - kStiffness * depth * n).norm(), 1e-4) << i;
    }
}

TEST(ForceReference, OfAnUprightPegInABoreIsWhatThePullHasBeyondThePlay) {
    // Truth: closed form. The wall holds the peg's edge, c above the tip where the hand pulls by a: the peg leans by
    // φ = F c / K_φ, which lets the tip go c φ farther, so that F = K (a - play) / (1 + K c² / K_φ) while φ leaves its
    // upper part free.
    const double play = 50e-6;
    const shape::Peg peg{0.02, 0.05, 0.0005};
    const ForceReference reference(sceneOf(peg, shape::BorePlate{.06, .06, .03, .02 + 2 * play, .04, .0005}));
    ASSERT_EQ(reference.missing(), "");
    for (const double aside : {2e-5, 6e-5, 1e-3}) {
        const Vec3 direction = Vec3(0.6, 0.8, 0.0);
        const Pose hand{Quat::Identity(), aside * direction + Vec3(0, 0, -0.02)};
        const Pose shown{Quat::Identity(), std::min(aside, play) * direction + Vec3(0, 0, -0.02)};
        const auto force = reference.at(shown, hand);
        ASSERT_TRUE(force) << aside;
        const double expected =
            kStiffness * std::max(0.0, aside - play) / (1.0 + kStiffness * peg.chamfer * peg.chamfer / kTurn);
        EXPECT_LE((*force + expected * direction).norm(), kStiffness * 1e-7) << aside;
    }
    // Beyond the plate's outer side: no reference.
    EXPECT_FALSE(reference.at({Quat::Identity(), Vec3(0.025, 0, 0.001)}, {Quat::Identity(), Vec3(0.025, 0, 0)}));
}

TEST(ForceReference, OfABallThatWeighsIsWhatTheTableDoesNotCarry) {
    // Truth: closed form: f in the air, K h down to 0 on the table, the contact K h below it.
    auto scene = sceneOf(shape::Sphere{0.02}, shape::Box{0.06, 0.06, 0.04});
    scene.parts[0].density = 7850.0;
    scene.effects.weight.gravity = Vec3(0, 0, -scene::kStandardGravity);
    const ForceReference reference(scene);
    const double f = 7850.0 * 4.0 / 3.0 * 3.14159265358979 * 1e-6 * scene::kStandardGravity;
    const double lying = 0.03, hang = f / kStiffness;
    for (const double h : {3.0 * hang, 0.7 * hang, 0.2 * hang, 0.0, -2.0 * hang}) {
        const Pose shown{Quat::Identity(), Vec3(0, 0, lying + std::max(0.0, h - hang))};
        const auto force = reference.at(shown, {Quat::Identity(), Vec3(0, 0, lying + h)});
        ASSERT_TRUE(force) << h;
        EXPECT_LE((*force - Vec3(0, 0, -std::min(f, kStiffness * h))).norm(), 1e-5) << h;
    }
}

TEST(ForceReference, OfAPegThatWeighsIsThatOfTheTick) {
    // Truth: independent program (least energy, without the tick's solver): a hand that tilts and drags a heavy peg in
    // its bore. Its turn is held by the mouth, so that the weight's torque tells.
    const shape::Peg peg{0.02, 0.05, 0.0005};
    auto scene = sceneOf(peg, shape::BorePlate{.06, .06, .03, .0202, .025, .0005});
    scene.parts[0].X_WP.p.z() = -0.015;
    scene.parts[0].density = 7850.0;
    scene.contact.geometry = scene::Geometry::ClosedForm;
    scene.effects.weight.gravity = Vec3(0, 0, -scene::kStandardGravity);
    const ForceReference reference(scene);
    ASSERT_EQ(reference.missing(), "");
    test::Bench bench(scene);
    Pose shown = scene.parts[0].X_WP;
    int compared = 0;
    for (int i = 0; i < 3000; ++i) {
        const double t = 1e-3 * i;
        const Pose hand{rotationFromVector(0.04 * Vec3(std::sin(3 * t), std::sin(2 * t), 0)),
                        Vec3(4e-4 * std::sin(4 * t), 3e-4 * std::sin(5 * t), -0.0155 + 0.001 * std::sin(2.5 * t))};
        const tick::TickOutput out = bench.step(hand);
        const Pose before = std::exchange(shown, out.X_WG);
        if (i < 100 || i % 10 != 0) continue;
        const auto force = reference.at(before, hand);
        if (!force) continue;
        ++compared;
        ASSERT_LE((*force - out.frame.F_H_W.force).norm(), 0.01) << i;
    }
    EXPECT_GT(compared, 100);
}

TEST(ForceReference, TellsWhyAPairHasNone) {
    // Truth: invariant: an oracle that does not know says so.
    EXPECT_NE(ForceReference(sceneOf(shape::Torus{.02, .004}, shape::Box{.06, .06, .04})).missing(), "");
    auto rubbing = sceneOf(shape::Sphere{0.02}, shape::Box{.06, .06, .04});
    for (auto& part : rubbing.parts) part.friction = 0.3;
    EXPECT_NE(ForceReference(rubbing).missing().find("rub"), std::string::npos);
    auto mesh = sceneOf(shape::Sphere{0.02}, shape::Box{.06, .06, .04});
    mesh.parts[1].geometry = scene::MeshFile{"a.off"};
    EXPECT_NE(ForceReference(mesh).missing().find("mesh"), std::string::npos);
}

}  // namespace
}  // namespace passung::truth
