#include "tests/devices/fakes/vibration_decoder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <string>

namespace passung::fake {
namespace {

std::uint32_t littleAt(const std::string& bytes, std::size_t at, std::size_t count) {
    if (at + count > bytes.size()) throw std::runtime_error("a WAV file that ends too early");
    std::uint32_t value = 0;
    for (std::size_t i = count; i > 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[at + i - 1]);
    return value;
}

std::size_t indexAt(const Sound& sound, double seconds) {
    const double index = std::clamp(seconds * sound.rate_hz, 0.0, static_cast<double>(sound.samples.size()));
    return static_cast<std::size_t>(std::lround(index));
}

}  // namespace

Sound readWav(const std::filesystem::path& path, int channel) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    if (bytes.substr(0, 4) != "RIFF" || bytes.size() < 12 || bytes.substr(8, 4) != "WAVE")
        throw std::runtime_error("no WAV file: " + path.string());
    Sound sound;
    std::uint32_t format = 0, channels = 0, bits = 0;
    for (std::size_t at = 12; at + 8 <= bytes.size();) {
        const std::string name = bytes.substr(at, 4);
        const std::size_t size = littleAt(bytes, at + 4, 4);
        const std::size_t begin = at + 8;
        if (name == "fmt ") {
            format = littleAt(bytes, begin, 2);
            channels = littleAt(bytes, begin + 2, 2);
            sound.rate_hz = littleAt(bytes, begin + 4, 4);
            bits = littleAt(bytes, begin + 14, 2);
            if (format == 0xfffe) format = littleAt(bytes, begin + 24, 2);  // the extensible form says it later
        } else if (name == "data") {
            const bool is_pcm = format == 1 && bits == 16, is_float = format == 3 && bits == 32;
            if ((!is_pcm && !is_float) || channel < 0 || static_cast<std::uint32_t>(channel) >= channels)
                throw std::runtime_error("a WAV file of another form");
            const std::size_t step = channels * bits / 8;
            // A recorder that was killed has left a size of zero or the greatest: what is there counts.
            const std::size_t end = size == 0 ? bytes.size() : std::min(bytes.size(), begin + size);
            for (std::size_t i = begin; i + step <= end; i += step) {
                const std::uint32_t word = littleAt(bytes, i + static_cast<std::size_t>(channel) * bits / 8, bits / 8);
                sound.samples.push_back(is_pcm ? static_cast<std::int16_t>(word) / 32768.0
                                               : static_cast<double>(std::bit_cast<float>(word)));
            }
            return sound;
        }
        at = begin + size + size % 2;
    }
    throw std::runtime_error("a WAV file without samples: " + path.string());
}

std::vector<double> envelopeOf(const Sound& sound, double carrier_hz) {
    const double omega = 2.0 * std::numbers::pi * carrier_hz / sound.rate_hz;
    const double half = 2.0 * sound.rate_hz / carrier_hz;
    const auto reach = static_cast<std::ptrdiff_t>(std::ceil(half));
    const auto count = static_cast<std::ptrdiff_t>(sound.samples.size());
    struct Tap {
        double weight, cosine, sine;
    };
    std::vector<Tap> taps;  // from -reach to reach
    for (std::ptrdiff_t i = -reach; i <= reach; ++i) {
        const double away = static_cast<double>(i);
        const double weight = std::abs(away) > half ? 0.0 : 1.0 + std::cos(std::numbers::pi * away / half);
        taps.push_back({weight, weight * std::cos(omega * away), weight * std::sin(omega * away)});
    }
    std::vector<double> envelope;
    for (std::ptrdiff_t middle = 0; middle < count; ++middle) {
        double in_phase = 0.0, quadrature = 0.0, weights = 0.0;
        const std::ptrdiff_t end = std::min(count, middle + reach + 1);
        for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, middle - reach); i < end; ++i) {
            const Tap& tap = taps[static_cast<std::size_t>(i - middle + reach)];
            const double x = sound.samples[static_cast<std::size_t>(i)];
            in_phase += tap.cosine * x;
            quadrature += tap.sine * x;
            weights += tap.weight;
        }
        envelope.push_back(2.0 * std::hypot(in_phase, quadrature) / weights);
    }
    return envelope;
}

double correlation(std::span<const double> a, std::span<const double> b) {
    if (a.size() != b.size()) throw std::runtime_error("rows of different length");
    double mean_a = 0.0, mean_b = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        mean_a += a[i] / static_cast<double>(a.size());
        mean_b += b[i] / static_cast<double>(a.size());
    }
    double ab = 0.0, aa = 0.0, bb = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += (a[i] - mean_a) * (b[i] - mean_b);
        aa += (a[i] - mean_a) * (a[i] - mean_a);
        bb += (b[i] - mean_b) * (b[i] - mean_b);
    }
    return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

double peak(const Sound& sound, double from_s, double to_s) {
    double most = 0.0;
    for (std::size_t i = indexAt(sound, from_s); i < indexAt(sound, to_s); ++i) {
        most = std::max(most, std::abs(sound.samples[i]));
    }
    return most;
}

double frequencyOf(const Sound& sound, double from_s, double to_s) {
    double first = 0.0, last = 0.0;
    int crossings = 0;
    for (std::size_t i = indexAt(sound, from_s) + 1; i < indexAt(sound, to_s); ++i) {
        const double before = sound.samples[i - 1], now = sound.samples[i];
        if (!(before < 0.0 && now >= 0.0)) continue;
        last = static_cast<double>(i - 1) + before / (before - now);
        if (crossings++ == 0) first = last;
    }
    return crossings < 2 ? 0.0 : (crossings - 1) * sound.rate_hz / (last - first);
}

}  // namespace passung::fake
