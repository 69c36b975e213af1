#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "core/base/random.h"

/// Files with faults as they come: bytes flipped, cut, doubled, moved, numbers out of all bounds.
namespace passung::test {

inline std::string numberToPlant(Random& random) {
    constexpr std::array<std::string_view, 14> kNumbers{
        "0",    "-1",   "1e308", "1e-308", "nan", "inf", "4294967296", "1e10", "2147483648", "99999999999999999999",
        "-0.0", "0x7f", "1e-9",  "3"};
    return std::string(kNumbers[random.below(kNumbers.size())]);
}

/// Replaces a run of digits by another number.
inline void plantNumber(std::string& bytes, Random& random) {
    const std::size_t from = random.below(bytes.size());
    const std::size_t begin = bytes.find_first_of("0123456789", from);
    if (begin == std::string::npos) return;
    const std::size_t end = std::min(bytes.find_first_not_of("0123456789.", begin), bytes.size());
    bytes.replace(begin, end - begin, numberToPlant(random));
}

inline void change(std::string& bytes, Random& random) {
    const std::size_t at = random.below(bytes.size());
    const std::size_t length = std::min<std::size_t>(1 + random.below(40), bytes.size() - at);
    switch (random.below(8)) {
        case 0:
            bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1u << random.below(8)));
            break;
        case 1:
            bytes[at] = static_cast<char>(random.below(256));
            break;
        case 2:
            bytes.erase(at, length);
            break;
        case 3:
            bytes.insert(at, bytes.substr(at, length));
            break;
        case 4:
            bytes.insert(at, bytes.substr(random.below(bytes.size()), length));
            break;
        case 5:
            bytes.insert(at, std::string(1 + random.below(2000), "[{\"'.,<>= \n"[random.below(11)]));
            break;
        case 6:
            bytes.resize(at + 1);
            break;
        default:
            plantNumber(bytes, random);
            break;
    }
    if (bytes.empty()) bytes = "x";
}

/// One to four changes; the same for the same seed.
inline std::string mutated(std::string bytes, std::uint64_t seed) {
    Random random(seed);
    const std::size_t changes = 1 + random.below(4);
    for (std::size_t i = 0; i < changes; ++i) change(bytes, random);
    return bytes;
}

}  // namespace passung::test
