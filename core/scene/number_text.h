#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace passung::scene {

/// A number in a format of printf.
inline std::string number(const char* format, double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

}  // namespace passung::scene
