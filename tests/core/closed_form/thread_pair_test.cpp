#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>

#include "core/base/processor_clock.h"
#include "core/closed_form/pose_solver.h"
#include "core/closed_form/solid.h"
#include "tests/core/closed_form/thread_reference.h"
#include "tests/support/length.h"
#include "tests/support/rt_guard.h"

// A parametric bolt in a nut of the same pitch: nut's frame, forces are the spring's alone.

namespace passung::closed_form {
namespace {

constexpr double kRho = 22.4e-3;       // [m]
constexpr double kStiffness = 2000.0;  // [N/m]
constexpr double kOverlap = 1e-7;      // [m]
constexpr double kTurn = 2.0 * std::numbers::pi;

struct Size {
    double diameter, pitch, chamfer;  // of the nut [m]
};
const std::array kSizes{Size{.008, .00125, .0}, Size{.008, .00125, .0009}, Size{.012, .0015, .0006},
                        Size{.02, .0045, .0},   Size{.002, .0004, .0002},  Size{.012, .001, .0}};

struct BoltInNut {
    shape::ThreadBolt bolt;
    shape::ThreadNut nut;
    SmoothSolid of_bolt, of_nut;
    bool nut_is_held;
    SolidPair pair;
    PoseSolver solver;
    PoseMemory memory;
    Pose X;  // of the bolt in the nut's frame

    BoltInNut(const Size& size, double play, bool holds_nut = false)
        : bolt{size.diameter - 2.0 * play, size.pitch, 2.0 * size.diameter, size.chamfer},
          nut{size.diameter, size.pitch, 1.6 * size.diameter, 0.8 * size.diameter, size.chamfer},
          of_bolt(*solidOf(bolt)),
          of_nut(*solidOf(nut)),
          nut_is_held(holds_nut),
          pair{holds_nut ? &of_nut : &of_bolt, holds_nut ? &of_bolt : &of_nut, {}, motion::Metric{kRho}},
          solver({&pair, 1}) {}

    double lead() const { return bolt.pitch / kTurn; }
    /// Free of the nut by half of the play on every side, `z` high.
    Pose engaged(double z) const {
        return {rotationFromVector(Vec3(0, 0, std::remainder(z / lead(), kTurn))), {0, 0, z}};
    }

    ConstrainedPose follow(const Pose& hand) {
        ConstrainedPose found = solver.solve(ofHeld(X), ofHeld(hand), memory, kThreadLooks);
        X = ofHeld(found.X_WG);
        return found;
    }
    /// The held part's where the bolt is at X in the nut's frame.
    Pose ofHeld(const Pose& pose) const { return nut_is_held ? pose.inverse() : pose; }
    /// Deepest overlap on the way of the last tick: at each pose without overlap, and between them.
    double overlapOnWay(const ThreadReference& truth) const {
        double most = 0.0;
        const auto at = [&](const Pose& pose) { most = std::max(most, truth.overlap(ofHeld(pose))); };
        const std::span<const Pose> way = solver.way();
        for (std::size_t i = 0; i < way.size(); ++i) {
            at(way[i]);
            for (const double s : {0.25, 0.5, 0.75})
                if (i > 0) at({way[i - 1].q.slerp(s, way[i].q), way[i - 1].p + s * (way[i].p - way[i - 1].p)});
        }
        return most;
    }
};

/// What a hand does, beside where it begins: a turn about the axis, a tilt and a way, by time.
struct Hand {
    std::string name;
    std::function<double(double)> turn;
    std::function<Vec3(double)> tilt, way;
    bool follows_thread;

    Pose at(const BoltInNut& scene, double z, double t) const {
        const double turned = turn(t);
        const Pose start = scene.engaged(z);
        const Vec3 lift(0, 0, follows_thread ? scene.lead() * turned : 0.0);
        return {rotationFromVector(tilt(t)) * rotationFromVector(Vec3(0, 0, turned)) * start.q,
                start.p + lift + scene.bolt.nominal_diameter / .008 * way(t)};
    }
};

std::vector<Hand> hands(std::uint64_t seed) {
    Random random(seed);
    std::array<double, 12> rate, phase;
    for (double& r : rate) r = kTurn * random.uniform(0.2, 0.7);
    for (double& p : phase) p = random.uniform(0.0, kTurn);
    const auto ramp = [](double t) { return std::min(1.0, t / 0.3); };
    const auto wave = [=](std::size_t i, double t) { return ramp(t) * std::sin(rate[i] * t + phase[i]); };
    const auto still = [](double) { return Vec3(0, 0, 0); };
    return {
        {"screwing_in", [](double t) { return -kTurn * t; }, still, still, true},
        {"pressed", [](double) { return 0.0; }, still, [=](double t) { return Vec3(0, 0, -2e-3 * ramp(t)); }, false},
        {"turned_alone", [](double t) { return kTurn * t; }, still, still, false},
        {"tilted", [=](double t) { return 2.0 * wave(0, t); },
         [=](double t) { return Vec3(.3 * wave(1, t), .3 * wave(2, t), 0); }, still, true},
        {"jammed_sideways", [=](double t) { return 3.0 * wave(0, t); }, still,
         [=](double t) { return Vec3(3e-3 * wave(1, t), 3e-3 * wave(2, t), 0); }, true},
        {"any_way", [=](double t) { return 4.0 * wave(0, t); },
         [=](double t) { return Vec3(.15 * wave(1, t), .15 * wave(2, t), 0); },
         [=](double t) { return Vec3(3e-3 * wave(3, t), 3e-3 * wave(4, t), 3e-3 * wave(5, t)); }, false},
        {"at_the_mouth", [=](double t) { return 4.0 * wave(0, t); },
         [=](double t) { return Vec3(.25 * wave(1, t), .25 * wave(2, t), 0); },
         [=](double t) { return Vec3(2e-3 * wave(3, t), 2e-3 * wave(4, t), 4.5e-3 + 3e-3 * wave(5, t)); }, false},
    };
}

double quantile(const std::vector<double>& values, double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

TEST(BoltInNut, IsFreeInTheMiddleOfItsPlayAndHasTheGapsOfTheProfile) {
    // Truth: closed form: radial play c at crests and roots, c/2 at flanks, less the share by which a flank's function
    // is scaled (at most 1.5 % with the coarsest pitch).
    for (const Size& size : kSizes) {
        constexpr double kPlay = 20e-6;
        BoltInNut scene(size, kPlay);
        ContactSearch search(scene.pair);
        PairContacts found;
        search.find(scene.engaged(-scene.nut.height / 2 - 1e-4), 25e-6, found);
        EXPECT_FALSE(found.full());
        int flanks = 0, roots = 0;
        for (const Contact& contact : found.all()) {
            ASSERT_GT(contact.gap, 0.97 * 0.5 * kPlay);
            const bool flank = contact.gap < 0.55 * kPlay;
            (flank ? flanks : roots) += 1;
            if (!flank) {
                EXPECT_NEAR(contact.gap, kPlay, 6e-6);
            }
        }
        const double turns = scene.nut.height / size.pitch / 2;
        EXPECT_GT(flanks, 8 * turns - 8);
        EXPECT_GT(roots, 8 * turns - 8);
    }
}

TEST(BoltInNut, AdvancesByItsPitchATurn) {
    // Truth: closed form: z = lead · turn, and pulled along the axis it lies c tan 30° off that: both flanks of a
    // ridge are 30° off the plane across the axis. As long as no end face passes another.
    // Where an end's edge comes by it holds the bolt for a tick: aside in the cone of the flanks, tan 30° of it along
    // the axis.
    constexpr double kAside = 2e-6;  // [m]
    constexpr double kPlay = 30e-6;
    for (const Size& size : kSizes) {
        for (const double pull : {-1e-3, 1e-3}) {
            BoltInNut scene(size, kPlay);
            const double start = -scene.nut.height / 2;
            scene.X = scene.engaged(start);
            double turned = 0.0, before = 0.0;
            const double turns = std::min(3.0, 0.35 * scene.nut.height / size.pitch);
            for (int tick = 0; tick < 1500; ++tick) {
                const double t = 1e-3 * tick, ramp = std::min(1.0, t / 0.3);
                const double hand = -kTurn * turns * std::max(0.0, t - 0.5);
                const Quat last = scene.X.q;
                scene.follow({rotationFromVector(Vec3(0, 0, hand)) * scene.engaged(start).q,
                              {0, 0, start + scene.lead() * hand + ramp * pull}});
                turned += rotationVector(scene.X.q * last.conjugate()).z();
                if (t < 0.5) continue;
                const double off = scene.X.p.z() - start - scene.lead() * turned;
                ASSERT_NEAR(off, std::copysign(kPlay / std::sqrt(3.0), pull), kAside / std::sqrt(3.0)) << tick;
                ASSERT_NEAR(scene.X.p.head<2>().norm(), 0.0, kPlay);
                if (tick > 510) {
                    ASSERT_NEAR(scene.X.p.z() - before, -turns * size.pitch / 1000, kAside / std::sqrt(3.0)) << tick;
                }
                before = scene.X.p.z();
            }
            EXPECT_LT(turned, -0.99 * turns * kTurn);
        }
    }
}

TEST(BoltInNut, PushedAsideRestsAtItsPlay) {
    // Truth: closed form: a flank's gap in the direction φ changes by s (sin α cos φ + cos α lead/r sin φ) with a way s
    // aside, so that s = c tan 30° / sqrt(tan² 30° + (lead/r)²), r at the crests that touch first.
    constexpr double kPlay = 30e-6;
    BoltInNut scene(kSizes[0], kPlay);
    const double start = -scene.nut.height / 2;
    scene.X = scene.engaged(start);
    ConstrainedPose found;
    for (int i = 0; i < 400; ++i) {
        Pose hand = scene.engaged(start);
        hand.p.x() = 2e-6 * i;
        found = scene.follow(hand);
    }
    EXPECT_TRUE(found.converged);
    const double radius = scene.nut.nominal_diameter / 2 - 0.625 * std::sqrt(3.0) / 2 * scene.nut.pitch;
    const double least = kPlay / std::sqrt(1.0 + 3.0 * std::pow(scene.lead() / radius, 2));
    EXPECT_GT(scene.X.p.x(), least - 1e-7);
    EXPECT_LT(scene.X.p.x(), kPlay + 1e-7);
}

class ThreadPaths : public testing::TestWithParam<bool> {};

TEST_P(ThreadPaths, OverlapNowhereCatchNowhereAndHoldTheLeastEnergy) {
    // Truth: dense points of both surfaces against the other's profile (thread_reference.h), on its way and between;
    // what dense places of the crests' edges can push holds what is felt. No step beyond the hand's. Each size has one
    // play and every third hand, looked at every twentieth tick (PASSUNG_LONG=1: the first size has three plays, each
    // size every hand, looked at every fourth tick).
    const bool long_run = test::atFullLength();
    const int every = long_run ? 4 : 20;
    std::vector<double> all;
    for (std::size_t i = 0; i < kSizes.size(); ++i) {
        constexpr std::array kShares{1e-3, 4e-3, 12e-3};  // of the diameter: 8, 32, 96 µm of an M8
        for (const double share : kShares) {
            const Size& size = kSizes[i];
            if (i > 0 && share != kShares[i % 2]) continue;
            if (i == 0 && !long_run && share != kShares.back()) continue;
            const double play = share * size.diameter;
            std::vector<double> spent;
            double deepest = 0.0, unheld = 0.0, beyond = 0.0;
            int late = 0, catches = 0, ticks = 0;
            std::size_t number = i;
            for (const Hand& hand : hands(i + 1)) {
                if (!long_run && ++number % 3 != 0) continue;
                SCOPED_TRACE(hand.name);
                BoltInNut scene(size, play, GetParam());
                const ThreadReference truth(scene.bolt, scene.nut, 6000, i);
                const double start = -scene.nut.height / 2 - play;
                const bool mouth = hand.name == "at_the_mouth", stays = hand.name == "pressed";
                scene.X = hand.at(scene, start, 0.0);
                Vec3 before = Vec3::Zero();
                Pose X_last = scene.X;
                int still = 0;
                for (int tick = 0; tick < 700; ++tick, ++ticks) {
                    const Pose X_WH = hand.at(scene, start, 1e-3 * tick),
                               X_before = hand.at(scene, start, 1e-3 * tick - 1e-3);
                    const std::int64_t begin = threadProcessorNanoseconds();
                    const ConstrainedPose found = scene.follow(X_WH);
                    spent.push_back(1e-3 * static_cast<double>(threadProcessorNanoseconds() - begin));
                    ASSERT_LE(found.overlap, kOverlap) << tick;
                    ASSERT_FALSE(found.full) << tick;
                    late += found.converged ? 0 : 1;
                    if (tick % every == 0) deepest = std::max(deepest, scene.overlapOnWay(truth));
                    if (mouth) continue;
                    const Vec3 force = kStiffness * found.pull.head<3>();
                    const double went = (scene.ofHeld(X_WH).p - scene.ofHeld(X_before).p).norm();
                    if (tick > 0) beyond = std::max(beyond, (force - before).norm() - kStiffness * went);
                    before = force;
                    const double hand_went = went + (X_WH.q * X_before.q.conjugate()).vec().norm();
                    still = !stays && hand_went > 1e-6 && (scene.X.p - X_last.p).norm() == 0.0 &&
                                    scene.X.q.coeffs() == X_last.q.coeffs()
                                ? still + 1
                                : 0;
                    catches += still == 3 ? 1 : 0;
                    X_last = scene.X;
                    if (tick % 50 != 0 || GetParam() || size.chamfer > 0.0 || !found.converged) continue;
                    unheld = std::max(unheld, truth.unheld(scene.X, found.pull, 2e-7, kRho));
                }
            }
            std::sort(spent.begin(), spent.end());
            all.insert(all.end(), spent.begin(), spent.end());
            std::printf(
                "%s of %4.1f mm, pitch %.3f, play %5.1f um: overlap %.4f um, unheld %.4f N, step beyond the "
                "hand's %.4f N, late %d, catches %d of %d; median %.0f p99.9 %.0f most %.0f us\n",
                GetParam() ? "nut" : "bolt", 1e3 * size.diameter, 1e3 * size.pitch, 1e6 * play, 1e6 * deepest,
                kStiffness * unheld, beyond, late, catches, ticks, quantile(spent, 0.5), quantile(spent, 0.999),
                spent.back());
            EXPECT_LE(deepest, kOverlap);
            EXPECT_LE(beyond, 0.1);
            EXPECT_LE(kStiffness * unheld, 0.02);
            EXPECT_EQ(catches, 0);
            EXPECT_LE(late, ticks / 1000);
        }
    }
    std::sort(all.begin(), all.end());
    std::printf("all: median %.0f p99.9 %.0f most %.0f us\n", quantile(all, 0.5), quantile(all, 0.999), all.back());
}

INSTANTIATE_TEST_SUITE_P(Held, ThreadPaths, testing::Bool(),
                         [](const auto& made) { return made.param ? "nut" : "bolt"; });

TEST(BoltInNut, PressedInOverlapsByTheDeepestOfAllItsContactsForASearchThatRemembers) {
    // Truth: the contacts themselves, found anew at each pose, to the bit. The hand is led away from the nut's axis by
    // up to 2 mm, as one that presses is, so that flanks are left and ridges passed on the way.
    constexpr double kPlay = 30e-6, kStart = -.0096, kPitch = .001;
    const auto bolt = solidOf(shape::ThreadBolt{.012 - 2.0 * kPlay, kPitch, .02, .0007});
    const auto nut = solidOf(shape::ThreadNut{.012, kPitch, .019, .010, .0006});
    const SolidPair pair{&*bolt, &*nut, {}, motion::Metric{kRho}};
    ContactSearch search(pair);
    double deepest = 0.0;
    for (int tick = 0; tick < 400; ++tick) {
        const double t = 1e-3 * tick, ramp = 2.0 * t;
        const Vec3 tilt(0.04 * ramp * std::sin(2.1 * t), 0.04 * ramp * std::sin(2.7 * t), 0.0);
        const Vec3 away(0.002 * ramp * std::sin(1.7 * t), 0.002 * ramp * std::sin(2.3 * t), -0.001 * ramp);
        const Pose X{rotationFromVector(tilt) * rotationFromVector(Vec3(0, 0, kTurn * kStart / kPitch)),
                     Vec3(0, 0, kStart) + away};
        const double depth = search.overlapAt(X).depth;
        deepest = std::max(deepest, depth);
        if (tick % 2 > 0) continue;
        PairContacts all;
        ContactSearch(pair).find(X, 0.0, all);
        ASSERT_EQ(depth, overlapOf(all)) << tick;
    }
    EXPECT_GT(deepest, 1e-3);
}

TEST(BoltInNut, AllocatesNothing) {
    // Truth: invariant.
    if (!support::RtGuard::available()) GTEST_SKIP() << "a sanitizer owns the allocator";
    BoltInNut scene(kSizes[1], 30e-6);
    const double start = -scene.nut.height / 2;
    scene.X = scene.engaged(start);
    const Hand hand = hands(3)[5];
    std::vector<Pose> poses;
    poses.reserve(300);
    for (int tick = 0; tick < 300; ++tick) poses.push_back(hand.at(scene, start, 1e-3 * tick));
    const support::RtGuard guard;
    for (const Pose& pose : poses) scene.follow(pose);
    EXPECT_EQ(guard.violations(), 0) << guard.describe();
}

}  // namespace
}  // namespace passung::closed_form
