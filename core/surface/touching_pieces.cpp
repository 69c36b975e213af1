#include "core/surface/touching_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/motion/friction.h"

namespace passung::surface {

namespace {

using Point = Eigen::Vector2d;

constexpr std::size_t kMostCorners = 64;  // of a face; of more some are left out

/// A convex polygon.
struct Polygon {
    std::array<Point, 3 * kMostCorners> corners;
    std::size_t count = 0;

    void add(const Point& x) noexcept {
        if (count < corners.size()) corners[count++] = x;
    }
    /// What lies where `c + k · x` ≥ 0.
    void cut(double c, const Point& k) noexcept {
        Polygon left;
        for (std::size_t i = 0; i < count; ++i) {
            const Point &a = corners[i], &b = corners[i + 1 < count ? i + 1 : 0];
            const double at_a = c + k.dot(a), at_b = c + k.dot(b);
            if (at_a >= 0.0) left.add(a);
            if ((at_a < 0.0) != (at_b < 0.0)) left.add(a + at_a / (at_a - at_b) * (b - a));
        }
        count = left.count;
        std::copy_n(left.corners.begin(), count, corners.begin());
    }
    Point middle() const noexcept {
        Point sum = Point::Zero();
        for (std::size_t i = 0; i < count; ++i) sum += corners[i];
        return sum / static_cast<double>(count);
    }
    double around() const noexcept {
        double sum = 0.0;
        for (std::size_t i = 0; i < count; ++i) sum += (corners[(i + 1) % count] - corners[i]).norm();
        return sum;
    }
    double area() const noexcept {
        double sum = 0.0;
        for (std::size_t i = 1; i + 1 < count; ++i) {
            const Point p = corners[i] - corners[0], q = corners[i + 1] - corners[0];
            sum += p.x() * q.y() - p.y() * q.x();
        }
        return 0.5 * sum;
    }
};

/// A face seen along the plane's normal, and how high it lies over each place: height = at + slope · x.
struct SeenFace {
    Polygon outline;
    double at = 0.0;
    Point slope = Point::Zero();
};

struct Plane {
    Vec3 n, t1, t2;
    Point seen(const Vec3& p) const noexcept { return {t1.dot(p), t2.dot(p)}; }
};

SeenFace seenFace(const ClusterTree& tree, const Cluster& face, const Placement& X, const Plane& plane) noexcept {
    SeenFace seen;
    const Vec3 normal = X.R * face.normal;
    seen.slope = -plane.seen(normal) / normal.dot(plane.n);
    const Vec3 first = X * tree.corner(face.first);
    seen.at = plane.n.dot(first) - seen.slope.dot(plane.seen(first));
    const std::size_t step = (face.count + kMostCorners - 1) / kMostCorners;
    for (std::size_t i = 0; i < face.count; i += step)
        seen.outline.add(plane.seen(X * tree.corner(face.first + static_cast<std::uint32_t>(i))));
    if (seen.outline.area() < 0.0)
        std::reverse(seen.outline.corners.begin(),
                     seen.outline.corners.begin() + static_cast<std::ptrdiff_t>(seen.outline.count));
    return seen;
}

}  // namespace

bool lieAlong(const HullPair& pair, const Placement& X, const Vec3& n) noexcept {
    return std::abs(pair.of_obstacle.normal.dot(n)) > motion::kSameWay &&
           std::abs((X.R * pair.of_held.normal).dot(n)) > motion::kSameWay;
}

std::size_t findPieces(const HullPair& pair, const Placement& X, const Vec3& n, double within, int fineness,
                       std::span<motion::TouchingPiece> pieces) noexcept {
    const auto tangents = motion::tangentsOf(n);
    const Plane plane{n, tangents.first, tangents.second};
    SeenFace held = seenFace(pair.held, pair.of_held, X, plane);
    const SeenFace obstacle = seenFace(pair.obstacle, pair.of_obstacle, {}, plane);
    Polygon& both = held.outline;
    both.cut(within - held.at + obstacle.at, obstacle.slope - held.slope);
    for (std::size_t i = 0; i < obstacle.outline.count && both.count > 2; ++i) {
        const Point& a = obstacle.outline.corners[i];
        const Point along = obstacle.outline.corners[(i + 1) % obstacle.outline.count] - a;
        const Point inward(-along.y(), along.x());
        if (along.squaredNorm() > 0.0) both.cut(-inward.dot(a), inward);
    }
    if (both.count < 3) return 0;
    std::size_t count = 0;
    const auto write = [&](const Point& x, double area) {
        if (!(area > 0.0) || count == pieces.size()) return;
        const double height = obstacle.at + obstacle.slope.dot(x);
        pieces[count++] = {.centre = x.x() * plane.t1 + x.y() * plane.t2 + height * n, .normal = n, .area = area};
    };
    const Point middle = both.middle();
    if (fineness <= 0) {
        write(middle, both.area());
        return count;
    }
    const double longest = both.around() / fineness;
    for (std::size_t i = 0; i < both.count; ++i) {
        const Point &a = both.corners[i], &b = both.corners[(i + 1) % both.count];
        const int parts = std::max(1, static_cast<int>(std::ceil((b - a).norm() / longest)));
        for (int k = 0; k < parts; ++k) {
            const Point p = a + k / static_cast<double>(parts) * (b - a) - middle;
            const Point q = a + (k + 1) / static_cast<double>(parts) * (b - a) - middle;
            write(middle + (p + q) / 3.0, 0.5 * (p.x() * q.y() - p.y() * q.x()));
        }
    }
    return count;
}

}  // namespace passung::surface
