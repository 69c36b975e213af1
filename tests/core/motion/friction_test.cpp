#include "core/motion/friction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/random.h"

namespace passung {
namespace {

using contact::ContactManifold;
using contact::ContactPoint;
using motion::Friction;
using motion::FrictionMotion;
using motion::FrictionPatches;
using motion::Motion;

constexpr double kRho = 0.02;       // [m]
constexpr double kKeepOut = -1e-6;  // [m]
const Friction kDry{.at_rest = 0.5, .sliding = 0.3};

ContactPoint contactAt(const Vec3& position, const Vec3& normal, double area = 1e-6) {
    ContactPoint c;
    c.position = position;
    c.normal = -normal;
    c.gradient = normal;
    c.phi = kKeepOut;
    c.area = area;
    return c;
}

ContactManifold manifoldOf(const std::vector<ContactPoint>& contacts) {
    ContactManifold manifold(contacts.size());
    for (const auto& c : contacts) EXPECT_TRUE(manifold.tryPush(c));
    return manifold;
}

Motion motion(const Vec3& dx, const Vec3& turn = Vec3::Zero()) {
    Motion u;
    u << dx, kRho * turn;
    return u;
}

FrictionMotion rub(const Motion& wanted, const ContactManifold& manifold, const Friction& friction = kDry,
                   const FrictionPatches& before = {}) {
    return constrainWithFriction(wanted, {manifold, {kRho}, kKeepOut}, {&friction, 1}, before);
}

/// A disc of radius `radius` in the plane z = 0, contacts `spacing` apart.
std::vector<ContactPoint> disc(double radius, double spacing) {
    std::vector<ContactPoint> contacts;
    const int n = static_cast<int>(radius / spacing) + 1;
    for (int i = -n; i <= n; ++i)
        for (int k = -n; k <= n; ++k) {
            const Vec3 p((i + 0.5) * spacing, (k + 0.5) * spacing, 0.0);
            if (p.norm() <= radius) contacts.push_back(contactAt(p, Vec3::UnitZ(), spacing * spacing));
        }
    return contacts;
}

TEST(Friction, SticksUpToItsCoefficientAtRestAndSlidesAgainstTheOtherBeyond) {
    // Truth: closed form. A point in the body's origin, pressed by d and drawn aside by e: it stays for e < μ_s d and
    // else follows to e - μ_d d.
    const auto manifold = manifoldOf({contactAt(Vec3::Zero(), Vec3::UnitZ())});
    constexpr double d = 1e-4;
    for (const double share : {0.0, 0.2, 0.49, 0.51, 1.0, 10.0}) {
        for (int k = 0; k < 7; ++k) {
            const Vec3 aside(std::cos(k), std::sin(k), 0.0);
            const FrictionMotion found = rub(motion(share * d * aside - d * Vec3::UnitZ()), manifold);
            const double slip = share <= kDry.at_rest ? 0.0 : share * d - kDry.sliding * d;
            EXPECT_TRUE(found.converged);
            EXPECT_NEAR((found.motion.u.head<3>() - slip * aside).norm(), 0.0, 1e-9 * d) << share;
            ASSERT_EQ(found.patches.count, 1);
            EXPECT_NEAR(found.patches.patch[0].pressure, d, 1e-9 * d);
            EXPECT_NEAR(found.patches.patch[0].impulse.norm(), (slip > 0.0 ? kDry.sliding : share) * d, 1e-8 * d);
            EXPECT_EQ(found.patches.patch[0].slides, slip > 0.0);
        }
    }
}

TEST(Friction, KeepsSlidingBetweenItsTwoCoefficients) {
    // Truth: closed form. Drawn by 0.4 d, between μ_d and μ_s: at rest it stays, sliding it follows.
    const auto manifold = manifoldOf({contactAt(Vec3::Zero(), Vec3::UnitZ())});
    const Motion wanted = motion({0.4e-4, 0.0, -1e-4});
    const FrictionMotion started = rub(motion({2e-4, 0.0, -1e-4}), manifold);
    EXPECT_NEAR(rub(wanted, manifold).motion.u.x(), 0.0, 1e-14);
    EXPECT_NEAR(rub(wanted, manifold, kDry, started.patches).motion.u.x(), 0.1e-4, 1e-13);
}

TEST(Friction, HoldsAPressedDiscAgainstTwoThirdsOfItsRadius) {
    // Truth: closed form, ∫ μ p r dA = 2/3 μ F R for even pressure. Turned about its axis by far more, the disc follows
    // until the spring's torque is that: K ρ² (turn left) = 2/3 μ_d K d R.
    constexpr double d = 1e-4, R = 0.01;
    const auto manifold = manifoldOf(disc(R, 0.25e-3));
    for (const double turn : {0.1, -0.1}) {
        const FrictionMotion found = rub(motion(-d * Vec3::UnitZ(), turn * Vec3::UnitZ()), manifold);
        EXPECT_TRUE(found.converged);
        ASSERT_EQ(found.patches.count, 1);
        EXPECT_NEAR(found.patches.patch[0].radius, 2.0 / 3.0 * R, 0.01 * R);
        const double left = turn - found.motion.u[5] / kRho;
        EXPECT_NEAR(std::abs(left) * kRho * kRho, 2.0 / 3.0 * kDry.sliding * d * R, 0.01 * kDry.sliding * d * R);
        EXPECT_EQ(left > 0.0, turn > 0.0);
    }
}

TEST(Friction, TwoFeetHoldAsTheirForcesDo) {
    // Truth: closed form. Feet at distances a and b from the centre of pressure carry b/(a+b) and a/(a+b) of the load:
    // torque 2 μ F a b/(a+b).
    constexpr double a = 0.004, b = 0.012;
    const auto manifold = manifoldOf({contactAt({a, 0, 0}, Vec3::UnitZ()), contactAt({-b, 0, 0}, Vec3::UnitZ())});
    const FrictionMotion found = rub(motion(-1e-4 * Vec3::UnitZ(), 0.2 * Vec3::UnitZ()), manifold);
    ASSERT_EQ(found.patches.count, 1);
    EXPECT_NEAR(found.patches.patch[0].centre.norm(), 0.0, 1e-9);
    EXPECT_NEAR(found.patches.patch[0].radius, 2.0 * a * b / (a + b), 1e-8);
}

TEST(Friction, ObeysCoulombsLawOnRandomContacts) {
    // Truth: invariant (the law itself). Every patch: |x| ≤ μ Λ; at rest no slip; sliding |x| = μ_d Λ against the slip;
    // the normals are obeyed. Up to four contacts of which the first two face apart.
    Random random(3);
    constexpr double kSlow = 20.0;  // what is left to change, per last change, where sweeps shrink it by a twentieth
    int resting = 0, sliding = 0, unsolved = 0, sweeps = 0;
    constexpr int kTrials = 2000;
    for (int trial = 0; trial < kTrials; ++trial) {
        const auto any = [&](double size) {
            return Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
        };
        std::vector<ContactPoint> contacts;
        const int count = 1 + static_cast<int>(random.below(4));
        for (int i = 0; i < count; ++i) contacts.push_back(contactAt(any(0.02), any(1.0).normalized()));
        const Motion wanted = motion(any(2e-4), any(1e-2));
        const auto manifold = manifoldOf(contacts);
        const FrictionMotion found = rub(wanted, manifold);
        const double size = wanted.norm();
        sweeps += found.sweeps;
        for (const auto& c : contacts) {
            const Vec3 dx = found.motion.u.head<3>() + (found.motion.u.tail<3>() / kRho).cross(c.position);
            EXPECT_GT(c.gradient.dot(dx), -1e-8);
        }
        if (!found.converged) {
            ++unsolved;
            continue;
        }
        for (int i = 0; i < found.patches.count; ++i) {
            const auto& patch = found.patches.patch[static_cast<std::size_t>(i)];
            const Vec3 dx = found.motion.u.head<3>() + (found.motion.u.tail<3>() / kRho).cross(patch.centre);
            const Vec3 slip = dx - patch.normal * patch.normal.dot(dx);
            const double x = patch.impulse.norm();
            EXPECT_LE(x, kDry.at_rest * patch.pressure * (1 + 1e-6) + 1e-8 * size);
            if (patch.slides) {
                EXPECT_NEAR(x, kDry.sliding * patch.pressure,
                            1e-5 * patch.pressure + (1e-7 + kSlow * found.change) * size)
                    << trial;
                ++sliding;
            } else {
                EXPECT_LT(slip.norm(), (1e-6 + kSlow * found.change) * size);
                if (x > 1e-9 * size) ++resting;
            }
        }
    }
    EXPECT_GT(resting, kTrials / 10);
    EXPECT_GT(sliding, kTrials / 10);
    EXPECT_LT(unsolved, kTrials / 50);
    std::printf("resting %d, sliding %d, unsolved %d of %d; %.1f sweeps on average\n", resting, sliding, unsolved,
                kTrials, static_cast<double>(sweeps) / kTrials);
}

/// Contacts of a peg of 10 mm radius with its bore: all along the wall, at both rims only, or from everywhere; a little
/// askew, some in touch and some near.
std::vector<ContactPoint> tightFit(Random& random, int kind, int count) {
    std::vector<ContactPoint> contacts;
    const double farthest = std::pow(10.0, random.uniform(-8, -5));
    for (int i = 0; i < count; ++i) {
        const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
        Vec3 inward(-std::cos(angle), -std::sin(angle), 0.0);
        const double z = kind == 1 ? 0.02 * std::round(random.uniform()) : random.uniform(0.0, 0.02);
        Vec3 position = -0.01 * inward + z * Vec3::UnitZ();
        if (kind == 2) {
            inward = Vec3(random.normal(), random.normal(), random.normal()).normalized();
            position = -0.01 * inward;
        }
        const Vec3 askew(random.normal(), random.normal(), random.normal());
        contacts.push_back(contactAt(position, (inward + 0.02 * askew).normalized()));
        contacts.back().phi = random.uniform(kKeepOut, farthest);
    }
    return contacts;
}

TEST(Friction, HoldsInATightFitOfManyContacts) {
    // Truth: invariant. However many contacts rub, the motion is finite and no longer than the wanted one, since
    // standing still is allowed, and no patch bears more than its cone; where a balance is found no contact is entered
    // by more than the problem's tolerance.
    Random random(20);
    int settled = 0;
    constexpr int kRuns = 150;
    for (int run = 0; run < kRuns; ++run) {
        const auto contacts = tightFit(random, run % 3, 200 + static_cast<int>(random.uniform(0.0, 1300.0)));
        const auto manifold = manifoldOf(contacts);
        Motion wanted;
        for (int i = 0; i < 6; ++i) wanted[i] = random.normal() * std::pow(10.0, random.uniform(-5, -2));
        const double at_rest = random.uniform(0.1, 1.0);
        const FrictionMotion found =
            rub(wanted, manifold, {.at_rest = at_rest, .sliding = at_rest * random.uniform(0.5, 1.0)});
        settled += found.converged ? 1 : 0;
        ASSERT_LE(found.motion.u.norm(), wanted.norm() * (1.0 + 1e-6)) << run;
        for (int i = 0; i < found.patches.count; ++i) {
            const auto& patch = found.patches.patch[static_cast<std::size_t>(i)];
            ASSERT_LE(patch.impulse.norm(), at_rest * patch.pressure * (1.0 + 1e-6) + 1e-8 * wanted.norm()) << run;
        }
        if (!found.converged) continue;
        const Vec3 turn = found.motion.u.tail<3>() / kRho;
        for (const ContactPoint& c : contacts) {
            const Vec3 way = found.motion.u.head<3>() + turn.cross(c.position);
            ASSERT_GE(c.phi + c.gradient.dot(way), kKeepOut - 1e-6 * wanted.norm()) << run;
        }
    }
    std::printf("settled %d of %d\n", settled, kRuns);
    EXPECT_GT(settled, kRuns / 4);
}

TEST(Friction, BalancesTheSpringByWhatItTells) {
    // Truth: closed form, the header's u = w + Σ λ_i a_i + Σ_p B_pᵀ x_p with all that is told: contacts with what they
    // push, patches with centre, radius and rub; the patches press with what the contacts push with. A body that lies
    // off the origin, two obstacles of their own coefficients, overlap to be removed.
    Random random(41);
    int balanced = 0, rubbing = 0;
    const Friction friction[] = {{.at_rest = 0.6, .sliding = 0.4}, {.at_rest = 0.2, .sliding = 0.2}};
    for (int trial = 0; trial < 3000; ++trial) {
        const auto any = [&](double size) {
            return Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
        };
        const Vec3 origin = any(0.5);
        const double rho = random.uniform(0.005, 0.05);
        std::vector<ContactPoint> contacts;
        const std::uint64_t count = 1 + random.below(trial % 10 == 0 ? 40 : 5);
        for (std::uint64_t i = 0; i < count; ++i) {
            const bool wall = random.below(3) == 0;
            contacts.push_back(contactAt(origin + any(0.02), wall ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitZ())));
            contacts.back().gradient *= random.uniform(0.8, 1.2);
            contacts.back().obstacle = wall ? 1 : 0;
            contacts.back().phi = random.uniform(-3e-6, 2e-6);
            contacts.back().area = random.uniform(1e-7, 1e-5);
        }
        const auto manifold = manifoldOf(contacts);
        const motion::Surroundings around{manifold, {rho, origin}, kKeepOut, -2e-6};
        Motion wanted;
        wanted << any(2e-4) - Vec3(1e-4, 0, 1e-4), any(1e-4);
        const FrictionMotion found = motion::constrainWithFriction(wanted, around, friction, {});
        ASSERT_LE(found.motion.active, 6);
        Motion sum = wanted;
        double push = 0.0, pressure = 0.0;
        for (int i = 0; i < found.motion.active; ++i) {
            const auto& held = found.motion.active_contacts[static_cast<std::size_t>(i)];
            const ContactPoint& c = contacts[held.contact];
            const Vec3 force = held.push * c.gradient.normalized(), lever = c.position - origin;
            sum.head<3>() += force;
            sum.tail<3>() += lever.cross(force) / rho;
            push += held.push;
            ASSERT_GE(held.push, 0.0);
            for (int k = 0; k < i; ++k)
                ASSERT_NE(held.contact, found.motion.active_contacts[static_cast<std::size_t>(k)].contact)
                    << "told twice";
        }
        for (int p = 0; p < found.patches.count; ++p) {
            const auto& patch = found.patches.patch[static_cast<std::size_t>(p)];
            const Vec3 rubbed = motion::impulseAlong(patch), lever = patch.centre - origin;
            sum.head<3>() += rubbed;
            sum.tail<3>() += (lever.cross(rubbed) + patch.radius * patch.impulse.z() * patch.normal) / rho;
            pressure += patch.pressure;
            rubbing += patch.impulse.norm() > 1e-9 ? 1 : 0;
            const Vec3 dx = found.motion.u.head<3>() + (found.motion.u.tail<3>() / rho).cross(lever);
            const double along = (dx - patch.normal * patch.normal.dot(dx)).norm();
            const double turning = patch.radius / rho * patch.normal.dot(found.motion.u.tail<3>());
            ASSERT_NEAR(patch.slip, std::hypot(along, turning), 1e-6 * wanted.norm()) << trial;
            const Friction& rough = friction[patch.obstacle];
            ASSERT_LE(patch.impulse.norm(), rough.at_rest * patch.pressure * (1.0 + 1e-6) + 1e-9 * wanted.norm());
        }
        ASSERT_NEAR(push, pressure, 1e-9 * (push + wanted.norm())) << trial;
        if (!found.converged || found.sweeps == motion::kFrictionSweeps) continue;
        ++balanced;
        for (const ContactPoint& c : contacts) {
            const double b = (c.phi < kKeepOut ? -2e-6 : kKeepOut) - c.phi;
            const double bound = found.motion.relaxed ? std::min(b, 0.0) : b;
            const Vec3 dx = found.motion.u.head<3>() + (found.motion.u.tail<3>() / rho).cross(c.position - origin);
            ASSERT_GE(c.gradient.dot(dx), bound - 2e-9 - 1e-6 * wanted.norm()) << trial;
        }
        ASSERT_LT((sum - found.motion.u).norm(), 1e-5 * wanted.norm()) << trial;
    }
    EXPECT_GT(balanced, 2500);
    EXPECT_GT(rubbing, 1000);
}

TEST(Friction, DoesNotCreepAtRest) {
    // Truth: invariant. A disc drawn aside within its cone, 10 000 times from where it came to: no drift.
    const auto contacts = disc(0.005, 0.5e-3);
    const auto manifold = manifoldOf(contacts);
    Vec3 p = Vec3::Zero();
    FrictionPatches before;
    for (int i = 0; i < 10000; ++i) {
        const FrictionMotion found = rub(motion(Vec3(0.4e-4, 0, -1e-4) - p, {0, 0, 1e-4}), manifold, kDry, before);
        before = found.patches;
        p += found.motion.u.head<3>();
    }
    EXPECT_LT(p.norm(), 1e-12);
}

TEST(Friction, NeverThrowsABodyOutOfAGroove) {
    // Truth: invariant. Pressed into a groove steeper than its cone a body locks: it does not rise, and no body moves
    // farther than it was drawn, whatever the coefficient. Grooves of random planes beside it.
    const auto wall = [](double side, double half_angle, double y) {
        return contactAt({0.01 * side, y, 0}, Vec3(-side * std::cos(half_angle), 0, std::sin(half_angle)));
    };
    const double narrow = 15.0 * std::numbers::pi / 180.0;
    const auto groove =
        manifoldOf({wall(1, narrow, 0.01), wall(-1, narrow, 0.01), wall(1, narrow, -0.01), wall(-1, narrow, -0.01)});
    const FrictionMotion pressed = rub(motion({2e-4, 0, -1e-3}), groove, {.at_rest = 0.4, .sliding = 0.3});
    EXPECT_LT(pressed.motion.u.z(), 1e-8);
    Random random(5);
    for (int trial = 0; trial < 1000; ++trial) {
        const auto any = [&](double size) {
            return Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
        };
        std::vector<ContactPoint> contacts;
        for (int i = 0; i < 3; ++i) contacts.push_back(contactAt(any(0.02), any(1.0).normalized()));
        const Motion wanted = motion(any(1e-3), any(1e-2));
        const FrictionMotion found = rub(wanted, manifoldOf(contacts), {.at_rest = 1.0, .sliding = 1.0});
        EXPECT_LE(found.motion.u.norm(), 1.01 * wanted.norm()) << trial << ' ' << found.converged;
    }
}

TEST(Friction, SlidesAlongARightAngledCornerAgainstBothItsWalls) {
    // Truth: closed form. Pressed by d onto a floor and by a against a wall, drawn by t along their edge: both rub
    // along it and neither along the other, u = t - μ_d (a + d). What rests may be held by more than μ_s (a + d), since
    // friction across the edge presses the walls; by less than that it is. To 1e-5 of the motion.
    constexpr double d = 1e-4, a = 2e-4;
    const auto manifold = manifoldOf({contactAt(Vec3::Zero(), Vec3::UnitZ()), contactAt(Vec3::Zero(), -Vec3::UnitX())});
    for (const double share : {0.2, 0.49, 0.7, 1.0, 3.0}) {
        const Motion wanted = motion({a, share * (a + d), -d});
        const FrictionMotion found = rub(wanted, manifold);
        const double slip = share <= kDry.at_rest ? 0.0 : (share - kDry.sliding) * (a + d);
        EXPECT_TRUE(found.converged);
        EXPECT_NEAR((found.motion.u.head<3>() - slip * Vec3::UnitY()).norm(), 0.0, 1e-5 * wanted.norm()) << share;
    }
}

TEST(Friction, SlidesOnTheEdgeOfATableThatItTipsOver) {
    // Truth: closed form. A body whose origin is beyond a table's edge, pressed there by d, stands on the edge only, b
    // behind its origin, and tips: Λ = d/(1 + b²/ρ²). Drawn along the edge by t its contact goes t - μ d, or stays.
    constexpr double d = 1e-4, b = 0.008;
    const auto manifold = manifoldOf({contactAt({-b, 0, 0}, Vec3::UnitZ()), contactAt({-2 * b, 0, 0}, Vec3::UnitZ())});
    for (const double share : {0.2, 0.49, 0.51, 0.7, 3.0}) {
        const FrictionMotion found = rub(motion({0, share * d, -d}), manifold);
        const Vec3 turn = found.motion.u.tail<3>() / kRho;
        const double slip = found.motion.u.y() + turn.cross(Vec3(-b, 0, 0)).y();
        EXPECT_TRUE(found.converged);
        EXPECT_NEAR(slip, share <= kDry.at_rest ? 0.0 : (share - kDry.sliding) * d, 1e-6 * d) << share;
        ASSERT_EQ(found.patches.count, 1);
        EXPECT_NEAR(found.patches.patch[0].pressure, d / (1.0 + b * b / (kRho * kRho)), 1e-6 * d);
    }
}

TEST(Friction, MovesInACornerWithoutEverHoldingWhatSlides) {
    // Truth: invariant. A box in a corner of two planes, drawn hard along it and anyhow besides: contacts and cones are
    // obeyed, and it moves along by more than friction could take.
    Random random(11);
    std::vector<ContactPoint> contacts;
    for (const double y : {-0.01, 0.01})
        for (const double far : {0.0, 0.02}) {
            contacts.push_back(contactAt({-far, y, 0}, Vec3::UnitZ()));
            contacts.push_back(contactAt({0, y, far}, -Vec3::UnitX()));
        }
    const auto manifold = manifoldOf(contacts);
    int unsolved = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const auto any = [&](double size) {
            return Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
        };
        const Motion wanted = motion(Vec3(2e-4, 2e-3, -2e-4) + any(2e-4), any(5e-3));
        const FrictionMotion found = rub(wanted, manifold);
        unsolved += found.converged ? 0 : 1;
        EXPECT_GT(found.motion.u.y(), 0.2e-3) << trial;
        for (const auto& c : contacts) {
            const Vec3 dx = found.motion.u.head<3>() + (found.motion.u.tail<3>() / kRho).cross(c.position);
            EXPECT_GT(c.gradient.dot(dx), -1e-8) << trial;
        }
        for (int i = 0; i < found.patches.count; ++i) {
            const auto& patch = found.patches.patch[static_cast<std::size_t>(i)];
            EXPECT_LE(patch.impulse.norm(), kDry.at_rest * patch.pressure * (1 + 1e-9)) << trial;
        }
    }
    EXPECT_LE(unsolved, 10);
}

TEST(Friction, FindsTheCentreWhereAContactBearsNothing) {
    // Truth: closed form. Two contacts of one plane, drawn so that one of them bears nothing: the centre is the other.
    for (const bool swapped : {false, true}) {
        std::vector<ContactPoint> contacts{contactAt({0.009, 0, 0}, Vec3::UnitZ()),
                                           contactAt(Vec3::Zero(), Vec3::UnitZ())};
        if (swapped) std::swap(contacts[0], contacts[1]);
        const FrictionMotion found =
            rub(motion({0, 1e-4, -5e-4}), manifoldOf(contacts), {.at_rest = 0.5, .sliding = 0.3});
        ASSERT_EQ(found.patches.count, 1);
        EXPECT_LT(found.patches.patch[0].centre.norm(), 0.01);
        EXPECT_NEAR(found.motion.u.y(), 0.0, 1e-9);
    }
}

TEST(Friction, BeginsWithTheFrictionBeforeAndEndsWhereItEndsWithout) {
    // Truth: invariant. A body drawn along a wide groove, ever more to one side, that slides all the time: the same
    // motion, in fewer sweeps if the friction of the tick before is known.
    std::vector<ContactPoint> contacts;
    for (const double side : {1.0, -1.0})
        for (const double y : {0.01, -0.01})
            contacts.push_back(contactAt({0.01 * side, y, 0}, Vec3(-0.5 * side, 0, std::sqrt(0.75))));
    const auto manifold = manifoldOf(contacts);
    FrictionPatches before = rub(motion({0, 3e-4, -2e-4}), manifold).patches;
    int cold_sweeps = 0, warm_sweeps = 0;
    for (int i = 1; i <= 100; ++i) {
        const Motion wanted = motion({5e-7 * i, 3e-4, -2e-4});
        FrictionPatches unknown = before;
        for (auto& patch : unknown.patch) {
            patch.impulse.setZero();
            patch.slip = 0.0;
        }
        const FrictionMotion warm = rub(wanted, manifold, kDry, before), cold = rub(wanted, manifold, kDry, unknown);
        ASSERT_TRUE(warm.converged && cold.converged);
        ASSERT_TRUE(warm.patches.patch[0].slides);
        EXPECT_LT((warm.motion.u - cold.motion.u).norm(), 1e-6 * wanted.norm()) << i;
        before = warm.patches;
        cold_sweeps += cold.sweeps;
        warm_sweeps += warm.sweeps;
    }
    std::printf("sweeps of 100 motions: cold %d, warm %d\n", cold_sweeps, warm_sweeps);
    EXPECT_LT(warm_sweeps, cold_sweeps);
}

TEST(Friction, IsRelaxedWhereTwoWallsThatRubLeaveNoWayOut) {
    // Truth: invariant. Between walls without play, against which the hand turns, an overlap with the floor is left
    // along them alone; what slips along a wall rises from it, which the other one forbids. Without friction the
    // overlap is left; with it, nothing sinks.
    constexpr double kDeep = 1e-5, kRounding = 1e-12, kHigh = 0.01;
    std::vector<ContactPoint> contacts{contactAt({0, 0, -kHigh}, Vec3::UnitZ())};
    contacts[0].phi -= kDeep;
    for (const double z : {-kHigh, kHigh}) {
        contacts.push_back(contactAt({-0.01, 0, z}, Vec3::UnitX()));
        contacts.push_back(contactAt({0.01, 0, z}, -Vec3::UnitX()));
    }
    const auto manifold = manifoldOf(contacts);
    const Motion wanted = motion({0, 0, -1e-4}, {0, 1e-2, 0});
    const auto smooth = motion::constrainMotion(wanted, {manifold, {kRho}, kKeepOut});
    EXPECT_FALSE(smooth.relaxed);
    EXPECT_NEAR(smooth.u.z(), kDeep, kRounding);
    const FrictionMotion rubbed = rub(wanted, manifold);
    EXPECT_TRUE(rubbed.motion.relaxed);
    EXPECT_GE(rubbed.motion.u.z(), -kRounding);
    EXPECT_NEAR(rubbed.motion.u.x(), 0.0, kRounding);
    std::printf("rises by %.3g of %.3g um\n", 1e6 * rubbed.motion.u.z(), 1e6 * kDeep);
}

TEST(Friction, AContactThatSaysNoWayOutBearsNothing) {
    // Truth: invariant: the same motion without it. A gradient of zero has no normal that anything could rub along.
    auto contacts = disc(0.01, 2e-3);
    const Motion wanted = motion({1e-4, 0, -1e-4}, {0, 0, 1e-3});
    const FrictionMotion without = rub(wanted, manifoldOf(contacts));
    ContactPoint none = contactAt({0.005, 0, 0}, Vec3::UnitX());
    none.gradient = Vec3::Zero();
    none.phi -= 1e-5;
    contacts.push_back(none);
    const FrictionMotion with = rub(wanted, manifoldOf(contacts));
    EXPECT_TRUE(with.converged);
    EXPECT_EQ(with.motion.u, without.motion.u);
}

TEST(Friction, WithoutFrictionIsTheConstrainedMotion) {
    // Truth: regression against constrainMotion, which has truths of its own.
    Random random(9);
    for (int trial = 0; trial < 100; ++trial) {
        std::vector<ContactPoint> contacts;
        for (int i = 0; i < 4; ++i)
            contacts.push_back(contactAt(0.02 * Vec3(random.normal(), random.normal(), random.normal()),
                                         Vec3(random.normal(), random.normal(), random.normal()).normalized()));
        const Motion wanted = motion(1e-4 * Vec3(random.normal(), random.normal(), random.normal()));
        const auto manifold = manifoldOf(contacts);
        const auto plain = motion::constrainMotion(wanted, {manifold, {kRho}, kKeepOut});
        EXPECT_EQ(rub(wanted, manifold, Friction{}).motion.u, plain.u);
    }
}

}  // namespace
}  // namespace passung
