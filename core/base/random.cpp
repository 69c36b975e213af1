#include "core/base/random.h"

#include <bit>
#include <cmath>
#include <string>

namespace passung {

std::uint64_t splitmix64(std::uint64_t& state) noexcept {
    state += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

std::uint64_t fnv1a64(std::string_view text) noexcept {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return hash;
}

Random::Random(std::uint64_t seed) noexcept {
    for (auto& word : state_) word = splitmix64(seed);
}

std::uint64_t Random::next() noexcept {
    const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 45);
    return result;
}

std::uint64_t Random::below(std::uint64_t n) noexcept {
    // Draws at or above the largest multiple of n would favour small results: 2^64 mod n = (2^64 - n) mod n.
    const std::uint64_t excess = (0 - n) % n;
    for (;;) {
        const std::uint64_t x = next();
        if (excess == 0 || x < 0 - excess) return x % n;
    }
}

double Random::uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

double Random::normal() noexcept {
    if (has_spare_) {
        has_spare_ = false;
        return spare_;
    }
    for (;;) {
        const double u = uniform(-1.0, 1.0);
        const double v = uniform(-1.0, 1.0);
        const double s = u * u + v * v;
        if (s >= 1.0 || s == 0.0) continue;
        const double k = std::sqrt(-2.0 * std::log(s) / s);
        spare_ = v * k;
        has_spare_ = true;
        return u * k;
    }
}

std::uint64_t streamSeed(std::string_view study, std::string_view participant, std::string_view phase,
                         std::string_view purpose, std::uint64_t study_seed) {
    std::string name;
    for (const auto part : {study, participant, phase, purpose}) {
        if (!name.empty()) name += '|';
        name += part;
    }
    return fnv1a64(name) ^ study_seed;
}

}  // namespace passung
