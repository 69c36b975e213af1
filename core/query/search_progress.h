#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/query/surface_search.h"

namespace passung::query {

/// What a search for m = min φ_A over the triangles of B knows, and what it may leave out; A's frame.
struct SearchProgress {
    SurfaceBounds found;
    double left = std::numeric_limits<double>::infinity();  // no less than this is left out or not looked at [m]
    double tolerance = 0.0;                                 // [m]
    int most_steps = 0;

    bool maySpend(std::size_t steps) const { return found.steps + static_cast<int>(steps) <= most_steps; }

    /// What is nowhere below this need not be looked at [m]: next to contact, half of what is known, which tells a gap
    /// from an overlap.
    double goal() const {
        return found.upper > 0.0 ? std::max(found.upper - tolerance, 0.5 * found.upper) : found.upper - tolerance;
    }
    /// Distances from here on are enough, squared.
    double enough() const { return goal() * std::abs(goal()); }

    /// True if what is nowhere below `lower` need not be looked at.
    bool leave(double lower) {
        if (lower < goal()) return false;
        left = std::min(left, lower);
        return true;
    }

    /// φ_A at a point of B; the point of A's surface next to it.
    void offer(double phi, const Vec3& p, const Vec3& on_a) {
        if (!(phi < found.upper)) return;
        found.upper = phi;
        found.point = p;
        const Vec3 out = phi < 0.0 ? on_a - p : p - on_a;
        const double length = out.norm();
        found.normal = length > 0.0 ? Vec3(out / length) : Vec3(Vec3::Zero());
    }
};

}  // namespace passung::query
