#include "study/design/adaptive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace passung::design {
namespace {

constexpr int kRuns = 1000;

/// Says "right" with the chance of a normal ogive between guess and 1 - lapse.
struct Observer {
    double threshold, sigma, guess = 0.0, lapse = 0.0;
    bool right(double x, Random& random) const {
        const double ogive = 0.5 * std::erfc(-(x - threshold) / sigma / std::sqrt(2.0));
        return random.uniform() < guess + (1.0 - guess - lapse) * ogive;
    }
    /// Where it is right with this chance: the ogive inverted by bisection.
    double levelAt(double chance) const {
        double low = threshold - 10.0 * sigma, high = threshold + 10.0 * sigma;
        for (int i = 0; i < 100; ++i) {
            const double middle = 0.5 * (low + high);
            const double p =
                guess + (1.0 - guess - lapse) * 0.5 * std::erfc(-(middle - threshold) / sigma / std::sqrt(2.0));
            (p < chance ? low : high) = middle;
        }
        return low;
    }
};

AdaptiveParams upDown(int down_after) {
    AdaptiveParams params;
    params.down_after = down_after;
    params.low = 0.0;
    params.high = 20.0;
    params.start = 14.0;
    params.step_up = params.step_down = 1.0;
    params.late_factor = 0.2;
    params.max_trials = 400;
    params.skip_reversals = 6;
    return params;
}

AdaptiveParams psi() {
    AdaptiveParams params;
    params.method = AdaptiveMethod::Psi;
    params.low = params.start = 0.0;
    params.high = 20.0;
    params.sigma_low = 0.5;
    params.sigma_high = 8.0;
    params.guess = 0.0;
    params.max_trials = 60;
    params.grid = 31;
    return params;
}

std::vector<double> play(AdaptiveTrack& track, const std::string& answers) {
    std::vector<double> levels;
    for (const char c : answers) {
        levels.push_back(track.nextLevel());
        track.answer(levels.back(), c == '1');
    }
    return levels;
}

double meanError(const AdaptiveParams& params, const Observer& observer, double truth, int runs = kRuns) {
    double sum = 0.0;
    for (int run = 0; run < runs; ++run) {
        Random random(streamSeed("bias", "", "", "simulated", static_cast<std::uint64_t>(run)));
        AdaptiveTrack track(params);
        while (!track.finished()) {
            const double level = track.nextLevel();
            track.answer(level, observer.right(level, random));
        }
        sum += track.estimate().value() - truth;
    }
    return sum / runs;
}

TEST(Adaptive, TargetsAreThoseOfTheLiterature) {
    // Truth: closed form (Levitt 1971: 0.5^(1/n); Kaernbach 1991: up / (up + down) for one down)
    EXPECT_DOUBLE_EQ(upDown(1).target(), 0.5);
    EXPECT_NEAR(upDown(2).target(), 0.7071, 5e-5);
    EXPECT_NEAR(upDown(3).target(), 0.7937, 5e-5);
    EXPECT_NEAR(upDown(4).target(), 0.8409, 5e-5);
    AdaptiveParams weighted = upDown(1);
    weighted.step_up = 3.0;
    EXPECT_DOUBLE_EQ(weighted.target(), 0.75);
}

TEST(Adaptive, TwoDownOneUpFollowsItsRule) {
    // Truth: closed form, by hand: down after two right in a row, up after each wrong, fine steps after two reversals.
    AdaptiveTrack track(upDown(2));
    EXPECT_EQ(play(track, "1111011"), (std::vector<double>{14, 14, 13, 13, 12, 13, 13}));
    EXPECT_EQ(track.reversals(), 2);
    EXPECT_DOUBLE_EQ(track.nextLevel(), 12.8);
    EXPECT_FALSE(track.estimate());
}

TEST(Adaptive, StepsStartFromWhatWasPresentedAndStayInTheirLimits) {
    // Truth: closed form
    AdaptiveTrack track(upDown(1));
    track.answer(10.0, true);
    EXPECT_EQ(track.nextLevel(), 9.0);
    track.answer(0.3, true);
    EXPECT_EQ(track.nextLevel(), 0.0);
}

TEST(Adaptive, LevelsMayBeLogarithmicOrAList) {
    // Truth: closed form: half a decade is a factor of sqrt(10).
    AdaptiveParams params = upDown(1);
    params.logarithmic = true;
    params.low = 0.1;
    params.high = 100.0;
    params.start = 10.0;
    params.step_down = 0.5;
    AdaptiveTrack track(params);
    track.answer(10.0, true);
    EXPECT_NEAR(track.nextLevel(), std::sqrt(10.0), 1e-12);
    params.levels = {1.0, 4.0, 10.0};
    AdaptiveTrack listed(params);
    listed.answer(10.0, true);
    EXPECT_EQ(listed.nextLevel(), 4.0) << "nearest to 3.16 in the logarithm";
}

TEST(Adaptive, EndsAtTrialsOrReversalsWhicheverComesFirst) {
    // Truth: closed form
    AdaptiveParams params = upDown(1);
    params.max_trials = 5;
    AdaptiveTrack by_trials(params);
    play(by_trials, "11111");
    EXPECT_TRUE(by_trials.finished());
    params.max_reversals = 2;
    AdaptiveTrack by_reversals(params);
    play(by_reversals, "101");
    EXPECT_TRUE(by_reversals.finished());
}

TEST(Adaptive, UpDownIsBiasedByLessThanATwentiethOfSigma) {
    // Truth: closed form: the level where the observer's own ogive has the chance that the rule settles at.
    const Observer observer{8.0, 2.0};
    for (const int down_after : {1, 2, 3}) {
        const AdaptiveParams params = upDown(down_after);
        const double error = meanError(params, observer, observer.levelAt(params.target()));
        EXPECT_LT(std::abs(error), 0.05 * observer.sigma) << down_after << " down";
        std::printf("%d down, 1 up: bias %.1f %% of sigma\n", down_after, 100.0 * error / observer.sigma);
    }
    AdaptiveParams weighted = upDown(1);
    weighted.step_up = 3.0;
    const double error = meanError(weighted, observer, observer.levelAt(0.75));
    EXPECT_LT(std::abs(error), 0.05 * observer.sigma);
    std::printf("weighted 3:1: bias %.1f %% of sigma\n", 100.0 * error / observer.sigma);
}

TEST(Adaptive, PsiIsBiasedByLessThanATwentiethOfSigma) {
    // Truth: closed form: the observer's threshold, which is no point of the grid.
    const Observer observer{8.2, 2.0, 0.0, 0.02};
    const double error = meanError(psi(), observer, observer.threshold);
    EXPECT_LT(std::abs(error), 0.05 * observer.sigma);
    std::printf("psi: bias %.1f %% of sigma\n", 100.0 * error / observer.sigma);
}

TEST(Adaptive, PsiAsksWhereTheThresholdMayBeAndGetsSurer) {
    // Truth: invariant
    AdaptiveTrack track(psi());
    const double before = track.uncertainty();
    Random random(5);
    const Observer observer{8.2, 2.0, 0.0, 0.02};
    while (!track.finished()) {
        const double level = track.nextLevel();
        EXPECT_GE(level, 0.0);
        EXPECT_LE(level, 20.0);
        track.answer(level, observer.right(level, random));
    }
    EXPECT_LT(track.uncertainty(), 0.25 * before);
}

TEST(Adaptive, TracksTakeTurnsByTheSeedAndCatchTrialsTellThemNothing) {
    // Truth: invariant
    const auto order = [](std::uint64_t seed, double catch_share) {
        AdaptiveParams params = upDown(1);
        params.max_trials = 30;
        InterleavedTracks tracks({params, params}, seed, catch_share, 20.0);
        std::map<int, int> counts;
        std::string turns;
        while (const auto step = tracks.next()) {
            const int track = step->track ? static_cast<int>(*step->track) : -1;
            if (track < 0) {
                EXPECT_EQ(step->level, 20.0);
            }
            ++counts[track];
            turns += track < 0 ? 'c' : track == 0 ? 'a' : 'b';
            tracks.answer(step->level, true);
        }
        EXPECT_EQ(counts[0], 30);
        EXPECT_EQ(counts[1], 30);
        EXPECT_EQ(counts[-1] > 0, catch_share > 0.0);
        return turns;
    };
    EXPECT_EQ(order(1, 0.2), order(1, 0.2));
    EXPECT_NE(order(1, 0.0), order(2, 0.0));
    EXPECT_NE(order(1, 0.0), std::string(30, 'a') + std::string(30, 'b'));
}

TEST(Adaptive, SaysWhatIsWrong) {
    // Truth: invariant: what is not a number is wrong too.
    EXPECT_TRUE(upDown(2).validate().empty());
    AdaptiveParams params = upDown(2);
    params.step_down = std::nan("");
    params.start = 30.0;
    EXPECT_EQ(params.validate(), (std::vector<std::string>{"start must lie from low to high", "steps must be > 0"}));
    params = psi();
    params.sigma_low = 9.0;
    EXPECT_EQ(params.validate(), std::vector<std::string>{"sigma_low must be > 0 and below sigma_high"});
}

}  // namespace
}  // namespace passung::design
