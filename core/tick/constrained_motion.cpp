#include "core/tick/constrained_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace passung::tick {

namespace {

constexpr int kMaxRows = 32;
constexpr int kSweeps = 40;
constexpr double kTolerance = 1e-7;     // [m], of a constraint
constexpr double kLeastGradient = 0.1;  // a flatter field (a medial axis) says nothing about direction

struct Row {
    Motion a;
    double b;
    double norm2;
    double lambda;
};

Row rowOf(const ContactPoint& contact, const Vec3& p_WO, double metric_radius, double keep_out) {
    Row row;
    row.a.head<3>() = contact.gradient;
    row.a.tail<3>() = (contact.position - p_WO).cross(contact.gradient) / metric_radius;
    row.b = keep_out - contact.phi;
    row.norm2 = row.a.squaredNorm();
    row.lambda = 0.0;
    return row;
}

/// Sweeps until no row is violated by more than the tolerance; returns false at the cap.
bool solve(std::array<Row, kMaxRows>& rows, std::size_t count, Motion& u) {
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        double worst = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            Row& row = rows[i];
            const double lambda = std::max(0.0, row.lambda + (row.b - row.a.dot(u)) / row.norm2);
            const double change = lambda - row.lambda;
            row.lambda = lambda;
            u += change * row.a;
            worst = std::max(worst, std::abs(change) * std::sqrt(row.norm2));
        }
        if (worst < kTolerance) return true;
    }
    return false;
}

}  // namespace

ConstrainedMotion constrainMotion(const Motion& wanted, const ContactManifold& manifold, const Vec3& p_WO,
                                  double metric_radius, double keep_out, int max_rows) noexcept {
    std::array<Row, kMaxRows> rows;
    const auto cap = static_cast<std::size_t>(std::min(max_rows, kMaxRows));
    std::size_t count = 0;
    ConstrainedMotion result;
    result.u = wanted;
    for (;;) {
        double violation = kTolerance;
        const ContactPoint* worst = nullptr;
        const Vec3 dx = result.u.head<3>();
        const Vec3 dphi = result.u.tail<3>() / metric_radius;
        for (const ContactPoint& contact : manifold) {
            const Vec3 motion = dx + dphi.cross(contact.position - p_WO);
            const double missing = keep_out - contact.phi - contact.gradient.dot(motion);
            if (missing > violation && contact.gradient.squaredNorm() > kLeastGradient * kLeastGradient) {
                violation = missing;
                worst = &contact;
            }
        }
        if (worst == nullptr) break;
        if (count == cap) {
            result.converged = false;
            break;
        }
        rows[count++] = rowOf(*worst, p_WO, metric_radius, keep_out);
        if (!solve(rows, count, result.u)) {
            result.converged = false;
            break;
        }
    }
    result.rows = static_cast<int>(count);
    return result;
}

}  // namespace passung::tick
