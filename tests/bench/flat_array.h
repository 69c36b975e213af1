#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/types.h"

namespace passung::bench {

/// The plainest thing that can be sampled: values in one array, x fastest. No bricks, no levels.
/// Value: std::int16_t or float.
template <class Value>
struct FlatArray {
    std::vector<Value> values;
    std::array<int, 3> nodes{};
    Vec3 origin = Vec3::Zero();
    double cell = 1.0;   // [m]
    float scale = 1.0f;  // of a value [m]

    /// Trilinear value at X · p of every point, which must lie inside; x, y, z of points apart, single precision.
    void sample(const Pose& X, std::span<const float> x, std::span<const float> y, std::span<const float> z,
                std::span<float> phi) const;
};

}  // namespace passung::bench
