#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/shape/profile.h"
#include "core/shape/thread_surface.h"

namespace passung::shape {

namespace {

constexpr int kFewestPieces = 6;               // of the angles that are searched
constexpr double kWidestPiece = 0.1;           // of flanks 60° apart [rad]
constexpr double kGolden = 0.381966011250105;  // of an interval
constexpr double kClosed = 1e-8;               // of the angles that are searched
constexpr int kMostSteps = 60;

double radial(const Vec3& p) { return std::sqrt(square(p.x()) + square(p.y())); }

/// Squared distances of a point to the lines of the surface in half planes, ψ from the one that the point is in.
class AcrossHalfPlanes {
public:
    AcrossHalfPlanes(const ThreadSurface& surface, const Vec3& p)
        : surface_(surface), r_(radial(p)), z_(p.z()), phi_(std::atan2(p.y(), p.x())) {
        const double level = std::clamp(z_, surface.low, surface.high), pitch = surface.form.pitch;
        from_ = level - pitch;
        to_ = level + pitch;
        if (from_ < surface.low + surface.chamfer) {
            from_ = surface.low;
            to_ = std::max(to_, surface.low + surface.chamfer + pitch);
        }
        if (to_ > surface.high - surface.chamfer) {
            to_ = surface.high;
            from_ = std::min(from_, surface.high - surface.chamfer - pitch);
        }
        least_ = square(r_ - surface.radiusAt(level, phi_)) + square(z_ - level);
        at(0.0);
    }

    /// The least at all ψ. A line through nearest points of one straight piece has one minimum for each turn of it, as
    /// far as the point sees the piece from its own side; so samples bracket them all.
    double least() {
        const double reach = std::sqrt(least_);
        const double end = reach < r_ ? std::asin(reach / r_) : std::numbers::pi;
        // Steeper flanks are passed sooner.
        const double widest = kWidestPiece * std::min(1.0, std::numbers::sqrt3 * surface_.form.run);
        const int pieces = std::max(kFewestPieces, static_cast<int>(std::ceil(2.0 * end / widest)));
        const double piece = 2.0 * end / pieces;
        double before = at(-end), here = before;
        for (int i = 0; i < pieces; ++i) {
            const double middle = -end + piece * i, after = at(middle + piece);
            if (here <= before && here <= after) descend(middle - piece, middle, middle + piece, here, end);
            before = here;
            here = after;
        }
        if (here <= before) descend(end - piece, end, end + piece, here, end);
        return least_;
    }

private:
    /// Larger values than the least so far need not be told apart. The nearest piece is not much farther along the axis
    /// than a pitch, or is part of a chamfer.
    double at(double psi) {
        const double away = r_ * std::sin(psi), r = r_ * std::cos(psi), reach = 2.0 * std::sqrt(least_);
        double least = square(reach);
        surface_.eachPiece(phi_ + psi, std::max(from_, z_ - reach), std::min(to_, z_ + reach),
                           [&](const ThreadSurface::Knot& from, const ThreadSurface::Knot& to) {
                               least = std::min(least, squaredToSegment(r, z_, from.r, from.z, to.r, to.z));
                           });
        least += square(away);
        least_ = std::min(least_, least);
        return least;
    }

    /// Brent 1973, chapter 5: a parabola through the three best places, or the golden section.
    void descend(double low, double x, double high, double at_x, double end) {
        const double closed = kClosed * end;
        double w = x, v = x, at_w = at_x, at_v = at_x, step = 0.0, before = 0.0;
        for (int i = 0; i < kMostSteps && std::abs(x - 0.5 * (low + high)) > 2.0 * closed - 0.5 * (high - low); ++i) {
            const double middle = 0.5 * (low + high), last = before;
            double a = (x - w) * (at_x - at_v), b = (x - v) * (at_x - at_w);
            double p = (x - v) * b - (x - w) * a, q = 2.0 * (b - a);
            if (q > 0.0) p = -p;
            q = std::abs(q);
            before = step;
            if (std::abs(p) < std::abs(0.5 * q * last) && p > q * (low - x) && p < q * (high - x)) {
                step = p / q;
                if (x + step - low < 2.0 * closed || high - x - step < 2.0 * closed)
                    step = x < middle ? closed : -closed;
            } else {
                before = x < middle ? high - x : low - x;
                step = kGolden * before;
            }
            const double u = x + (std::abs(step) >= closed ? step : std::copysign(closed, step)), at_u = at(u);
            if (at_u <= at_x) {
                (u < x ? high : low) = x;
                v = w, at_v = at_w;
                w = x, at_w = at_x;
                x = u, at_x = at_u;
                continue;
            }
            (u < x ? low : high) = u;
            if (at_u <= at_w || w == x) {
                v = w, at_v = at_w;
                w = u, at_w = at_u;
            } else if (at_u <= at_v || v == x || v == w) {
                v = u, at_v = at_u;
            }
        }
    }

    const ThreadSurface& surface_;
    double r_, z_, phi_;
    double from_, to_;  // heights that are looked at
    double least_;
};

}  // namespace

double distanceTo(const ThreadBolt& bolt, const Vec3& p) {
    const ThreadSurface surface = surfaceOf(bolt);
    const double r = radial(p), z = p.z(), phi = std::atan2(p.y(), p.x());
    double d2 = AcrossHalfPlanes(surface, p).least();
    for (const double end : {surface.low, surface.high})
        if (r < surface.radiusAt(end, phi)) d2 = std::min(d2, square(z - end));
    const bool inside = z > surface.low && z < surface.high && r < surface.radiusAt(z, phi);
    return inside ? -std::sqrt(d2) : std::sqrt(d2);
}

double distanceTo(const ThreadNut& nut, const Vec3& p) {
    const ThreadSurface surface = surfaceOf(nut);
    const double r = radial(p), z = p.z(), phi = std::atan2(p.y(), p.x());
    const double beside = r - 0.5 * nut.outer_diameter;
    const double above = std::max(surface.low - z, z - surface.high);
    double d2 = std::min(AcrossHalfPlanes(surface, p).least(), square(beside) + square(std::max(above, 0.0)));
    for (const double end : {surface.low, surface.high})
        if (beside < 0.0 && r > surface.radiusAt(end, phi)) d2 = std::min(d2, square(z - end));
    const bool inside = beside < 0.0 && above < 0.0 && r > surface.radiusAt(z, phi);
    return inside ? -std::sqrt(d2) : std::sqrt(d2);
}

}  // namespace passung::shape
