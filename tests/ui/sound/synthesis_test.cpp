#include "ui/sound/synthesis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "ui/sound/sound_feed.h"

namespace passung::sound {
namespace {

constexpr double kRate = SoundFeed::kRate;

/// A hand that comes at this speed and touches in tick 5.
TickRecord coming(std::int64_t tick, double speed) {
    TickRecord record;
    record.tick = tick;
    record.hand_position_m = {static_cast<float>(speed * kTickSeconds * static_cast<double>(tick)), 0.0f, 0.0f};
    record.hand_quaternion = {1.0f, 0.0f, 0.0f, 0.0f};
    record.status = kEngaged;
    record.hand_depth_m = tick >= 5 ? 1e-4f : 0.0f;
    record.contacts = tick >= 5 ? 1 : 0;
    return record;
}

std::vector<float> rendered(Synthesis& synthesis, double seconds) {
    std::vector<float> samples(static_cast<std::size_t>(seconds * kRate));
    synthesis.render(samples);
    return samples;
}

double loudest(const std::vector<float>& samples) {
    double most = 0.0;
    for (const float sample : samples) most = std::max(most, std::abs(static_cast<double>(sample)));
    return most;
}

SoundPlan knocks() { return {.cues = {.sound = true, .full_speed = 0.1, .sound_decay = 0.05}}; }

std::vector<float> impactAt(double speed) {
    Synthesis synthesis(kRate);
    synthesis.begin(knocks());
    for (std::int64_t tick = 0; tick <= 5; ++tick) synthesis.follow(coming(tick, speed));
    return rendered(synthesis, 0.2);
}

TEST(Synthesis, AKnockIsAsLoudAsTheImpactIsFastAndDiesAwayAsTheCueDoes) {
    // Truth: closed form, every sample, within what positions in 32-bit floats leave of a speed.
    for (const double speed : {0.02, 0.05, 0.1, 0.4}) {
        const double command = std::min(1.0, speed / 0.1);
        const std::vector<float> samples = impactAt(speed);
        for (std::size_t n = 0; n < samples.size(); ++n) {
            const double t = static_cast<double>(n) / kRate;
            const double w = 2.0 * std::numbers::pi * Synthesis::kKnockHz;
            const double expected = Synthesis::kKnock * command * std::exp(-t / 0.05) *
                                    (3.0 * std::sin(w * t) + 2.0 * std::sin(2.76 * w * t)) / 5.0;
            ASSERT_NEAR(static_cast<double>(samples[n]), expected, 1e-4) << speed << " m/s, sample " << n;
        }
    }
}

TEST(Synthesis, ContactThatLastsIsSilentAndAnotherImpactSounds) {
    // Truth: invariant. While the hand stays in contact the cue's command only falls.
    Synthesis synthesis(kRate);
    synthesis.begin(knocks());
    for (std::int64_t tick = 0; tick <= 5; ++tick) synthesis.follow(coming(tick, 0.1));
    const double first = loudest(rendered(synthesis, 0.01));
    for (std::int64_t tick = 6; tick < 1000; ++tick) synthesis.follow(coming(tick, 0.1));
    rendered(synthesis, 0.99);
    EXPECT_LT(loudest(rendered(synthesis, 0.01)), 1e-6 * first);
    TickRecord away = coming(1000, 0.1);
    away.hand_depth_m = 0.0f;
    away.contacts = 0;
    synthesis.follow(away);
    synthesis.follow(coming(1001, 0.1));
    EXPECT_NEAR(loudest(rendered(synthesis, 0.01)), first, 1e-3 * first);
}

TEST(Synthesis, MaskingNoiseIsWhiteAndAsLoudAsSaid) {
    // Truth: closed form. Uniform noise of amplitude a has the power a²/3; white noise has no correlation between
    // samples: over N of them ±1/√N, five times that allowed. Its mean is 0 likewise.
    Synthesis synthesis(kRate);
    synthesis.begin({.cues = {.masking = true}, .seed = 11});
    const std::vector<float> noise = rendered(synthesis, 2.0);
    const auto n = static_cast<double>(noise.size());
    std::vector<double> lag(40, 0.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < noise.size(); ++i) {
        sum += static_cast<double>(noise[i]);
        for (std::size_t k = 0; k < lag.size() && k <= i; ++k)
            lag[k] += static_cast<double>(noise[i]) * static_cast<double>(noise[i - k]);
    }
    EXPECT_NEAR(lag[0] / n, Synthesis::kNoise * Synthesis::kNoise / 3.0, 0.01 * lag[0] / n);
    EXPECT_NEAR(sum / n, 0.0, 5.0 * Synthesis::kNoise / std::sqrt(n));
    for (std::size_t k = 1; k < lag.size(); ++k) EXPECT_NEAR(lag[k] / lag[0], 0.0, 5.0 / std::sqrt(n)) << k;
}

/// Stimuli a second apart, each of 0.3 s.
SoundPlan beeps() {
    SoundPlan plan;
    plan.stimulus = {.least_interval = 1.0, .most_interval = 1.0, .duration = 0.3};
    return plan;
}

TEST(Synthesis, AStimulusIsATonePureFromItsOnsetToTheAnswer) {
    // Truth: closed form. Tick 1000 is the first onset; 100 ms hold 200 passages through 0 of a tone of 1 kHz.
    Synthesis synthesis(kRate);
    synthesis.begin(beeps());
    for (std::int64_t tick = 0; tick < 1000; ++tick) synthesis.follow(coming(tick, 0.0));
    EXPECT_EQ(loudest(rendered(synthesis, 0.05)), 0.0) << "not yet";
    for (std::int64_t tick = 1000; tick < 1150; ++tick) synthesis.follow(coming(tick, 0.0));
    rendered(synthesis, 0.01);
    const std::vector<float> tone = rendered(synthesis, 0.05);
    EXPECT_NEAR(loudest(tone), Synthesis::kTone, 1e-3);
    int passages = 0;
    for (std::size_t i = 1; i < tone.size(); ++i) passages += (tone[i] > 0.0f) != (tone[i - 1] > 0.0f) ? 1 : 0;
    EXPECT_NEAR(passages, 100, 1);
    TickRecord press = coming(1150, 0.0);
    press.input_flags = 1u << 8;
    synthesis.follow(press);
    rendered(synthesis, Synthesis::kRamp);
    EXPECT_EQ(loudest(rendered(synthesis, 0.05)), 0.0) << "it was answered";
}

TEST(Synthesis, AStimulusDoesNotGoOnWhenTicksNoLongerCome) {
    // Truth: invariant. A paused or stopped trial beeps at nobody.
    Synthesis synthesis(kRate);
    synthesis.begin(beeps());
    for (std::int64_t tick = 0; tick < 1010; ++tick) synthesis.follow(coming(tick, 0.0));
    rendered(synthesis, Synthesis::kStale + 2.0 * Synthesis::kRamp);
    EXPECT_EQ(loudest(rendered(synthesis, 1.0)), 0.0);
}

TEST(Synthesis, NothingClipsWhenEverythingSoundsAtOnce) {
    // Truth: invariant, the sum of the amplitudes.
    EXPECT_LT(Synthesis::kKnock + Synthesis::kTone + Synthesis::kNoise, 1.0);
    SoundPlan all = beeps();
    all.cues = {.sound = true, .full_speed = 0.01, .sound_decay = 10.0, .masking = true};
    Synthesis synthesis(kRate);
    synthesis.begin(all);
    for (std::int64_t tick = 0; tick < 1010; ++tick) synthesis.follow(coming(tick, 1.0));
    const double most = loudest(rendered(synthesis, 0.09));
    EXPECT_LT(most, 1.0);
    EXPECT_GT(most, 0.7) << "not everything sounded";
}

TEST(SoundFeed, PlaysTheTicksOfItsRingByThePlanOfTheirAttempt) {
    // Truth: invariant. The next attempt's plan holds from its first tick; no plan is silence at once.
    SoundFeed feed;
    const auto push = [&](std::int64_t from, std::int64_t to, double speed) {
        for (std::int64_t tick = from; tick < to; ++tick) ASSERT_TRUE(feed.ring().tryPush({coming(tick, speed), tick}));
    };
    const auto filled = [&](double seconds) {
        std::vector<float> samples(static_cast<std::size_t>(seconds * kRate));
        feed.fill(samples);
        return samples;
    };
    EXPECT_EQ(loudest(filled(0.02)), 0.0);
    feed.plan(knocks());
    push(0, 6, 0.1);
    const std::vector<float> heard = filled(0.02);
    const std::vector<float> expected = impactAt(0.1);
    EXPECT_TRUE(std::equal(heard.begin(), heard.end(), expected.begin()));
    feed.plan({.cues = {.masking = true}});
    push(6, 400, 0.1);
    filled(2.0);
    EXPECT_LT(loudest(filled(0.02)), 1e-6) << "the noise belongs to the next attempt";
    push(0, 3, 0.0);
    EXPECT_GT(loudest(filled(0.02)), 0.9 * Synthesis::kNoise);
    feed.plan({});
    EXPECT_EQ(loudest(filled(0.02)), 0.0);
}

}  // namespace
}  // namespace passung::sound
