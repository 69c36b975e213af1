#include "core/geometry/triangle_builder.h"

#include <cmath>
#include <numbers>

namespace passung::geometry {

TriangleBuilder::Index TriangleBuilder::vertex(double x, double y, double z) {
    mesh_.vertices.emplace_back(x, y, z);
    return static_cast<Index>(mesh_.vertices.size() - 1);
}

void TriangleBuilder::quad(Index a, Index b, Index c, Index d) {
    triangle(a, b, c);
    triangle(a, c, d);
}

TriangleBuilder::Ring TriangleBuilder::ring(double radius, double z, int segments) {
    Ring result;
    for (int k = 0; k < segments; ++k) {
        const auto [c, s] = direction(k, segments);
        result.push_back(vertex(radius * c, radius * s, z));
    }
    return result;
}

TriangleBuilder::Ring TriangleBuilder::ring(const std::vector<Eigen::Vector2d>& points, double z) {
    Ring result;
    for (const auto& p : points) result.push_back(vertex(p.x(), p.y(), z));
    return result;
}

TriangleBuilder::Ring TriangleBuilder::rectangle(double half_width, double half_depth, double z) {
    return {vertex(half_width, half_depth, z), vertex(-half_width, half_depth, z), vertex(-half_width, -half_depth, z),
            vertex(half_width, -half_depth, z)};
}

void TriangleBuilder::disc(const Ring& rim, double z, bool up) {
    const Index centre = vertex(0.0, 0.0, z);
    for (std::size_t k = 0; k < rim.size(); ++k) {
        const Index a = rim[k], b = rim[(k + 1) % rim.size()];
        up ? triangle(centre, a, b) : triangle(centre, b, a);
    }
}

void TriangleBuilder::band(const Ring& lower, const Ring& upper) {
    for (std::size_t k = 0; k < lower.size(); ++k) {
        const std::size_t next = (k + 1) % lower.size();
        quad(lower[k], lower[next], upper[next], upper[k]);
    }
}

void TriangleBuilder::faceWithHole(const Ring& corners, const Ring& rim, const std::array<std::size_t, 4>& on_axis,
                                   bool up) {
    const std::size_t n = rim.size();
    for (std::size_t q = 0; q < 4; ++q) {
        const Index corner = corners[q];
        const std::size_t end = q + 1 < 4 ? on_axis[q + 1] : n + on_axis[0];
        for (std::size_t k = on_axis[q]; k < end; ++k)
            up ? triangle(corner, rim[(k + 1) % n], rim[k]) : triangle(corner, rim[k], rim[(k + 1) % n]);
        const Index next = corners[(q + 1) % 4], middle = rim[end % n];
        up ? triangle(corner, next, middle) : triangle(next, corner, middle);
    }
}

void TriangleBuilder::faceWithHole(const Ring& corners, const Ring& rim, bool up) {
    const std::size_t quarter = rim.size() / 4;
    faceWithHole(corners, rim, {0, quarter, 2 * quarter, 3 * quarter}, up);
}

std::array<double, 2> TriangleBuilder::direction(int k, int n) {
    const int quarter = n / 4, q = k / quarter, j = k % quarter;
    const double angle = 2.0 * std::numbers::pi * j / n;
    const double c = std::cos(angle), s = std::sin(angle);
    switch (q) {
        case 0:
            return {c, s};
        case 1:
            return {-s, c};
        case 2:
            return {-c, -s};
        default:
            return {s, -c};
    }
}

}  // namespace passung::geometry
