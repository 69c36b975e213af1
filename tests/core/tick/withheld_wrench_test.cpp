#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/tick/hand_state.h"
#include "core/tick/step.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

Pose at(double x, double z) { return {Quat::Identity(), Vec3(x, 0, z)}; }

/// A ball that is pressed into a table and drawn along it.
scene::SceneSpec rubbing(scene::ContactMethod method) {
    auto spec = test::scene(shape::Sphere{0.02}, at(0, 0.02), shape::Box{0.08, 0.08, 0.04}, at(0, -0.02), method);
    spec.contact.stiffness = 1000;
    spec.limits.max_force = 3;  // acts
    if (method != scene::ContactMethod::Penalty)
        for (auto& part : spec.parts) part.friction = part.sliding_friction = 0.3;
    return spec;
}

Pose handAt(int tick) { return at(2e-5 * std::max(0, tick - 300), 0.012 - 2e-5 * std::min(tick, 300)); }

TEST(WithheldWrench, EverythingButTheWrenchIsAsWithIt) {
    // Truth: invariant: no stage but the last reads what was commanded, so that the same hand gives the same bits.
    using enum scene::ContactMethod;
    for (const auto method : {Penalty, GodObjectHeuristic, GodObject}) {
        auto spec = rubbing(method);
        test::Bench with(spec);
        spec.display_wrench = false;
        test::Bench without(spec);
        double most = 0.0;
        for (int tick = 0; tick < 600; ++tick) {
            const DeviceReading reading{handAt(tick)};
            const tick::TickOutput given = without.step(reading);
            const TickRecord displayed = tick::makeRecord(tick, reading, with.step(reading));
            const TickRecord withheld = tick::makeRecord(tick, reading, given);
            EXPECT_EQ(given.F_D_B.force, Vec3(Vec3::Zero()));
            EXPECT_EQ(given.F_D_B.torque, Vec3(Vec3::Zero()));
            most = std::max(most, std::abs(double{displayed.force_N[2]}));
            EXPECT_EQ(withheld.force_N, (std::array<float, 3>{}));
            EXPECT_EQ(withheld.torque_Nm, (std::array<float, 3>{}));
            EXPECT_EQ(withheld.energy_J, 0.0f);
            EXPECT_EQ(withheld.status & ~std::uint32_t{kWrenchWithheld},
                      displayed.status & ~std::uint32_t{kForceLimited | kRateLimited});
            EXPECT_NE(withheld.status & kWrenchWithheld, 0u);
            EXPECT_EQ(withheld.hand_position_m, displayed.hand_position_m);
            EXPECT_EQ(withheld.proxy_position_m, displayed.proxy_position_m) << tick;
            EXPECT_EQ(withheld.proxy_quaternion, displayed.proxy_quaternion) << tick;
            EXPECT_EQ(withheld.hand_depth_m, displayed.hand_depth_m);
            EXPECT_EQ(withheld.proxy_depth_m, displayed.proxy_depth_m);
            EXPECT_EQ(withheld.contacts, displayed.contacts);
            EXPECT_EQ(withheld.iterations, displayed.iterations);
            EXPECT_EQ(withheld.nodes_visited, displayed.nodes_visited);
            EXPECT_EQ(withheld.quality, displayed.quality);
        }
        for (const auto& pair : without.state().pairs) EXPECT_EQ(pair.taken_in, 0.0) << "nothing was sent";
        EXPECT_GT(most, 2.9) << "the comparison has a force to leave out";
    }
}

TEST(WithheldWrench, OneThatIsNotFiniteIsToldAllTheSame) {
    // Truth: invariant: the attempt ends by kNonFiniteLatched, as with a displayed wrench.
    auto spec = rubbing(scene::ContactMethod::Penalty);
    spec.display_wrench = false;
    spec.contact.stiffness = std::numeric_limits<double>::max();
    test::Bench bench(spec);
    tick::TickOutput out;
    for (int tick = 0; tick < 400; ++tick) out = bench.step(handAt(tick));
    EXPECT_NE(out.frame.status & kNonFiniteLatched, 0u);
    EXPECT_EQ(out.F_D_B.force, Vec3(Vec3::Zero()));
}

}  // namespace
}  // namespace passung
