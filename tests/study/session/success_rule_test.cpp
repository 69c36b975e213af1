#include "study/session/success_rule.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace passung::session {
namespace {

// The task: 95 % of 20 mm, slower than 5 mm/s, for 0.5 s. The rule knows a speed after 50 ticks, so a part that rests
// in the bore from tick 0 is at rest from tick 50 and has held for 500 ticks at tick 550.
constexpr std::int64_t kFirstRest = SuccessRule::kSpeedTicks;
constexpr std::int64_t kHold = 500;
constexpr double kClearance = 5e-4;  // [m]

TickRecord tipAt(std::int64_t tick, double depth, double beside = 0.0) {
    TickRecord record;
    record.tick = tick;
    record.proxy_position_m = {static_cast<float>(beside), 0.0f, static_cast<float>(-depth)};
    return record;
}

/// First tick of 0 … `last` at which the rule is fulfilled, -1 if none; `at(tick)` makes the record.
std::int64_t firstFulfilled(std::int64_t last, const std::function<TickRecord(std::int64_t)>& at) {
    plan::PegInHoleTask task;
    task.clearance = kClearance;
    SuccessRule rule(task, Pose{});
    for (std::int64_t tick = 0; tick <= last; ++tick)
        if (rule.fulfilledAt(at(tick))) return tick;
    return -1;
}

TEST(SuccessRule, IsFulfilledWhenTheHoldEndsAndNotOneTickEarlier) {
    // Truth: closed form
    EXPECT_EQ(firstFulfilled(2000, [](std::int64_t tick) { return tipAt(tick, 0.0191); }), kFirstRest + kHold);
}

TEST(SuccessRule, HoldAndSpeedCountMissedCycles) {
    // Truth: closed form. Every other cycle is missed: the hold's 500 periods are 250 ticks, and 8 µm a tick are 4
    // mm/s, slower than 5 mm/s, although they would be 8 mm/s at a tick a millisecond.
    const auto missing = [](std::int64_t tick, std::uint32_t periods) {
        TickRecord record = tipAt(tick, 0.0191 + 8e-6 * static_cast<double>(tick));
        record.periods = periods;
        return record;
    };
    EXPECT_EQ(firstFulfilled(400, [&](std::int64_t tick) { return missing(tick, 2); }), kFirstRest + kHold / 2);
    EXPECT_EQ(firstFulfilled(400, [&](std::int64_t tick) { return missing(tick, 1); }), -1);
}

TEST(SuccessRule, JustBelowTheDepthIsNeverEnough) {
    // Truth: closed form. 95 % of 20 mm are 19 mm.
    EXPECT_EQ(firstFulfilled(5000, [](std::int64_t tick) { return tipAt(tick, 0.01899); }), -1);
    EXPECT_EQ(firstFulfilled(5000, [](std::int64_t tick) { return tipAt(tick, 0.01901); }), kFirstRest + kHold);
}

TEST(SuccessRule, BesideTheBoreIsNeverEnough) {
    // Truth: closed form. 0.5 mm of clearance and 0.2 mm of give: the bore ends 0.7 mm from the axis. A soft contact
    // may let the tip 1.9 mm beside it as deep as it should be, even where the depth that was found is small.
    for (const double beside : {0.0019, 0.00071})
        EXPECT_EQ(firstFulfilled(5000, [=](std::int64_t tick) { return tipAt(tick, 0.0195, beside); }), -1) << beside;
    EXPECT_EQ(firstFulfilled(5000, [](std::int64_t tick) { return tipAt(tick, 0.0195, 0.00069); }), kFirstRest + kHold);
}

TEST(SuccessRule, OverlapAboveTheWallsGiveIsNeverEnough) {
    // Truth: closed form. On the axis and deep, but 0.2 mm in the material is the most.
    const auto overlapping = [](float depth_m) {
        return [depth_m](std::int64_t tick) {
            TickRecord record = tipAt(tick, 0.0195);
            record.proxy_depth_m = depth_m;
            return record;
        };
    };
    EXPECT_EQ(firstFulfilled(5000, overlapping(0.00021f)), -1);
    EXPECT_EQ(firstFulfilled(5000, overlapping(0.00019f)), kFirstRest + kHold);
}

TEST(SuccessRule, OverlapInOneTickBeginsTheHoldAnew) {
    // Truth: closed form. It must hold in every tick; the last one of the hold is too deep in the wall.
    constexpr std::int64_t last = kFirstRest + kHold;
    const auto at = [](std::int64_t tick) {
        TickRecord record = tipAt(tick, 0.0195);
        if (tick == last) record.proxy_depth_m = 0.001f;
        return record;
    };
    EXPECT_EQ(firstFulfilled(5000, at), last + 1 + kHold);
}

TEST(SuccessRule, PartThatStillMovesTooFastHasNotArrived) {
    // Truth: closed form. Steady motion into a deep bore, 5 % above and below 5 mm/s.
    const auto moving = [](double speed) {
        return [speed](std::int64_t tick) { return tipAt(tick, 0.0195 + speed * 1e-3 * static_cast<double>(tick)); };
    };
    EXPECT_EQ(firstFulfilled(5000, moving(0.00525)), -1);
    EXPECT_EQ(firstFulfilled(5000, moving(0.00475)), kFirstRest + kHold);
}

TEST(SuccessRule, HoldInterruptedAtItsLastTickBeginsAnew) {
    // Truth: closed form. 20 µm too high for the last tick; that is no speed (0.4 mm/s over 50 ticks).
    constexpr std::int64_t last = kFirstRest + kHold;
    EXPECT_EQ(firstFulfilled(5000, [](std::int64_t tick) { return tipAt(tick, tick == last ? 0.01899 : 0.01901); }),
              last + 1 + kHold);
}

TEST(SuccessRule, OneQuantumOfACoarseEncoderIsNoMotion) {
    // Truth: closed form. 64 µm to and fro every tick: 64 mm/s between neighbours, at most 1.3 mm/s over 50 ticks.
    EXPECT_EQ(firstFulfilled(5000, [](std::int64_t tick) { return tipAt(tick, tick % 3 ? 0.0195 : 0.019564); }),
              kFirstRest + kHold);
}

TEST(SuccessRule, MissingTickBeginsTheHoldAnew) {
    // Truth: closed form. Tick 300 is lost; the speed is known again 50 ticks after the gap.
    SuccessRule rule(plan::PegInHoleTask{}, Pose{});
    std::int64_t fulfilled = -1;
    for (std::int64_t tick = 0; tick < 2000 && fulfilled < 0; ++tick)
        if (tick != 300 && rule.fulfilledAt(tipAt(tick, 0.0195))) fulfilled = tick;
    EXPECT_EQ(fulfilled, 301 + kFirstRest + kHold);
}

TEST(SuccessRule, PositionThatIsNotANumberIsNoSuccess) {
    // Truth: invariant
    const double nan = std::nan("");
    EXPECT_EQ(firstFulfilled(2000, [nan](std::int64_t tick) { return tipAt(tick, nan); }), -1);
}

TEST(SuccessRule, DepthIsTakenInTheTargetsFrame) {
    // Truth: closed form. The mouth lies at z = -5 mm: 24.5 - 5.0 = 19.5 mm is deep enough, 23.5 is not.
    Pose X_WT;
    X_WT.p.z() = -0.005;
    for (const double depth : {0.0245, 0.0235}) {
        SuccessRule rule(plan::PegInHoleTask{}, X_WT);
        bool fulfilled = false;
        for (std::int64_t tick = 0; tick < 2000; ++tick) fulfilled = rule.fulfilledAt(tipAt(tick, depth)) || fulfilled;
        EXPECT_EQ(fulfilled, depth > 0.024) << depth;
    }
}

}  // namespace
}  // namespace passung::session
