#include "study/design/interleaving.h"

#include <gtest/gtest.h>

#include <vector>

namespace passung::design {
namespace {

AdaptiveTrack track(int max_trials) {
    AdaptiveParams params;
    params.high = 20.0;
    params.start = 14.0;
    params.step_up = params.step_down = 1.0;
    params.max_trials = max_trials;
    return AdaptiveTrack(params);
}

TEST(Interleaving, TracksTakeTurnsAtRandomUntilAllAreFinished) {
    // Truth: closed form: each of n draws is either track alike, n/2 +- 4 sqrt(n)/2; then only the one that is left.
    const std::vector<AdaptiveTrack> both{track(1), track(1)};
    int first = 0;
    for (std::uint64_t trial = 0; trial < 1000; ++trial) {
        Random random(trial);
        first += drawTrack(both, random) == std::size_t{0} ? 1 : 0;
    }
    EXPECT_NEAR(first, 500, 64);
    std::vector<AdaptiveTrack> tracks = both;
    tracks[0].answer(14.0, true);
    Random random(1);
    EXPECT_EQ(drawTrack(tracks, random), std::size_t{1});
    tracks[1].answer(14.0, true);
    EXPECT_EQ(drawTrack(tracks, random), std::nullopt);
}

TEST(Interleaving, CatchTrialsAreSoManyAndEachPlaceIsAsLikely) {
    // Truth: closed form: a place is one of 3 in 12 with chance 1/4, 1000 times: 250 +- 4 sqrt(1000 3/16).
    std::vector<int> times(13);
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        Random random(seed);
        const auto catches = drawCatches(12, 3, random);
        ASSERT_EQ(catches.size(), 3u);
        for (const std::size_t place : catches) ++times.at(place);
    }
    EXPECT_EQ(times[0], 0) << "places count from 1";
    for (std::size_t place = 1; place <= 12; ++place) EXPECT_NEAR(times[place], 250, 55) << place;
}

}  // namespace
}  // namespace passung::design
