#include "ui/app/frame_clock.h"

#include <gtest/gtest.h>

namespace passung::app {
namespace {

constexpr std::int64_t kMs = 1'000'000;  // [ns]

loop::ScreenTick tickAt(std::int64_t tick, std::int64_t began_ns) {
    loop::ScreenTick shown;
    shown.record.tick = tick;
    shown.began_ns = began_ns;
    return shown;
}

TEST(FrameClock, APictureIsAsOldAsTheNewestTickThatItShows) {
    // Truth: closed form. Items move on while a picture is drawn: it shows what they were when it was taken.
    FrameClock clock;
    clock.show(tickAt(3, 100 * kMs));
    clock.take();
    clock.show(tickAt(20, 117 * kMs));
    clock.present(130 * kMs);
    clock.take();
    clock.present(157 * kMs);
    const auto times = clock.timesSince(90 * kMs);
    ASSERT_TRUE(times);
    EXPECT_EQ(times->first_ns, 100 * kMs);
    EXPECT_EQ(times->age.count(), 2);
    EXPECT_DOUBLE_EQ(times->age.meanMicroseconds(), 35'000.0);
    EXPECT_DOUBLE_EQ(times->age.maxMicroseconds(), 40'000.0);
}

TEST(FrameClock, WhatShowsNoNewTickHasNoAge) {
    // Truth: invariant. A picture drawn anew because the pointer moved says nothing about ticks.
    FrameClock clock;
    clock.take();
    clock.present(5 * kMs);
    EXPECT_FALSE(clock.timesSince(0)) << "nothing was shown yet";
    clock.show(tickAt(0, 10 * kMs));
    clock.take();
    clock.present(20 * kMs);
    clock.take();
    clock.present(3000 * kMs);
    EXPECT_EQ(clock.timesSince(0)->age.count(), 1);
}

TEST(FrameClock, EveryAttemptBeginsAnewAndOnlyItsOwnerGetsIt) {
    // Truth: invariant.
    FrameClock clock;
    clock.show(tickAt(500, 500 * kMs));
    clock.take();
    clock.present(540 * kMs);
    clock.show(tickAt(2, 1002 * kMs));
    clock.take();
    EXPECT_FALSE(clock.timesSince(1000 * kMs)) << "the picture before was of the attempt before";
    clock.present(1012 * kMs);
    const auto times = clock.timesSince(1000 * kMs);
    ASSERT_TRUE(times);
    EXPECT_EQ(times->age.count(), 1);
    EXPECT_DOUBLE_EQ(times->age.maxMicroseconds(), 10'000.0);
    EXPECT_FALSE(clock.timesSince(2000 * kMs)) << "nothing of a later attempt was shown";
}

}  // namespace
}  // namespace passung::app
