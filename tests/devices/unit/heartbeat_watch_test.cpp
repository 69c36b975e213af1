#include "devices/unit/heartbeat_watch.h"

#include <gtest/gtest.h>

namespace passung::unit {
namespace {

using Nanoseconds = HeartbeatWatch::Nanoseconds;
constexpr Nanoseconds kMs = 1'000'000;

/// A study that commands and a host that looks, each at its time.
struct Bench {
    HeartbeatWatch watch{std::chrono::milliseconds(5), std::chrono::milliseconds(50)};
    HeartbeatWatch::Beat beat;

    double command(Nanoseconds at, bool pushes = true) {
        beat = {beat.number + 1, at, pushes, watch.withheld()};
        return watch.share(beat, at);
    }
    double look(Nanoseconds at) { return watch.share(beat, at); }
};

TEST(HeartbeatWatch, PassesAWrenchForOneHeartbeat) {
    // Truth: invariant.
    Bench bench;
    EXPECT_EQ(bench.look(0), 0.0) << "nothing was commanded yet";
    EXPECT_EQ(bench.command(10 * kMs), 1.0);
    EXPECT_EQ(bench.look(15 * kMs), 1.0);
    EXPECT_EQ(bench.look(15 * kMs + 1), 0.0);
    EXPECT_EQ(bench.look(9 * kMs), 1.0);
    EXPECT_EQ(bench.look(4 * kMs), 0.0) << "a stamp from far ahead is none";
}

TEST(HeartbeatWatch, RampsBackWhatComesWithinFiftyMillisecondsAndCountsIt) {
    // Truth: closed form: the share grows evenly from 0 to 1 within 50 ms.
    Bench bench;
    bench.command(10 * kMs);
    bench.look(30 * kMs);
    EXPECT_EQ(bench.command(60 * kMs), 0.0);
    EXPECT_EQ(bench.watch.gaps(), 1u);
    for (int ms = 1; ms <= 50; ++ms) EXPECT_DOUBLE_EQ(bench.command((60 + ms) * kMs), ms / 50.0);
    EXPECT_EQ(bench.command(120 * kMs), 1.0);
    EXPECT_EQ(bench.watch.gaps(), 1u);
    EXPECT_EQ(bench.watch.withheld(), 0u);
}

TEST(HeartbeatWatch, LatchesBeyondUntilTheStudyKnowsAndHasCommandedZero) {
    // Truth: invariant: whether the host has looked meanwhile or not.
    for (const bool looks : {true, false}) {
        Bench bench;
        bench.command(10 * kMs);
        bench.look(20 * kMs);
        if (looks) bench.look(60 * kMs + 1);
        bench.beat = {2, 60 * kMs + 1, true, 0};
        EXPECT_EQ(bench.look(60 * kMs + 1), 0.0);
        EXPECT_EQ(bench.watch.withheld(), 1u);
        EXPECT_EQ(bench.watch.gaps(), 0u);
        bench.beat = {3, 61 * kMs, false, 0};
        bench.look(61 * kMs);
        bench.beat = {4, 62 * kMs, true, 0};
        EXPECT_EQ(bench.look(62 * kMs), 0.0) << "it did not know";
        EXPECT_EQ(bench.command(63 * kMs), 0.0) << "it knows, and has not commanded zero";
        bench.command(64 * kMs, false);
        EXPECT_EQ(bench.command(65 * kMs), 1.0);
    }
}

TEST(HeartbeatWatch, AHostThatWasLateItselfBlamesNobody) {
    // Truth: invariant: the newest command is young, whatever the last one was that was seen.
    Bench bench;
    bench.command(10 * kMs);
    bench.beat.number = 200;
    bench.beat.at = 300 * kMs;
    EXPECT_EQ(bench.look(301 * kMs), 1.0);
    EXPECT_EQ(bench.watch.gaps() + bench.watch.withheld(), 0u);
}

TEST(HeartbeatWatch, AMissingZeroIsNoGap) {
    // Truth: invariant: between attempts commands are rare, and zero.
    Bench bench;
    bench.command(10 * kMs, false);
    bench.look(100 * kMs);
    EXPECT_EQ(bench.command(101 * kMs), 1.0);
    EXPECT_EQ(bench.watch.gaps() + bench.watch.withheld(), 0u);
}

}  // namespace
}  // namespace passung::unit
