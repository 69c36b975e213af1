#include "study/design/adaptive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/base/random.h"
#include "core/base/sanitizer.h"

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

AdaptiveParams psi(double guess = 0.0) {
    AdaptiveParams params;
    params.method = AdaptiveMethod::Psi;
    params.low = params.start = 0.0;
    params.high = 20.0;
    params.sigma_low = 0.5;
    params.sigma_high = 8.0;
    params.guess = guess;
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
    const AdaptiveTrack fresh(params);
    double sum = 0.0;
    for (int run = 0; run < runs; ++run) {
        Random random(streamSeed("bias", "", "", "simulated", static_cast<std::uint64_t>(run)));
        AdaptiveTrack track = fresh;
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
    if (kSanitized) GTEST_SKIP() << "a mean of many runs; what one of them does, the other tests do";
    for (const double guess : {0.0, 0.5}) {
        const Observer observer{8.2, 2.0, guess, 0.02};
        const double error = meanError(psi(guess), observer, observer.threshold);
        EXPECT_LT(std::abs(error), 0.05 * observer.sigma) << guess;
        std::printf("psi, guess %.1f: bias %.1f %% of sigma\n", guess, 100.0 * error / observer.sigma);
    }
}

/// Psi as its paper has it (Kontsevich, Tyler 1999, steps 1 to 8): for each level and each answer the whole posterior,
/// its entropy, and the expectation over both answers. Nothing is shared with the program but the definition.
class PlainPsi {
public:
    explicit PlainPsi(const AdaptiveParams& p) : p_(p) {
        for (int a = 0; a < p.grid; ++a)
            for (int s = 0; s < 11; ++s)
                points_.push_back({p.low + (p.high - p.low) * a / (p.grid - 1.0),
                                   p.sigma_low * std::exp(std::log(p.sigma_high / p.sigma_low) * s / 10.0),
                                   1.0 / (11.0 * p.grid)});
    }
    double next() const {
        double best = p_.low, least = 1e300;
        for (int c = 0; c < p_.grid; ++c) {
            const double x = p_.low + (p_.high - p_.low) * c / (p_.grid - 1.0);
            double expected = 0.0;
            for (const bool right : {true, false}) {
                const auto [after, share] = posterior(x, right);
                double entropy = 0.0;
                for (const Point& point : after)
                    if (point.weight > 0.0) entropy -= point.weight * std::log(point.weight);
                expected += share * entropy;
            }
            if (expected < least - 1e-12) best = x, least = expected;
        }
        return best;
    }
    void answer(double x, bool right) { points_ = posterior(x, right).first; }
    double deviation() const {
        double mean = 0.0, square = 0.0;
        for (const Point& point : points_) {
            mean += point.weight * point.threshold;
            square += point.weight * point.threshold * point.threshold;
        }
        return std::sqrt(square - mean * mean);
    }

private:
    struct Point {
        double threshold, sigma, weight;
    };
    std::pair<std::vector<Point>, double> posterior(double x, bool right) const {
        std::vector<Point> after = points_;
        double sum = 0.0;
        for (Point& point : after) {
            const Observer observer{point.threshold, point.sigma, p_.guess, p_.lapse};
            const double z = (x - observer.threshold) / observer.sigma;
            const double p =
                observer.guess + (1.0 - observer.guess - observer.lapse) * 0.5 * (1.0 + std::erf(z / std::sqrt(2.0)));
            point.weight *= right ? p : 1.0 - p;
            sum += point.weight;
        }
        for (Point& point : after) point.weight /= sum;
        return {after, sum};
    }
    AdaptiveParams p_;
    std::vector<Point> points_;
};

TEST(Adaptive, PsiAsksWhatAPlainWritingOfItsPaperAsks) {
    // Truth: independent program (PlainPsi above: posteriors and entropies written out)
    AdaptiveParams params = psi(0.5);
    params.grid = 21;
    params.max_trials = 30;
    AdaptiveTrack track(params);
    PlainPsi plain(params);
    const Observer observer{7.3, 1.5, 0.5, 0.02};
    Random random(11);
    while (!track.finished()) {
        const double level = track.nextLevel();
        EXPECT_NEAR(level, plain.next(), 1e-9) << track.trials();
        const bool right = observer.right(level, random);
        track.answer(level, right);
        plain.answer(level, right);
        EXPECT_NEAR(track.uncertainty().value(), plain.deviation(), 1e-9);
    }
}

TEST(Adaptive, PsiAsksWhereTheThresholdMayBeAndGetsSurer) {
    // Truth: invariant
    AdaptiveTrack track(psi());
    const double before = track.uncertainty().value();
    Random random(5);
    const Observer observer{8.2, 2.0, 0.0, 0.02};
    while (!track.finished()) {
        const double level = track.nextLevel();
        EXPECT_GE(level, 0.0);
        EXPECT_LE(level, 20.0);
        track.answer(level, observer.right(level, random));
    }
    EXPECT_LT(track.uncertainty().value(), 0.25 * before);
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
