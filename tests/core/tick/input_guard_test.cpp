#include "core/tick/input_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "core/tick/hand_state.h"

namespace passung {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// As input_guard.h says in words: three, a fifth of a second, and down to 250 Hz.
constexpr int kFew = 3, kMany = 200, kLongestGap = 4;
constexpr std::uint32_t kWhatIsWrong = kDeviceStale | kInputNotAPose | kInputJump;
constexpr std::uint32_t kWhatIsDone = kInputHeld | kInputRejected;

Pose at(double x) { return {Quat::Identity(), Vec3(x, 0, 0)}; }
Pose turned(double angle) { return {rotationFromVector(Vec3(0, angle, 0)), Vec3::Zero()}; }
DeviceReading stale(const Pose& X_BD) { return {.X_BD = X_BD, .fresh = false}; }

/// The guard alone: 20 m/s and 200 rad/s, so 20 mm and 0.2 rad a tick; device space is the scene.
class Guard {
public:
    tick::TickFrame give(const DeviceReading& reading) {
        tick::TickFrame frame;
        frame.reading = reading;
        tick::runStage<tick::kInputGuard>(model_, state_, frame);
        return frame;
    }
    tick::TickFrame give(const Pose& X_BD) { return give(DeviceReading{X_BD}); }
    void rest(int ticks) {
        for (int i = 0; i < ticks; ++i) give(at(0));
    }

private:
    tick::HandModel model_;
    tick::HandState state_;
};

struct Fault {
    const char* name;
    DeviceReading reading;
    std::uint32_t bit;
};

/// Each kind of bad sample of a device that rests at 0.
std::vector<Fault> everyFault() {
    const auto quaternion = [](double w, double x) { return DeviceReading{Pose{Quat(w, x, 0, 0), Vec3::Zero()}}; };
    return {{"not a number", DeviceReading{at(kNan)}, kInputNotAPose},
            {"infinite", DeviceReading{at(-std::numeric_limits<double>::infinity())}, kInputNotAPose},
            {"no number in the quaternion", quaternion(kNan, 0), kInputNotAPose},
            {"quaternion of length 0", quaternion(0, 0), kInputNotAPose},
            {"quaternion of length 1.01", quaternion(1.01, 0), kInputNotAPose},
            {"a kilometre away", DeviceReading{at(1001)}, kInputNotAPose},
            {"finite, its square is not", DeviceReading{at(1e300)}, kInputNotAPose},
            {"a metre away", DeviceReading{at(1)}, kInputJump},
            {"turned by a radian", quaternion(std::cos(0.5), std::sin(0.5)), kInputJump},
            {"not fresh", stale(at(0)), kDeviceStale}};
}

TEST(InputGuard, TakesAGoodDeviceFromItsFirstSampleOn) {
    // Truth: invariant. The first pose is used as it is; nothing is reported; one tick between samples.
    Guard guard;
    for (int i = 0; i < 100; ++i) {
        const auto frame = guard.give(at(0.3 + 0.019 * i));
        EXPECT_TRUE(frame.input_usable);
        EXPECT_EQ(frame.status, 0u);
        EXPECT_EQ(frame.sample_periods, 1);
        EXPECT_EQ(frame.X_WH.p.x(), 0.3 + 0.019 * i);
    }
}

TEST(InputGuard, HoldsOneBadSampleRejectsMoreAndSaysWhatIsWrong) {
    // Truth: invariant (the stage's contract), for each kind of bad sample: exactly the bits that fit, and back with
    // the first good one.
    for (const auto& [name, bad, bit] : everyFault()) {
        SCOPED_TRACE(name);
        Guard guard;
        guard.rest(5);
        auto frame = guard.give(bad);
        EXPECT_TRUE(frame.input_usable);
        EXPECT_EQ(frame.status, bit | kInputHeld);
        EXPECT_EQ(frame.sample_periods, 0);
        EXPECT_EQ(frame.X_WH.p.norm(), 0.0);
        frame = guard.give(bad);
        EXPECT_FALSE(frame.input_usable);
        EXPECT_EQ(frame.status, bit | kInputRejected);
        EXPECT_EQ(frame.sample_periods, 0);
        EXPECT_EQ(frame.X_WH.p.norm(), 0.0);
        frame = guard.give(at(0));
        EXPECT_TRUE(frame.input_usable);
        EXPECT_EQ(frame.status, 0u);
        EXPECT_EQ(frame.sample_periods, 3);
    }
}

TEST(InputGuard, RejectsWhatIsBadBeforeAnyGoodSample) {
    // Truth: invariant. There is nothing to hold and nothing to jump from.
    for (const auto& [name, bad, bit] : everyFault()) {
        if (bit == kInputJump) continue;
        SCOPED_TRACE(name);
        Guard guard;
        const auto frame = guard.give(bad);
        EXPECT_FALSE(frame.input_usable);
        EXPECT_EQ(frame.status, bit | kInputRejected);
        EXPECT_TRUE(isFinite(frame.X_WH));
        EXPECT_TRUE(guard.give(at(0)).input_usable);
    }
}

TEST(InputGuard, JudgesAJumpByTheTimeSinceTheLastGoodSample) {
    // Truth: closed form. 20 mm and 0.2 rad a tick; after one bad sample twice as much.
    const auto statusOf = [](const Pose& X_BD, int bad_samples) {
        Guard guard;
        guard.rest(5);
        for (int i = 0; i < bad_samples; ++i) guard.give(stale(at(0)));
        return guard.give(X_BD).status & kWhatIsWrong;
    };
    for (const int bad : {0, 1, 9}) {
        EXPECT_EQ(statusOf(at(0.0199 * (bad + 1)), bad), 0u);
        EXPECT_EQ(statusOf(at(0.0201 * (bad + 1)), bad), static_cast<std::uint32_t>(kInputJump));
        EXPECT_EQ(statusOf(turned(0.199 * (bad + 1)), bad), 0u);
        EXPECT_EQ(statusOf(turned(0.201 * (bad + 1)), bad), static_cast<std::uint32_t>(kInputJump));
    }
}

TEST(InputGuard, ForgetsAWildFirstSampleWithinThreeGoodOnes) {
    // Truth: invariant. The wild pose is not held against the good samples: zero at once, back with the third.
    for (const Pose& wild : {at(999), at(-3), turned(3)}) {
        Guard guard;
        guard.give(wild);
        for (int i = 1; i < kFew; ++i) {
            const auto frame = guard.give(at(0.001 * i));
            EXPECT_FALSE(frame.input_usable) << i;
            EXPECT_EQ(frame.status, static_cast<std::uint32_t>(kInputJump | kInputRejected)) << i;
        }
        auto frame = guard.give(at(0.004));
        EXPECT_TRUE(frame.input_usable);
        EXPECT_TRUE(frame.relocated);
        EXPECT_EQ(frame.status, static_cast<std::uint32_t>(kInputRelocated));
        EXPECT_EQ(frame.X_WH.p.x(), 0.004);
        frame = guard.give(wild);
        EXPECT_EQ(frame.status, static_cast<std::uint32_t>(kInputJump | kInputHeld)) << "now the good one is believed";
        EXPECT_EQ(frame.X_WH.p.x(), 0.004);
    }
}

TEST(InputGuard, BelievesThreeSamplesThatAgreeAgainstAFirstThatNobodyConfirmed) {
    // Truth: invariant. Zero, zero, then there; also for a device that has a new sample on every fourth tick only, and
    // then moves up to 80 mm from one to the next; not for one that is slower or moves farther.
    for (const int gap : {1, 2, 3, 4, 5}) {
        for (const double speed : {0.015, 0.0199, 0.0201}) {
            Guard guard;
            guard.give(at(0));
            for (int i = 0; i <= 2 * gap; ++i) {
                const bool fresh = i % gap == 0;
                const auto frame = guard.give(fresh ? DeviceReading{at(5 + speed * i)} : stale(at(0)));
                const bool believed = i == 2 * gap && gap <= kLongestGap && speed < 0.02;
                EXPECT_EQ(frame.input_usable, believed) << gap << ' ' << i;
                EXPECT_EQ(frame.relocated, believed) << gap << ' ' << i;
            }
        }
    }
}

TEST(InputGuard, LetsADriverRepeatOneWrongPoseForAFifthOfASecond) {
    // Truth: invariant. 5 m away is out of reach for 250 ticks: zero all the while, and back at once; after
    // kAgreeingSamplesToMove of them the device is believed to be there.
    for (const int wrong : {2, 3, 10, kMany - 1}) {
        Guard guard;
        guard.rest(5);
        for (int i = 0; i < wrong; ++i) {
            const auto frame = guard.give(at(5));
            ASSERT_EQ(frame.input_usable, i == 0) << i;
            ASSERT_EQ(frame.X_WH.p.x(), 0.0);
        }
        const auto frame = guard.give(at(0.001));
        EXPECT_TRUE(frame.input_usable);
        EXPECT_FALSE(frame.relocated);
    }
    Guard guard;
    guard.rest(5);
    tick::TickFrame frame;
    for (int i = 0; i < kMany; ++i) frame = guard.give(at(5));
    EXPECT_TRUE(frame.relocated);
    EXPECT_EQ(frame.X_WH.p.x(), 5.0);
}

TEST(InputGuard, NeverBelievesJumpsThatDoNotAgree) {
    // Truth: invariant. Places 20 m or more apart and 20 m or more from the last good one: 300 ticks reach 6 m.
    Guard guard;
    guard.rest(5);
    Random random(3);
    double last = 0;
    for (int i = 0; i < 300; ++i) {
        double x;
        do {
            x = 20.0 * static_cast<double>(1 + random.below(40));
        } while (x == last);
        last = x;
        const auto frame = guard.give(at(x));
        ASSERT_EQ(frame.X_WH.p.x(), 0.0) << i;
        ASSERT_EQ(frame.status, kInputJump | (i == 0 ? kInputHeld : kInputRejected)) << i;
    }
}

TEST(InputGuard, NeverBelievesAWildPlaceThatReturnsOnceInAWhile) {
    // Truth: invariant. The same place each time: between good samples, or among samples that are no pose with more
    // ticks between than kLongestSearchGap. 1 000 ticks reach 20 m.
    Guard among_good, among_nothing;
    among_good.rest(5);
    among_nothing.rest(5);
    for (int i = 0; i < 1000; ++i) {
        const bool every_second = i % 2 == 0;
        auto frame = among_good.give(at(every_second ? 900 : 0));
        ASSERT_EQ(frame.status, every_second ? static_cast<std::uint32_t>(kInputJump | kInputHeld) : kStatusOk) << i;
        ASSERT_EQ(frame.X_WH.p.x(), 0.0) << i;
        frame = among_nothing.give(at(i % (kLongestGap + 1) == 0 ? 900 : kNan));
        ASSERT_EQ(frame.input_usable, i == 0) << i;
        ASSERT_EQ(frame.X_WH.p.x(), 0.0) << i;
    }
}

TEST(InputGuard, FindsADeviceAgainThatWasCarriedWhileItWasSilent) {
    // Truth: closed form. 1 m in 1 s is 1 m/s: no jump. But the pose is unconfirmed: it is not held when it is denied.
    Guard guard;
    guard.rest(5);
    for (int i = 0; i < 1000; ++i) {
        ASSERT_EQ(guard.give(stale(at(0))).status, kDeviceStale | (i == 0 ? kInputHeld : kInputRejected));
    }
    auto frame = guard.give(at(1));
    EXPECT_EQ(frame.status, 0u);
    EXPECT_EQ(frame.sample_periods, 1001);
    frame = guard.give(at(0));
    EXPECT_EQ(frame.status, static_cast<std::uint32_t>(kInputJump | kInputRejected));
    guard.give(at(0));
    EXPECT_TRUE(guard.give(at(0)).input_usable);
}

TEST(InputGuard, HoldsAPoseThatFollowedOneHeldTickButNoneThatFollowedRejectedOnes) {
    // Truth: the stage's contract. The first sample after rejected ones, which are two bad ticks or more, is taken at
    // its word: denied by the next it is not held, and three samples that agree move the guard. After no bad tick or
    // one held tick it is confirmed by the sample before it: held, and 200 are needed. Bad ticks, or missed periods.
    for (int bad = 0; bad <= 4; ++bad) {
        for (const bool missed : {false, true}) {
            SCOPED_TRACE(bad);
            Guard guard;
            guard.rest(5);
            for (int i = 0; i < bad && !missed; ++i) guard.give(stale(at(0)));
            DeviceReading good{at(0.01)};
            good.periods = missed ? bad + 1 : 1;
            const auto taken = guard.give(good);
            EXPECT_EQ(taken.status, 0u);
            EXPECT_EQ(taken.sample_periods, bad + 1);
            const bool confirmed = bad <= 1;
            EXPECT_EQ(guard.give(at(5)).status, kInputJump | (confirmed ? kInputHeld : kInputRejected));
            EXPECT_EQ(guard.give(at(5)).status, static_cast<std::uint32_t>(kInputJump | kInputRejected));
            EXPECT_EQ(guard.give(at(5)).relocated, !confirmed);
        }
    }
}

TEST(InputGuard, TakesTheOtherSignOfAQuaternionForTheSameRotation) {
    // Truth: closed form. q and -q: neither a jump nor less allowed to turn.
    Guard guard;
    for (int i = 0; i < 100; ++i) {
        Pose X_BD = turned(0.19 * i);
        if (i % 2 == 1) X_BD.q.coeffs() *= -1.0;
        const auto frame = guard.give(X_BD);
        ASSERT_EQ(frame.status, 0u) << i;
        ASSERT_NEAR(rotationVector(frame.X_WH.q * turned(0.19 * i).q.conjugate()).norm(), 0.0, 1e-12);
    }
}

TEST(InputGuard, NormalisesARoundedQuaternion) {
    // Truth: closed form. Lengths within 1e-3 of 1 are a driver's rounding.
    for (const double length : {0.9991, 1.0009}) {
        Guard guard;
        Pose X_BD = turned(0.7);
        X_BD.q.coeffs() *= length;
        const auto frame = guard.give(X_BD);
        EXPECT_EQ(frame.status, 0u);
        EXPECT_NEAR(frame.X_WH.q.norm(), 1.0, 1e-15);
        EXPECT_NEAR(frame.X_WH.q.coeffs().dot(turned(0.7).q.coeffs()), 1.0, 1e-15);
    }
}

TEST(InputGuard, HoldsBetweenTheSamplesOfADeviceThatIsSlowerThanTheTick) {
    // Truth: invariant. New on every other tick: usable all the time, two ticks between samples.
    Guard guard;
    guard.give(at(0));
    for (int i = 1; i < 100; ++i) {
        const bool fresh = i % 2 == 0;
        const auto frame = guard.give(DeviceReading{.X_BD = at(0.001 * i), .fresh = fresh});
        EXPECT_TRUE(frame.input_usable);
        EXPECT_EQ(frame.status, fresh ? kStatusOk : static_cast<std::uint32_t>(kDeviceStale | kInputHeld));
        EXPECT_EQ(frame.sample_periods, fresh ? 2 : 0);
        EXPECT_EQ(frame.X_WH.p.x(), fresh ? 0.001 * i : 0.001 * (i - 1));
    }
}

TEST(InputGuard, IsNeverLockedAndSaysExactlyWhenItActs) {
    // Truth: invariant. 500 storms of hostile readings; after each, samples that agree are usable again,
    // at the latest after kAgreeingSamplesToMove.
    Guard guard;
    Random random(11);
    const auto faults = everyFault();
    for (int storm = 0; storm < 500; ++storm) {
        const auto length = random.below(40);
        for (std::uint64_t i = 0; i < length; ++i) {
            DeviceReading reading{at(random.uniform(-3, 3) * (random.below(2) == 0 ? 1.0 : 100.0))};
            if (random.below(3) == 0) reading = faults[random.below(faults.size())].reading;
            const auto frame = guard.give(reading);
            ASSERT_TRUE(isFinite(frame.X_WH));
            const bool wrong = (frame.status & kWhatIsWrong) != 0, done = (frame.status & kWhatIsDone) != 0;
            ASSERT_EQ(wrong, done);
            ASSERT_EQ(frame.sample_periods == 0, wrong);
            ASSERT_EQ(frame.input_usable, (frame.status & kInputRejected) == 0);
            if (!wrong) {
                ASSERT_EQ(frame.X_WH.p, reading.X_BD.p);
            }
        }
        const double place = random.uniform(-500, 500);
        for (int i = 1; i < kMany; ++i) guard.give(at(place));
        ASSERT_TRUE(guard.give(at(place + 0.001)).input_usable) << storm;
    }
}

TEST(StartGate, OpensAfterSoManyTicksInARowWithinBothTolerances) {
    // Truth: the stage's contract, at a start pose that is elsewhere and turned. 10 mm and 0.2 rad in any direction:
    // just within counts, just beyond or without a usable sample begins anew; after more than hold_ticks ticks it is
    // open and stays so.
    tick::HandModel model;
    model.start_gate = {.position_tolerance = 0.01, .angle_tolerance = 0.2, .hold_ticks = 7};
    model.X_WG_start = {rotationFromVector(Vec3(0.4, -1.1, 0.3)), Vec3(0.3, -0.2, 0.5)};
    Random random(4);
    const auto away = [&](double distance, double angle) {
        const auto any = [&] { return Vec3(random.normal(), random.normal(), random.normal()).normalized(); };
        const Pose& X = model.X_WG_start;
        return Pose{rotationFromVector(angle * any()) * X.q, X.p + distance * any()};
    };
    struct Tick {
        double distance, angle;
        bool usable;
    };
    for (const Tick& other : {Tick{0.0101, 0.0, true}, Tick{0.0, 0.201, true}, Tick{0.5, 0.0, true},
                              Tick{0.0, 3.0, true}, Tick{0.0, 0.0, false}}) {
        tick::HandState state;
        const auto engaged = [&](const Tick& t) {
            tick::TickFrame frame;
            frame.X_WH = away(t.distance, t.angle);
            frame.input_usable = t.usable;
            tick::runStage<tick::kStartGate>(model, state, frame);
            return state.engaged;
        };
        const Tick within{0.0099, 0.199, true};
        for (int i = 0; i < 20; ++i) EXPECT_FALSE(engaged(other)) << i;
        for (int i = 0; i < 7; ++i) EXPECT_FALSE(engaged(within)) << i;
        EXPECT_FALSE(engaged(other));
        for (int i = 0; i < 7; ++i) EXPECT_FALSE(engaged(within)) << i;
        EXPECT_TRUE(engaged(within));
        EXPECT_TRUE(engaged(other));
    }
}

TEST(InputGuard, PutsTheHeldPartWhereTheRegistrationSays) {
    // Truth: closed form. Base in the world, the handle's way scaled but not its rotation, the part off the handle.
    Random random(6);
    for (int i = 0; i < 100; ++i) {
        const auto any = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
        const Pose X_WB{rotationFromVector(any()), any()}, X_BD{rotationFromVector(any()), any()},
            X_DH{rotationFromVector(any()), any()};
        const double scale = random.uniform(0.2, 5.0);
        const Pose X_WH = tick::registeredPose({X_WB, scale, X_DH}, X_BD, X_DH);
        const Vec3 point = any();  // of the held part
        const Vec3 expected = X_WB.p + X_WB.q * (scale * X_BD.p + X_BD.q * (X_DH.p + X_DH.q * point));
        EXPECT_NEAR((X_WH * point - expected).norm(), 0.0, 1e-12);
    }
}

TEST(InputGuard, CountsMissedPeriodsAsTimeThatHasPassed) {
    // Truth: closed form. 55 mm in three periods are 18 m/s; held over them, a pose would be three periods old.
    Guard guard;
    guard.rest(10);
    DeviceReading late{at(0.055)};
    late.periods = 3;
    const auto frame = guard.give(late);
    EXPECT_TRUE(frame.input_usable);
    EXPECT_EQ(frame.sample_periods, 3);
    late = stale(at(0.055));
    late.periods = 3;
    EXPECT_FALSE(guard.give(late).input_usable);
}

}  // namespace
}  // namespace passung
