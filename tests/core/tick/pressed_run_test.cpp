// Truth: closed form. A ball of 20 mm over a table: its centre ends 8 mm above the table, and stays there while it
// slides.
#include "core/tick/pressed_run.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/scenes.h"

namespace passung {
namespace {

constexpr double kRadius = 10e-3, kPressed = 2e-3;  // [m]

class Pressed : public testing::TestWithParam<scene::Geometry> {};

/// Three millimetres over the table, held by a turned handle, behind a start gate that never opens.
scene::SceneSpec ballOverTable(scene::Geometry geometry) {
    auto spec = test::scene(shape::Sphere{2.0 * kRadius}, {Quat::Identity(), Vec3(0.004, 0.002, kRadius + 3e-3)},
                            shape::Box{0.06, 0.06, 0.02}, {Quat::Identity(), Vec3(0, 0, -0.01)},
                            scene::ContactMethod::GodObject);
    spec.contact.geometry = geometry;
    spec.registration.X_WB = {Quat(Eigen::AngleAxisd(0.5, Vec3::UnitX())), Vec3(0.1, 0.0, 0.0)};
    spec.start_gate = {1e-6, 1e-6, 1'000'000};
    return spec;
}

TEST_P(Pressed, IntoTheNearestObstacleAndAlongIt) {
    const test::Bench bench(ballOverTable(GetParam()));
    tick::PressedRun run(bench.scene());
    EXPECT_TRUE(run.readingAt(0).X_BD.p.isApprox(bench.model().X_WG_start.p));
    const double tolerance = 0.1e-3;  // cells of half a millimetre, triangles of a ball
    double farthest = 0.0;
    for (int i = 0; i < 2 * tick::PressedRun::kApproachTicks; ++i) {
        const DeviceReading reading = run.readingAt(i);
        const tick::TickOutput output = run.step(reading);
        EXPECT_TRUE(output.frame.X_WH.p.isApprox(reading.X_BD.p)) << "the registration has something to do";
        EXPECT_NE(output.frame.status & kEngaged, 0u) << i;
        if (i < tick::PressedRun::kApproachTicks) continue;
        EXPECT_NEAR(reading.X_BD.p.z(), kRadius - kPressed, tolerance) << i;
        EXPECT_GT(output.frame.contacts, 0u) << i;
        EXPECT_GT(output.F_D_B.force.z(), 0.0) << i;
        farthest = std::max(farthest, (reading.X_BD.p - bench.model().X_WG_start.p).head<2>().norm());
    }
    EXPECT_NEAR(farthest, 3e-3, 0.2e-3);
}

INSTANTIATE_TEST_SUITE_P(Geometries, Pressed,
                         testing::Values(scene::Geometry::Field, scene::Geometry::ClosedForm, scene::Geometry::Surface),
                         [](const auto& tested) {
                             switch (tested.param) {
                                 case scene::Geometry::Field:
                                     return "Field";
                                 case scene::Geometry::ClosedForm:
                                     return "ClosedForm";
                                 default:
                                     return "Surface";
                             }
                         });

}  // namespace
}  // namespace passung
