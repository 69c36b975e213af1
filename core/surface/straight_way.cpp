#include "core/surface/straight_way.h"

#include <cmath>

namespace passung::surface {
namespace {

constexpr double kLeastPiece = 1.0 / 16;
constexpr double kUnsure = 1e-10;  // [m]: rounding

Placement inverseOf(const Placement& X) noexcept {
    Placement inverse;
    inverse.R = X.R.transpose();
    inverse.p = -(inverse.R * X.p);
    return inverse;
}

/// The middle one of the Bernstein coefficients of what a plane sets apart that turns from n0 to n1: the outer ones are
/// what it does at the ends.
double middleOf(const HullPair& pair, const Placement& X0, const Vec3& n0, const Placement& X1,
                const Vec3& n1) noexcept {
    const double held = leastReachOf(pair.held, pair.of_held, X1.R.transpose() * n0 + X0.R.transpose() * n1) +
                        n0.dot(X1.p) + n1.dot(X0.p);
    return 0.5 * (held + leastReachOf(pair.obstacle, pair.of_obstacle, -(n0 + n1)));
}

}  // namespace

StraightWay::StraightWay(const Placement& begin, const Placement& end) noexcept
    : from(begin), to(end), turn(rotationVector(Quat(Mat3(end.R * begin.R.transpose())))) {}

Placement StraightWay::at(double share) const noexcept {
    Placement X;
    X.R.noalias() = rotationFromVector(share * turn).toRotationMatrix() * from.R;
    X.p = from.p + share * (to.p - from.p);
    return X;
}

StraightWay StraightWay::mirrored() const noexcept { return {inverseOf(from), inverseOf(to)}; }

double riseOf(const HullPair& pair, const StraightWay& way) noexcept {
    return (pair.of_held.centre.norm() + pair.of_held.radius) * way.turn.squaredNorm() / 8.0;
}

bool setsApart(const HullPair& pair, const StraightWay& way, const Vec3& n0, const Vec3& n1, double least) noexcept {
    const double need = riseOf(pair, way) + kUnsure;
    return least >= need && middleOf(pair, way.from, n0, way.to, n1) >= need;
}

bool keepsApart(const HullPair& pair, const StraightWay& way, const Vec3& n_begin, const Vec3& n_end,
                int& looks) noexcept {
    const double rise = riseOf(pair, way);
    Placement X = way.from;
    Vec3 n = n_begin;
    double done = 0.0;
    for (double piece = 1.0; done < 1.0;) {
        const double need = rise * piece * piece + kUnsure;
        Placement next = way.to;
        Vec3 n_next = n_end;
        if (done + piece < 1.0) {
            next = way.at(done + piece);
            const NearestHulls there = nearestPoints(pair, next, n);
            looks += there.looks;
            if (there.meets) return false;
            n_next = there.n;
        }
        looks += 2;
        bool apart = separationAlong(pair, X, n) >= need && separationAlong(pair, next, n_next) >= need &&
                     middleOf(pair, X, n, next, n_next) >= need;
        if (!apart) {
            CornerSeed seed;
            const NearestHulls swept = nearestHulls(pair, X, next, n, need, need, seed);
            looks += 2 * swept.looks;
            apart = swept.separation >= need;
        }
        if (!apart) {
            piece *= 0.5;
            if (piece < kLeastPiece) return false;
            continue;
        }
        done += piece;
        X = next;
        n = n_next;
        while (std::fmod(done, 2.0 * piece) == 0.0 && done + 2.0 * piece <= 1.0) piece *= 2.0;
    }
    return true;
}

}  // namespace passung::surface
