#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace passung {

/// Portable random numbers: the same seed gives the same draws with every compiler and library.
/// (The standard's distributions and std::shuffle do not promise that.) Name in the data: kRandomName.
inline constexpr const char* kRandomName = "xoshiro256ss/fy-v1";

/// One step of splitmix64; advances `state`. Used for seeding.
std::uint64_t splitmix64(std::uint64_t& state) noexcept;

/// FNV-1a, 64 bit.
std::uint64_t fnv1a64(std::string_view text) noexcept;

/// xoshiro256** (Blackman and Vigna 2018), state = four draws of splitmix64.
class Random {
public:
    explicit Random(std::uint64_t seed) noexcept;
    std::uint64_t next() noexcept;
    /// Uniform in 0 … n-1 by rejection; @pre n > 0.
    std::uint64_t below(std::uint64_t n) noexcept;
    /// Uniform in [0, 1), 53 bits.
    double uniform() noexcept;
    double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }
    /// Standard normal by the polar method of Marsaglia; the second value of a pair is kept for the next call.
    double normal() noexcept;

private:
    std::array<std::uint64_t, 4> state_;
    double spare_ = 0.0;
    bool has_spare_ = false;
};

/// Fisher-Yates from the end.
template <class T>
void shuffle(std::vector<T>& items, Random& random) {
    for (std::size_t i = items.size(); i-- > 1;) std::swap(items[i], items[random.below(i + 1)]);
}

/// Seed of a named stream, so that one more draw for one purpose cannot move another purpose's draws:
/// FNV-1a-64("study|participant|phase|purpose") XOR study_seed.
std::uint64_t streamSeed(std::string_view study, std::string_view participant, std::string_view phase,
                         std::string_view purpose, std::uint64_t study_seed);

}  // namespace passung
