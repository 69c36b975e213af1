#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace passung {

/// Two lower-case hexadecimal digits a byte.
std::string hexText(std::span<const unsigned char> bytes);

/// 16 lower-case hexadecimal digits, most significant first.
std::string hexText(std::uint64_t value);

}  // namespace passung
