#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/support/scenes.h"

namespace passung {
namespace {

using scene::ContactMethod;

constexpr double kHeldHalf = 0.01, kPostHalf = 0.5e-3, kPostHeight = 0.02, kStiffness = 1000.0, kTolerance = 20e-6;

/// A block whose points lie 4 mm apart, over a post 1 mm wide that ends at z = 0.
scene::SceneSpec blockOverPost(ContactMethod method, bool two_way) {
    auto spec = test::scene(shape::Box{0.04, 0.04, 2 * kHeldHalf}, {Quat::Identity(), Vec3(0, 0, 0.02)},
                            shape::Box{2 * kPostHalf, 2 * kPostHalf, kPostHeight},
                            {Quat::Identity(), Vec3(0, 0, -kPostHeight / 2)}, method);
    spec.contact.spacing = 4e-3;
    spec.contact.stiffness = kStiffness;
    spec.contact.rotational_stiffness = 100.0;  // so stiff that the block does not tilt on the post
    spec.contact.two_way = two_way;
    return spec;
}

/// The block's lower face `depth` below the post's end, its points farther than 1 mm from the post's corners.
Pose between(const test::Bench& bench, double depth) {
    for (double x = -0.01; x <= 0.01; x += 0.25e-3)
        for (double y = -0.01; y <= 0.01; y += 0.25e-3) {
            bool free = true;
            for (const shell::SurfacePoint& point : bench.model().shell->points())
                free = free && std::max(std::abs(point.position.x() + x), std::abs(point.position.y() + y)) >
                                   kPostHalf + 0.7e-3;
            if (free) return {Quat::Identity(), Vec3(x, y, kHeldHalf - depth)};
        }
    ADD_FAILURE() << "no place between the points";
    return {};
}

TEST(TwoWay, FindsThePostThatPokesAFaceBetweenItsSamples) {
    // Truth: closed form. The post's end is 0.3 mm deep under the face; one way only the face's own points are asked,
    // none of which is over the post.
    constexpr double kDepth = 0.3e-3;
    for (const bool two_way : {false, true}) {
        test::Bench bench(blockOverPost(ContactMethod::Penalty, two_way));
        const auto out = bench.step(between(bench, kDepth));
        if (!two_way) {
            EXPECT_EQ(out.frame.proxy_depth, 0.0);
            EXPECT_EQ(out.frame.F_H_W.force.norm(), 0.0);
            continue;
        }
        EXPECT_NEAR(out.frame.proxy_depth, kDepth, kTolerance);
        EXPECT_NEAR(out.frame.F_H_W.force.z(), kStiffness * kDepth, kStiffness * kTolerance);
        EXPECT_LT(out.frame.F_H_W.force.head<2>().norm(), 0.01 * kStiffness * kDepth);
    }
}

TEST(TwoWay, KeepsTheProxyOnThePostThatItsSamplesMiss) {
    // Truth: closed form. The face rests on the post's end while the hand goes 2 mm deeper; overlap ≤ 5 % of the cell
    // and the field's tolerance. One way the proxy follows the hand.
    for (const bool two_way : {false, true}) {
        test::Bench bench(blockOverPost(ContactMethod::GodObjectHeuristic, two_way));
        Pose hand = between(bench, -1e-3);
        tick::TickOutput out;
        for (int i = 0; i < 150; ++i) {
            hand.p.z() -= 2e-5;
            out = bench.step(hand);
        }
        const double face = out.X_WG.p.z() - kHeldHalf;
        if (two_way) {
            EXPECT_NEAR(face, 0.0, 0.05 * bench.model().finest_cell + kTolerance);
            EXPECT_NEAR(out.frame.hand_depth, 2e-3, kTolerance);
            EXPECT_NEAR(out.frame.F_H_W.force.z(), kStiffness * 2e-3, 0.05 * kStiffness * 2e-3);
        } else {
            EXPECT_NEAR(face, -2e-3, 1e-6);
        }
    }
}

TEST(TwoWay, GivesTheMeanOfBothWaysOfASphereInAPlane) {
    // Truth: closed form. From the ball's points F = κ × volume of the cap; from the table's points κ ∫ (R - distance
    // from the centre) dA over the disc that the face cuts out. Sums over a disc of 9 mm radius sampled every 0.7 mm:
    // 1 %.
    constexpr double R = 0.02, h = 0.002, off = R - h;
    auto spec = test::scene(shape::Sphere{2 * R}, {Quat::Identity(), Vec3(0, 0, 0.1)}, shape::Box{0.03, 0.03, 0.02},
                            {Quat::Identity(), Vec3(0, 0, -0.01)}, ContactMethod::Penalty);
    spec.contact.cell = 0.7e-3;
    spec.contact.spacing = 0.7e-3;
    spec.contact.variant = scene::PenaltyVariant::AreaWeighted;
    spec.contact.two_way = true;
    test::Bench bench(spec);
    const auto out = bench.step(Pose{Quat::Identity(), Vec3(0, 0, R - h)});
    const auto cube = [](double x) { return x * x * x; };
    const double cap = std::numbers::pi * h * h * (3 * R - h) / 3;
    const double disc = std::numbers::pi * (R * (R * R - off * off) - 2.0 / 3.0 * (cube(R) - cube(off)));
    const double expected = spec.contact.area_stiffness * 0.5 * (cap + disc);
    EXPECT_NEAR(out.frame.F_H_W.force.z(), expected, 0.01 * expected);
    EXPECT_LT(out.frame.F_H_W.force.head<2>().norm(), 0.01 * expected);
    EXPECT_LT(out.frame.F_H_W.torque.norm(), 0.01 * expected * R);
}

TEST(TwoWay, IsBuiltAndNamedOnlyWhereASceneAsksForIt) {
    // Truth: invariant. What is absent is not built; what is there is told with the key that asked for it.
    for (const auto method : {ContactMethod::Penalty, ContactMethod::GodObjectHeuristic}) {
        for (const bool two_way : {false, true}) {
            test::Bench bench(blockOverPost(method, two_way));
            EXPECT_EQ(bench.model().held_field != nullptr, two_way);
            EXPECT_EQ(bench.model().obstacles.front().shell != nullptr, two_way);
            bool named = false;
            for (const tick::Stage& stage : bench.model().stages)
                named = named || std::string(stage.reason).find("contact.two_way") != std::string::npos;
            EXPECT_EQ(named, two_way);
        }
    }
}

}  // namespace
}  // namespace passung
