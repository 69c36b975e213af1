#include "core/shell/enclosing_ball.h"

#include <array>
#include <cmath>
#include <limits>

namespace passung::shell {

namespace {

constexpr double kSlack = 1.0 + 1e-12;  // of a radius
constexpr double kIndependent = 1e-10;  // squared height over squared length, below which a point adds no dimension

/// Points that hold a ball: all on its surface.
struct Support {
    std::array<Vec3, 5> points;
    std::size_t count = 0;
};

/// The smallest ball with the chosen points on its surface: its centre c = p0 + Σ λ_j e_j with e_j = p_j - p0 and
/// 2 e_i · (c - p0) = |e_i|². False if the points are not independent.
bool ballThrough(const Support& all, unsigned chosen, Ball& ball) {
    std::array<Vec3, 3> e;
    std::size_t dimension = 0;
    const Vec3* origin = nullptr;
    for (std::size_t i = 0; i < all.count; ++i) {
        if (!(chosen >> i & 1u)) continue;
        if (origin == nullptr) {
            origin = &all.points[i];
        } else {
            e[dimension++] = all.points[i] - *origin;
        }
    }
    // Orthogonal directions u_i with c - p0 = Σ s_i u_i, one equation after the other.
    std::array<Vec3, 3> u;
    Vec3 offset = Vec3::Zero();
    for (std::size_t i = 0; i < dimension; ++i) {
        u[i] = e[i];
        for (std::size_t j = 0; j < i; ++j) u[i] -= e[i].dot(u[j]) / u[j].squaredNorm() * u[j];
        if (!(u[i].squaredNorm() > kIndependent * e[i].squaredNorm())) return false;
        offset += (0.5 * e[i].squaredNorm() - e[i].dot(offset)) / e[i].dot(u[i]) * u[i];
    }
    ball = {*origin + offset, offset.norm()};
    return true;
}

bool holds(const Ball& ball, const Vec3& p) {
    return (p - ball.centre).squaredNorm() <= ball.radius * ball.radius * kSlack;
}

/// The smallest ball around `support`, whose last point lies on its surface, and which of them hold it.
Ball smallestBall(Support& support) {
    Ball best;
    best.radius = std::numeric_limits<double>::infinity();
    unsigned holders = 0;
    const unsigned last = 1u << (support.count - 1);
    for (unsigned others = 0; others < last; ++others) {
        const unsigned chosen = others | last;
        if (chosen == 31u) continue;  // five points hold no ball that four of them do not
        Ball ball;
        if (!ballThrough(support, chosen, ball) || !(ball.radius < best.radius)) continue;
        bool whole = true;
        for (std::size_t i = 0; i < support.count && whole; ++i) whole = holds(ball, support.points[i]);
        if (!whole) continue;
        best = ball;
        holders = chosen;
    }
    Support kept;
    for (std::size_t i = 0; i < support.count; ++i)
        if (holders >> i & 1u) kept.points[kept.count++] = support.points[i];
    if (kept.count > 0) support = kept;
    return best;
}

}  // namespace

Ball enclosingBall(std::span<const SurfacePoint> points) {
    Vec3 centre = points[0].position;
    Ball best{centre, std::numeric_limits<double>::infinity()};
    Support support;
    for (int pivot = 0; pivot < kMostPivots; ++pivot) {
        const SurfacePoint* farthest = nullptr;
        double squared = -1.0;
        for (const SurfacePoint& point : points) {
            const double d = (point.position - centre).squaredNorm();
            if (!(d > squared)) continue;
            squared = d;
            farthest = &point;
        }
        const double radius = std::sqrt(squared);
        const bool first = support.count == 0;
        if (radius < best.radius) best = {centre, radius};
        support.points[support.count++] = farthest->position;
        const Ball next = smallestBall(support);
        if (!std::isfinite(next.radius)) break;
        // The ball of those that hold it is the least that any ball can be.
        if (!first && !(best.radius > next.radius * kSlack)) break;
        if (!first && support.count == 5) break;
        centre = next.centre;
    }
    best.radius *= kSlack;
    return best;
}

}  // namespace passung::shell
