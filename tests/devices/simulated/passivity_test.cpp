#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/base/tick_record.h"
#include "core/loop/stability.h"
#include "devices/simulated/device_dynamics.h"
#include "devices/simulated/simulated_device.h"
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
    scene::SceneSpec spec =
        test::scene(shape::Sphere{0.02}, Pose{Quat::Identity(), {0, 0, 0.011}}, shape::Box{0.05, 0.05, 0.02},
                    Pose{Quat::Identity(), {0, 0, -0.01}}, scene::ContactMethod::GodObjectHeuristic);
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

/// The least of both energy accounts while a simulated participant presses and searches on a plate for a bore that is
/// not where it sees it, at the stiffness that the preset is rated for.
struct Accounts {
    double hand = 0.0, controller = 0.0;  // least so far [J]
    double motors = 0.0;                  // least of minus their work on the handle's true motion [J]
    double last_hand = 0.0;
    double contact = 0.0;  // share of ticks in contact
};

Accounts searchOnAPlate(const simulated::DeviceParams& preset, scene::ContactMethod method, double passivity_damping,
                        int ticks) {
    const DeviceDescription rated = simulated::describe(preset);
    simulated::VisibleTask task;
    task.X_WHeldStart = {Quat::Identity(), Vec3(-0.002, 0.001, 0.008)};
    scene::SceneSpec spec = test::scene(shape::Peg{0.01, 0.03, 0.0005}, task.X_WHeldStart, shape::Box{0.08, 0.08, 0.02},
                                        {Quat::Identity(), Vec3(0, 0, -0.01)}, method);
    spec.registration.X_DH.p = Vec3(0, 0, -0.02);
    spec.contact.spacing = 2e-3;
    spec.record_hand_depth = false;
    spec.contact.stiffness = rated.stable_stiffness_N_per_m;
    spec.contact.rotational_stiffness = rated.stable_rotational_stiffness_Nm_per_rad;
    spec.contact.damping = rated.recommended_damping_Ns_per_m;
    spec.contact.rotational_damping = rated.recommended_rotational_damping_Nms_per_rad;
    spec.limits.max_force = rated.max_force_N;
    spec.limits.max_torque = rated.max_torque_Nm;
    spec.limits.max_force_rate = rated.max_force_rate_N_per_s;
    spec.limits.actuates_torque = rated.actuated_degrees == 6;
    spec.limits.quantum = preset.quantum.value;
    spec.limits.rotational_quantum = preset.rotational_quantum.value;
    spec.effects.passivity_damping = passivity_damping;
    test::Bench bench(spec);
    simulated::SimulatedDevice device(preset, {}, task, {spec.registration.X_WB, 1.0, spec.registration.X_DH}, 7);
    Accounts found;
    int contact = 0;
    double motors = 0.0;
    for (int i = 0; i < ticks; ++i) {
        const Pose before = device.dynamics().truePose();
        const DeviceReading reading = device.read();
        const Wrench& acted = device.dynamics().actingWrench();
        const Pose& X = device.dynamics().truePose();
        motors += acted.force.dot(X.p - before.p) + acted.torque.dot(rotationVector(X.q * before.q.conjugate()));
        found.motors = std::min(found.motors, -motors);
        const auto output = bench.step(reading);
        device.command(output.F_D_B);
        if (i % 16 == 0) device.show({.tick = i, .X_WShown = output.X_WG, .running = i > 500});
        found.hand = std::min(found.hand, reading.hand_energy_J);
        found.controller = std::min(found.controller, output.frame.energy);
        found.last_hand = reading.hand_energy_J;
        contact += output.frame.contacts > 0 || output.F_D_B.force.norm() > 1e-6 ? 1 : 0;
    }
    found.contact = static_cast<double>(contact) / ticks;
    return found;
}

TEST(HandsPort, GivesOutNoEnergyInAMinuteOfContactAtTheRatedStiffness) {
    // Truth: invariant. Net energy at the hand's port at least -1 mJ with the passivity controller off, and at the
    // controller's port at least -1 mJ with it on: that of the motors on the handle's true motion, and by the
    // controller's own account, which knows the motion in encoder steps only.
    using Method = scene::ContactMethod;
    for (const simulated::DeviceParams& preset : simulated::presets()) {
        const bool longest = preset.name == "sigma7" || preset.name == "falcon";
        for (const auto method : {Method::Penalty, Method::GodObject}) {
            const int ticks = longest && method == Method::GodObject ? 60000 : 10000;
            const auto off = searchOnAPlate(preset, method, 0.0, ticks);
            const auto on = searchOnAPlate(preset, method, 5.0, ticks);
            std::printf(
                "%-11s %-10s %2d s, %2.0f %% in contact: hand's port least %8.1e J, in all %8.1e J; controller on: "
                "motors least %8.1e J, own account %8.1e J\n",
                std::string(preset.name).c_str(), method == Method::Penalty ? "penalty" : "god_object", ticks / 1000,
                100 * off.contact, off.hand, off.last_hand, on.motors, on.controller);
            EXPECT_GE(off.hand, -1e-3) << preset.name;
            EXPECT_GE(on.motors, -1e-3) << preset.name;
            EXPECT_GE(on.controller, -1e-3) << preset.name;
            EXPECT_GT(off.contact, 0.4) << preset.name;
            EXPECT_GT(off.last_hand, 1e-3) << preset.name;
        }
    }
}

}  // namespace
}  // namespace passung
