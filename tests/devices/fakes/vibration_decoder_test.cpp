#include "tests/devices/fakes/vibration_decoder.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>

#include "tests/support/temp_folder.h"

namespace passung {
namespace {

using fake::Sound;

/// amplitude(t) · sin(2π f t + phase), a second long, or so many.
Sound vibration(double rate, double carrier, double phase, const std::function<double(double)>& amplitude,
                double seconds = 1.0) {
    Sound sound{rate, {}};
    for (int i = 0; i < static_cast<int>(seconds * rate); ++i) {
        const double t = i / rate;
        sound.samples.push_back(amplitude(t) * std::sin(2.0 * std::numbers::pi * carrier * t + phase));
    }
    return sound;
}

TEST(VibrationDecoder, FindsASteadyAmplitudeAtEveryCarrierAndPhase) {
    // Truth: closed form: A sin(ωt + φ) has the envelope A. What is left comes from sampling the window: below 1e-3.
    for (const double rate : {8000.0, 44100.0}) {
        for (const double carrier : {40.0, 173.0, 250.0, 400.0}) {
            for (const double phase : {0.0, 2.0}) {
                const Sound sound = vibration(
                    rate, carrier, phase, [](double) { return 0.6; }, 0.25);
                const std::vector<double> envelope = fake::envelopeOf(sound, carrier);
                const auto edge = static_cast<std::size_t>(2.0 * rate / carrier) + 1;
                for (std::size_t i = edge; i + edge < envelope.size(); i += 997) {
                    ASSERT_NEAR(envelope[i], 0.6, 1e-3) << rate << ' ' << carrier << ' ' << phase;
                }
                EXPECT_NEAR(fake::frequencyOf(sound, 0.02, 0.24), carrier, 1e-3 * carrier);
            }
        }
    }
}

TEST(VibrationDecoder, FollowsAnAmplitudeThatChangesSlowly) {
    // Truth: closed form: an amplitude of 2 Hz passes a window of four periods of 250 Hz with a loss below 1 %.
    const auto amplitude = [](double t) { return 0.4 + 0.3 * std::sin(4.0 * std::numbers::pi * t); };
    const std::vector<double> envelope = fake::envelopeOf(vibration(8000.0, 250.0, 0.3, amplitude), 250.0);
    std::vector<double> truth;
    for (std::size_t i = 0; i < envelope.size(); ++i) truth.push_back(amplitude(static_cast<double>(i) / 8000.0));
    EXPECT_GT(fake::correlation(envelope, truth), 0.9999);
    for (std::size_t i = 100; i + 100 < envelope.size(); i += 101) EXPECT_NEAR(envelope[i], truth[i], 0.003);
}

TEST(VibrationDecoder, SeesSilenceBeforeAndAfterABurstAndNotAnotherCarrier) {
    // Truth: closed form: outside a burst and two periods around it the envelope is zero; a tone far from the carrier
    // is damped, for the window is 16 ms long.
    const Sound burst = vibration(8000.0, 250.0, 0.0, [](double t) { return t >= 0.4 && t < 0.5 ? 0.8 : 0.0; });
    const std::vector<double> envelope = fake::envelopeOf(burst, 250.0);
    EXPECT_EQ(envelope[8000 * 39 / 100], 0.0);
    EXPECT_NEAR(envelope[8000 * 45 / 100], 0.8, 1e-3);
    EXPECT_EQ(envelope[8000 * 51 / 100], 0.0);
    EXPECT_EQ(fake::peak(burst, 0.0, 0.4), 0.0);
    EXPECT_NEAR(fake::peak(burst, 0.4, 0.5), 0.8, 1e-9);
    EXPECT_EQ(fake::frequencyOf(burst, 0.0, 0.39), 0.0);
    const Sound other = vibration(8000.0, 500.0, 0.0, [](double) { return 0.8; });
    EXPECT_LT(fake::envelopeOf(other, 250.0)[4000], 0.01);
}

TEST(VibrationDecoder, CorrelatesByTheFormula) {
    // Truth: closed form, by hand: deviations (-1, 0, 1) and (-3, 0, 3); (-1, 1, 0) with (-1, 0, 1): 1 / 2.
    EXPECT_DOUBLE_EQ(fake::correlation(std::vector{1.0, 2.0, 3.0}, std::vector{2.0, 5.0, 8.0}), 1.0);
    EXPECT_DOUBLE_EQ(fake::correlation(std::vector{1.0, 2.0, 3.0}, std::vector{8.0, 5.0, 2.0}), -1.0);
    EXPECT_DOUBLE_EQ(fake::correlation(std::vector{1.0, 3.0, 2.0}, std::vector{1.0, 2.0, 3.0}), 0.5);
    EXPECT_EQ(fake::correlation(std::vector{1.0, 1.0}, std::vector{1.0, 2.0}), 0.0);
}

TEST(VibrationDecoder, ReadsAFileThatAnotherProgramWrote) {
    // Truth: independent program (the module wave of Python 3.11): stereo, 16 bits, 8 kHz, 60 ms. On the left a burst
    // of 250 Hz and amplitude 0.5 from 20 to 40 ms, on the right 0.25 throughout.
    const std::string path = PASSUNG_SOURCE_DIR "/tests/data/wire/burst_250Hz.wav";
    const Sound left = fake::readWav(path, 0), right = fake::readWav(path, 1);
    EXPECT_EQ(left.rate_hz, 8000.0);
    ASSERT_EQ(left.samples.size(), 480u);
    EXPECT_EQ(fake::peak(left, 0.0, 0.020), 0.0);
    EXPECT_NEAR(fake::peak(left, 0.020, 0.040), 0.5, 1e-3);
    EXPECT_EQ(fake::peak(left, 0.040, 0.060), 0.0);
    EXPECT_NEAR(fake::envelopeOf(left, 250.0)[240], 0.5, 1e-3);
    EXPECT_NEAR(fake::frequencyOf(left, 0.020, 0.040), 250.0, 0.5);
    for (const double x : right.samples) EXPECT_EQ(x, 0.25);
    EXPECT_THROW(fake::readWav(path, 2), std::runtime_error);
}

TEST(VibrationDecoder, ReadsFloatsAndWhatAKilledRecorderHasLeft) {
    // Truth: closed form: the head of a WAV file, written out by hand; its sizes are zero, as before a file is closed.
    const test::TempFolder folder;
    std::string bytes("RIFF\0\0\0\0WAVEfmt \x10\0\0\0\x03\0\x01\0\x40\x1f\0\0\0\x7d\0\0\x04\0\x20\0data\0\0\0\0", 44);
    for (const float x : {0.5f, -1.0f}) {
        const auto word = std::bit_cast<std::uint32_t>(x);
        for (const int shift : {0, 8, 16, 24}) bytes += static_cast<char>(word >> shift & 0xff);
    }
    bytes += "\x01";  // half a sample
    std::ofstream(folder / "a.wav", std::ios::binary) << bytes;
    const Sound sound = fake::readWav(folder / "a.wav");
    EXPECT_EQ(sound.rate_hz, 8000.0);
    EXPECT_EQ(sound.samples, (std::vector<double>{0.5, -1.0}));
    std::ofstream(folder / "b.wav", std::ios::binary) << bytes.substr(0, 40);
    EXPECT_THROW(fake::readWav(folder / "b.wav"), std::runtime_error);
    EXPECT_THROW(fake::readWav(folder / "none.wav"), std::runtime_error);
}

}  // namespace
}  // namespace passung
