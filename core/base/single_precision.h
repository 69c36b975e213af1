#pragma once

#include <cmath>
#include <limits>

#include "core/base/types.h"

namespace passung {

/// Relative error of a value that is stored as a float, with room for computing with it.
inline constexpr double kFloatRounding = 0x1p-24 * (1.0 + 0x1p-20);

/// The number nearest to `value` that a float holds. A conversion there and back is not enough: g++ 12 leaves it out
/// where it makes vector instructions of two or more of them.
inline double roundedToFloat(double value) {
    const volatile float rounded = static_cast<float>(value);
    return static_cast<double>(rounded);
}

inline Vec3 roundedToFloat(const Vec3& v) {
    return {roundedToFloat(v.x()), roundedToFloat(v.y()), roundedToFloat(v.z())};
}

/// The smallest float that is not below `value`.
inline float roundedUpToFloat(double value) {
    const auto rounded = static_cast<float>(roundedToFloat(value));
    return static_cast<double>(rounded) < value ? std::nextafter(rounded, std::numeric_limits<float>::infinity())
                                                : rounded;
}

}  // namespace passung
