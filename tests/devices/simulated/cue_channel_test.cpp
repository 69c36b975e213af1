#include "devices/simulated/cue_channel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "devices/simulated/simulated_device.h"

namespace passung::simulated {
namespace {

TEST(CueChannel, LetsThroughWhatReachesTheThresholdLate) {
    // Truth: closed form: without noise the strength itself, 30 ticks later, and nothing below the threshold.
    CueChannel channel({.threshold = 0.2, .delay = 0.03, .noise = 0.0}, 1);
    std::vector<double> given;
    for (int k = 0; k < 200; ++k) {
        given.push_back(k < 50 ? 0.0 : std::min(1.0, (k - 50) / 100.0));
        channel.give(given.back());
        const double then = k < 30 ? 0.0 : given[static_cast<std::size_t>(k - 30)];
        EXPECT_DOUBLE_EQ(channel.perceived(), then >= 0.2 ? then : 0.0) << k;
    }
}

TEST(CueChannel, StrengthIsWrongByTheNoise) {
    // Truth: closed form: the logarithm of perceived over given has standard deviation 0.3, ± 4 standard errors.
    CueChannel channel({.threshold = 0.001, .delay = 0.0, .noise = 0.3}, 2);
    double sum = 0.0, square = 0.0;
    constexpr int kOnsets = 4000;
    for (int i = 0; i < kOnsets; ++i) {
        channel.give(0.1);
        const double wrong = std::log(channel.perceived() / 0.1);
        sum += wrong / kOnsets;
        square += wrong * wrong / kOnsets;
        channel.give(0.0);
    }
    EXPECT_NEAR(sum, 0.0, 4.0 * 0.3 / std::sqrt(kOnsets));
    EXPECT_NEAR(std::sqrt(square - sum * sum), 0.3, 4.0 * 0.3 / std::sqrt(2.0 * kOnsets));
}

TEST(CueChannel, WhereNothingIsGivenNoNumberIsDrawn) {
    // Truth: invariant: what is perceived of a cue does not depend on how long nothing was given before.
    CueChannel early({}, 3), late({}, 3);
    for (int k = 0; k < 5000; ++k) late.give(0.0);
    for (int k = 0; k < 2000; ++k) {
        early.give(0.5);
        late.give(0.5);
        if (k >= 250) {
            EXPECT_EQ(early.perceived(), late.perceived());
        }
    }
    EXPECT_GT(early.perceived(), 0.0);
}

/// Readings of a device in free space whose person is given `cue` from a second after the go sign on; < 0: never asked.
std::vector<Pose> readings(double cue) {
    VisibleTask task;
    task.X_WHeldStart.p = Vec3(0, 0, 0.03);
    SimulatedDevice device(*findPreset("sigma7"), HandParams{}, task, {}, 4);
    std::vector<Pose> all;
    for (int k = 0; k < 6000; ++k) {
        all.push_back(device.read().X_BD);
        device.command({});
        if (cue >= 0.0) device.notice({.vibration = k >= 2000 ? cue : 0.0});
        if (k % 16 == 0) device.show({.tick = k, .X_WShown = all.back(), .running = k >= 1000});
    }
    return all;
}

bool sameBits(const std::vector<Pose>& a, const std::vector<Pose>& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i].p != b[i].p || a[i].q.coeffs() != b[i].q.coeffs()) return false;
    return true;
}

TEST(CueChannel, AHandThatIsGivenNothingMovesAsWithoutCues) {
    // Truth: invariant: equal bits without cues, with cues at 0 and below the threshold; other ones with a cue.
    const std::vector<Pose> none = readings(-1.0);
    EXPECT_TRUE(sameBits(none, readings(0.0)));
    EXPECT_TRUE(sameBits(none, readings(0.001)));
    EXPECT_FALSE(sameBits(none, readings(0.6)));
}

}  // namespace
}  // namespace passung::simulated
