#include "core/tick/keep_apart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/triangle_distance.h"
#include "tests/support/contact_way.h"
#include "tests/support/rt_guard.h"
#include "tests/support/scenes.h"

// Parts in two hands push each other away before they touch.

namespace passung {
namespace {

using scene::ContactMethod;
using scene::Geometry;
using shape::Box;
using test::at;
using Way = test::ContactWay;

constexpr double kStiffness = 300.0, kRange = 0.015;  // [N/m], [m]

constexpr Way kClosedForm{"closed_form", ContactMethod::GodObject, Geometry::ClosedForm, 1e-7};
constexpr Way kField{"field", ContactMethod::GodObject, Geometry::Field, 1e-7};
constexpr Way kPenalty{"penalty", ContactMethod::Penalty, Geometry::Field, 1e-7};
constexpr Way kSurface{"surface", ContactMethod::GodObject, Geometry::Surface, 1e-7};

/// A box in one hand, a part in the other.
scene::SceneSpec twoHands(const Way& way, const shape::Shape& second, const Pose& X_second) {
    auto spec = test::scene(Box{0.02, 0.02, 0.02}, at(0, 0, 0), second, X_second, way.method);
    spec.parts[1].held = true;
    spec.parts[1].hand = 1;
    spec.contact.geometry = way.geometry;
    spec.other_hands.push_back({spec.limits, spec.registration, spec.start_gate});
    spec.effects.keep_apart = {kStiffness, kRange};
    return spec;
}

/// Two ticks with the hands there: in the first one a hand may be told where the other one's part was before.
std::array<tick::TickOutput, 2> step(test::Bench& bench, const Pose& first, const Pose& second) {
    const std::array readings{DeviceReading{first}, DeviceReading{second}};
    std::array<tick::TickOutput, 2> out;
    for (int i = 0; i < 2; ++i) tick::step(bench.whole(), bench.wholeState(), readings, out);
    return out;
}

class OfEachWay : public testing::TestWithParam<Way> {};
INSTANTIATE_TEST_SUITE_P(KeepApart, OfEachWay, testing::Values(kClosedForm, kField, kPenalty, kSurface),
                         [](const auto& of) { return std::string(of.param.name); });

TEST_P(OfEachWay, FacesPushEachOtherByHowMuchNearerThanTheRangeTheyAre) {
    // Truth: closed form: k (r - d) away from each other, d between the faces; nothing from the range on.
    test::Bench bench(twoHands(GetParam(), Box{0.02, 0.02, 0.02}, at(0.06, 0, 0)));
    for (double gap = 0.03; gap > 0.001; gap -= 5e-5) {
        const auto out = step(bench, at(0, 0, 0), at(0.02 + gap, 0, 0));
        const double force = gap < kRange ? kStiffness * (kRange - gap) : 0.0;
        EXPECT_LT((out[0].frame.of_keep_apart.force - Vec3(-force, 0, 0)).norm(), 1e-6) << gap;
        EXPECT_LT((out[1].frame.of_keep_apart.force - Vec3(force, 0, 0)).norm(), 1e-6) << gap;
        EXPECT_LT((out[0].F_D_B.force - Vec3(-force, 0, 0)).norm(), 1e-6) << gap;
    }
}

TEST_P(OfEachWay, AnEdgeIsPushedAtItsNearestPoint) {
    // Truth: closed form: a box turned by 45° points at a face's middle with an edge that lies along y; turned by a
    // little about z one of the edge's ends is nearest, and the torque about the origin is its lever times the force.
    test::Bench bench(twoHands(GetParam(), Box{0.2, 0.2, 0.02}, at(0, 0, -0.06)));
    const double gap = 0.005, tilt = 0.01, half = 0.01, diagonal = half * std::numbers::sqrt2;
    const Quat on_edge = rotationFromVector(Vec3(0, std::numbers::pi / 4, 0));
    const Quat turned = rotationFromVector(Vec3(tilt, 0, 0)) * on_edge;
    const double height = diagonal * std::cos(tilt) + half * std::sin(tilt) + gap;
    tick::TickOutput out;
    for (int i = 0; i < 5; ++i) out = step(bench, {turned, Vec3(0, 0, height - 0.05)}, at(0, 0, -0.06))[0];
    const Vec3 corner(0, -half * std::cos(tilt) + diagonal * std::sin(tilt), -(height - gap));
    const Vec3 force(0, 0, kStiffness * (kRange - gap));
    EXPECT_LT((out.frame.of_keep_apart.force - force).norm(), 1e-6);
    EXPECT_LT((out.frame.of_keep_apart.torque - corner.cross(force)).norm(), 1e-8);
}

TEST(KeepApart, WithAStiffnessOfZeroIsNoneToTheLastBit) {
    // Truth: invariant: the hash over all outputs, beside a scene that does not name it.
    auto zero = twoHands(kClosedForm, Box{0.02, 0.02, 0.02}, at(0.03, 0, 0)), none = zero;
    zero.effects.keep_apart.stiffness = 0.0;
    none.effects.keep_apart = {};
    test::Bench a(none), b(zero);
    for (int i = 0; i < 500; ++i) {
        step(a, at(1e-5 * i, 0, 0), at(0.03, 0, 0));
        step(b, at(1e-5 * i, 0, 0), at(0.03, 0, 0));
        ASSERT_EQ(a.wholeState().hash, b.wholeState().hash) << i;
    }
    for (const tick::Stage& stage : b.model().stages) EXPECT_STRNE(stage.name, "keeping apart");
}

TEST(KeepApart, TheDistanceIsThatOfAllTriangles) {
    // Truth: each triangle of the one against each of the other, by triangle_distance. A bar in and over a pocket, at
    // random poses: the force's size is k (r - d).
    auto spec = twoHands(kField, shape::SquareBorePlate{0.08, 0.08, 0.03, 0.04, 0.03, 0.02, 0.002}, at(0, 0, 0.2));
    spec.parts[0].geometry = Box{0.01, 0.008, 0.03};
    test::Bench bench(spec);
    const auto &held = bench.scene().parts[0]->mesh, &other = bench.scene().parts[1]->mesh;
    const auto triangle = [](const geometry::TriangleMesh& mesh, std::size_t i, const Pose& X) {
        const auto& t = mesh.triangles[i];
        return std::array{Vec3(X * mesh.vertices[t[0]]), Vec3(X * mesh.vertices[t[1]]), Vec3(X * mesh.vertices[t[2]])};
    };
    Random random(11);
    int within = 0;
    for (int run = 0; run < 200; ++run) {
        const auto vector = [&](double size) {
            return Vec3(size * random.normal(), size * random.normal(), size * random.normal());
        };
        const Pose X{rotationFromVector(vector(0.2)), vector(0.008) + Vec3(0, 0, 0.215)}, X_O = spec.parts[1].X_WP;
        spec.parts[0].X_WP = X;  // a hand does not get there from anywhere in a tick
        test::Bench there(spec);
        const auto out = step(there, X, X_O)[0];
        double least = 1.0;
        for (std::size_t i = 0; i < held.triangles.size(); ++i) {
            const auto a = triangle(held, i, X);
            for (std::size_t k = 0; k < other.triangles.size(); ++k) {
                const auto b = triangle(other, k, X_O);
                least = std::min(least, geometry::closestPair(a, b, 1.0).distance);
            }
        }
        if (least < 1e-6) continue;  // which way is out nobody knows yet
        const double size = out.frame.of_keep_apart.force.norm();
        EXPECT_NEAR(size, kStiffness * std::max(0.0, kRange - least), kStiffness * 2e-6) << run;
        within += least < kRange ? 1 : 0;
    }
    EXPECT_GT(within, 60);
}

TEST(KeepApart, WhatAHandPutsInItGetsBack) {
    // Truth: energy, summed along a closed way of position and turn about a part at rest, in steps of 10 µm at their
    // middles: none is left, beside the most that was held. The trapezium's error falls with the square of the step.
    test::Bench bench(twoHands(kClosedForm, Box{0.03, 0.02, 0.025}, at(0.038, 0.004, 0)));
    const auto pose = [](double t) {
        return Pose{rotationFromVector(Vec3(0.2 * std::sin(t), 0.3 * std::sin(2.0 * t), 0.2 * std::cos(t) - 0.2)),
                    Vec3(0.003 * std::sin(t), 0.006 * std::cos(t) - 0.006, 0.004 * std::sin(2.0 * t))};
    };
    constexpr int kSteps = 8000;
    double sum = 0.0, most = 0.0;
    Wrench last;
    Pose before = pose(0.0);
    for (int i = 0; i <= kSteps; ++i) {
        const Pose X = pose(2.0 * std::numbers::pi * i / kSteps);
        const Wrench w = step(bench, X, at(0.038, 0.004, 0))[0].frame.of_keep_apart;
        if (i > 0)
            sum += 0.5 * (w.force + last.force).dot(X.p - before.p) +
                   0.5 * (w.torque + last.torque).dot(rotationVector(X.q * before.q.conjugate()));
        most = std::max(most, std::abs(sum));
        last = w;
        before = X;
    }
    EXPECT_GT(most, 1e-4);
    EXPECT_LT(std::abs(sum), 2e-3 * most);
}

TEST(KeepApart, TheTickNeitherAllocatesNorLocks) {
    // Truth: rt_guard.
    if (!support::RtGuard::available()) GTEST_SKIP();
    test::Bench bench(twoHands(kSurface, Box{0.03, 0.02, 0.02}, at(0.04, 0, 0.02)));
    std::array<tick::TickOutput, 2> out;
    for (int i = 0; i < 300; ++i) {
        const std::array readings{DeviceReading{at(2e-5 * i, 0, 0)}, DeviceReading{at(0.04, 0, 0.02)}};
        const support::RtGuard guard;
        tick::step(bench.whole(), bench.wholeState(), readings, out);
        ASSERT_EQ(guard.violations(), 0) << guard.describe();
    }
}

}  // namespace
}  // namespace passung
