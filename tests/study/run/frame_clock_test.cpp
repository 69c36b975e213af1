#include "study/run/machine/frame_clock.h"

#include <gtest/gtest.h>

#include <array>

namespace passung::run {
namespace {

constexpr std::int64_t kMs = 1'000'000;  // [ns]

loop::ScreenTick tickAt(std::int64_t tick, std::int64_t began_ns) {
    loop::ScreenTick shown;
    shown.record.tick = tick;
    shown.began_ns = began_ns;
    return shown;
}

std::vector<Picture> takeAll(FrameClock& clock) {
    std::vector<Picture> all(100);
    all.resize(clock.takePictures(all));
    return all;
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
    const auto pictures = takeAll(clock);
    ASSERT_EQ(pictures.size(), 2u);
    EXPECT_EQ(pictures[0].began_ns, 100 * kMs);
    EXPECT_EQ(pictures[0].presented_ns, 130 * kMs);
    EXPECT_EQ(pictures[1].presented_ns - pictures[1].began_ns, 40 * kMs);
    std::array<Picture, 4> seen;
    EXPECT_EQ(clock.takeForScreen(seen), 2u) << "both who ask get all of them";
}

TEST(FrameClock, WhatShowsNoNewTickIsNoNewPicture) {
    // Truth: invariant. A picture drawn anew because the pointer moved says nothing about ticks.
    FrameClock clock;
    clock.take();
    clock.present(5 * kMs);
    EXPECT_TRUE(takeAll(clock).empty()) << "nothing was shown yet";
    clock.show(tickAt(0, 10 * kMs));
    clock.take();
    clock.present(20 * kMs);
    clock.take();
    clock.present(3000 * kMs);
    EXPECT_EQ(takeAll(clock).size(), 1u);
}

TEST(FrameClock, CountsThePicturesThatWereDrawnWithTheVisualCue) {
    // Truth: closed form. A cue that comes and goes between two pictures was on none; one that stays is on each new
    // one.
    FrameClock clock;
    const auto picture = [&](std::int64_t tick, bool cued) {
        clock.show(tickAt(tick, tick * kMs), cued);
        clock.take();
        clock.present((tick + 10) * kMs);
    };
    picture(1, false);
    clock.show(tickAt(5, 5 * kMs), true);
    picture(8, false);
    picture(20, true);
    picture(30, true);
    clock.take();
    clock.present(55 * kMs);
    const auto pictures = takeAll(clock);
    EXPECT_EQ(timesBetween(pictures, 0, 0, 19 * kMs).cued, 0);
    EXPECT_EQ(timesBetween(pictures, 0, 0, 60 * kMs).cued, 2);
    EXPECT_EQ(timesBetween(pictures, 0, 35 * kMs, 60 * kMs).cued, 1) << "one came before the trial";
    clock.prepared(clock.expect());
    clock.take();
    clock.present(70 * kMs);
    picture(80, false);
    const auto later = takeAll(clock);
    ASSERT_EQ(later.size(), 1u);
    EXPECT_FALSE(later[0].cued) << "the attempt before was cued";
}

TEST(FrameClock, AnAttemptIsShownWhenTheDisplayHasGotAPictureOfIt) {
    // Truth: invariant. A picture that was taken before shows the attempt before, however late the display gets it.
    FrameClock clock;
    const std::int64_t first = clock.expect();
    clock.prepared(first);
    clock.take();
    EXPECT_FALSE(clock.hasShown(first));
    const std::int64_t second = clock.expect();
    clock.prepared(second);
    clock.present(12 * kMs);
    EXPECT_TRUE(clock.hasShown(first));
    EXPECT_FALSE(clock.hasShown(second));
    clock.take();
    clock.present(30 * kMs);
    EXPECT_TRUE(clock.hasShown(second));
    EXPECT_TRUE(takeAll(clock).empty()) << "no tick has happened";
}

TEST(FrameClock, TheOldestPictureAgesUntilAnotherTakesItsPlace) {
    // Truth: closed form. Of a trial from 100 to 31 000 ms: pictures of the ticks at 110 and 160, then none for 29 s.
    const std::vector<Picture> pictures{{10 * kMs, 50 * kMs},
                                        {110 * kMs, 150 * kMs},
                                        {160 * kMs, 190 * kMs},
                                        {29'150 * kMs, 29'200 * kMs},
                                        {30'990 * kMs, 31'040 * kMs}};
    const auto all = timesBetween(pictures, 0, 100 * kMs, 31'000 * kMs);
    ASSERT_EQ(all.ages_ns.size(), 3u);
    EXPECT_EQ(all.ages_ns.front(), 30 * kMs);
    EXPECT_EQ(all.ages_ns.back(), 50 * kMs);
    EXPECT_EQ(all.oldest_ns, (29'200 - 160) * kMs);
    EXPECT_EQ(timesBetween(pictures, 0, 100 * kMs, 29'100 * kMs).oldest_ns, (29'100 - 160) * kMs)
        << "what is still on the screen has aged as well";
    EXPECT_EQ(timesBetween(pictures, 0, 0, 45 * kMs).oldest_ns, 45 * kMs) << "the scene as it stood at the start";
    EXPECT_EQ(timesBetween({}, 0, 1000 * kMs, 31'000 * kMs).oldest_ns, 31'000 * kMs);
    EXPECT_TRUE(timesBetween(pictures, 40'000 * kMs, 40'000 * kMs, 41'000 * kMs).ages_ns.empty())
        << "of another attempt";
}

}  // namespace
}  // namespace passung::run
