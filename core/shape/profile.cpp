#include "core/shape/profile.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace passung::shape {

namespace {

using std::numbers::pi;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double squaredExcess(double ex, double ey) { return square(std::max(ex, 0.0)) + square(std::max(ey, 0.0)); }

/// Squared distance to the edge where the slopes of two perpendicular sides meet: (x0 + t, y0 + t, t), low ≤ t ≤ high.
/// dx = x - x0, dy = y - y0.
double squaredToMitre(double dx, double dy, double z, double low, double high) {
    const double t = std::clamp((dx + dy + z) / 3.0, low, high);
    return square(dx - t) + square(dy - t) + square(z - t);
}

/// The foot's t on the slope of a straight side (or a cone's line) that p is `d` outside of, at height z.
double slopeFoot(double d, double z) { return 0.5 * (d + z); }

/// Real roots of x³ + px + q (Cardano; three roots: Viète). A double root may be missed: there the cubic does not
/// change sign.
int cubicRoots(double p, double q, std::array<double, 3>& roots) {
    const double discriminant = square(0.5 * q) + p * p * p / 27.0;
    if (discriminant >= 0.0) {
        const double a = std::cbrt(std::abs(0.5 * q) + std::sqrt(discriminant));
        const double root = a > 0.0 ? a - p / (3.0 * a) : 0.0;
        roots[0] = q > 0.0 ? -root : root;
        return 1;
    }
    const double amplitude = 2.0 * std::sqrt(-p / 3.0);
    const double angle = std::acos(std::clamp(3.0 * q / (p * amplitude), -1.0, 1.0)) / 3.0;
    for (int k = 0; k < 3; ++k) roots[static_cast<std::size_t>(k)] = amplitude * std::cos(angle - 2.0 * pi * k / 3.0);
    return 3;
}

/// Squared distance to the edge where cone and key's side meet. With R, a the radius and half the key at t = 0:
///     x² = (R + t)² - (a + t)² = g (R + a + 2t),  g = R - a,  y = a + t,  z = t
/// is a parabola in the plane that holds the x axis and (0, 1, 1):  t(x) = (x²/g - R - a) / 2.
/// Minimise f(x) = (x - px)² + (a + t - py)² + (t - pz)². With m = (py - a + pz) / 2 and t'(x) = x/g:
///     f'/2 = (x - px) + 2 (t - m) x/g = 0   ⇔   x³ + (g² - g (R + a) - 2 g m) x - g² px = 0.
/// Limits: g → 0 (key as wide as the peg): the parabola shrinks to the line x = 0.
double squaredToParabola(const KeyedProfile& profile, const Vec3& p, double y, double low, double high) {
    const double g = profile.radius - profile.half_key, sum = profile.radius + profile.half_key;
    const double m = 0.5 * (y - profile.half_key + p.z());
    const double linear = g * g - g * sum - 2.0 * g * m, constant = -g * g * p.x();
    const double x_low = profile.grown(low).crossing(), x_high = profile.grown(high).crossing();
    double best = kInfinity;
    const auto consider = [&](double root) {
        const double x = std::clamp(root, x_low, x_high);
        const double t = std::clamp(0.5 * (x * x / g - sum), low, high);
        best = std::min(best, square(x - p.x()) + square(profile.half_key + t - y) + square(t - p.z()));
    };
    std::array<double, 3> roots{};
    const int count = cubicRoots(linear, constant, roots);
    for (int k = 0; k < count; ++k) {
        double x = roots[static_cast<std::size_t>(k)];
        consider(x);
        // Cardano's difference of large terms costs digits; one step of Newton brings them back.
        const double slope = 3.0 * x * x + linear;
        if (slope != 0.0) consider(x - (x * x * x + linear * x + constant) / slope);
    }
    return best;
}

/// At most squaredToParabola: with its m, f(x) = (x - px)² + 2 (t - m)² + (py - a - pz)²/2 by the parabola's plane, and
/// (x, t) lies in a box.
double leastToParabola(const KeyedProfile& profile, const Vec3& p, double y, double low, double high) {
    const double x_low = profile.grown(low).crossing(), x_high = profile.grown(high).crossing();
    const double off_x = p.x() - std::clamp(p.x(), x_low, x_high);
    const double m = 0.5 * (y - profile.half_key + p.z()), off_t = m - std::clamp(m, low, high);
    return square(off_x) + 2.0 * square(off_t) + 0.5 * square(y - profile.half_key - p.z());
}

int arcSegments(double angle, double step) {
    constexpr int kMost = 512;  // a quarter of the most of a full turn
    const double wanted = step > 0.0 ? angle / step : kMost;
    return std::max(3, static_cast<int>(std::ceil(std::min<double>(wanted, kMost))));
}

}  // namespace

double squaredToSegment(double x, double y, double ax, double ay, double bx, double by) {
    const double ex = bx - ax, ey = by - ay;
    const double px = x - ax, py = y - ay;
    const double length2 = ex * ex + ey * ey;
    const double t = length2 > 0.0 ? std::clamp((px * ex + py * ey) / length2, 0.0, 1.0) : 0.0;
    return square(px - t * ex) + square(py - t * ey);
}

bool SquareProfile::contains(double x, double y) const { return std::abs(x) < half_width && std::abs(y) < half_depth; }

double SquareProfile::squaredDistance(double x, double y) const {
    return squaredExcess(std::abs(x) - half_width, std::abs(y) - half_depth);
}

double SquareProfile::squaredToBorder(double x, double y) const {
    const double ex = std::abs(x) - half_width, ey = std::abs(y) - half_depth;
    return ex < 0.0 && ey < 0.0 ? square(std::max(ex, ey)) : squaredExcess(ex, ey);
}

/// The nearest point lies in the quadrant of p (mirrored there, any other is no farther). Four pieces: two planes, at
/// feet that lie on them; their common edge; the lowest and the highest border.
double SquareProfile::squaredToSlope(const Vec3& p, double low, double high) const {
    const double dx = std::abs(p.x()) - half_width, dy = std::abs(p.y()) - half_depth, z = p.z();
    double d2 = std::min(grown(low).squaredToBorder(p.x(), p.y()) + square(z - low),
                         grown(high).squaredToBorder(p.x(), p.y()) + square(z - high));
    d2 = std::min(d2, squaredToMitre(dx, dy, z, low, high));
    const auto plane = [&](double d, double along) {
        const double t = slopeFoot(d, z);
        if (t >= low && t <= high && along <= t) d2 = std::min(d2, 0.5 * square(d - z));
    };
    plane(dx, dy);
    plane(dy, dx);
    return d2;
}

ProfileSteps SquareProfile::stepsFor(double low, double high, double) const {
    ProfileSteps steps;
    steps.levels = low < high ? std::vector<double>{low, high} : std::vector<double>{low};
    return steps;
}

Outline SquareProfile::outline(const ProfileSteps&) const {
    const double w = half_width, d = half_depth;
    return {{{w, 0.0}, {w, d}, {0.0, d}, {-w, d}, {-w, 0.0}, {-w, -d}, {0.0, -d}, {w, -d}}, {0, 2, 4, 6}};
}

bool KeyedProfile::contains(double x, double y) const {
    return square(x) + square(y) < square(radius) || (x >= 0.0 && x < reach && std::abs(y) < half_key);
}

double KeyedProfile::squaredDistance(double x, double y) const {
    const double beyond = std::max(std::sqrt(square(x) + square(y)) - radius, 0.0);
    return std::min(square(beyond), squaredExcess(std::max(-x, x - reach), std::abs(y) - half_key));
}

/// In the half plane y ≥ 0: the arc, where the foot on the circle is outside the key; the key's side; half its top.
double KeyedProfile::squaredToBorder(double x, double y) const {
    y = std::abs(y);
    const double r = std::sqrt(square(x) + square(y));
    double d2 = std::min(squaredToSegment(x, y, crossing(), half_key, reach, half_key),
                         squaredToSegment(x, y, reach, half_key, reach, 0.0));
    const bool beside_key = x <= 0.0 || radius * y >= half_key * r;
    if (beside_key) d2 = std::min(d2, square(r - radius));
    return d2;
}

/// In the half space y ≥ 0: cone, key's side and key's top at feet that lie on them; the edges where cone and side and
/// where side and top meet; the lowest and the highest border.
double KeyedProfile::squaredToSlope(const Vec3& p, double low, double high) const {
    const double x = p.x(), y = std::abs(p.y()), z = p.z();
    const double r = std::sqrt(square(x) + square(y));
    double d2 = std::min(grown(low).squaredToBorder(x, y) + square(z - low),
                         grown(high).squaredToBorder(x, y) + square(z - high));
    d2 = std::min(d2, squaredToMitre(x - reach, y - half_key, z, low, high));

    const double on_cone = slopeFoot(r - radius, z);
    const bool beside_key = x <= 0.0 || (radius + on_cone) * y >= (half_key + on_cone) * r;
    if (on_cone >= low && on_cone <= high && beside_key) d2 = std::min(d2, 0.5 * square(r - radius - z));

    const double on_side = slopeFoot(y - half_key, z);
    if (on_side >= low && on_side <= high && x >= grown(on_side).crossing() && x <= reach + on_side)
        d2 = std::min(d2, 0.5 * square(y - half_key - z));

    const double on_top = slopeFoot(x - reach, z);
    if (on_top >= low && on_top <= high && y <= half_key + on_top) d2 = std::min(d2, 0.5 * square(x - reach - z));

    // The edge's cubic costs more than all above, and most points are nearer to something else.
    constexpr double kRounding = 1e-6, kPicometre2 = 1e-24;  // of d2; [m²]
    if (leastToParabola(*this, p, y, low, high) <= (1.0 + kRounding) * d2 + kPicometre2)
        d2 = std::min(d2, squaredToParabola(*this, p, y, low, high));
    return d2;
}

double KeyedProfile::crossing() const { return std::sqrt((radius - half_key) * (radius + half_key)); }

double KeyedProfile::crossingAngle() const { return std::atan2(half_key, crossing()); }

/// Walls: the chord of an arc is off by s(φ) = ρ (1 - cos φ/2), φ its step, ρ the largest radius. Cone: its rings begin
/// at the crossing, whose angle α moves by Δα from ring to ring, so that a triangle spans φ + Δα; at 45° the distance
/// is s(φ + Δα)/√2. The edge of cone and key, x² = g (R + a + 2t), has chords that are off by √2 Δx²/(8 g); counted
/// twice, because a cone's point may have lost its foot there.
ProfileSteps KeyedProfile::stepsFor(double low, double high, double chord_error) const {
    constexpr double kRounding = 1e-15;  // of a vertex, per radius
    constexpr int kMostRings = 65;
    const double widest = radius + high;
    const auto sagitta = [&](double angle) { return widest * (1.0 - std::cos(0.5 * angle) + kRounding); };
    ProfileSteps steps;
    const double step = 2.0 * std::acos(std::clamp(1.0 - 0.5 * chord_error / widest, 0.0, 1.0));
    const double front = 0.5 * pi - std::min(grown(low).crossingAngle(), crossingAngle());
    steps.front = arcSegments(front, step);
    steps.back = arcSegments(0.5 * pi, step);
    const double walls = sagitta(std::max(front / steps.front, 0.5 * pi / steps.back));
    steps.levels = {low};
    steps.error = walls;
    if (!(low < high)) return steps;

    const double g = radius - half_key;
    const double x_low = grown(low).crossing(), x_high = grown(high).crossing();
    for (int rings = 2; rings <= kMostRings; ++rings) {
        const double dx = (x_high - x_low) / (rings - 1);
        double turn = 0.0;
        steps.levels = {low};
        for (int k = 1; k < rings; ++k) {
            const double x = x_low + k * dx;
            const double t = k + 1 < rings ? std::clamp(0.5 * (x * x / g - radius - half_key), low, high) : high;
            turn = std::max(turn, std::abs(grown(t).crossingAngle() - grown(steps.levels.back()).crossingAngle()));
            steps.levels.push_back(t);
        }
        const double edge = std::numbers::sqrt2 * square(dx) / (8.0 * g);
        const double cone = sagitta(front / steps.front + turn) / std::numbers::sqrt2;
        steps.error = std::max(walls, cone + 2.0 * edge);
        if (steps.error <= chord_error) break;
    }
    return steps;
}

Outline KeyedProfile::outline(const ProfileSteps& steps) const {
    Outline result;
    auto& points = result.points;
    points.emplace_back(reach, 0.0);
    points.emplace_back(reach, half_key);
    points.emplace_back(crossing(), half_key);
    const double start = crossingAngle(), front = 0.5 * pi - start;
    for (int k = 1; k < steps.front; ++k) {
        const double angle = start + front * k / steps.front;
        points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    const std::size_t top = points.size();
    points.emplace_back(0.0, radius);
    for (int k = 1; k < steps.back; ++k) {
        const double angle = 0.5 * pi * k / steps.back;
        points.emplace_back(-radius * std::sin(angle), radius * std::cos(angle));
    }
    const std::size_t left = points.size();
    points.emplace_back(-radius, 0.0);
    // The half y < 0 is the mirror image.
    for (std::size_t k = left - 1; k > 0; --k) points.emplace_back(points[k].x(), -points[k].y());
    result.on_axis = {0, top, left, 2 * left - top};
    return result;
}

SquareProfile profileOf(const SquarePeg& peg) { return {0.5 * peg.width, 0.5 * peg.depth}; }
KeyedProfile profileOf(const KeyedPeg& peg) {
    return {0.5 * peg.diameter, 0.5 * peg.key_width, 0.5 * peg.diameter + peg.key_height};
}
SquareProfile profileOf(const SquareBorePlate& plate) { return {0.5 * plate.pocket_width, 0.5 * plate.pocket_depth}; }
KeyedProfile profileOf(const KeyedBorePlate& plate) {
    return {0.5 * plate.bore_diameter, 0.5 * plate.key_width, 0.5 * plate.bore_diameter + plate.key_height};
}

}  // namespace passung::shape
