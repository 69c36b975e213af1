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
// Tool:    x the handle, y the tool, D = 1 - 1/z a difference from tick to tick, k the contact, M the tool's mass.
//          The tool goes where, by the implicit Euler rule, coupling, contact and inertia balance
//          (core/tick/penalty_tool.h):
//              (K + B D/T)(x - y) = (k + M D²/T²) y          the hand then feels u = (K + B D/T)(y - x) z^-d.
//          With C = alpha + beta D and W = kappa + nu D², kappa = k T²/m, nu = M/m, u = -C W/(C + W) z^-d x m/T²: two
//          springs in a row. Closing the loop as above and multiplying by z^(d+3):
//              p(z) = (z - 1)(z - E) z^(d+1) (z² C + z² W) + (c1 z + c0) (z C)(z² W) = 0,   degree d + 5.
//          Quasi-static: the tool has neither mass nor damper, K (x - y) = k y, so that what the hand feels is the wall
//          above with k/(K + k) times both K and B.
// Limits:  k -> infinity: the wall above, whatever M. M = k = 0: nothing is felt. k = 0: W = nu D² has a double root at
//          z = 1 and (z - 1)(z - E) a single one, so that p has one: handle and tool stay where both are put. It is
//          divided out, and what is left decides.
// Invariant: scaling (m, b, B, K) by one factor, or T by s with b, B by 1/s and K by 1/s², changes nothing.
#include "core/loop/stability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace passung::loop {
namespace {

constexpr int kMaxDegree = kMaxDeviceDelayTicks + 5;

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

/// A handle's numbers: see above.
struct Handle {
    double delta, E, c1, c0;
};

Handle handleOf(const SampledWall& w) {
    const double delta = w.damping * w.period / w.mass, E = std::exp(-delta);
    // The quotients lose digits for small delta; their series do not.
    const bool small = delta < 1e-3;
    return {delta, E, small ? 0.5 - delta / 6 + delta * delta / 24 : (delta - 1 + E) / (delta * delta),
            small ? 0.5 - delta / 3 + delta * delta / 8 : (1 - E - delta * E) / (delta * delta)};
}

Polynomial characteristicPolynomial(const SampledWall& w) {
    const double alpha = w.stiffness * w.period * w.period / w.mass;
    const double beta = w.virtual_damping * w.period / w.mass;
    const auto [delta, E, c1, c0] = handleOf(w);
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

/// The product, times z^shift, added to `p`.
template <std::size_t N, std::size_t M>
void addProduct(const std::array<double, N>& a, const std::array<double, M>& b, std::size_t shift, Polynomial& p) {
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t k = 0; k < M; ++k) p.c[i + k + shift] += a[i] * b[k];
}

Polynomial characteristicPolynomial(const SampledTool& tool) {
    const SampledWall& w = tool.wall;
    const double square = w.period * w.period / w.mass;
    const double alpha = w.stiffness * square, beta = w.virtual_damping * w.period / w.mass;
    const double kappa = tool.contact_stiffness * square, nu = tool.tool_mass / w.mass;
    const auto [delta, E, c1, c0] = handleOf(w);
    // z² (C + W), and (z C)(z² W) times the handle's numerator
    const std::array free{E, -(1 + E), 1.0};
    const std::array sum{nu, -beta - 2 * nu, alpha + beta + kappa + nu};
    const std::array coupling{-beta, alpha + beta};
    const std::array contact{nu, -2 * nu, kappa + nu};
    const std::array felt{c0 * coupling[0], c0 * coupling[1] + c1 * coupling[0], c1 * coupling[1]};
    Polynomial p;
    p.degree = w.delay_ticks + 5;
    addProduct(free, sum, static_cast<std::size_t>(w.delay_ticks) + 1, p);
    addProduct(felt, contact, 0, p);
    return p;
}

/// p/(z - 1). @pre p(1) = 0
Polynomial withoutRootAtOne(const Polynomial& p) {
    Polynomial q;
    q.degree = p.degree - 1;
    double carried = 0.0;
    for (auto i = static_cast<std::size_t>(p.degree); i > 0; --i) q.c[i - 1] = carried += p.c[i];
    return q;
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

namespace {

/// Where a loop whose wall is `probe` stops being `stable` as its stiffness grows. In a stable monic polynomial of
/// degree n no coefficient reaches 2^n, so that of a wall has a bound; without delay it lies below 100 m/T² (1 +
/// delta), and delay only lowers it. The scan is geometric, since the stable stretch may be short.
template <class Stable>
double borderOf(SampledWall& probe, const Stable& stable) {
    probe.stiffness = 0;
    if (!inRange(probe)) return 0;
    const auto stableAt = [&](double K) {
        probe.stiffness = K;
        return stable();
    };
    constexpr double kLowest = 1e-8, kGrowth = 1.02;
    const double unit = probe.mass / (probe.period * probe.period);
    const double highest = 100.0 * (1 + probe.damping * probe.period / probe.mass);
    double below = kLowest * unit;
    if (!stableAt(below)) return 0;
    double above = below;
    while (true) {
        if (!(above < highest * unit)) return std::numeric_limits<double>::infinity();
        above *= kGrowth;
        if (!stableAt(above)) break;
        below = above;
    }
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (below + above);
        (stableAt(middle) ? below : above) = middle;
    }
    return below;
}

/// What the hand feels of a quasi-static coupling: two springs in a row.
SampledWall inARow(const SampledTool& tool) {
    SampledWall felt = tool.wall;
    const double sum = felt.stiffness + tool.contact_stiffness;
    const double share = sum > 0.0 ? tool.contact_stiffness / sum : 0.0;
    felt.stiffness *= share;
    felt.virtual_damping *= share;
    return felt;
}

}  // namespace

double stableStiffnessBorder(const SampledWall& wall) {
    SampledWall probe = wall;
    return borderOf(probe, [&] { return isStable(probe); });
}

bool isStable(const SampledTool& tool) {
    const bool valid = inRange(tool.wall) && std::isfinite(tool.contact_stiffness) && tool.contact_stiffness >= 0 &&
                       std::isfinite(tool.tool_mass) && tool.tool_mass >= 0;
    if (!valid) return false;
    if (tool.tool_mass == 0) return isStable(inARow(tool));
    return rootsInsideUnitCircle(characteristicPolynomial(tool));
}

double stableStiffnessBorder(const SampledTool& tool) {
    SampledTool probe = tool;
    return borderOf(probe.wall, [&] { return isStable(probe); });
}

double stableStiffnessBorderInAir(const SampledWall& wall) {
    constexpr double kStep = 1.5, kLightest = 1e-3, kHeaviest = 1e3;
    const double alone = stableStiffnessBorder(wall);
    double least = alone;
    for (double share = kLightest; share < kHeaviest; share *= kStep) {
        SampledTool probe{.wall = wall, .contact_stiffness = 0.0, .tool_mass = share * wall.mass};
        const auto stableAt = [&](double K) {
            probe.wall.stiffness = K;
            return rootsInsideUnitCircle(withoutRootAtOne(characteristicPolynomial(probe)));
        };
        // A much softer one has roots so near to 1 that rounding decides.
        constexpr double kSoftest = 0.05, kGrowth = 1.02;
        double below = kSoftest * alone, above = below;
        while (above < least && stableAt(above)) {
            below = above;
            above *= kGrowth;
        }
        if (!(above < least)) continue;
        for (int i = 0; i < 40; ++i) {
            const double middle = 0.5 * (below + above);
            (stableAt(middle) ? below : above) = middle;
        }
        least = below;
    }
    return least;
}

double stableStiffnessBorderUpTo(const SampledTool& tool) {
    constexpr double kStep = 1.05, kSoftest = 1e-4;
    SampledTool probe = tool;
    double least = stableStiffnessBorder(tool);
    for (double share = 1 / kStep; share > kSoftest; share /= kStep) {
        probe.contact_stiffness = share * tool.contact_stiffness;
        const double border = stableStiffnessBorder(probe);
        if (std::isinf(border)) break;
        least = std::min(least, border);
    }
    return least;
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
