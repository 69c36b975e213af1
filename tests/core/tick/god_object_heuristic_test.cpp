#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/tick/god_object_heuristic.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

using scene::ContactMethod;

constexpr double kCell = 0.5e-3;
const Pose kTableTop{Quat::Identity(), Vec3(0, 0, -0.02)};
const shape::Shape kTable = shape::Box{0.08, 0.08, 0.04};

Pose at(double x, double y, double z) { return {Quat::Identity(), Vec3(x, y, z)}; }

test::Bench ballOverTable(double stiffness = 1000.0) {
    auto spec = test::scene(shape::Sphere{0.02}, at(0, 0, 0.02), kTable, kTableTop, ContactMethod::GodObjectHeuristic);
    spec.contact.stiffness = stiffness;
    return test::Bench(spec);
}

TEST(GodObjectHeuristic, StaysOnPlaneWhenDevicePressesThrough) {
    // Truth: closed form. The ball's lowest point is its centre less its radius; overlap ≤ 5 % of the cell.
    test::Bench bench = ballOverTable();
    for (int i = 0; i <= 1000; ++i) {
        const double depth = -0.005 + 2e-5 * i;  // to 15 mm below the surface at 20 mm/s
        const auto out = bench.step(at(0.0003, -0.0002, 0.01 - depth));
        const double lowest = out.X_WG.p.z() - 0.01;
        EXPECT_GT(lowest, -0.05 * kCell) << "tick " << i;
        if (depth > 0.001) {
            EXPECT_LT(std::abs(lowest), 0.05 * kCell) << "tick " << i;
        }
    }
}

TEST(GodObjectHeuristic, PushesBackWithStiffnessTimesDepthAlongTheNormal) {
    // Truth: closed form. F = K h n on a plane, up to the overlap that the proxy keeps.
    test::Bench bench = ballOverTable(800.0);
    tick::TickOutput out;
    for (int i = 0; i < 400; ++i) out = bench.step(at(0, 0, 0.01 - std::min(0.004, 2e-5 * i)));
    EXPECT_NEAR(out.frame.F_H_W.force.z(), 800.0 * 0.004, 800.0 * 0.05 * kCell);
    EXPECT_LT(std::hypot(out.frame.F_H_W.force.x(), out.frame.F_H_W.force.y()), 1e-3 * out.frame.F_H_W.force.z());
}

TEST(GodObjectHeuristic, SlidesWithoutFrictionAlongAPlane) {
    // Truth: invariant. No effect of the scene brakes along the surface.
    test::Bench bench = ballOverTable();
    tick::TickOutput out;
    for (int i = 0; i < 300; ++i) out = bench.step(at(0, 0, 0.01 - std::min(0.003, 2e-5 * i)));
    for (int i = 0; i < 500; ++i) {
        out = bench.step(at(3e-5 * i, 1e-5 * i, 0.007));
        const Vec3 force = out.frame.F_H_W.force;
        EXPECT_LT(std::hypot(force.x(), force.y()), 0.01 * force.z()) << "tick " << i;
    }
    EXPECT_NEAR(out.X_WG.p.x(), 3e-5 * 499, 2e-5);
}

TEST(GodObjectHeuristic, FollowsTheHandExactlyInFreeMotion) {
    // Truth: invariant. Without contact G = H and the wrench is zero, from rest to 5 m/s, down to a hundredth of a
    // millimetre over the table.
    test::Bench bench = ballOverTable();
    Random random(3);
    Vec3 hand(0, 0, 0.03);
    for (int i = 0; i < 3000; ++i) {
        const double speed = 5.0 * std::pow(random.uniform(), 3);
        const Vec3 goal(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02),
                        0.01001 + 0.03 * std::pow(random.uniform(), 4));
        const Vec3 way = goal - hand;
        hand += std::min(1.0, speed * 1e-3 / way.norm()) * way;
        const Vec3 turn(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), 0);
        const auto out = bench.step(Pose{rotationFromVector(turn), hand});
        ASSERT_LT((out.X_WG.p - hand).norm(), 1e-9) << "tick " << i << " at " << speed << " m/s, z = " << hand.z();
        ASSERT_LT(out.frame.F_H_W.force.norm(), 1e-5) << "tick " << i;
    }
}

/// Exact distance of `p` from the rectangle |x| ≤ a, |y| ≤ b, z = 0.
double distanceFromRectangle(const Vec3& p, double a, double b) {
    return Vec3(std::max(0.0, std::abs(p.x()) - a), std::max(0.0, std::abs(p.y()) - b), p.z()).norm();
}

TEST(GodObjectHeuristic, NeverLetsABallThroughAZeroThicknessSheet) {
    // Truth: closed form. The ball's centre stays a radius away from the rectangle, at every tick and between them, for
    // any tilt, from both sides, over the middle and at the border, with and without a budget of nodes.
    constexpr double kHalf = 0.03, kRadius = 0.005;
    auto spec = test::scene(shape::Sphere{2 * kRadius}, Pose{}, shape::Sheet{2 * kHalf, 2 * kHalf}, Pose{},
                            ContactMethod::GodObjectHeuristic);
    Random random(11);
    for (const int budget : {0, 500, 100, 20}) {
        for (const double speed : {0.1, 0.5, 2.0, 5.0}) {
            for (int stroke = 0; stroke < 12; ++stroke) {
                const double side = stroke % 2 == 0 ? 1.0 : -1.0;
                const Quat tilt = rotationFromVector(Vec3(random.normal(), random.normal(), random.normal()));
                const Pose X_WSheet{tilt, Vec3(random.uniform(-0.01, 0.01), 0.003, 0.002)};
                const double off = stroke < 6 ? 0.015 : kHalf + random.uniform(-0.004, 0.004);
                Vec3 hand(off, random.uniform(-0.015, 0.015), side * 0.02);
                const Vec3 drift(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), -side);
                spec.parts[0].X_WP = {Quat::Identity(), X_WSheet * hand};
                spec.parts[1].X_WP = X_WSheet;
                spec.contact.budget_nodes = budget;
                test::Bench bench(spec);
                Vec3 before = hand;
                for (int i = 0; i < static_cast<int>(0.05 / (speed * 1e-3)); ++i) {
                    hand += speed * 1e-3 * drift;
                    const auto out = bench.step(Pose{Quat::Identity(), X_WSheet * hand});
                    const Vec3 centre = X_WSheet.inverse() * out.X_WG.p;
                    for (const double part : {0.25, 0.5, 0.75, 1.0}) {
                        const Vec3 between = before + part * (centre - before);
                        ASSERT_GT(distanceFromRectangle(between, kHalf, kHalf), kRadius)
                            << "budget " << budget << " speed " << speed << " stroke " << stroke << " tick " << i;
                    }
                    before = centre;
                }
            }
        }
    }
}

TEST(GodObjectHeuristic, NeverLetsATumblingBoxThroughASheet) {
    // Truth: closed form. A box is the convex hull of its corners: while all eight are on their side, so is the box.
    constexpr double kHalf = 0.01;
    auto spec = test::scene(shape::Box{2 * kHalf, kHalf, 3 * kHalf}, at(0, 0, 0.03), shape::Sheet{0.2, 0.2}, Pose{},
                            ContactMethod::GodObjectHeuristic);
    spec.contact.cell = 1e-3;
    for (const int budget : {0, 300, 40}) {
        spec.contact.budget_nodes = budget;
        Random random(17);
        for (int stroke = 0; stroke < 6; ++stroke) {
            test::Bench bench(spec);
            const Vec3 spin(random.normal(), random.normal(), random.normal());
            for (int i = 0; i < 1200; ++i) {
                const Quat turn = rotationFromVector(0.004 * i * spin);
                const auto out = bench.step(Pose{turn, Vec3(5e-6 * i, 0, 0.03 - 1e-4 * std::min(i, 600))});
                for (int corner = 0; corner < 8; ++corner) {
                    const Vec3 p(corner & 1 ? kHalf : -kHalf, corner & 2 ? 0.5 * kHalf : -0.5 * kHalf,
                                 corner & 4 ? 1.5 * kHalf : -1.5 * kHalf);
                    ASSERT_GT((out.X_WG * p).z(), 0.0) << "budget " << budget << " stroke " << stroke << " tick " << i;
                }
            }
        }
    }
}

TEST(GodObjectHeuristic, FollowsAPegIntoABoreOfFiftyMicrometresWithoutGivingUp) {
    // Truth: closed form for the depth (the bore reaches to -30 mm, the hand goes 25 mm down), invariant for the rest:
    // the solver ends by itself in all ticks but a few whose way bends, and no step has to be taken back. Pushed and
    // tilted all the way.
    for (const double rotational_stiffness : {1.0, 10.0}) {
        auto spec = test::scene(shape::Peg{0.02, 0.05, 0.001}, at(0, 0, 0.01),
                                shape::BorePlate{0.06, 0.06, 0.03, 0.0201, 0.03, 0.001}, Pose{},
                                ContactMethod::GodObjectHeuristic);
        spec.contact.stiffness = 3000;
        spec.contact.rotational_stiffness = rotational_stiffness;
        spec.contact.spacing = 1.5e-3;
        test::Bench bench(spec);
        int limits = 0, rejected = 0;
        tick::TickOutput out;
        for (int i = 0; i < 6000; ++i) {
            const double t = 1e-3 * i, size = std::min(t, 1.0) * 6e-4;
            const Vec3 p(size * std::cos(20 * t), size * std::sin(17 * t), 0.01 - 0.007 * std::min(t, 5.0));
            out =
                bench.step(Pose{rotationFromVector(Vec3(0.02 * std::sin(9 * t), 0.02 * std::cos(7 * t), 0.05 * t)), p});
            limits += (out.frame.status & kIterationLimit) != 0 ? 1 : 0;
            rejected += (out.frame.status & kStepRejected) != 0 ? 1 : 0;
            ASSERT_LT(out.frame.proxy_depth, 0.05 * kCell) << i;
        }
        EXPECT_LT(out.X_WG.p.z(), -0.0245);
        EXPECT_LE(limits, 12);
        EXPECT_EQ(rejected, 0);
    }
}

TEST(GodObjectHeuristic, LeavesACornerForceAlongTheBisector) {
    // Truth: closed form. Two equal constraints: a ball pressed into the edge between a floor and a wall along the
    // bisector is pushed back along it. The scene is turned at random to show that the grid has no say.
    Random random(5);
    for (int trial = 0; trial < 5; ++trial) {
        const Quat turn = rotationFromVector(Vec3(random.normal(), random.normal(), random.normal()));
        auto spec = test::scene(shape::Sphere{0.01}, {turn, turn * Vec3(0.012, 0, 0.012)}, shape::Box{0.05, 0.05, 0.02},
                                {turn, turn * Vec3(0.025, 0, -0.01)}, ContactMethod::GodObjectHeuristic);
        spec.parts.push_back(
            {.name = "wall", .geometry = shape::Box{0.02, 0.05, 0.05}, .X_WP = {turn, turn * Vec3(-0.01, 0, 0.02)}});
        test::Bench bench(spec);
        tick::TickOutput out;
        for (int i = 0; i < 600; ++i) {
            const double along = 0.012 - std::min(0.010, 2e-5 * i);
            out = bench.step(Pose{turn, turn * Vec3(along, 0, along)});
        }
        const Vec3 bisector = turn * Vec3(1, 0, 1).normalized();
        EXPECT_LT(std::acos(std::min(1.0, out.frame.F_H_W.force.normalized().dot(bisector))), 0.02);
        const Vec3 centre = turn.conjugate() * out.X_WG.p;
        EXPECT_GT(centre.x(), 0.005 - 0.05 * kCell);
        EXPECT_GT(centre.z(), 0.005 - 0.05 * kCell);
    }
}

TEST(GodObjectHeuristic, LeavesADeepOverlapWithoutAKick) {
    // Truth: invariant. Started 2 mm inside, the proxy comes out; no tick moves it by more than the step limits allow.
    auto spec = test::scene(shape::Sphere{0.02}, at(0, 0, 0.008), kTable, kTableTop, ContactMethod::GodObjectHeuristic);
    test::Bench bench(spec);
    Pose last = at(0, 0, 0.008);
    tick::TickOutput out;
    for (int i = 0; i < 200; ++i) {
        out = bench.step(at(0, 0, 0.008));
        EXPECT_LT((out.X_WG.p - last.p).norm(), 0.004);
        last = out.X_WG;
    }
    EXPECT_GT(out.X_WG.p.z(), 0.01 - 0.05 * kCell);
}

TEST(GodObjectHeuristic, PullsNobodyBackToWhereTheDeviceIsBelievedToHaveBeenByMistake) {
    // Truth: invariant. A first reading from above the table, the true place below it: there, free, no force is sent.
    test::Bench bench = ballOverTable();
    bench.step(at(0, 0, 0.03));
    double most = 0.0;
    for (int i = 0; i < 100; ++i) most = std::max(most, bench.step(at(0, 0, -0.06)).F_D_B.force.norm());
    EXPECT_EQ(most, 0.0);
    EXPECT_LT((bench.state().X_WG.p - Vec3(0, 0, -0.06)).norm(), 1e-12);
}

TEST(GodObjectHeuristic, StaysOnItsSideOfAPlateThroughADriverThatIsStuck) {
    // Truth: closed form (the ball rests on the plate, a radius above it). Pressed 11 mm into a plate of 4 mm; the
    // driver then repeats a pose half a metre away, for fewer ticks than it takes to get there at 20 m/s.
    for (const int wrong : {1, 2, 3, 10, 20}) {
        auto spec = test::scene(shape::Sphere{0.02}, at(0, 0, 0.012), shape::Box{0.08, 0.08, 0.004}, at(0, 0, -0.002),
                                ContactMethod::GodObjectHeuristic);
        test::Bench bench(spec);
        for (int i = 0; i < 500; ++i) bench.step(at(0, 0, 0.012 - 2.6e-5 * i));
        for (int i = 0; i < wrong; ++i) bench.step(at(0.5, 0, 0));
        const auto out = bench.step(at(0, 0, -0.001));
        EXPECT_NEAR(out.X_WG.p.z(), 0.01, 0.05 * kCell) << wrong;
        EXPECT_NEAR(out.F_D_B.force.z(), 11.0, 0.1) << wrong;
    }
}

TEST(GodObjectHeuristic, KeepsABoxOnItsSideOfASheetAtEveryBudget) {
    // Truth: closed form. The lowest corner of a tilted box that is pushed down slowly and fast stays over the sheet's
    // zero level, one cell in front of it, up to the overlap that is accepted. (Above 0.1 m/s: the tests before.)
    constexpr double kHalf[3] = {0.02, 0.02, 0.03};
    for (const int budget : {0, 300, 100, 40, 20, 10}) {
        for (const double speed : {0.002, 0.02, 0.1}) {
            Random random(3);
            for (int stroke = 0; stroke < 3; ++stroke) {
                const Quat turn = rotationFromVector(Vec3(random.normal(), random.normal(), random.normal()));
                const auto lowestCorner = [&](const Pose& X_WG) {
                    double lowest = 1.0;
                    for (int corner = 0; corner < 8; ++corner) {
                        const Vec3 p(corner & 1 ? kHalf[0] : -kHalf[0], corner & 2 ? kHalf[1] : -kHalf[1],
                                     corner & 4 ? kHalf[2] : -kHalf[2]);
                        lowest = std::min(lowest, (X_WG * p).z());
                    }
                    return lowest;
                };
                const double high = kCell + 0.5e-3 - lowestCorner({turn, Vec3::Zero()});
                auto spec = test::scene(shape::Box{2 * kHalf[0], 2 * kHalf[1], 2 * kHalf[2]}, {turn, Vec3(0, 0, high)},
                                        shape::Sheet{0.3, 0.3}, Pose{}, ContactMethod::GodObjectHeuristic);
                spec.contact.budget_nodes = budget;
                test::Bench bench(spec);
                const double step = 1e-3 * speed;
                for (int i = 0; i < std::min(1000, static_cast<int>(0.03 / step)); ++i) {
                    const auto out = bench.step(Pose{turn, Vec3(0.2 * step * i, 0, high - step * i)});
                    ASSERT_GT(lowestCorner(out.X_WG), kCell - 0.05 * kCell)
                        << "budget " << budget << " speed " << speed << " stroke " << stroke << " tick " << i;
                }
            }
        }
    }
}

TEST(GodObjectHeuristic, SaysSoWhereTheHandIsTooFastToFollow) {
    // Truth: invariant. Just over a table, faster and faster: where the proxy lags the status says it.
    auto spec = test::scene(shape::Box{0.02, 0.02, 0.01}, at(0, 0, 0.0051), kTable, kTableTop,
                            ContactMethod::GodObjectHeuristic);
    test::Bench bench(spec);
    Vec3 hand(0, 0, 0.0051);
    int lagging = 0;
    for (int i = 0; i < 1400; ++i) {  // up to 20 m/s
        hand.x() = 0.02 * std::sin(3.5e-4 * i * i);
        const auto out = bench.step(Pose{Quat::Identity(), hand});
        const bool lags = (out.X_WG.p - hand).norm() > 1e-6;
        lagging += lags ? 1 : 0;
        ASSERT_EQ(lags, (out.frame.status & kIterationLimit) != 0) << "tick " << i;
    }
    EXPECT_GT(lagging, 10);
}

TEST(GodObjectHeuristic, GoesRoundSharpEdgesWithoutFallingIn) {
    // Truth: invariant. A box is dragged and turned over the edges of another at up to 1.5 m/s: what a step leaves of
    // overlap is pushed out before it comes to kAccept, so that hardly any step has to be taken back.
    auto spec = test::scene(shape::Box{0.02, 0.02, 0.02}, at(0, 0, 0.03), shape::Box{0.03, 0.03, 0.02}, Pose{},
                            ContactMethod::GodObjectHeuristic);
    test::Bench bench(spec);
    int rejected = 0;
    for (int i = 0; i < 4000; ++i) {
        const double t = 1e-3 * i;
        const Pose X_WH{rotationFromVector(Vec3(std::sin(11 * t), std::cos(7 * t), std::sin(5 * t))),
                        Vec3(0.03 * std::sin(9 * t), 0.03 * std::cos(13 * t), 0.03 * std::cos(3 * t))};
        const auto out = bench.step(X_WH);
        if (i < 20) continue;
        ASSERT_LE(out.frame.proxy_depth, tick::kAccept * kCell) << i;
        rejected += (out.frame.status & kStepRejected) != 0 ? 1 : 0;
    }
    EXPECT_LE(rejected, 4);
}

}  // namespace
}  // namespace passung
