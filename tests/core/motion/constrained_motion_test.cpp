#include "core/motion/constrained_motion.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "core/base/random.h"

namespace passung {
namespace {

using contact::ContactManifold;
using contact::ContactPoint;
using motion::ConstrainedMotion;
using motion::Motion;

constexpr double kRho = 0.02;       // [m]
constexpr double kKeepOut = -1e-6;  // [m]

Vec3 randomVector(Random& random, double size) {
    return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

Motion randomMotion(Random& random, double size) {
    Motion u;
    u << randomVector(random, size), randomVector(random, size);
    return u;
}

ContactPoint contactAt(const Vec3& position, const Vec3& gradient, double phi) {
    ContactPoint c;
    c.position = position;
    c.normal = -gradient;
    c.gradient = gradient;
    c.phi = phi;
    return c;
}

ConstrainedMotion solve(const Motion& wanted, const std::vector<ContactPoint>& contacts,
                        const std::vector<std::uint32_t>& likely = {}) {
    ContactManifold manifold(contacts.size());
    for (const auto& c : contacts) EXPECT_TRUE(manifold.tryPush(c));
    return motion::constrainMotion(wanted, {manifold, {kRho}, kKeepOut}, likely);
}

double pushOf(const ConstrainedMotion& motion) {
    double sum = 1e-12;
    for (int i = 0; i < motion.active; ++i) sum += motion.active_contacts[static_cast<std::size_t>(i)].push;
    return sum;
}

/// The wall of a bore around a peg: `count` noisy contacts at three heights.
std::vector<ContactPoint> bore(Random& random, int count) {
    std::vector<ContactPoint> contacts;
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
        contacts.push_back(contactAt(0.01 * out + Vec3(0, 0, 0.01 * (i % 3)), -out + randomVector(random, 1e-3),
                                     kKeepOut + random.uniform(0.0, 1e-5)));
    }
    return contacts;
}

struct Row {
    Motion a;
    double b;
};

std::vector<Row> rowsOf(const std::vector<ContactPoint>& contacts) {
    std::vector<Row> rows;
    for (const auto& c : contacts) {
        Row row;
        row.a << c.gradient, c.position.cross(c.gradient) / kRho;
        row.b = kKeepOut - c.phi;
        rows.push_back(row);
    }
    return rows;
}

double worstViolation(const Motion& u, const std::vector<ContactPoint>& contacts) {
    double worst = 0.0;
    for (const auto& row : rowsOf(contacts)) worst = std::max(worst, row.b - row.a.dot(u));
    return worst;
}

/// The nearest feasible motion by trying every set of active rows.
Motion nearestByEnumeration(const Motion& wanted, const std::vector<Row>& rows) {
    Motion best = Motion::Zero();
    double least = 1e300;
    for (unsigned set = 0; set < 1u << rows.size(); ++set) {
        std::vector<std::size_t> active;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if ((set >> i & 1u) != 0) active.push_back(i);
        }
        if (active.size() > 6) continue;
        const auto n = static_cast<Eigen::Index>(active.size());
        Eigen::MatrixXd N(6, n);
        Eigen::VectorXd b(n);
        for (Eigen::Index k = 0; k < n; ++k) {
            N.col(k) = rows[active[static_cast<std::size_t>(k)]].a;
            b[k] = rows[active[static_cast<std::size_t>(k)]].b;
        }
        Motion u = wanted;
        if (n > 0) {
            const Eigen::FullPivLU<Eigen::MatrixXd> gram(N.transpose() * N);
            if (!gram.isInvertible()) continue;
            u += N * gram.solve(b - N.transpose() * wanted);
        }
        double worst = 0.0;
        for (const auto& row : rows) worst = std::max(worst, row.b - row.a.dot(u));
        if (worst < 1e-12 && (u - wanted).norm() < least) {
            least = (u - wanted).norm();
            best = u;
        }
    }
    return best;
}

TEST(ConstrainedMotion, EqualsTheNearestMotionFoundByTryingEveryActiveSet) {
    // Truth: independent program (enumeration of all sets of active rows). 1 500 random manifolds of one to nine
    // contacts, with and without overlap; a start that obeys all rows exists by construction.
    Random random(7);
    int bent = 0, full = 0;
    for (int trial = 0; trial < 1500; ++trial) {
        const Motion obeying = trial % 2 == 0 ? Motion(Motion::Zero()) : randomMotion(random, 1e-5);
        std::vector<ContactPoint> contacts;
        const int count = 1 + static_cast<int>(random.below(9));
        for (int i = 0; i < count; ++i) {
            auto c = contactAt(randomVector(random, 0.03), randomVector(random, 1.0).normalized(), 0.0);
            const double room = random.uniform() < 0.3 ? 0.0 : random.uniform(0.0, 2e-4);
            Motion a;
            a << c.gradient, c.position.cross(c.gradient) / kRho;
            c.phi = kKeepOut + room - a.dot(obeying);
            contacts.push_back(c);
        }
        const Motion wanted = randomMotion(random, 3e-4);
        const ConstrainedMotion result = solve(wanted, contacts);
        ASSERT_TRUE(result.converged) << trial;
        if (result.relaxed) continue;  // the other branch, below
        const Motion truth = nearestByEnumeration(wanted, rowsOf(contacts));
        // A violation of the tolerance moves the nearest point by at most the tolerance over the sine of the least
        // angle between rows; random rows are farther apart than 1e-2.
        ASSERT_LT((result.u - truth).norm(), motion::kMotionTolerance / 1e-2) << trial;
        ASSERT_LE(worstViolation(result.u, contacts), motion::kMotionTolerance) << trial;
        bent += result.active > 0 ? 1 : 0;
        full += result.active >= 4 ? 1 : 0;
    }
    EXPECT_GT(bent, 1000);
    EXPECT_GT(full, 100);
}

TEST(ConstrainedMotion, LetsAMotionPassThatNoContactStops) {
    // Truth: closed form (away from a wall: the motion itself, to the bit).
    Motion away = Motion::Zero();
    away << 1e-4, 2e-5, 3e-4, 1e-5, -2e-5, 4e-5;
    const auto result = solve(away, {contactAt(Vec3::Zero(), Vec3::UnitZ(), 0.0)});
    EXPECT_EQ(result.u, away);
    EXPECT_EQ(result.active, 0);
}

TEST(ConstrainedMotion, SlidesAFlatFaceAlongAPlaneWithoutTurningIt) {
    // Truth: closed form. 400 equal rows' worth of a flat face: pushed down and along, it moves along only.
    std::vector<ContactPoint> contacts;
    for (int i = 0; i < 20; ++i) {
        for (int k = 0; k < 20; ++k) {
            contacts.push_back(contactAt(Vec3(0.002 * (i - 9.5), 0.002 * (k - 9.5), 0.0), Vec3::UnitZ(), kKeepOut));
        }
    }
    Motion wanted = Motion::Zero();
    wanted << 1e-4, 2e-4, -5e-4, 0, 0, 0;
    const auto result = solve(wanted, contacts);
    EXPECT_TRUE(result.converged);
    EXPECT_FALSE(result.relaxed);
    Motion truth = wanted;
    truth[2] = 0.0;
    EXPECT_LT((result.u - truth).norm(), 1e-9);
}

TEST(ConstrainedMotion, EndsOnContactsThatAreNearlyDependent) {
    // Truth: invariant. A ring of 300 noisy wall contacts at three heights, as of a peg in a bore, pushed and tilted:
    // the solver ends by itself, obeys every contact and moves no farther from what is wanted than standing still does.
    Random random(11);
    int most = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const std::vector<ContactPoint> contacts = bore(random, 300);
        const Motion wanted = randomMotion(random, 1e-3);
        const auto result = solve(wanted, contacts);
        ASSERT_TRUE(result.converged) << trial;
        ASSERT_LE(worstViolation(result.u, contacts), motion::kMotionTolerance) << trial;
        ASSERT_LE((result.u - wanted).norm(), wanted.norm() * (1.0 + 1e-12)) << trial;
        most = std::max(most, result.iterations);
    }
    RecordProperty("most_iterations", most);
    EXPECT_LT(most, motion::kMaxIterations / 2);
}

TEST(ConstrainedMotion, LosesNothingOfManyContacts) {
    // Truth: closed form (the conditions of Karush, Kuhn and Tucker, which only the one nearest motion meets): no
    // contact of 3 000 is violated though never more than kMostRows are rows, and u - w is a sum of pushes along the
    // contacts' normals that are told, none of which pulls.
    Random random(13);
    for (int trial = 0; trial < 100; ++trial) {
        const std::vector<ContactPoint> contacts = bore(random, 3000);
        const Motion wanted = randomMotion(random, 1e-3);
        const auto result = solve(wanted, contacts);
        ASSERT_TRUE(result.converged && !result.relaxed) << trial;
        ASSERT_LE(worstViolation(result.u, contacts), motion::kMotionTolerance);
        Motion pushed = wanted;
        for (int i = 0; i < result.active; ++i) {
            const auto& held = result.active_contacts[static_cast<std::size_t>(i)];
            const auto& contact = contacts[held.contact];
            ASSERT_GE(held.push, 0.0);
            Motion a;
            a << contact.gradient, contact.position.cross(contact.gradient) / kRho;
            pushed += held.push / contact.gradient.norm() * a;
        }
        ASSERT_LT((pushed - result.u).norm(), 1e-9) << trial;  // rows nearly dependent: large pushes, rounded
    }
}

TEST(ConstrainedMotion, MeetsItsConditionsWhereverTheBodyLies) {
    // Truth: closed form (the conditions of Karush, Kuhn and Tucker) with the header's a_i and b_i: a body that lies
    // and contacts that press off the origin, gradients longer and shorter than 1, overlaps beyond what is kept, of
    // which the deepest come out first, spheres that ask for nothing, gradients too short to say anything. Cold, warm,
    // and with the wrong contacts first.
    Random random(23);
    int relaxed = 0, held_contacts = 0, deep = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const Vec3 origin = randomVector(random, 0.5);
        const double rho = random.uniform(0.005, 0.05), keep_out = -2e-6, sunk_out = -5e-6;
        const std::uint64_t count = 1 + random.below(trial % 10 == 0 ? 120 : 7);
        ContactManifold manifold(count);
        for (std::uint64_t i = 0; i < count; ++i) {
            const double length = random.below(12) == 0 ? random.uniform(0.0, 0.0999) : random.uniform(0.101, 1.4);
            auto contact = contactAt(origin + randomVector(random, 0.02),
                                     length * (Vec3::UnitZ() + randomVector(random, 0.7)).normalized(),
                                     random.uniform(-8e-6, 3e-5));
            if (random.below(8) == 0) contact.radius = 1e-3;
            ASSERT_TRUE(manifold.tryPush(contact));
        }
        const motion::Surroundings around{manifold, {rho, origin}, keep_out, sunk_out};
        const Motion wanted = randomMotion(random, std::pow(10.0, random.uniform(-6.0, -4.0)));
        std::vector<std::uint32_t> likely;
        for (int round = 0; round < 3; ++round) {
            const auto result = motion::constrainMotion(wanted, around, likely);
            ASSERT_TRUE(result.converged);
            const auto rowOf = [&](const ContactPoint& c) {
                Row row;
                row.a << c.gradient, (c.position - origin).cross(c.gradient) / rho;
                row.b = (c.phi < keep_out ? sunk_out : keep_out) - c.phi;
                if (result.relaxed || c.radius > 0.0) row.b = std::min(row.b, 0.0);
                return row;
            };
            for (const ContactPoint& c : manifold) {
                const Row row = rowOf(c);
                if (c.gradient.norm() > motion::kLeastGradient) {
                    ASSERT_GE(row.a.dot(result.u), row.b - 1.001 * motion::kMotionTolerance) << trial;
                }
            }
            Motion pushed = wanted;
            double size = wanted.norm();
            for (int i = 0; i < result.active; ++i) {
                const auto& held = result.active_contacts[static_cast<std::size_t>(i)];
                const ContactPoint& c = manifold[held.contact];
                const Row row = rowOf(c);
                ASSERT_GT(c.gradient.norm(), motion::kLeastGradient);
                ASSERT_GE(held.push, 0.0);
                ASSERT_NEAR(row.a.dot(result.u), row.b, 1e-9 * (1.0 + size)) << trial;
                pushed += held.push / c.gradient.norm() * row.a;
                size += held.push;
                deep += row.b > 0.0 && c.phi < keep_out ? 1 : 0;
            }
            ASSERT_LT((pushed - result.u).norm(), 1e-9 * size) << trial;
            relaxed += result.relaxed ? 1 : 0;
            held_contacts += result.active;
            likely.clear();
            if (round == 0)
                for (int i = 0; i < result.active; ++i)
                    likely.push_back(result.active_contacts[static_cast<std::size_t>(i)].contact);
            else
                for (int i = 0; i < 6; ++i) likely.push_back(static_cast<std::uint32_t>(random.below(count)));
        }
    }
    EXPECT_GT(relaxed, 30);
    EXPECT_GT(deep, 300);
    EXPECT_GT(held_contacts, 3000);
}

TEST(ConstrainedMotion, BeginsWarmAndEndsWhereItEndsCold) {
    // Truth: invariant (the nearest motion is one). A hand that goes on by 1 % of its pull a tick: begun with what held
    // before, the same motion in fewer steps; begun with any contacts, the same motion.
    Random random(17);
    int cold_steps = 0, warm_steps = 0;
    for (int trial = 0; trial < 100; ++trial) {
        const std::vector<ContactPoint> contacts = bore(random, 200);
        Motion wanted = randomMotion(random, 1e-3);
        std::vector<std::uint32_t> held;
        for (int tick = 0; tick < 10; ++tick, wanted += randomMotion(random, 1e-5)) {
            const auto cold = solve(wanted, contacts), warm = solve(wanted, contacts, held);
            std::vector<std::uint32_t> any;
            for (int i = 0; i < 6; ++i) any.push_back(static_cast<std::uint32_t>(random.below(200)));
            const auto wrong = solve(wanted, contacts, any);
            // |u₁ - u₂|² = λ₁ · (b - N₁ᵀu₂) + λ₂ · (b - N₂ᵀu₁): each violates the other's rows by the tolerance at
            // most.
            ASSERT_LT((warm.u - cold.u).squaredNorm(), motion::kMotionTolerance * (pushOf(warm) + pushOf(cold)))
                << trial;
            ASSERT_LT((wrong.u - cold.u).squaredNorm(), motion::kMotionTolerance * (pushOf(wrong) + pushOf(cold)))
                << trial;
            held.clear();
            for (int i = 0; i < warm.active; ++i)
                held.push_back(warm.active_contacts[static_cast<std::size_t>(i)].contact);
            if (tick == 0) continue;
            cold_steps += cold.iterations;
            warm_steps += warm.iterations;
        }
    }
    std::printf("steps of 900 motions: cold %d, warm %d\n", cold_steps, warm_steps);
    EXPECT_LT(5 * warm_steps, cold_steps);
}

TEST(ConstrainedMotion, KeepsAnOverlapFromGrowingWhereItCannotBeRemoved) {
    // Truth: closed form. Two walls 0.2 mm too near: a push into one of them is stopped, along them it is free.
    std::vector<ContactPoint> contacts;
    for (const double y : {-0.01, 0.0, 0.01}) {
        for (const double z : {-0.01, 0.01}) {
            contacts.push_back(contactAt(Vec3(-0.01, y, z), Vec3::UnitX(), -1e-4));
            contacts.push_back(contactAt(Vec3(0.01, y, z), -Vec3::UnitX(), -1e-4));
        }
    }
    Motion wanted = Motion::Zero();
    wanted << 3e-4, 1e-4, -2e-4, 0, 0, 0;
    const auto result = solve(wanted, contacts);
    EXPECT_TRUE(result.relaxed);
    EXPECT_TRUE(result.converged);
    Motion truth = wanted;
    truth[0] = 0.0;
    EXPECT_LT((result.u - truth).norm(), 1e-9);
}

TEST(ConstrainedMotion, EndsWhenTheHandIsFarAndWallsAreNearlyParallel) {
    // Truth: invariant. Two opposite walls whose gradients are noisy in the last digits that a float holds, the hand up
    // to a metre away: solved, to the tolerance that the header states.
    Random random(5);
    for (const double noise : {0.0, 1e-8, 1e-7}) {
        for (const double size : {0.01, 0.1, 1.0}) {
            for (int trial = 0; trial < 100; ++trial) {
                std::vector<ContactPoint> contacts;
                for (int i = 0; i < 40; ++i) {
                    const double side = i % 2 == 0 ? 1.0 : -1.0;
                    const Vec3 position(side * 0.01, random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02));
                    contacts.push_back(
                        contactAt(position, side * Vec3::UnitX() + randomVector(random, noise),
                                  kKeepOut + (random.uniform() < 0.5 ? 0.0 : random.uniform(0.0, 1e-5))));
                }
                Motion wanted;
                wanted << randomVector(random, size), randomVector(random, std::min(size, 0.05));
                const auto result = solve(wanted, contacts);
                ASSERT_TRUE(result.converged) << noise << " " << size << " " << trial;
                ASSERT_LE(worstViolation(result.u, contacts), std::max(1e-9, 2e-7 * wanted.norm()) * (1.0 + 1e-9));
            }
        }
    }
}

TEST(ConstrainedMotion, IsNotSentFarAwayByAWedgeThatIsALittleTooNarrow) {
    // Truth: closed form. Two walls that close by 1e-4 per unit and overlap by 1 um each: the way out is 20 mm along
    // the wedge. The motion stays within what was wanted.
    std::vector<ContactPoint> contacts;
    for (const double side : {1.0, -1.0}) {
        contacts.push_back(contactAt(Vec3(0.0, -side * 0.001, 0.0), Vec3(1e-4, side, 0.0).normalized(), -2e-6));
    }
    Motion wanted = Motion::Zero();
    wanted << 0, 1e-4, 0, 0, 0, 0;
    const auto result = solve(wanted, contacts);
    EXPECT_TRUE(result.relaxed);
    EXPECT_LE((result.u - wanted).norm(), wanted.norm() * (1.0 + 1e-9));
}

TEST(ConstrainedMotion, LeavesAWedgeByAtMostFourTimesItsOverlap) {
    // Truth: closed form and the header's limit. Walls at half angle θ to the way out, each overlapped by d: the
    // nearest motion without overlap goes d / sin θ along that way. It is made up to |w| + 4 d, and not beyond.
    constexpr double d = 2e-6;
    for (const double far : {1.5, 3.0, 3.9, 4.1, 5.0, 30.0}) {
        const double sine = 1.0 / far, cosine = std::sqrt(1.0 - sine * sine);
        std::vector<ContactPoint> contacts;
        for (const double side : {1.0, -1.0})
            contacts.push_back(contactAt(Vec3::Zero(), Vec3(sine, side * cosine, 0.0), kKeepOut - d));
        const auto result = solve(Motion::Zero(), contacts);
        EXPECT_TRUE(result.converged);
        EXPECT_EQ(result.relaxed, far > 4.0) << far;
        Motion truth = Motion::Zero();
        truth[0] = far > 4.0 ? 0.0 : far * d;
        EXPECT_NEAR((result.u - truth).norm(), 0.0, 1e-3 * d) << far;
        auto sphere = contactAt(Vec3::Zero(), Vec3::UnitZ(), -3e-3);  // asks for nothing, however deep it reaches
        sphere.radius = 0.005;
        contacts.push_back(sphere);
        EXPECT_EQ(solve(Motion::Zero(), contacts).relaxed, far > 4.0) << far;
        Motion back = Motion::Zero();  // a hand that draws deeper into it by d adds its own |w| to both sides
        back[0] = -d;
        EXPECT_EQ(solve(back, contacts).relaxed, far > 4.0) << far;
        Motion aside = Motion::Zero();  // one that draws along the walls' edge by 2 d makes the limit 6 d
        aside[2] = 2.0 * d;
        EXPECT_EQ(solve(aside, contacts).relaxed, far > 6.0) << far;
    }
}

TEST(ConstrainedMotion, NeverAsksASphereThatStandsInToMoveOut) {
    // Truth: closed form. A sphere that reaches 3 mm into the obstacle may leave, slide, but not go deeper.
    auto sphere = contactAt(Vec3::Zero(), Vec3::UnitZ(), -3e-3);
    sphere.radius = 0.005;
    Motion wanted = Motion::Zero();
    EXPECT_EQ(solve(wanted, {sphere}).u, wanted);
    wanted << 1e-4, 0, 2e-4, 0, 0, 0;
    EXPECT_EQ(solve(wanted, {sphere}).u, wanted);
    wanted[2] = -2e-4;
    const auto stopped = solve(wanted, {sphere});
    EXPECT_NEAR(stopped.u[0], 1e-4, 1e-12);
    EXPECT_NEAR(stopped.u[2], 0.0, 1e-9);
}

}  // namespace
}  // namespace passung
