#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace passung::shape {

inline constexpr int kFewestSegments = 12;
inline constexpr int kMostSegments = 2048;        // then the chord error is 1.2e-6 of the radius
inline constexpr double kVertexRounding = 1e-15;  // of a vertex on a round face, per radius

/// Segments of a circle so that the sagitta r(1 - cos(π/n)) stays within `chord_error`; divisible by 4, so that the
/// extreme points on the axes are vertices.
inline int segmentsFor(double radius, double chord_error) {
    const double cosine = std::clamp(1.0 - chord_error / radius, 0.0, 1.0);
    const double half_angle = std::acos(cosine);
    const double wanted = half_angle > 0.0 ? std::numbers::pi / half_angle : kMostSegments;
    const int segments = static_cast<int>(std::ceil(std::min<double>(wanted, kMostSegments)));
    return std::clamp((segments + 3) / 4 * 4, kFewestSegments, kMostSegments);
}

/// Sagitta of a circle of segmentsFor(radius, asked) segments.
inline double sagittaFor(double radius, double asked) {
    return radius * (1.0 - std::cos(std::numbers::pi / segmentsFor(radius, asked)) + kVertexRounding);
}

}  // namespace passung::shape
