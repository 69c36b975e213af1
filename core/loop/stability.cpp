// Stability of a spring-damper wall in a sampled haptic loop.
//
// Sources: Colgate and Schenkel (1994), passivity; Gil, Hulin and others (2004 …), the linear rule; the Schur-Cohn
// recursion is textbook. The polynomial below is derived here.
//
// Symbols: m, b mass and damping of the handle; K, B wall; T period; d delay in ticks, t_d = d T;
//          alpha = K T²/m, beta = B T/m, delta = b T/m: the only numbers that matter besides d.
//
// Handle:  m x'' + b x' = u, with u constant during a tick. With E = exp(-delta) its sampled motion is exactly
//          x(z)/u(z) = (T²/m) (c1 z + c0) / ((z - 1)(z - E)),
//          c1 = (delta - 1 + E)/delta²,  c0 = (1 - E - delta E)/delta².
// Wall:    u = -(K + B (1 - 1/z)/T) z^-d x.
// Closing the loop and multiplying by z^(d+1):
//          p(z) = (z - 1)(z - E) z^(d+1) + (c1 z + c0)(alpha z + beta (z - 1)) = 0,   degree d + 3.
// Stable iff all roots lie inside the unit circle.
//
// Limits:  delta -> 0:    c1 = c0 = 1/2. With d = 0 the test then reduces to
//                         0 < beta < 2 and alpha < 2 beta (2 - beta)/(2 + beta).
//          alpha, b -> 0: beta < 2 tan(pi/(4 (d + 1))).
//          small values:  K = (b + B)/(T/2 + t_d), the linear rule.
// Invariant: scaling (m, b, B, K) by one factor, or T by s with b, B by 1/s and K by 1/s², changes nothing.
#include "core/loop/stability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace passung::loop {
namespace {

constexpr int kMaxDegree = kMaxDeviceDelayTicks + 3;

// Coefficient i belongs to z^i.
struct Polynomial {
    std::array<double, kMaxDegree + 1> c{};
    int degree = 0;
};

bool inRange(const SampledWall& w) {
    return std::isfinite(w.mass) && w.mass > 0 && std::isfinite(w.damping) && w.damping >= 0 &&
           std::isfinite(w.stiffness) && w.stiffness >= 0 && std::isfinite(w.virtual_damping) &&
           w.virtual_damping >= 0 && std::isfinite(w.period) && w.period > 0 && w.delay_ticks >= 0 &&
           w.delay_ticks <= kMaxDeviceDelayTicks;
}

Polynomial characteristicPolynomial(const SampledWall& w) {
    const double alpha = w.stiffness * w.period * w.period / w.mass;
    const double beta = w.virtual_damping * w.period / w.mass;
    const double delta = w.damping * w.period / w.mass;
    const double E = std::exp(-delta);
    // The quotients lose digits for small delta; their series do not.
    const bool small = delta < 1e-3;
    const double c1 = small ? 0.5 - delta / 6 + delta * delta / 24 : (delta - 1 + E) / (delta * delta);
    const double c0 = small ? 0.5 - delta / 3 + delta * delta / 8 : (1 - E - delta * E) / (delta * delta);

    Polynomial p;
    p.degree = w.delay_ticks + 3;
    const auto d = static_cast<std::size_t>(w.delay_ticks);
    p.c[d + 3] += 1;
    p.c[d + 2] -= 1 + E;
    p.c[d + 1] += E;
    p.c[2] += c1 * (alpha + beta);
    p.c[1] += c0 * (alpha + beta) - c1 * beta;
    p.c[0] -= c0 * beta;
    return p;
}

// Schur-Cohn: p has all roots inside the unit circle iff |c_0| < |c_n| and (c_n p(z) - c_0 z^n p(1/z))/z has, too.
bool rootsInsideUnitCircle(Polynomial p) {
    for (int n = p.degree; n > 0; --n) {
        const auto top = static_cast<std::size_t>(n);
        const double first = p.c[0];
        const double last = p.c[top];
        if (!(std::abs(first) < std::abs(last))) return false;
        std::array<double, kMaxDegree + 1> reduced{};
        for (std::size_t i = 1; i <= top; ++i) reduced[i - 1] = (last * p.c[i] - first * p.c[top - i]) / last;
        p.c = reduced;
    }
    return true;
}

}  // namespace

bool isStable(const SampledWall& wall) {
    return inRange(wall) && rootsInsideUnitCircle(characteristicPolynomial(wall));
}

double stableStiffnessBorder(const SampledWall& wall) {
    SampledWall probe = wall;
    probe.stiffness = 0;
    if (!inRange(probe)) return 0;
    const auto stableAt = [&](double K) {
        probe.stiffness = K;
        return isStable(probe);
    };
    // In a stable monic polynomial of degree n no coefficient reaches 2^n, so K has a bound; without delay it lies
    // below 100 m/T² (1 + delta), and delay only lowers it. The scan is geometric, since the stable stretch may be
    // short.
    constexpr double kLowest = 1e-8, kGrowth = 1.02;
    const double highest = 100.0 * (1 + wall.damping * wall.period / wall.mass);
    const double unit = wall.mass / (wall.period * wall.period);
    double stable = kLowest * unit;
    if (!stableAt(stable)) return 0;
    double unstable = stable;
    while (unstable < highest * unit) {
        unstable *= kGrowth;
        if (!stableAt(unstable)) break;
        stable = unstable;
    }
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (stable + unstable);
        (stableAt(middle) ? stable : unstable) = middle;
    }
    return stable;
}

// The wall is passive iff for all 0 < theta <= pi
//     b > K (T/2) s(theta) - B cos((d+1) theta),   s = sin((2d+1) theta/2) / sin(theta/2).
// Where s > 0 this bounds K from above, where s < 0 from below (the damper must not be left alone).
// Limits: d = 0: K < 2 (b - |B|)/T. B = 0: K < b/(T/2 + t_d), from theta -> 0. B > b: none.
double passiveStiffness(const SampledWall& wall) {
    SampledWall probe = wall;
    probe.stiffness = 0;
    if (!inRange(probe)) return 0;
    constexpr int kSteps = 20000;
    const double n = wall.delay_ticks;
    double upper = linearStiffness(wall);  // theta -> 0
    double lower = 0;
    for (int i = 1; i <= kSteps; ++i) {
        const double theta = std::numbers::pi * i / kSteps;
        const double s = std::sin((n + 0.5) * theta) / std::sin(0.5 * theta);
        const double supply = wall.damping + wall.virtual_damping * std::cos((n + 1) * theta);
        if (std::abs(s) < 1e-9) {
            if (supply < 0) return 0;
        } else if (s > 0) {
            upper = std::min(upper, supply / (0.5 * wall.period * s));
        } else {
            lower = std::max(lower, supply / (0.5 * wall.period * s));
        }
    }
    return upper > lower ? upper : 0;
}

// The reading steps by Δ, the spring's force by K Δ. In by Δ and out again the force may be a whole step lower on the
// way in than on the way out: K Δ² given out, of which friction takes 2 f_c Δ. Hence K <= 2 f_c/Δ.
double passiveStiffness(const SampledWall& wall, double coulomb, double quantum) {
    const double smooth = passiveStiffness(wall);
    if (!(quantum > 0) || !(coulomb >= 0)) return smooth;
    return std::min(smooth, 2 * coulomb / quantum);
}

double linearStiffness(const SampledWall& wall) {
    return (wall.damping + wall.virtual_damping) / (wall.period * (0.5 + wall.delay_ticks));
}

}  // namespace passung::loop
