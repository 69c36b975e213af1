#include "study/measures/smooth_motion.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "study/measures/measures.h"

namespace passung::measures {
namespace {

using std::numbers::pi;

/// Uniform in -1 ... 1 (Park and Miller 1988), as in motion_reference.py.
class Noise {
public:
    double operator()() {
        state_ = state_ * 48271 % 2147483647;
        return 2.0 * static_cast<double>(state_) / 2147483647.0 - 1.0;
    }

private:
    std::uint64_t state_ = 1;
};

using Movement = std::function<Vec3(double)>;

Vec3 line(double s) { return {0.08 * s, 0.05 * s, -0.03 * s}; }
Vec3 circle(double s) { return {0.03 * std::cos(2.0 * pi * s), 0.03 * std::sin(2.0 * pi * s), 0.02}; }
Vec3 reach(double s) { return {0.1 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s), 0.0, 0.0}; }

/// A second of it, with noise of up to `noise` and an encoder of that step.
std::vector<TickRecord> recorded(const Movement& movement, double step, double noise = 2e-6) {
    Noise random;
    std::vector<TickRecord> records(1001);
    for (std::size_t k = 0; k < records.size(); ++k) {
        const Vec3 at = movement(static_cast<double>(k) / 1000.0);
        records[k].tick = static_cast<std::int64_t>(k);
        records[k].hand_quaternion = records[k].proxy_quaternion = {1.0f, 0.0f, 0.0f, 0.0f};
        for (int axis = 0; axis < 3; ++axis) {
            double c = at[axis] + noise * random();
            if (step > 0.0) c = step * std::floor(c / step + 0.5);
            records[k].hand_position_m[static_cast<std::size_t>(axis)] = static_cast<float>(c);
        }
    }
    return records;
}

std::map<std::string, std::optional<double>> measure(const std::vector<TickRecord>& records, double bandwidth = 10.0) {
    TrialContext context;
    context.end_tick = records.back().tick;
    context.motion_bandwidth = bandwidth;
    std::map<std::string, std::optional<double>> result;
    for (const Value& value : computeMeasures(records, context)) result[value.name] = value.value;
    return result;
}

TEST(SmoothMotion, TheFilterPassesWhatTheSquareOfAButterworthsGainSaysAndDelaysNothing) {
    // Truth: closed form. Forward and backward the gain at f is 1/(1 + (tan(pi f/fs) / tan(pi B/fs))^4), the phase 0.
    for (const double bandwidth : {6.0, 10.0, 20.0})
        for (const double f : {2.0, 10.0, 25.0}) {
            std::vector<double> series;
            for (int k = 0; k <= 4000; ++k) series.push_back(std::sin(2.0 * pi * f * k / 1000.0));
            const std::vector<double> before = series;
            lowPass(series, bandwidth);
            const double gain =
                1.0 / (1.0 + std::pow(std::tan(pi * f / 1000.0) / std::tan(pi * bandwidth / 1000.0), 4));
            for (std::size_t k = 1500; k <= 2500; ++k) ASSERT_NEAR(series[k], gain * before[k], 1e-9) << f << " " << k;
        }
}

TEST(SmoothMotion, AStraightLineAndShortSeriesComeThrough) {
    // Truth: closed form (gain 1 at rest, the same at both ends), and invariant: no series is too short.
    std::vector<double> ramp;
    for (int k = 0; k <= 1000; ++k) ramp.push_back(0.25 * k);
    const std::vector<double> before = ramp;
    lowPass(ramp, 10.0);
    for (std::size_t k = 0; k < ramp.size(); ++k) EXPECT_NEAR(ramp[k], before[k], 1e-3) << k;
    for (const std::size_t size : {0u, 1u, 2u, 5u}) {
        std::vector<double> constant(size, 3.0);
        lowPass(constant, 10.0);
        for (const double value : constant) EXPECT_NEAR(value, 3.0, 1e-12);
    }
}

TEST(SmoothMotion, ClosedFormMovementsHaveTheirWayAndSmoothnessWhateverTheEncodersStep) {
    // Truth: closed form of the ways, 2 pi r, and of the jerk, -ln(720 (8/15)^2); independent program of the spectral
    // arc length and of the low-pass (tests/study/measures/motion_reference.py, Python 3.11).
    struct Case {
        const char* name;
        Movement movement;
        double way, arc_length;
        std::optional<double> jerk;
        /// By step, as the reference prints them: path, spectral arc length, log dimensionless jerk (0: not told).
        std::map<double, std::array<double, 3>> reference;
    };
    const double least_jerk = -std::log(720.0 * 64.0 / 225.0);
    for (const Case& c : {Case{"line",
                               line,
                               std::hypot(0.08, 0.05, 0.03),
                               -2.386186,
                               std::nullopt,
                               {{0.0, {0.098999, -2.386258, 0}},
                                {5e-6, {0.098995, -2.386186, 0}},
                                {20e-6, {0.098995, -2.386082, 0}},
                                {60e-6, {0.098969, -2.385548, 0}}}},
                          Case{"circle",
                               circle,
                               2.0 * pi * 0.03,
                               -2.384893,
                               -8.274909,
                               {{0.0, {0.188442, -2.384912, -8.274714}},
                                {5e-6, {0.188440, -2.384886, -8.274774}},
                                {20e-6, {0.188440, -2.384885, -8.273892}},
                                {60e-6, {0.188438, -2.384958, -8.277763}}}},
                          Case{"minimum jerk",
                               reach,
                               0.1,
                               -1.402426,
                               least_jerk,
                               {{0.0, {0.100003, -1.402397, -5.312190}},
                                {5e-6, {0.100000, -1.402403, -5.312121}},
                                {20e-6, {0.100000, -1.402400, -5.315382}},
                                {60e-6, {0.100020, -1.402341, -5.352168}}}}})
        for (const auto& [step, reference] : c.reference) {
            SCOPED_TRACE(std::string(c.name) + " " + std::to_string(step));
            const auto values = measure(recorded(c.movement, step));
            const double way = *values.at("path_length_m"), arc = *values.at("spectral_arc_length");
            EXPECT_NEAR(way, c.way, 0.01 * c.way);
            EXPECT_NEAR(arc, c.arc_length, 0.02 * std::abs(c.arc_length));
            EXPECT_NEAR(way, reference[0], 1e-6);
            EXPECT_NEAR(arc, reference[1], 2e-6);
            const auto jerk = values.at("log_dimensionless_jerk");
            ASSERT_EQ(jerk.has_value(), c.jerk.has_value()) << "a line's jerk is the sensor's";
            if (!jerk) continue;
            EXPECT_NEAR(*jerk, *c.jerk, 0.02 * std::abs(*c.jerk));
            EXPECT_NEAR(*jerk, reference[2], 2e-6);
        }
}

TEST(SmoothMotion, JerkIsToldAsFarAsTheStepAndTheSpeedLetIt) {
    // Truth: closed form. Noise of up to q and steps of q have a variance of q^2 (1/3 + 1/12) an axis; of a reach over
    // A in 1 s the jerk's integral is 720 A^2. Told as long as that is 20 times jerkOfNoise() 1.25 q^2: up to 16.8 um
    // at 0.1 m, 1.68 um at 0.01 m.
    EXPECT_NEAR(jerkOfNoise(10.0), 1.0251e9, 1e5) << "the formula's 102.5 B^7";
    EXPECT_NEAR(jerkOfNoise(20.0) / jerkOfNoise(10.0), 128.0, 1e-9);
    const auto told = [](double way, double step) {
        const Movement movement = [way](double s) { return Vec3(10.0 * way * reach(s)); };
        return measure(recorded(movement, step, step)).at("log_dimensionless_jerk").has_value();
    };
    EXPECT_TRUE(told(0.1, 15e-6));
    EXPECT_FALSE(told(0.1, 19e-6));
    EXPECT_TRUE(told(0.01, 1.5e-6));
    EXPECT_FALSE(told(0.01, 1.9e-6));
}

TEST(SmoothMotion, TheWayOfAnOscillationIsThatOfItsPassedPart) {
    // Truth: closed form. 10 Hz of amplitude a for 2 s: a way of 80 a; half of it passes 10 Hz, of 20 Hz 0.9415.
    std::vector<TickRecord> records(2001);
    for (std::size_t k = 0; k < records.size(); ++k) {
        records[k].tick = static_cast<std::int64_t>(k);
        records[k].hand_quaternion = {1.0f, 0.0f, 0.0f, 0.0f};
        records[k].hand_position_m = {
            static_cast<float>(0.01 * std::sin(2.0 * pi * 10.0 * static_cast<double>(k) / 1000.0)), 0.0f, 0.0f};
    }
    EXPECT_NEAR(*measure(records, 10.0).at("path_length_m"), 0.5 * 0.8, 0.02 * 0.4);
    EXPECT_NEAR(*measure(records, 20.0).at("path_length_m"), 0.9415 * 0.8, 0.02 * 0.75);
}

TEST(SmoothMotion, MissedCyclesAreStraightLines) {
    // Truth: closed form: of a line nothing is missing. Every tenth tick stands for four periods.
    std::vector<TickRecord> all = recorded(line, 0.0, 0.0), some;
    for (std::size_t k = 0; k < all.size(); ++k)
        if (k % 13 == 0 || k % 13 > 3) some.push_back(all[k]);
    for (std::size_t i = 1; i < some.size(); ++i)
        some[i].periods = static_cast<std::uint32_t>(some[i].tick - some[i - 1].tick);
    for (std::size_t i = 0; i < some.size(); ++i) some[i].tick = static_cast<std::int64_t>(i);
    const SmoothMotion motion = smoothMotion(some, 10.0);
    ASSERT_EQ(motion.positions.size(), all.size());
    EXPECT_EQ(motion.at.back(), 1000u);
    for (std::size_t k = 0; k < all.size(); ++k)
        EXPECT_NEAR((motion.positions[k] - line(0.001 * static_cast<double>(k))).norm(), 0.0, 1e-6);
}

TEST(SmoothMotion, ALongTrialsSpectrumIsThatOfItsParts) {
    // Truth: closed form. A constant speed for N ms: A(f)/A(0) = |sin(pi f N)/(N sin(pi f))|, f in 1/ms; its curve up
    // to the last frequency with at least 0.05 of A(0), summed here from that formula.
    for (const std::size_t n : {100u, 1000u, 70000u}) {
        const std::size_t size = 16 * std::bit_ceil(n);
        std::vector<double> amplitude;
        for (std::size_t k = 0; k <= static_cast<std::size_t>(0.01 * static_cast<double>(size)); ++k) {
            const double f = static_cast<double>(k) / static_cast<double>(size);
            amplitude.push_back(k == 0 ? 1.0
                                       : std::abs(std::sin(pi * f * static_cast<double>(n)) /
                                                  (static_cast<double>(n) * std::sin(pi * f))));
        }
        while (amplitude.back() < 0.05) amplitude.pop_back();
        double length = 0.0;
        for (std::size_t k = 1; k < amplitude.size(); ++k)
            length += std::hypot(1.0 / static_cast<double>(amplitude.size() - 1), amplitude[k] - amplitude[k - 1]);
        EXPECT_NEAR(spectralArcLength(std::vector<double>(n, 0.2)), -length, 1e-9) << n;
    }
    EXPECT_TRUE(std::isnan(spectralArcLength(std::vector<double>(100, 0.0)))) << "nothing moves";
}

TEST(Measures, BouncesCountOnceTheyAreTwentyMillisecondsApart) {
    // Truth: closed form: 7 contacts with 20 ms of air between them, each of 5 bounces that are 19 ms apart; of an
    // earlier formula they would be 35.
    std::vector<TickRecord> records = recorded(line, 0.0, 0.0);
    std::size_t k = 10;
    for (int contact = 0; contact < 7; ++contact, k += 1)
        for (int bounce = 0; bounce < 5; ++bounce) {
            records[k].force_N = {0.0f, 0.0f, 1.0f};
            records[k + 1].force_N = {0.0f, 0.0f, 1.0f};
            k += 2 + 19;
        }
    ASSERT_LT(k, records.size());
    EXPECT_EQ(measure(records).at("contact_onsets"), 7.0);
}

TEST(Measures, PercentilesAreOfTheContactTicksAndContactOutsideIsWhereTheTipIsInNoHole) {
    // Truth: closed form (nearest rank). Forces 1 ... 200 N in 200 ticks: the 198th; the tip is in the bore in 50 of
    // them.
    std::vector<TickRecord> records = recorded(line, 0.0, 0.0);
    for (std::size_t i = 0; i < 200; ++i) {
        TickRecord& record = records[300 + i];
        const float rank = static_cast<float>((i * 73) % 200 + 1);
        record.force_N = {rank, 0.0f, 0.0f};
        record.torque_Nm = {0.0f, 0.01f * rank, 0.0f};
        record.hand_depth_m = 1e-3f * rank;
        record.proxy_depth_m = 1e-6f * rank;
        record.proxy_position_m = {0.0f, 0.0f, i < 50 ? -0.005f : 0.005f};
    }
    const auto values = measure(records);
    EXPECT_EQ(values.at("p99_force_N"), 198.0);
    EXPECT_EQ(values.at("peak_force_N"), 200.0);
    EXPECT_NEAR(*values.at("p99_torque_Nm"), 1.98, 1e-6);
    EXPECT_NEAR(*values.at("p99_hand_depth_m"), 0.198, 1e-7);
    EXPECT_NEAR(*values.at("p99_proxy_depth_m"), 198e-6, 1e-10);
    EXPECT_NEAR(*values.at("contact_time_s"), 0.2, 1e-12);
    EXPECT_NEAR(*values.at("contact_time_outside_s"), 0.15, 1e-12);
    EXPECT_FALSE(measure(recorded(line, 0.0, 0.0)).at("p99_force_N")) << "nothing touched";
}

TEST(Measures, AHalfCircleIsHalfPiTimesItsDiameter) {
    // Truth: closed form, within what the low-pass takes of a circle.
    const auto values = measure(recorded([](double s) { return circle(0.5 * s); }, 0.0, 0.0));
    EXPECT_NEAR(*values.at("straight_path_ratio"), pi / 2.0, 1e-3);
    EXPECT_NEAR(*measure(recorded(line, 0.0, 0.0)).at("straight_path_ratio"), 1.0, 1e-5);
    EXPECT_FALSE(measure(recorded([](double) { return Vec3(0, 0, 0); }, 0.0, 0.0)).at("straight_path_ratio"));
}

}  // namespace
}  // namespace passung::measures
