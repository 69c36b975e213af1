#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/tick_record.h"
#include "core/loop/stability.h"
#include "devices/simulated/device_dynamics.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

struct Bounce {
    double least_energy = 0.0;  // of the controller's account [J]
    double fastest = 0.0;       // of the handle in the last second [m/s]
    double motor_work = 0.0;    // that the motors did on the handle [J]
    double last_energy = 0.0;
};

/// A bare handle, held down by a constant force, against a wall `share` times as stiff as its border allows.
Bounce bounce(double share, double passivity_damping) {
    simulated::DeviceParams preset = *simulated::findPreset("sigma7");
    preset.coulomb_force.value = preset.coulomb_torque.value = 0.0;
    model::SceneSpec spec =
        test::scene(model::Sphere{0.02}, Pose{Quat::Identity(), {0, 0, 0.011}}, model::Box{0.05, 0.05, 0.02},
                    Pose{Quat::Identity(), {0, 0, -0.01}}, model::ContactMethod::GodObjectHeuristic);
    const loop::SampledWall wall{.mass = preset.mass.value,
                                 .damping = preset.damping.value,
                                 .virtual_damping = preset.recommended_damping.value,
                                 .delay_ticks = preset.delay_ticks};
    spec.contact.stiffness = share * stableStiffnessBorder(wall);
    spec.contact.damping = preset.recommended_damping.value;
    spec.contact.rotational_stiffness = 0.0;
    spec.limits.max_force = preset.max_force.value;
    spec.limits.max_torque = preset.max_torque.value;
    spec.limits.max_force_rate = preset.max_force_rate.value;
    spec.effects.passivity_damping = passivity_damping;
    test::Bench bench(spec);
    simulated::DeviceDynamics dynamics(preset, spec.parts[0].X_WP);
    simulated::HandCoupling hand;
    hand.attached = true;
    hand.F_D_B.force = Vec3(0, 0, -3.0);
    Bounce result;
    for (int i = 0; i < 5000; ++i) {
        const auto output = bench.step(dynamics.readPose());
        result.least_energy = std::min(result.least_energy, output.frame.energy);
        result.last_energy = output.frame.energy;
        dynamics.command(output.F_D_B);
        const Vec3 before = dynamics.truePose().p;
        dynamics.advance(hand);
        result.motor_work += dynamics.actingWrench().force.dot(dynamics.truePose().p - before);
        if (i >= 4000) result.fastest = std::max(result.fastest, dynamics.trueTwist().v.norm());
    }
    return result;
}

TEST(EnergyAccount, IsMinusTheWorkThatTheMotorsDid) {
    // Truth: independent program (the simulated mechanism books its motors' work in substeps, on its true pose; the
    // account knows the encoders): equal but for encoder steps and for the last tick's motion. A device without delay.
    ASSERT_EQ(simulated::findPreset("sigma7")->delay_ticks, 0);
    const Bounce found = bounce(0.5, 0.0);
    EXPECT_GT(std::abs(found.motor_work), 1e-4);
    EXPECT_NEAR(found.last_energy, -found.motor_work, 1e-2 * std::abs(found.motor_work) + 1e-6);
}

TEST(PassivityController, StopsAWallThatIsStifferThanTheDeviceBears) {
    // Truth: invariant. 1.5 times the border: without the controller energy comes out without end and the handle
    // bounces; with it the account stays above -1 mJ and the handle comes to rest.
    const Bounce free = bounce(1.5, 0.0), controlled = bounce(1.5, 100.0);
    std::printf("least energy %.3g J, fastest %.3g m/s; with the controller %.3g J, %.3g m/s\n", free.least_energy,
                free.fastest, controlled.least_energy, controlled.fastest);
    EXPECT_LT(free.least_energy, -0.05);
    EXPECT_GT(free.fastest, 0.05);
    EXPECT_GT(controlled.least_energy, -1e-3);
    EXPECT_LT(controlled.fastest, 0.1 * free.fastest);
}

}  // namespace
}  // namespace passung
