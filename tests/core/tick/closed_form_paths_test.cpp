#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/base/processor_clock.h"
#include "core/base/random.h"
#include "core/tick/closed_form_proxy.h"
#include "tests/core/closed_form/peg_reference.h"
#include "tests/core/tick/wander.h"
#include "tests/hard/dense_overlap.h"
#include "tests/support/scenes.h"
#include "tests/support/surface_cases.h"

// God objects on closed forms along paths of a hand: overlap, grain, what holds. Forces are the spring's alone.

namespace passung::tick {
namespace {

using closed_form::PegReference;
using scene::ContactMethod;

constexpr double kStiffness = 2000.0;  // [N/m]
constexpr double kOverlap = 1e-7;      // [m]
constexpr std::array kPlays{100e-6, 50e-6, 10e-6};
const shape::Peg kPeg{.02, .05, .0005};

shape::BorePlate bore(double play) { return {.06, .06, .03, .02 + 2.0 * play, .025, .0005}; }

scene::SceneSpec sceneOf(const shape::Shape& held, const Pose& start, const shape::Shape& fixed,
                         ContactMethod method = ContactMethod::GodObject) {
    auto spec = test::scene(held, start, fixed, Pose{}, method);
    spec.contact.geometry = scene::Geometry::ClosedForm;
    spec.contact.stiffness = kStiffness;
    spec.contact.rotational_stiffness = 1.0;
    return spec;
}

constexpr double kInserted = 0.5;  // [s]: the peg is in the bore
constexpr double kRamp = 0.8;      // [s]: until it wanders freely

/// Into the bore, then about in it: pulled aside with up to 6 N, tilted by up to 3 degrees, turned.
struct PegHand {
    Random random;
    double middle, amplitude;  // of the tip's depth [m]
    std::array<test::Wander, 5> wander{
        {{random, 1.2, kRamp}, {random, 1.2, kRamp}, {random, 0.6, kRamp}, {random, 1.2, kRamp}, {random, 1.2, kRamp}}};

    Pose at(double t) const {
        const double in = std::min(1.0, t / kInserted), inside = std::max(0.0, t - kInserted);
        const Vec3 p(0.003 * wander[0].at(inside), 0.003 * wander[1].at(inside),
                     0.0005 + (middle - 0.0005) * in * in * (3.0 - 2.0 * in) + amplitude * wander[2].at(inside));
        const Vec3 tilt(0.037 * wander[3].at(inside), 0.037 * wander[4].at(inside), 0.0);
        return {rotationFromVector(tilt) * rotationFromVector(Vec3(0, 0, inside)), p};
    }
};

PegReference::Row pullOf(const Pose& X, const Pose& hand, double rho) {
    PegReference::Row pull;
    pull << hand.p - X.p, rho * rotationVector(hand.q * X.q.conjugate());
    return pull;
}

class PegPaths : public testing::TestWithParam<ContactMethod> {};

TEST_P(PegPaths, InTheBoreNothingCatchesAndTheLeastEnergyIsHeld) {
    // Truth: closed form: normals of wall and peg are level but for the tilt, so that none holds the tilted peg along
    // its axis by more than its share; dense points (peg_reference.h) overlap nowhere and can push what is felt.
    for (const double play : kPlays) {
        double step = 0.0, beyond = 0.0, deepest = 0.0, between = 0.0, unheld = 0.0;
        std::int64_t spent = 0;
        int ticks = 0;
        std::uint32_t looks = 0;
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const PegHand hand{Random(seed), -0.012, 0.006};
            test::Bench bench(sceneOf(kPeg, hand.at(0.0), bore(play), GetParam()));
            const PegReference truth(kPeg, bore(play), bench.model().metric_radius, 2048);
            Vec3 before = Vec3::Zero();
            Pose X_before = hand.at(0.0);
            for (int i = 0; i < 2200; ++i) {
                const Pose X_WH = hand.at(1e-3 * i);
                const std::int64_t begin = threadProcessorNanoseconds();
                const TickOutput out = bench.step(X_WH);
                spent += threadProcessorNanoseconds() - begin;
                ++ticks;
                const Vec3 force = out.F_D_B.force;
                if (i > 1000 * kInserted) {
                    const Pose X_last = hand.at(1e-3 * (i - 1));
                    step = std::max(step, (force - before).norm());
                    beyond = std::max(beyond, (force - before).norm() - kStiffness * (X_WH.p - X_last.p).norm());
                    looks = std::max(looks, out.frame.iterations);
                    ASSERT_EQ(out.frame.status & kIterationLimit, 0u) << i;
                }
                if (i % 40 == 0) {
                    deepest = std::max(deepest, -truth.least(out.X_WG));
                    for (const double s : {0.25, 0.5, 0.75})
                        between = std::max(between, -truth.least({X_before.q.slerp(s, out.X_WG.q),
                                                                  X_before.p + s * (out.X_WG.p - X_before.p)}));
                    if (i > 1000 * kInserted)
                        unheld = std::max(unheld, truth.unheld(out.X_WG, pullOf(out.X_WG, X_WH, 22.4e-3), 2e-7));
                }
                before = force;
                X_before = out.X_WG;
            }
        }
        std::printf(
            "play %3.0f um: step %.4f N a tick, beyond the hand's %.4f N, overlap %.3f um, between %.3f um, "
            "unheld %.4f N, most looks %u, mean %.1f us\n",
            1e6 * play, step, beyond, 1e6 * deepest, 1e6 * between, kStiffness * unheld, looks,
            1e-3 * static_cast<double>(spent) / ticks);
        EXPECT_LE(beyond, 0.05);
        EXPECT_LE(deepest, kOverlap);
        EXPECT_LE(between, kOverlap);
        EXPECT_LE(kStiffness * unheld, 0.01);
        EXPECT_LE(looks, 8u);
    }
}

INSTANTIATE_TEST_SUITE_P(GodObjects, PegPaths,
                         testing::Values(ContactMethod::GodObject, ContactMethod::GodObjectHeuristic),
                         [](const auto& made) {
                             return made.param == ContactMethod::GodObject ? "god_object" : "god_object_heuristic";
                         });

TEST(ClosedFormPaths, ATiltedPegIsNotHeldAlongItsAxis) {
    // Truth: closed form: with 6 N sideways and a tilt that the play allows, contact normals lean by no more than that
    // tilt, so that |Fz| is at most 6 N · 2 times it; the hand goes down and up at 30 mm/s.
    for (const double play : kPlays) {
        test::Bench bench(sceneOf(kPeg, {Quat::Identity(), Vec3(0, 0, 0.002)}, bore(play)));
        double most = 0.0, step = 0.0, lag = 0.0;
        Vec3 before = Vec3::Zero();
        for (int i = 0; i < 3000; ++i) {
            const double t = 1e-3 * i, in = std::min(1.0, t / 0.6), aside = std::clamp((t - 0.6) / 0.6, 0.0, 1.0);
            const double smooth = aside * aside * (3.0 - 2.0 * aside);
            const Pose X_WH{
                rotationFromVector(Vec3(0, 0.05 * smooth, 0)),
                Vec3(0.003 * smooth, 0,
                     0.002 - 0.014 * in * in * (3.0 - 2.0 * in) - 0.0047 * smooth * std::sin(6.0 * (t - 0.6)))};
            const TickOutput out = bench.step(X_WH);
            if (t > 1.2) {
                most = std::max(most, std::abs(out.F_D_B.force.z()));
                step = std::max(step, (out.F_D_B.force - before).norm());
                lag = std::max(lag, std::abs(out.X_WG.p.z() - X_WH.p.z()));
            }
            before = out.F_D_B.force;
        }
        std::printf("play %3.0f um: |Fz| %.4f N, step %.4f N a tick\n", 1e6 * play, most, step);
        EXPECT_LE(most, 12.0 * 2.0 * play / 0.008);
        EXPECT_LE(step, 0.05);
        EXPECT_LE(lag, 4e-5);
    }
}

TEST(ClosedFormPaths, AnAlignedPegGoesInAtAnySpeedAsIfNothingWereThere) {
    // Truth: closed form: the peg on the bore's axis overlaps nowhere, so that no pose is nearer to the hand than it.
    // What held it back by the chamfer in the tick before is no obstacle once its body is in the bore.
    for (const double play : kPlays)
        for (const double speed : {0.007, 0.022, 0.05, 0.1})
            for (int k = 0; k < 8; ++k) {
                const double start = -0.0005 + 1e-3 * speed * k / 8.0;
                test::Bench bench(sceneOf(kPeg, {Quat::Identity(), Vec3(0, 0, start)}, bore(play)));
                double lag = 0.0;
                for (int i = 0; i < 200; ++i) {
                    const Pose X_WH{Quat::Identity(), Vec3(0, 0, start - 1e-3 * i * speed)};
                    lag = std::max(lag, (bench.step(X_WH).X_WG.p - X_WH.p).norm());
                }
                EXPECT_LE(lag, 1e-6) << play << " " << speed << " " << k;
            }
}

/// What a stroke is made with.
struct Stroke {
    const char* name;
    shape::Shape held, fixed;
    Vec3 start, end;  // of the hand; beyond the obstacle
};

std::vector<Stroke> strokes() {
    using namespace shape;
    return {
        {"box through foil", Box{.01, .012, .008}, Box{.06, .06, 20e-6}, {0, 0, .02}, {.003, 0, -.02}},
        {"needle through foil", Cylinder{.0004, .03}, Box{.06, .06, 50e-6}, {0, 0, .02}, {.001, 0, -.04}},
        {"pin under a face", Box{.03, .03, .01}, Cylinder{.001, .01}, {.001, 0, .015}, {.001, 0, -.02}},
        {"long bar on an edge", Cylinder{.004, .2}, Box{.05, .01, .05}, {.05, 0, .06}, {.04, .002, -.06}},
        {"ball through a thin ring", Sphere{.008}, Torus{.02, .0006}, {.01, 0, .01}, {.01, 0, -.01}},
        {"foil on a pin", Box{.03, .03, 30e-6}, Cylinder{.0005, .01}, {.003, .002, .01}, {.003, .002, -.01}},
        {"small ball on foil", Sphere{.0002}, Box{.06, .06, 20e-6}, {0, 0, .002}, {.0005, 0, -.02}},
    };
}

TEST(ClosedFormPaths, NoStrokeOfTheHandPassesAnObstacleAtAnySpeed) {
    // Truth: dense points of both surfaces against exact distances, at every pose that the proxy went through and five
    // places between them; a part that is through lies beyond the obstacle.
    for (const Stroke& stroke : strokes()) {
        SCOPED_TRACE(stroke.name);
        for (const double speed : {0.05, 1.0, 10.0}) {
            Random random(7);
            const Vec3 turn = 0.4 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            test::Bench bench(sceneOf(stroke.held, {Quat::Identity(), stroke.start}, stroke.fixed));
            hard::DenseDistance dense(hard::denseBody(stroke.held, 5e-4),
                                      {{hard::denseBody(stroke.fixed, 5e-4), Pose{}}});
            const int ticks = std::max(1, static_cast<int>((stroke.end - stroke.start).norm() / speed * 1e3));
            double deepest = 0.0, between = 0.0;
            Pose X_last{Quat::Identity(), stroke.start};
            for (int i = 1; i <= ticks + 60; ++i) {
                const double s = std::min(1.0, static_cast<double>(i) / ticks);
                bench.step(Pose{rotationFromVector(s * turn), stroke.start + s * (stroke.end - stroke.start)});
                if (ticks > 200 && i % 8 != 0) continue;
                X_last = bench.state().solver.way().front();
                for (const Pose& X : bench.state().solver.way()) {
                    deepest = std::max(deepest, -dense.least(X, 0.0));
                    for (const double share : {0.2, 0.4, 0.5, 0.6, 0.8})
                        between = std::max(
                            between,
                            -dense.least({X_last.q.slerp(share, X.q), X_last.p + share * (X.p - X_last.p)}, 0.0));
                    X_last = X;
                }
            }
            std::printf("%s at %.2f m/s: overlap %.3f um, between %.3f um\n", stroke.name, speed, 1e6 * deepest,
                        1e6 * between);
            EXPECT_LE(deepest, kOverlap);
            EXPECT_LE(between, kOverlap);
        }
    }
}

TEST(ClosedFormPaths, WhereTheHandSnapsPastAnEdgeTheWayIsFreeToo) {
    // Truth: dense points of both surfaces against exact distances, at nine places between the poses that the proxy
    // went through. Hands of less than 40 mm/s lead pegs over the edges of their mouths, past which they slip by
    // millimetres.
    struct Mouth {
        shape::Shape held, fixed;
        double size;  // of the hand's way [m]
    };
    for (const Mouth& mouth : {Mouth{shape::Peg{.02, .05, .0005}, bore(50e-6), .006},
                               Mouth{shape::SquarePeg{.02, .016, .05, .0005},
                                     shape::SquareBorePlate{.06, .06, .03, .0201, .0161, .025, .0005}, .0048}}) {
        const Pose start{Quat::Identity(), Vec3(0, 0, .002)};
        const test::RandomPath hand(start, {0, 0, -.5 * mouth.size}, Vec3::Constant(mouth.size), 0.5, 4);
        test::Bench bench(sceneOf(mouth.held, start, mouth.fixed));
        hard::DenseDistance dense(hard::denseBody(mouth.held, 1e-3), {{hard::denseBody(mouth.fixed, 1e-3), Pose{}}});
        double deepest = 0.0, farthest = 0.0;
        for (int i = 0; i < 1200; ++i) {
            bench.step(hand(1e-3 * i));
            const auto way = bench.state().solver.way();
            farthest = std::max(farthest, (way.back().p - way.front().p).norm());
            for (std::size_t k = 1; k < way.size(); ++k)
                for (int j = 1; j < 10; ++j)
                    deepest = std::max(deepest, -dense.least({way[k - 1].q.slerp(0.1 * j, way[k].q),
                                                              way[k - 1].p + 0.1 * j * (way[k].p - way[k - 1].p)},
                                                             -deepest));
        }
        std::printf("overlap on the way %.3f um, farthest in a tick %.0f um\n", 1e6 * deepest, 1e6 * farthest);
        EXPECT_LE(deepest, kOverlap);
        EXPECT_GT(farthest, 5e-4);
    }
}

}  // namespace
}  // namespace passung::tick
