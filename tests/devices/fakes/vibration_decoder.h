#pragma once

#include <filesystem>
#include <span>
#include <vector>

namespace passung::fake {

/// One channel of sound, from -1 to 1.
struct Sound {
    double rate_hz = 0.0;
    std::vector<double> samples;
};

/// The channel of that number of a WAV file: PCM of 16 bits or IEEE floats of 32. Throws where it is neither.
Sound readWav(const std::filesystem::path& path, int channel = 0);

/// The amplitude of a vibration of `carrier_hz` at each sample, taken over a window of four periods around it: x is
/// multiplied by cos and sin of the carrier and both are averaged with the weights 1 - cos, whose spectrum has a zero
/// at twice the carrier. A steady A sin(ωt + φ) gives A; what is slower than the window comes through; a burst's edge
/// is spread over two periods to both sides. Nearer to an end than that the window is cut and its weights are scaled.
std::vector<double> envelopeOf(const Sound& sound, double carrier_hz);

/// Pearson's coefficient of two rows of equal length; 0 where one of them is constant.
double correlation(std::span<const double> a, std::span<const double> b);

/// The greatest |x| among the samples from one time to another.
double peak(const Sound& sound, double from_s, double to_s);

/// Crossings of zero upwards in the time between the first and the last of them; 0 with fewer than two.
double frequencyOf(const Sound& sound, double from_s, double to_s);

}  // namespace passung::fake
