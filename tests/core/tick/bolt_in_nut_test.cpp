#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "core/base/processor_clock.h"
#include "core/scene/contact_geometry.h"
#include "tests/core/closed_form/thread_reference.h"
#include "tests/support/rt_guard.h"
#include "tests/support/scenes.h"

// A parametric bolt in its nut under god objects, as a scene makes them. Forces are the spring's alone.

namespace passung::tick {
namespace {

using scene::ContactMethod;

constexpr double kPlay = 30e-6;  // [m]
const shape::ThreadBolt kBolt{.008 - 2.0 * kPlay, .00125, .02, .0009};
const shape::ThreadNut kNut{.008, .00125, .013, .0065, .0008};
constexpr double kStart = -.003;  // [m]: two turns deep

scene::SceneSpec boltInNut(ContactMethod method) {
    const double turned = 2.0 * std::numbers::pi * kStart / kBolt.pitch;
    auto spec = test::scene(kBolt, {rotationFromVector(Vec3(0, 0, turned)), {0, 0, kStart}}, kNut, Pose{}, method);
    spec.contact.geometry = scene::Geometry::Auto;
    spec.contact.stiffness = 2000.0;
    spec.contact.rotational_stiffness = 1.0;
    return spec;
}

/// Three turns inwards in six seconds, pressed, tilted and pulled aside on the way, within 0.1 m/s.
Pose handAt(double t) {
    const double ramp = std::min(1.0, t / 0.5), turned = -std::numbers::pi * std::max(0.0, t - 0.5);
    const Vec3 tilt(0.04 * ramp * std::sin(2.1 * t), 0.04 * ramp * std::sin(2.7 * t), 0.0);
    const Vec3 away(0.002 * ramp * std::sin(1.7 * t), 0.002 * ramp * std::sin(2.3 * t), -0.001 * ramp);
    const double start = 2.0 * std::numbers::pi * kStart / kBolt.pitch;
    return {rotationFromVector(tilt) * rotationFromVector(Vec3(0, 0, start + turned)),
            Vec3(0, 0, kStart + turned * kBolt.pitch / (2.0 * std::numbers::pi)) + away};
}

/// What came of the hand's way.
struct Followed {
    double deepest = 0.0;  // overlap [m]
    double beyond = 0.0;   // largest step of the force beyond the hand's [N]
    double off = 0.0;      // the thread [m]
    double turned = 0.0;   // [rad]
    double work = 0.0;     // that the contact did on the hand in all [J]
    int late = 0, violations = 0;
};

constexpr int kTicks = 6500;

Followed follow(const scene::SceneSpec& spec) {
    test::Bench bench(spec);
    const closed_form::ThreadReference truth(kBolt, kNut, 8000, 1);
    std::vector<double> spent;
    spent.reserve(kTicks);
    Followed result;
    Wrench before;
    Pose X_last = handAt(0.0), X_before = handAt(-1e-3);
    for (int i = 0; i < kTicks; ++i) {
        const Pose X_WH = handAt(1e-3 * i);
        const support::RtGuard guard;
        const std::int64_t begin = threadProcessorNanoseconds();
        const TickOutput out = bench.step(X_WH);
        spent.push_back(1e-3 * static_cast<double>(threadProcessorNanoseconds() - begin));
        result.violations += static_cast<int>(guard.violations());
        result.late += (out.frame.status & kIterationLimit) != 0 ? 1 : 0;
        const Vec3 force = out.F_D_B.force, way = X_WH.p - X_before.p;
        if (i > 0) {
            result.beyond = std::max(result.beyond, (force - before.force).norm() - 2000.0 * way.norm());
            result.work +=
                0.5 * (force + before.force).dot(way) +
                0.5 * (out.F_D_B.torque + before.torque).dot(rotationVector(X_WH.q * X_before.q.conjugate()));
        }
        before = out.F_D_B;
        X_before = X_WH;
        result.turned += rotationVector(out.X_WG.q * X_last.q.conjugate()).z();
        X_last = out.X_WG;
        const double tilt = (out.X_WG.q * Vec3::UnitZ()).head<2>().norm();
        const double aside = std::abs(out.X_WG.p.z() - kStart - result.turned * kBolt.pitch / (2.0 * std::numbers::pi));
        result.off = std::max(result.off, aside - 0.5 * kBolt.nominal_diameter * tilt);
        if (i % 20 == 0) result.deepest = std::max(result.deepest, truth.overlap(out.X_WG));
    }
    std::sort(spent.begin(), spent.end());
    std::printf(
        "overlap %.4f um, step beyond the hand's %.4f N, off the thread %.1f um, late %d of %d, work %.4f J; median "
        "%.0f p99.9 %.0f most %.0f us\n",
        1e6 * result.deepest, result.beyond, 1e6 * result.off, result.late, kTicks, result.work, spent[kTicks / 2],
        spent[kTicks * 999 / 1000], spent.back());
    return result;
}

/// Whatever rubs.
void expectSmoothWithoutOverlap(const Followed& followed) {
    EXPECT_LE(followed.deepest, 1e-7);
    EXPECT_LE(followed.beyond, 0.05);
    // Beside the play of the flanks a tilt lifts the axis by no more than it lifts the crests.
    EXPECT_LE(followed.off, kPlay);
    if (support::RtGuard::available()) {
        EXPECT_EQ(followed.violations, 0);
    }
}

class BoltUnderGodObject : public testing::TestWithParam<ContactMethod> {};

TEST_P(BoltUnderGodObject, TurnsInSmoothlyWithoutOverlap) {
    // Truth: dense points of both surfaces against the profile (thread_reference.h); closed form: it advances with its
    // turn, but for its play; a spring's force changes no faster than the hand moves, but for some hundredths.
    const auto spec = boltInNut(GetParam());
    ASSERT_EQ(scene::geometryOf(spec).geometry, scene::Geometry::ClosedForm);
    const Followed followed = follow(spec);
    expectSmoothWithoutOverlap(followed);
    EXPECT_LT(followed.turned, -2.9 * 2.0 * std::numbers::pi);
    EXPECT_EQ(followed.late, 0);
}

TEST_P(BoltUnderGodObject, TurnsInAgainstFriction) {
    // Truth: as above; energy: what rubs takes work from the hand, and gives none.
    auto spec = boltInNut(GetParam());
    for (scene::PartSpec& part : spec.parts) {
        part.friction = 0.2;
        part.sliding_friction = 0.15;
    }
    ASSERT_EQ(scene::geometryOf(spec).geometry, scene::Geometry::ClosedForm);
    const Followed followed = follow(spec);
    expectSmoothWithoutOverlap(followed);
    EXPECT_LT(followed.turned, -2.5 * 2.0 * std::numbers::pi);
    EXPECT_LT(followed.work, -0.01);
    EXPECT_LE(followed.late, kTicks / 5);  // rows of friction are counted, and end a tick
}

INSTANTIATE_TEST_SUITE_P(GodObjects, BoltUnderGodObject,
                         testing::Values(ContactMethod::GodObject, ContactMethod::GodObjectHeuristic),
                         [](const auto& made) {
                             return made.param == ContactMethod::GodObject ? "god_object" : "god_object_heuristic";
                         });

}  // namespace
}  // namespace passung::tick
