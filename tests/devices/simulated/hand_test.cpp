#include "devices/simulated/hand.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "devices/simulated/simulated_device.h"
#include "tests/support/rt_guard.h"

using namespace passung;
using namespace passung::simulated;

namespace {

VisibleTask task() {
    VisibleTask t;
    t.X_WHeldStart = {rotationFromVector(Vec3(0.05, 0, 0.4)), Vec3(-0.02, 0.01, 0.03)};
    return t;
}

HandRegistration registration() {
    HandRegistration r;
    r.X_WB = {rotationFromVector(Vec3(0, 0, 1.2)), Vec3(0.01, 0.02, 0.02)};
    r.scale = 1.5;
    r.X_DH.p = Vec3(0, 0, -0.04);
    return r;
}

/// Free space: nothing is touched, the display shows the part. Returns all readings.
std::vector<Pose> freeRun(std::uint64_t seed, int ticks, int go_at) {
    SimulatedDevice device(*findPreset("sigma7"), HandParams{}, task(), registration(), seed);
    std::vector<Pose> readings;
    for (int k = 0; k < ticks; ++k) {
        readings.push_back(device.read().X_BD);
        device.command({});
        if (k % 16 == 0)
            device.show({.tick = k, .X_WShown = registration().partFromHandle(readings.back()), .running = k >= go_at});
    }
    return readings;
}

/// How long a hand in free space, whose handle is where it wants it, stops and looks before it lowers the part.
int settleTicks(const HandParams& params, std::uint64_t seed) {
    Hand hand(params, task(), registration(), seed);
    Pose X_BD = registration().handleFromPart(task().X_WHeldStart);
    int ticks = 0;
    for (int k = 0; k < 10'000 && hand.phase() < HandPhase::Descend; ++k) {
        if (k % 16 == 0) hand.see({.tick = k, .X_WShown = registration().partFromHandle(X_BD), .running = k >= 1000});
        X_BD = hand.act(X_BD, {}).X_BSet;
        ticks += hand.phase() == HandPhase::Settle ? 1 : 0;
    }
    return ticks;
}

bool sameBits(const std::vector<Pose>& a, const std::vector<Pose>& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
        if (std::memcmp(a[i].p.data(), b[i].p.data(), 3 * sizeof(double)) != 0 ||
            std::memcmp(a[i].q.coeffs().data(), b[i].q.coeffs().data(), 4 * sizeof(double)) != 0)
            return false;
    return true;
}

TEST(MinimumJerk, IsTheQuinticOfFlashAndHogan) {
    // Truth: closed form; the only quintic from 0 to 1 with zero speed and acceleration at both ends, peak speed 15/8.
    EXPECT_EQ(minimumJerk(0), 0);
    EXPECT_EQ(minimumJerk(1), 1);
    EXPECT_EQ(minimumJerk(0.5), 0.5);
    EXPECT_EQ(minimumJerk(-3), 0);
    EXPECT_EQ(minimumJerk(7), 1);
    const double h = 1e-4;
    for (double t = 0.05; t < 1; t += 0.05) {
        EXPECT_NEAR(minimumJerk(t) + minimumJerk(1 - t), 1, 1e-14);
        const double speed = (minimumJerk(t + h) - minimumJerk(t - h)) / (2 * h);
        EXPECT_NEAR(speed, 30 * t * t * (1 - t) * (1 - t), 1e-6);
    }
}

TEST(MinimumJerk, ReachGoesStraightAndTurnsAboutOneAxis) {
    // Truth: closed form at half time: midpoint and half angle.
    const Reach reach{
        {Quat::Identity(), Vec3(0, 0, 0)}, {rotationFromVector(Vec3(0, 0, 0.8)), Vec3(0.1, 0, -0.2)}, 2.0};
    EXPECT_NEAR((reach.at(1.0).p - Vec3(0.05, 0, -0.1)).norm(), 0, 1e-15);
    EXPECT_NEAR((rotationVector(reach.at(1.0).q) - Vec3(0, 0, 0.4)).norm(), 0, 1e-12);
    EXPECT_NEAR((reach.at(5.0).p - reach.to.p).norm(), 0, 1e-15);
}

TEST(HandRegistration, HandleAndPartAreInverse) {
    // Truth: invariant; X_WH = X_WB · scale(X_BD) · X_DH there and back.
    const Pose X_BD{rotationFromVector(Vec3(0.1, -0.7, 0.2)), Vec3(0.03, 0.02, -0.05)};
    const Pose back = registration().handleFromPart(registration().partFromHandle(X_BD));
    EXPECT_NEAR((back.p - X_BD.p).norm(), 0, 1e-15);
    EXPECT_NEAR(rotationVector(back.q * X_BD.q.conjugate()).norm(), 0, 1e-14);
    HandRegistration plain;
    plain.scale = 2.0;
    EXPECT_NEAR((plain.partFromHandle(X_BD).p - 2.0 * X_BD.p).norm(), 0, 1e-15);
}

TEST(Tremor, ShakesAFreeMassByItsAmplitudeWithinItsBand) {
    // Truth: closed form; the force integrated twice has the asked root mean square, and between 8 and 12 Hz the signal
    // crosses zero 16 to 24 times a second.
    Random random(5);
    const Tremor tremor(1e-4, 0.5, random);
    double squares = 0;
    int crossings = 0;
    constexpr int kTicks = 400000;
    Vec3 last = tremor.force(0);
    for (int k = 1; k <= kTicks; ++k) {
        const Vec3 f = tremor.force(k * 1e-3);
        // |F| / (m w²) with w in the band lies between the extremes; the middle is used and 25 % allowed.
        const double w = 2 * 3.14159265358979 * 10;
        squares += (f / (0.5 * w * w)).squaredNorm();
        if (f.x() * last.x() < 0) ++crossings;
        last = f;
    }
    EXPECT_NEAR(std::sqrt(squares / kTicks / 3), 1e-4, 0.25e-4);
    EXPECT_GE(crossings, 16 * 400);
    EXPECT_LE(crossings, 24 * 400);
}

TEST(Hand, ReachesTheStartPoseAndHoldsIt) {
    // Truth: invariant; within 1 mm and 1 degree from 1.5 s on, as long as the display does not say go.
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const std::vector<Pose> run = freeRun(seed, 6000, 1 << 30);
        const Pose first = registration().partFromHandle(run.front());
        EXPECT_GT((first.p - task().X_WHeldStart.p).norm(), 1e-3) << "starts away from it";
        for (std::size_t k = 1500; k < run.size(); ++k) {
            const Pose X_WH = registration().partFromHandle(run[k]);
            ASSERT_LT((X_WH.p - task().X_WHeldStart.p).norm(), 1e-3) << k;
            ASSERT_LT(rotationVector(X_WH.q * task().X_WHeldStart.q.conjugate()).norm(), 0.0175) << k;
        }
    }
}

TEST(Hand, ReactsToTheGoSignNoEarlierThanItsVisualDelay) {
    // Truth: invariant; two runs that differ only in the go sign are equal to the bit until the delay has passed.
    constexpr int kGo = 2000;
    const std::vector<Pose> still = freeRun(3, 4000, 1 << 30), moving = freeRun(3, 4000, kGo);
    std::size_t first = 0;
    while (first < still.size() && still[first].p == moving[first].p) ++first;
    EXPECT_GE(first, kGo + 200u);
    EXPECT_LE(first, kGo + 200u + 16u + 60u);  // a frame, and the slow begin of the reach
}

TEST(Hand, FeelsForceNoEarlierThanItsHapticDelay) {
    // Truth: invariant; only the arm's mechanics may react to a push before the delay, the intention may not.
    const HandParams params;
    const auto run = [&](int push_at) {
        Hand hand(params, task(), HandRegistration{}, 1);
        std::vector<Pose> set_points;
        for (int k = 0; k < 12000; ++k) {
            const bool pushed = k >= push_at;
            set_points.push_back(hand.act(task().X_WHeldStart, {Vec3(0, 0, pushed ? 2.0 : 0.0), Vec3::Zero()}).X_BSet);
            if (k % 16 == 0) hand.see({.tick = k, .X_WShown = task().X_WHeldStart, .running = k >= 1000});
        }
        return set_points;
    };
    constexpr int kPush = 3000;  // while descending: what is felt ends the descent
    const std::vector<Pose> without = run(1 << 30), with = run(kPush);
    std::size_t first = 0;
    while (first < with.size() && with[first].p == without[first].p) ++first;
    EXPECT_GE(first, kPush + 130u);
    EXPECT_LE(first, kPush + 130u + 5u);
}

TEST(Hand, SameSeedSameMovementDifferentSeedDifferent) {
    // Truth: invariant, bit for bit.
    const std::vector<Pose> a = freeRun(11, 5000, 1500);
    EXPECT_TRUE(sameBits(a, freeRun(11, 5000, 1500)));
    EXPECT_FALSE(sameBits(a, freeRun(12, 5000, 1500)));
}

TEST(Hand, StaysFiniteAndInReachWhenNothingIsEverTouched) {
    // Truth: invariant; two minutes in empty space: a hand that finds no plate must not run away without bound.
    const std::vector<Pose> run = freeRun(4, 120000, 1500);
    for (const Pose& X_BD : run) {
        ASSERT_TRUE(isFinite(X_BD));
        ASSERT_LT((X_BD.p - run.front().p).norm(), 0.3);
    }
}

TEST(Hand, SurvivesABrokenDisplayAndWrench) {
    // Truth: invariant; a wrench that is not finite never reaches the hand, silence of the display is harmless.
    SimulatedDevice device(*findPreset("sigma7"), HandParams{}, task(), registration(), 9);
    for (int k = 0; k < 3000; ++k) {
        ASSERT_TRUE(isFinite(device.read().X_BD));
        device.command({Vec3(0, std::numeric_limits<double>::infinity(), 0), Vec3(0, 0, std::nan(""))});
    }
}

TEST(Hand, ALapseIsAPauseOfItsLengthAtTheFirstLook) {
    // Truth: closed form; nothing else differs.
    HandParams absent;
    absent.lapse_rate = 1.0;
    absent.lapse_duration = 0.8;
    EXPECT_EQ(settleTicks(absent, 4), settleTicks({}, 4) + 800);
}

TEST(Hand, LapsesInItsShareOfTrials) {
    // Truth: closed form, binomial: 100 trials at 0.3 have a standard deviation of 4.6, of which 4 are allowed.
    HandParams params;
    params.lapse_rate = 0.3;
    const int without = settleTicks({}, 0);
    int lapses = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) lapses += settleTicks(params, seed) > without ? 1 : 0;
    EXPECT_NEAR(lapses, 30, 4 * 4.6);
}

TEST(Hand, NonsenseParametersAreNamed) {
    // Truth: invariant; one issue per planted fault, with its key.
    EXPECT_TRUE(HandParams{}.validate().empty());
    HandParams p;
    p.visual_delay = 0.6;
    ASSERT_EQ(p.validate().size(), 1u);
    EXPECT_EQ(p.validate()[0].key, "visual_delay");
    p.stiffness = std::nan("");
    p.last_search_radius = 1e-3;
    p.lapse_rate = 1.1;
    EXPECT_EQ(p.validate().size(), 4u);
}

TEST(SimulatedDevice, ReadCommandAndShowAreRealTimeSafe) {
    // Truth: invariant; nothing is allocated, locked or written in 10 000 cycles.
    if (!support::RtGuard::available()) GTEST_SKIP() << "the sanitizer owns the allocator";
    SimulatedDevice device(*findPreset("hug"), HandParams{}, task(), registration(), 2);
    const support::RtGuard guard;
    for (int k = 0; k < 10000; ++k) {
        const Pose X_BD = device.read().X_BD;
        device.command({Vec3(0, 0, k % 3000 > 2000 ? 2.0 : 0.0), Vec3::Zero()});
        if (k % 16 == 0) device.show({.tick = k, .X_WShown = X_BD, .running = k > 1500});
    }
    EXPECT_EQ(guard.violations(), 0) << guard.describe();
}

}  // namespace
