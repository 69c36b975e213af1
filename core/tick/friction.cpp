#include "core/tick/friction.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace passung::tick {

namespace {

constexpr double kSameWay = 0.985;      // cosine of 10 degrees: contacts that face so much alike rub as one
constexpr double kRubTolerance = 1e-8;  // of what a sweep changes, relative to the wanted motion
constexpr int kWholeSweeps = 10;
constexpr double kRubAccepted = 1e-4;  // of what the last sweep changed, relative to the wanted motion
constexpr double kUnsettled = 20.0;    // what is left to change, per last change, where sweeps shrink it by a twentieth
constexpr double kAtRest = 1e-6;       // slip relative to the wanted motion

using Rows = Eigen::Matrix<double, 3, 6>;

/// Two unit vectors along the plane across `n`.
std::pair<Vec3, Vec3> tangentsOf(const Vec3& n) noexcept {
    const Vec3 t1 = n.cross(std::abs(n.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY()).normalized();
    return {t1, n.cross(t1)};
}

Rows rowsOf(const Surroundings& around, const FrictionPatch& patch) noexcept {
    const auto [t1, t2] = tangentsOf(patch.normal);
    const Vec3 r = patch.centre - around.p_WO;
    Rows B;
    B << t1.transpose(), r.cross(t1).transpose() / around.metric_radius,  //
        t2.transpose(), r.cross(t2).transpose() / around.metric_radius,   //
        Vec3::Zero().transpose(), patch.radius / around.metric_radius * patch.normal.transpose();
    return B;
}

/// Mean distance from the centre of pressure of the points that the patch touches after the motion.
double effectiveRadius(const Surroundings& around, const FrictionPatch& patch, const Motion& u) noexcept {
    const auto [t1, t2] = tangentsOf(patch.normal);
    const auto forTouching = [&, t1 = t1, t2 = t2](auto use) {
        for (const ContactPoint& c : around.contacts) {
            const double phi = c.phi + c.gradient.dot(around.wayOf(c.position, u));
            if (c.obstacle != patch.obstacle || !(phi < around.keep_out + std::abs(around.keep_out)) ||
                !(c.gradient.dot(patch.normal) > kSameWay * c.gradient.norm()))
                continue;
            const Vec3 r = c.position - patch.centre;
            use(c.area, Eigen::Vector2d(r.dot(t1), r.dot(t2)));
        }
    };
    double area = 0.0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
    forTouching([&](double a, const Eigen::Vector2d& x) {
        area += a;
        mean += a * x;
        second += a * x * x.transpose();
    });
    if (!(area > 0.0)) return 0.0;
    mean /= area;
    second = second / area - mean * mean.transpose();
    // Pressure 1 + k · (x - mean) has its centre at 0 if second · k = -mean; a line of points has no k across.
    const double across = 1e-9 * second.trace() + std::numeric_limits<double>::min();
    const Eigen::Vector2d k = (second + across * Eigen::Matrix2d::Identity()).inverse() * -mean;
    double weight = 0.0, sum = 0.0;
    forTouching([&](double a, const Eigen::Vector2d& x) {
        const double w = std::max(0.0, a * (1.0 + k.dot(x - mean)));
        weight += w;
        sum += w * x.norm();
    });
    return weight > 0.0 ? sum / weight : 0.0;
}

/// The friction of `patch` in the tangents of a normal that differs a little.
Vec3 turned(const FrictionPatch& patch, const Vec3& normal) noexcept {
    const auto [t1, t2] = tangentsOf(patch.normal);
    const auto [s1, s2] = tangentsOf(normal);
    const Vec3 along = patch.rub.x() * t1 + patch.rub.y() * t2;
    return {along.dot(s1), along.dot(s2), patch.rub.z()};
}

bool alike(const FrictionPatch& a, const FrictionPatch& b) noexcept {
    return a.obstacle == b.obstacle && a.normal.dot(b.normal) > kSameWay;
}

/// The patches of the contacts that hold `motion`. `known`: of the sweep before, whose tangents and radius stay, or
/// (`first`) of the motion before, whose friction is where the search begins.
FrictionPatches patchesOf(const Surroundings& around, const Motion& wanted, const ConstrainedMotion& motion,
                          const FrictionPatches& known, bool first) noexcept {
    FrictionPatches result;
    const double least = 1e-12 * wanted.norm() + std::numeric_limits<double>::min();
    for (int i = 0; i < motion.active; ++i) {
        const HeldContact& held = motion.held[static_cast<std::size_t>(i)];
        const ContactPoint& contact = around.contacts[held.contact];
        FrictionPatch one;
        one.normal = contact.gradient.normalized();
        one.obstacle = contact.obstacle;
        int to = 0;
        while (to < result.count && !alike(result.patch[static_cast<std::size_t>(to)], one)) ++to;
        FrictionPatch& patch = result.patch[static_cast<std::size_t>(to)];
        if (to == result.count) {
            patch = one;
            ++result.count;
        }
        // Without any pressure the first contact is the centre; a weight that no other feels.
        const double pressure = std::max(held.push, least);
        patch.pressure += pressure;
        patch.centre += pressure * contact.position;
    }
    for (int i = 0; i < result.count; ++i) {
        FrictionPatch& patch = result.patch[static_cast<std::size_t>(i)];
        patch.centre /= patch.pressure;
        for (int k = 0; k < known.count; ++k) {
            const FrictionPatch& old = known.patch[static_cast<std::size_t>(k)];
            if (!alike(old, patch)) continue;
            patch.slides = old.slides;
            if (first) {
                patch.rub = turned(old, patch.normal);
                break;
            }
            patch.normal = old.normal;
            patch.rub = old.rub;
            patch.radius = old.radius;
            break;
        }
    }
    return result;
}

/// The largest friction of a patch that is there no longer.
double lostRub(const FrictionPatches& before, const FrictionPatches& now) noexcept {
    double lost = 0.0;
    for (int i = 0; i < before.count; ++i) {
        const FrictionPatch& old = before.patch[static_cast<std::size_t>(i)];
        bool there = false;
        for (int k = 0; k < now.count; ++k) there = there || alike(old, now.patch[static_cast<std::size_t>(k)]);
        if (!there) lost = std::max(lost, old.rub.norm());
    }
    return lost;
}

/// What the contacts leave of a motion: 1 - N N⁺.
Eigen::Matrix<double, 6, 6> freedom(const ConstrainedMotion& motion) noexcept {
    Eigen::Matrix<double, 6, 6> free = Eigen::Matrix<double, 6, 6>::Identity();
    for (int i = 0; i < motion.active; ++i) free -= motion.held_span.col(i) * motion.held_span.col(i).transpose();
    return free;
}

/// x with |x| ≤ most that leaves no slip, or slip against it on the bound: (H + ν) x = target.
Vec3 rubFor(const Eigen::Matrix3d& H, const Vec3& target, double most) noexcept {
    if (!(most > 0.0)) return Vec3::Zero();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(H);
    const double floor = 1e-12 * std::max(H.trace(), std::numeric_limits<double>::min());
    const Vec3 along = eigen.eigenvectors().transpose() * target;
    const auto at = [&](double nu) {
        Vec3 x;
        for (int i = 0; i < 3; ++i) x[i] = along[i] / (std::max(eigen.eigenvalues()[i], floor) + nu);
        return x;
    };
    double low = 0.0, high = target.norm() / most;
    if (at(0.0).norm() > most) {
        for (int i = 0; i < 60 && high - low > 1e-14 * high; ++i) {  // |x| falls with ν; |x(high)| ≤ most
            const double nu = 0.5 * (low + high);
            (at(nu).norm() > most ? low : high) = nu;
        }
        low = high;
    }
    return eigen.eigenvectors() * at(low);
}

}  // namespace

RubbedMotion constrainWithFriction(const Motion& wanted, const Surroundings& around, std::span<const Friction> friction,
                                   const FrictionPatches& before, std::span<const std::uint32_t> likely) noexcept {
    RubbedMotion result;
    const double small = kRubTolerance * wanted.norm();
    MotionSolver solver(around, likely);
    Motion drawn = wanted;  // with the friction found so far
    FrictionPatches known = before;
    for (int i = 0; i < known.count; ++i) {
        const FrictionPatch& patch = known.patch[static_cast<std::size_t>(i)];
        drawn += rowsOf(around, patch).transpose() * patch.rub;
    }
    bool settled = false;
    for (int sweep = 0; sweep < kRubSweeps; ++sweep) {
        result.motion = sweep == 0 ? solver.solve(drawn) : solver.solveMet(drawn);
        result.patches = patchesOf(around, wanted, result.motion, known, sweep == 0);
        Motion u = result.motion.u;
        double change = lostRub(known, result.patches);
        const double share = sweep < kWholeSweeps ? 1.0 : 0.5;  // the half calms an iteration that swings
        drawn = wanted;
        const Eigen::Matrix<double, 6, 6> free = freedom(result.motion);
        for (int i = 0; i < result.patches.count; ++i) {
            FrictionPatch& patch = result.patches.patch[static_cast<std::size_t>(i)];
            if (!(patch.radius > 0.0))  // met for the first time
                patch.radius = effectiveRadius(around, patch, result.motion.u);
            const Friction& rough = friction[patch.obstacle];
            const Rows B = rowsOf(around, patch);
            const Eigen::Matrix<double, 6, 3> F = free * B.transpose();
            const Eigen::Matrix3d H = B * F;
            const Vec3 slip = B * u;
            const double most = (patch.slides ? rough.sliding : rough.at_rest) * patch.pressure;
            Vec3 rub = rubFor(H, H * patch.rub - slip, most);
            const Vec3 left = slip + H * (rub - patch.rub);
            const bool slides = left.norm() > kAtRest * wanted.norm();
            if (slides && !patch.slides) rub = rubFor(H, H * patch.rub - slip, rough.sliding * patch.pressure);
            if (slides) patch.slides = true;
            change = std::max(change, (rub - patch.rub).norm());
            rub = patch.rub + share * (rub - patch.rub);
            u += F * (rub - patch.rub);
            patch.rub = rub;
            drawn += B.transpose() * rub;
        }
        known = result.patches;
        result.sweeps = sweep + 1;
        result.change = change / wanted.norm();
        settled = change <= small && !solver.meetsMore(result.motion.u);
        if (settled) break;
    }
    if (!settled && (!(result.change <= kRubAccepted) || solver.meetsMore(result.motion.u))) {
        result.converged = false;
        result.motion = solver.solve(Motion::Zero());
    }
    for (int i = 0; i < result.patches.count; ++i) {
        FrictionPatch& patch = result.patches.patch[static_cast<std::size_t>(i)];
        if (!result.converged) patch.rub.setZero();  // nowhere to begin the next search
        const double rest = (kAtRest + kUnsettled * result.change) * wanted.norm();
        patch.slides = (rowsOf(around, patch) * result.motion.u).norm() > rest;
    }
    return result;
}

}  // namespace passung::tick
