#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"

namespace passung::test {

/// A part as it stands in the world.
struct Standing {
    geometry::TriangleMesh mesh;
    Pose X_W;
};

/// A perspective camera: a point from which the world is seen through a picture plane. Its own axes: x to the right, y
/// up, looking along -z.
struct Eye {
    Pose X_W;
    double opening = 0.5;  // angle between the rays to the middles of the picture's upper and lower edge [rad]
};

/// Which part a ray through the middle of each pixel meets first, row by row from the upper left; -1: none. Every
/// triangle is met from both sides.
class SeenParts {
public:
    SeenParts(const std::vector<Standing>& parts, const Eye& eye, int width, int height)
        : width_(width),
          height_(height),
          part_(static_cast<std::size_t>(width * height), -1),
          depth_(part_.size(), 1e300),
          half_(std::tan(0.5 * eye.opening)) {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            std::vector<Vec3> seen;  // vertices in the camera's frame
            seen.reserve(parts[i].mesh.vertices.size());
            for (const Vec3& v : parts[i].mesh.vertices)
                seen.push_back(eye.X_W.q.conjugate() * (parts[i].X_W * v - eye.X_W.p));
            for (const auto& [a, b, c] : parts[i].mesh.triangles) meet(static_cast<int>(i), seen[a], seen[b], seen[c]);
        }
    }

    int at(int x, int y) const { return part_[static_cast<std::size_t>(y * width_ + x)]; }
    int width() const { return width_; }
    int height() const { return height_; }
    int count(int part) const { return static_cast<int>(std::count(part_.begin(), part_.end(), part)); }

private:
    /// Through the middle of a pixel, on the plane z = -1.
    Vec3 ray(int x, int y) const {
        const double unit = 2.0 * half_ / height_;
        return {(x + 0.5 - 0.5 * width_) * unit, (0.5 * height_ - y - 0.5) * unit, -1.0};
    }

    /// Only pixels in the box around the triangle's image can see it.
    void meet(int part, const Vec3& a, const Vec3& b, const Vec3& c) {
        const double nearest = -std::max({a.z(), b.z(), c.z()});
        if (-std::min({a.z(), b.z(), c.z()}) <= 0.0) return;  // behind the eye
        int left = 0, right = width_ - 1, top = 0, bottom = height_ - 1;
        if (nearest > 0.0) {
            const double unit = 2.0 * half_ / height_;
            const auto column = [&](const Vec3& p) { return 0.5 * width_ - p.x() / p.z() / unit; };
            const auto row = [&](const Vec3& p) { return 0.5 * height_ + p.y() / p.z() / unit; };
            const auto clamped = [](double value, int high) {
                return static_cast<int>(std::clamp(value, -1.0, static_cast<double>(high)));
            };
            left = clamped(std::min({column(a), column(b), column(c)}) - 1.0, width_);
            right = clamped(std::max({column(a), column(b), column(c)}) + 1.0, width_ - 1);
            top = clamped(std::min({row(a), row(b), row(c)}) - 1.0, height_);
            bottom = clamped(std::max({row(a), row(b), row(c)}) + 1.0, height_ - 1);
        }
        const Vec3 normal = (b - a).cross(c - a);
        for (int y = std::max(0, top); y <= bottom; ++y)
            for (int x = std::max(0, left); x <= right; ++x) {
                const Vec3 way = ray(x, y);
                const double slope = normal.dot(way);
                if (slope == 0.0) continue;
                const double t = normal.dot(a) / slope;  // the plane is met at t · way
                auto& nearest_here = depth_[static_cast<std::size_t>(y * width_ + x)];
                if (!(t > 0.0 && t < nearest_here)) continue;
                const Vec3 p = t * way;
                const auto side = [&](const Vec3& from, const Vec3& to) {
                    return normal.dot((to - from).cross(p - from)) >= 0.0;
                };
                if (!side(a, b) || !side(b, c) || !side(c, a)) continue;
                nearest_here = t;
                part_[static_cast<std::size_t>(y * width_ + x)] = part;
            }
    }

    int width_, height_;
    std::vector<int> part_;
    std::vector<double> depth_;  // along the camera's axis
    double half_;
};

}  // namespace passung::test
