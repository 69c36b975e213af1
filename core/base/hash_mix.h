#pragma once

#include <cstdint>

namespace passung {

/// A hash with one more word in it: low bits of the result depend on all bits of what went in before.
constexpr std::uint64_t hashMix(std::uint64_t hash, std::uint64_t word) noexcept {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 32;
}

}  // namespace passung
