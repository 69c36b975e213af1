#include "core/closed_form/pose_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/core/closed_form/shape_pairs.h"
#include "tests/support/rt_guard.h"

namespace passung::closed_form {
namespace {

constexpr double kRho = 22.4e-3;       // [m]
constexpr double kStiffness = 2000.0;  // [N/m]

/// Points of a shape's surface, most of them on edges: of its triangles, whose corners lie on the true surface.
std::vector<Vec3> surfacePoints(const shape::Shape& shape, Random& random) {
    const auto mesh = shape::tessellate(shape, 1e-7);
    constexpr double kMost = 20'000.0;
    std::vector<Vec3> points;
    for (const Vec3& vertex : mesh.vertices)
        if (random.uniform() * static_cast<double>(mesh.vertices.size()) < kMost) points.push_back(vertex);
    for (int i = 0; i < 10'000; ++i) {
        const auto& triangle = mesh.triangles[static_cast<std::size_t>(random.uniform(0.0, 0.999999) *
                                                                       static_cast<double>(mesh.triangles.size()))];
        const double s = random.uniform(0.0, 1.0), t = random.uniform(0.0, 1.0 - s);
        const Vec3 a = mesh.vertices[triangle[0]], b = mesh.vertices[triangle[1]], c = mesh.vertices[triangle[2]];
        points.push_back(a + s * (b - a) + t * (c - a));
        points.push_back(a + s * (b - a));
    }
    return points;
}

/// How deep points of one part's surface lie in the other [m].
double overlapOf(const std::vector<Vec3>& points, const Pose& X, const shape::Shape& other) {
    double most = 0.0;
    for (const Vec3& p : points) most = std::max(most, -shape::signedDistance(other, X * p));
    return most;
}

/// A hand that moves about smoothly, from rest.
struct HandPath {
    Vec3 start, amplitude;
    double tilt;
    std::array<double, 6> phase, rate;

    HandPath(const ShapePair& pair, Random& random) : start(pair.start), amplitude(pair.amplitude), tilt(pair.tilt) {
        for (std::size_t i = 0; i < 6; ++i) {
            phase[i] = random.uniform(0.0, 2.0 * std::numbers::pi);
            rate[i] = random.uniform(0.2, 0.7);  // [Hz]
        }
    }

    Pose at(double t) const {
        const double ramp = std::min(1.0, t / 0.3);
        Vec3 p = start, w;
        for (int i = 0; i < 3; ++i) {
            const auto k = static_cast<std::size_t>(i);
            p[i] += 0.7 * ramp * amplitude[i] * std::sin(2.0 * std::numbers::pi * rate[k] * t + phase[k]);
            w[i] = ramp * tilt * std::sin(2.0 * std::numbers::pi * rate[k + 3] * t + phase[k + 3]);
        }
        return {rotationFromVector(w), p};
    }
};

/// A pose near `start` where the parts do not overlap: away from the obstacle, or at the start where that is a bore.
Pose freeStart(const SolidPair& pair, const Vec3& start) {
    for (double up = 0.0; up < 0.1; up += 0.001) {
        Pose X{Quat::Identity(), start + Vec3(0.0, 0.0, up)};
        ContactSearch search(pair);
        PairContacts found;
        search.find(X, 1e-3, found);
        if (overlapOf(found) == 0.0 && valueOf(*pair.obstacle, X.p) > 0.0) return X;
    }
    return {Quat::Identity(), start + Vec3(0.0, 0.0, 0.1)};
}

class PoseOfShapes : public testing::TestWithParam<ShapePair> {};

TEST_P(PoseOfShapes, NeverOverlapsByMoreThanATenthOfAMicrometre) {
    // Truth: closed form (shape::signedDistance at dense points of both surfaces, which the solver does not know).
    const auto held = solidOf(GetParam().held), obstacle = solidOf(GetParam().obstacle);
    const SolidPair pair{&*held, &*obstacle, {}, motion::Metric{kRho}};
    Random random(4);
    const auto of_held = surfacePoints(GetParam().held, random),
               of_obstacle = surfacePoints(GetParam().obstacle, random);
    for (int path = 0; path < 3; ++path) {
        const HandPath hand(GetParam(), random);
        PoseSolver solver({&pair, 1});
        PoseMemory memory;
        Pose X = freeStart(pair, GetParam().start);
        for (int tick = 0; tick < 2000; ++tick) {
            const ConstrainedPose found = solver.solve(X, hand.at(1e-3 * tick), memory);
            X = found.X_WG;
            ASSERT_LE(found.overlap, 1e-7) << tick;
            ASSERT_FALSE(found.full) << tick;
            if (tick % 50 != 0) continue;
            ASSERT_LE(overlapOf(of_held, X, GetParam().obstacle), 1e-7) << tick;
            ASSERT_LE(overlapOf(of_obstacle, X.inverse(), GetParam().held), 1e-7) << tick;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, PoseOfShapes, testing::ValuesIn(shapePairs()), nameOfPair);

shape::Peg thePeg() { return {.02, .05, .0005}; }
shape::BorePlate theBore(double play) { return {.06, .06, .03, .02 + 2.0 * play, .025, .0005}; }

struct PegInBore {
    SmoothSolid peg = *solidOf(thePeg()), bore;
    SolidPair pair;
    PoseSolver solver;
    PoseMemory memory;

    explicit PegInBore(double play)
        : bore(*solidOf(theBore(play))), pair{&peg, &bore, {}, motion::Metric{kRho}}, solver({&pair, 1}) {}
    Vec3 force(const ConstrainedPose& found) const { return -kStiffness * found.pull.head<3>(); }
};

TEST(BarInBore, PulledAsideAtItsMiddleRestsAlignedAtItsPlay) {
    // Truth: closed form: the axes are the play apart, and nothing tilts or lifts the bar.
    for (const double play : {100e-6, 50e-6, 10e-6}) {
        const auto bar = solidOf(shape::Cylinder{.02, .02}), bore = solidOf(theBore(play));
        const SolidPair pair{&*bar, &*bore, {}, motion::Metric{kRho}};
        PoseSolver solver({&pair, 1});
        PoseMemory memory;
        ConstrainedPose found{.X_WG = {Quat::Identity(), {0, 0, -0.012}}};
        for (int i = 0; i < 30; ++i) found = solver.solve(found.X_WG, {Quat::Identity(), {0.003, 0.0, -0.012}}, memory);
        EXPECT_TRUE(found.converged);
        EXPECT_NEAR((found.X_WG.p - Vec3(play, 0.0, -0.012)).norm(), 0.0, 1e-7);
        EXPECT_NEAR(found.X_WG.q.vec().norm(), 0.0, 1e-6);
        EXPECT_NEAR(kStiffness * found.pull[2], 0.0, 1e-6);
    }
}

TEST(PegInBore, NothingHoldsItAgainstATwistAboutItsAxis) {
    // Truth: invariant: all normals of a body of revolution meet its axis.
    PegInBore scene(50e-6);
    Random random(5);
    ConstrainedPose found{.X_WG = {Quat::Identity(), {0, 0, -0.01}}};
    for (int i = 0; i < 500; ++i) {
        const Pose hand{rotationFromVector(Vec3(0.03 * std::sin(0.01 * i), 0.02, 0.002 * i)), {0.002, 0.001, -0.012}};
        found = scene.solver.solve(found.X_WG, hand, scene.memory);
        const Vec3 axis = found.X_WG.q * Vec3::UnitZ();
        EXPECT_NEAR(found.pull.tail<3>().dot(axis), 0.0, 2e-7) << i;
    }
}

TEST(PegInBore, ATiltedPegSlidesWithoutACatch) {
    // Truth: closed form: the wall's normals are level and the peg's lie across its axis, so that none rises by more
    // than the peg tilts; the force changes no faster than the hand moves.
    for (const double play : {100e-6, 50e-6, 10e-6}) {
        PegInBore scene(play);
        ConstrainedPose found{.X_WG = {Quat::Identity(), {0, 0, -0.010}}};
        Vec3 before = Vec3::Zero();
        double looks = 0.0;
        for (int tick = 0; tick < 3000; ++tick) {
            const double t = 1e-3 * tick, ramp = std::min(1.0, t);
            const Pose hand{rotationFromVector(Vec3(0.035, 0.035, 0.0) * ramp),
                            {0.003 * ramp * std::cos(2.0 * t), 0.003 * ramp * std::sin(2.0 * t),
                             -0.010 - 0.005 * std::sin(3.0 * t) * ramp}};
            found = scene.solver.solve(found.X_WG, hand, scene.memory);
            ASSERT_TRUE(found.converged) << tick;
            ASSERT_LE(found.iterations, 8) << tick;
            looks += found.iterations;
            const Vec3 force = scene.force(found);
            ASSERT_LT((force - before).norm(), 0.1) << tick;
            before = force;
            const double tilt = (found.X_WG.q * Vec3::UnitZ()).head<2>().norm();
            for (const HeldContact& held : scene.memory.all())
                ASSERT_LE(std::abs(held.contact.normal.z()), tilt + 1e-6) << tick;
        }
        EXPECT_LT(looks / 3000.0, 3.0);
    }
}

TEST(PegInBore, OneThatWandersAboutItsMouthConvergesAsNewtonsMethodDoes) {
    // Truth: theory: near a minimum each look squares the error, so that few are needed wherever the hand does not slip
    // past an edge, however little the energy bends there. (With all of B raised to be positive 148 ticks took more.)
    PegInBore scene(10e-6);
    ConstrainedPose found{.X_WG = {Quat::Identity(), {0, 0, 0.002}}};
    const auto wave = [](double rate, double t, double phase) {
        return std::sin(2.0 * std::numbers::pi * rate * t + phase);
    };
    int slow = 0, unfinished = 0;
    for (int tick = 0; tick < 6000; ++tick) {
        const double t = 1e-3 * tick;
        const Pose hand{rotationFromVector(Vec3(0.05 * wave(0.29, t, 0.0), 0.04 * wave(0.43, t, 2.0), 0.0)),
                        {0.003 * wave(0.37, t, 0.0), 0.0025 * wave(0.23, t, 1.0),
                         0.002 - 0.01 * (1.0 - wave(0.4, t, 0.5 * std::numbers::pi))}};
        found = scene.solver.solve(found.X_WG, hand, scene.memory);
        ASSERT_LE(found.overlap, kKeptOverlap) << tick;
        slow += found.iterations > 5 ? 1 : 0;
        unfinished += found.converged ? 0 : 1;
    }
    std::printf("more than 5 looks: %d, not at the end of its way: %d of 6000 ticks\n", slow, unfinished);
    EXPECT_LE(slow, 40);
    EXPECT_LE(unfinished, 20);
}

TEST(PoseSolver, ABallPressedOnABoxRestsOnItsFace) {
    // Truth: closed form.
    const auto ball = solidOf(shape::Sphere{.02}), box = solidOf(shape::Box{.03, .02, .01});
    const SolidPair pair{&*ball, &*box, {}, motion::Metric{kRho}};
    PoseSolver solver({&pair, 1});
    PoseMemory memory;
    ConstrainedPose found{.X_WG = {Quat::Identity(), {0.001, 0.002, 0.02}}};
    for (int i = 0; i < 10; ++i) found = solver.solve(found.X_WG, {Quat::Identity(), {0.001, 0.002, 0.012}}, memory);
    EXPECT_TRUE(found.converged);
    EXPECT_NEAR((found.X_WG.p - Vec3(0.001, 0.002, 0.015)).norm(), 0.0, 1e-7);
    EXPECT_NEAR(found.pull[2], -0.003, 1e-7);
    ASSERT_EQ(memory.all().size(), 1u);
    EXPECT_NEAR(memory.all()[0].push, 0.003, 1e-7);
}

TEST(PoseSolver, CrossedEdgesPushAlongTheirCommonNormalOnly) {
    // Truth: closed form: two boxes edge on edge; nothing holds along either edge.
    const auto held = solidOf(shape::Box{.02, .02, .02}), obstacle = solidOf(shape::Box{.02, .02, .02});
    const Quat on_edge(Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitX()));  // edge along x
    const Quat quarter(Eigen::AngleAxisd(0.4 * std::numbers::pi, Vec3::UnitZ()));
    const double half = .01 * std::sqrt(2.0);
    const SolidPair pair{&*held, &*obstacle, {on_edge, {0, 0, -half}}, motion::Metric{kRho}};
    PoseSolver solver({&pair, 1});
    PoseMemory memory;
    const Quat turned = quarter * on_edge;  // its lower edge crosses the obstacle's upper one
    ConstrainedPose found{.X_WG = {turned, {0.0003, 0.0002, half + 1e-4}}};
    for (int i = 0; i < 40; ++i) {
        const Vec3 p(0.0003 + 2e-5 * i, 0.0002 + 1e-5 * i, half - 5e-4);
        found = solver.solve(found.X_WG, {turned, p}, memory);
        EXPECT_NEAR(found.pull[0], 0.0, 5e-7) << i;
        EXPECT_NEAR(found.pull[1], 0.0, 5e-7) << i;
        EXPECT_LT(found.pull[2], -1e-4) << i;
    }
}

TEST(PoseSolver, AllocatesNothing) {
    // Truth: invariant.
    if (!support::RtGuard::available()) GTEST_SKIP() << "a sanitizer owns the allocator";
    PegInBore scene(50e-6);
    ConstrainedPose found{.X_WG = {Quat::Identity(), {0, 0, -0.005}}};
    const support::RtGuard guard;
    for (int tick = 0; tick < 200; ++tick)
        found = scene.solver.solve(found.X_WG, {rotationFromVector(Vec3(0.03, 0.02, 0.0)), {0.002, 0.001, -0.006}},
                                   scene.memory);
    EXPECT_EQ(guard.violations(), 0) << guard.describe();
}

}  // namespace
}  // namespace passung::closed_form
