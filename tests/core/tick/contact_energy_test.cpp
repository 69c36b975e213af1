#include "core/tick/contact_energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "tests/support/every_effect.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

using scene::ContactMethod;

constexpr double kStiffness = 1000.0;  // [N/m]

/// A ball that touches a floor (z = 0) and a wall (x = 10 mm).
scene::SceneSpec ballInCorner(ContactMethod method) {
    scene::SceneSpec spec = test::scene(shape::Sphere{0.02}, {Quat::Identity(), {0, 0, 0.01}},
                                        shape::Box{0.06, 0.06, 0.02}, {Quat::Identity(), {0, 0, -0.01}}, method);
    spec.parts.push_back({.name = "wall",
                          .geometry = shape::Shape(shape::Box{0.02, 0.06, 0.06}),
                          .X_WP = {Quat::Identity(), {0.02, 0, 0.03}}});
    spec.contact.stiffness = kStiffness;
    spec.contact.rotational_stiffness = 1.0;
    return spec;
}

constexpr ContactMethod kMethods[] = {ContactMethod::Penalty, ContactMethod::GodObjectHeuristic,
                                      ContactMethod::GodObject};

double sumOf(const tick::FewOfMany<tick::PairAccount>& pairs) {
    double sum = 0.0;
    for (const tick::PairAccount& pair : pairs) sum += pair.taken_in;
    return sum;
}

TEST(ContactEnergy, OfFloorAndWallIsTheWorkAlongTheirNormals) {
    // Truth: closed form. Both are smooth: only the floor pushes along z, only the wall along x, so that each takes in
    // the work of its own direction, a force held from tick to tick times the step that follows it.
    const Vec3 step(2e-5, 0.0, -5e-5);
    for (const ContactMethod method : {ContactMethod::GodObjectHeuristic, ContactMethod::GodObject}) {
        const auto spec = ballInCorner(method);
        test::Bench bench(spec);
        Vec3 work = Vec3::Zero(), sent = Vec3::Zero();
        for (int k = 0; k <= 20; ++k) {
            work -= k > 0 ? Vec3(sent.cwiseProduct(step)) : Vec3(Vec3::Zero());
            sent = bench.step(Pose{Quat::Identity(), spec.parts[0].X_WP.p + k * step}).F_D_B.force;
        }
        const auto& pairs = bench.state().pairs;
        ASSERT_EQ(pairs.size(), 4u) << "of each part, and of none";
        EXPECT_GT(work.z(), 4e-4);
        EXPECT_GT(work.x(), 6e-5);
        EXPECT_NEAR(pairs[1].taken_in, work.z(), 1e-6 * work.z());
        EXPECT_NEAR(pairs[2].taken_in, work.x(), 1e-6 * work.z());
        EXPECT_NEAR(pairs[3].taken_in, 0.0, 1e-12);
        EXPECT_EQ(pairs[1].least, 0.0);
    }
}

TEST(ContactEnergy, OfTheOnlyObstacleInContactIsTheWhole) {
    // Truth: invariant. With a damper and friction, a delay and limits that act; the wall is a centimetre away.
    for (const ContactMethod method : kMethods) {
        auto spec = ballInCorner(method);
        spec.parts[0].X_WP.p.x() -= 0.01;
        spec.contact.damping = 5.0;
        spec.limits.delay_ticks = 2;
        spec.limits.max_force = 0.5;
        spec.limits.max_force_rate = 50.0;
        for (auto& part : spec.parts) part.friction = part.sliding_friction = 0.3;
        if (method == ContactMethod::Penalty)
            for (auto& part : spec.parts) part.friction = part.sliding_friction = 0.0;
        test::Bench bench(spec);
        double whole = 0.0;
        std::uint32_t acted = 0;
        for (int k = 0; k <= 400; ++k) {
            const double t = k / 400.0;
            const Vec3 off(-0.004 * t, 0.002 * t, -0.001 * std::sin(3 * t));
            const auto out = bench.step(Pose{Quat::Identity(), spec.parts[0].X_WP.p + off});
            whole = out.frame.energy;
            acted |= out.frame.status;
        }
        EXPECT_TRUE(acted & kForceLimited);
        const auto& pairs = bench.state().pairs;
        EXPECT_GT(std::abs(whole), 1e-5);
        EXPECT_NEAR(pairs[1].taken_in, whole, 1e-9 * std::abs(whole)) << static_cast<int>(method);
        EXPECT_EQ(pairs[2].taken_in, 0.0);
    }
}

/// Everything that may come between contact and motor.
scene::SceneSpec withEverything(ContactMethod method, bool two_way) {
    auto spec = ballInCorner(method);
    spec.contact.two_way = two_way;
    spec.contact.damping = 3.0;
    spec.contact.rotational_damping = 1e-3;
    test::addEveryEffect(spec);
    spec.limits.delay_ticks = 2;
    spec.limits.max_force = 2.0;
    spec.limits.max_torque = 0.01;
    spec.limits.max_force_rate = 500.0;
    spec.limits.quantum = 1e-5;
    spec.registration.X_WB = {Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())), {0.1, -0.2, 0.3}};
    spec.registration.X_DH = {Quat(Eigen::AngleAxisd(-0.4, Vec3(0, 1, 1).normalized())), {0.01, 0.02, -0.03}};
    if (method == ContactMethod::Penalty) return spec;
    spec.contact.proxy_filter = 150;
    for (auto& part : spec.parts) part.friction = part.sliding_friction = 0.3;
    return spec;
}

TEST(ContactEnergy, OfAllPairsIsTheAccountOfTheWhole) {
    // Truth: invariant. Random motion in and out of both contacts, with held and lost samples; up to rounding.
    for (const ContactMethod method : kMethods)
        for (const bool two_way : {false, true}) {
            const auto spec = withEverything(method, two_way);
            test::Bench bench(spec);
            const Pose X_BH = spec.registration.X_WB.inverse();
            Random random(11);
            Vec3 off = Vec3::Zero(), turn = Vec3::Zero();
            double booked = 0.0, most = 0.0;
            for (int k = 0; k < 600; ++k) {
                off += 1e-4 * Vec3(random.normal(), random.normal(), random.normal()) - 0.05 * off;
                turn += 2e-3 * Vec3(random.normal(), random.normal(), random.normal()) - 0.05 * turn;
                const Pose X_WH{rotationFromVector(turn), spec.parts[0].X_WP.p + off};
                DeviceReading reading{X_BH * X_WH * spec.registration.X_DH.inverse()};
                reading.fresh = k % 50 != 30;
                if (k % 97 > 94) reading.X_BD.p.x() = std::nan("");
                const double energy = bench.step(reading).frame.energy;
                most = std::max(most, std::abs(energy));
                ASSERT_NEAR(sumOf(bench.state().pairs), energy, 1e-12 * (1.0 + booked)) << k;
                booked = std::max(booked, std::abs(bench.state().pairs[2].taken_in));
            }
            EXPECT_GT(most, 1e-6);
            EXPECT_GT(booked, 1e-6) << "the wall was not felt";
        }
}

TEST(ContactEnergy, OfPenaltyVariantsIsSplitByTheirForces) {
    // Truth: closed form. Pressed into the floor alone, then into the wall alone: each spring keeps its own.
    for (const auto variant :
         {scene::PenaltyVariant::MaxNormalised, scene::PenaltyVariant::AreaWeighted, scene::PenaltyVariant::Raw}) {
        auto spec = ballInCorner(ContactMethod::Penalty);
        spec.contact.variant = variant;
        spec.contact.area_stiffness = 1e9;
        test::Bench bench(spec);
        const Vec3 start = spec.parts[0].X_WP.p;
        const auto press = [&](const Vec3& into) {
            for (int k = 0; k <= 20; ++k) bench.step(Pose{Quat::Identity(), start + k * 2e-5 * into});
            return bench.state().pairs;
        };
        const auto floor = press(-Vec3::UnitZ());
        EXPECT_GT(floor[1].taken_in, 1e-6);
        EXPECT_NEAR(floor[2].taken_in, 0.0, 1e-3 * floor[1].taken_in);
        press(Vec3(-1, 0, 1));  // free
        const double before = bench.state().pairs[1].taken_in;
        const auto wall = press(Vec3::UnitX());
        EXPECT_GT(wall[2].taken_in, 1e-6);
        EXPECT_NEAR(wall[1].taken_in, before, 1e-3 * wall[2].taken_in);
    }
}

}  // namespace
}  // namespace passung
