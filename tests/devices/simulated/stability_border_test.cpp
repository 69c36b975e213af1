#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "core/base/tick_record.h"
#include "core/loop/stability.h"
#include "devices/simulated/device_dynamics.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

using loop::SampledWall;
using simulated::DeviceDynamics;
using simulated::DeviceParams;

enum class Axis { Translation, Rotation };

SampledWall wallOf(const DeviceParams& p, Axis axis) {
    if (axis == Axis::Translation) return {p.mass.value, p.damping.value, 0, p.recommended_damping.value, kTickSeconds};
    return {p.inertia.value, p.rotational_damping.value, 0, p.recommended_rotational_damping.value, kTickSeconds};
}

/// The mechanism of `p` with nothing but mass, damping and delay.
DeviceParams linearPart(DeviceParams p, int delay_ticks) {
    p.workspace_radius.value = 1e3;  // no end stops
    for (auto* s : {&p.coulomb_force, &p.coulomb_torque, &p.quantum, &p.rotational_quantum}) s->value = 0.0;
    p.max_force.value = p.max_torque.value = 1e12;
    p.sensed_degrees = p.actuated_degrees = 6;
    p.delay_ticks = delay_ticks;
    return p;
}

/// A handle on a bilateral spring and damper, sampled and held as the haptic loop does.
class Swing {
public:
    Swing(const DeviceParams& params, Axis axis, double stiffness, double damping)
        : axis_(axis), stiffness_(stiffness), damping_(damping), dynamics_(params, Pose{}) {
        const Vec3 start(1e-3, 0, 0);
        dynamics_.place({rotationFromVector(axis == Axis::Rotation ? start : Vec3(Vec3::Zero())),
                         axis == Axis::Rotation ? Vec3(Vec3::Zero()) : start},
                        {});
        last_ = 1e-3;
    }

    double tick() {
        const Pose X = dynamics_.readPose();
        const double x = axis_ == Axis::Rotation ? rotationVector(X.q).x() : X.p.x();
        const double load = -stiffness_ * x - damping_ * (x - last_) / kTickSeconds;
        last_ = x;
        const Vec3 along(load, 0, 0);
        dynamics_.command(axis_ == Axis::Rotation ? Wrench{Vec3::Zero(), along} : Wrench{along, Vec3::Zero()});
        dynamics_.advance({});
        return x;
    }

private:
    Axis axis_;
    double stiffness_, damping_, last_;
    DeviceDynamics dynamics_;
};

/// Does the swing die out? Near the border it does so slowly: the largest swing of a late stretch against an early one.
bool diesOut(const DeviceParams& params, Axis axis, double stiffness, double damping) {
    Swing swing(params, axis, stiffness, damping);
    constexpr int kStretch = 4000;
    constexpr double kAway = 0.5;  // five hundred times the start: it does not come back
    const auto largest = [&] {
        double most = 0.0;
        for (int i = 0; i < kStretch && most < kAway; ++i) most = std::max(most, std::abs(swing.tick()));
        return most;
    };
    for (int i = 0; i < 200; ++i) swing.tick();
    const double early = largest();
    return early < kAway && largest() < early;
}

TEST(StabilityBorder, OfEveryPresetIsWhereItsSimulatedSwingStopsDyingOut) {
    // Truth: independent program. The mechanism in the time domain, bisection on what it does, against the roots of the
    // characteristic polynomial; recommended damping, delays of 0 to 3 ticks. Mark: 1 %.
    double worst = 0.0;
    int borders = 0;
    for (const DeviceParams& preset : simulated::presets()) {
        for (const Axis axis : {Axis::Translation, Axis::Rotation}) {
            for (int delay = 0; delay <= 3; ++delay) {
                SampledWall wall = wallOf(preset, axis);
                wall.delay_ticks = delay;
                const double exact = stableStiffnessBorder(wall);
                if (!(exact > 0.0)) continue;
                const DeviceParams linear = linearPart(preset, delay);
                double stable = 0.5 * exact, unstable = 2.0 * exact;
                ASSERT_TRUE(diesOut(linear, axis, stable, wall.virtual_damping)) << preset.name << delay;
                ASSERT_FALSE(diesOut(linear, axis, unstable, wall.virtual_damping)) << preset.name << delay;
                while (unstable - stable > 1e-4 * exact) {
                    const double middle = 0.5 * (stable + unstable);
                    (diesOut(linear, axis, middle, wall.virtual_damping) ? stable : unstable) = middle;
                }
                const double error = 0.5 * (stable + unstable) / exact - 1.0;
                worst = std::max(worst, std::abs(error));
                ++borders;
                EXPECT_LT(std::abs(error), 0.01)
                    << preset.name << (axis == Axis::Rotation ? " rotation " : " ") << delay;
            }
        }
    }
    std::printf("%d borders, worst deviation %.3f %%\n", borders, 100.0 * worst);
    EXPECT_EQ(borders, 48);
}

/// What a handle does that a constant force presses onto a plane through a ball, after it met it at 0.1 m/s.
struct Press {
    double early = 0.0, late = 0.0;  // swing of the handle in the second and in the last half second [m]
    bool touches = false;
};

/// Moves the handle under the contact's wrench and the hand's until it should rest. `coordinate` of its true pose
/// swings; `touched` says of a wrench whether the contact pushes back. Waits so many ticks between the two looks.
Press settle(test::Bench& bench, DeviceDynamics& dynamics, const simulated::HandCoupling& hand, int wait,
             const auto& coordinate, const auto& touched) {
    Press result;
    const auto swing = [&](int ticks) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (int i = 0; i < ticks; ++i) {
            const auto output = bench.step(dynamics.readPose());
            dynamics.command(output.F_D_B);
            dynamics.advance(hand);
            const double at = coordinate(dynamics.truePose());
            low = std::min(low, at);
            high = std::max(high, at);
            result.touches = touched(output.F_D_B);
        }
        return high - low;
    };
    swing(500);
    result.early = swing(500);
    swing(wait);
    result.late = swing(500);
    return result;
}

Press press(const DeviceParams& preset, scene::ContactMethod method, double stiffness) {
    scene::SceneSpec spec = test::scene(shape::Sphere{0.02}, Pose{Quat::Identity(), {0, 0, 0.0101}},
                                        shape::Box{0.05, 0.05, 0.02}, Pose{Quat::Identity(), {0, 0, -0.01}}, method);
    spec.contact.stiffness = stiffness;
    spec.contact.damping = preset.recommended_damping.value;
    spec.contact.rotational_stiffness = 0.0;
    spec.limits.max_force = preset.max_force.value;
    spec.limits.max_torque = preset.max_torque.value;
    spec.limits.max_force_rate = preset.max_force_rate.value;
    spec.limits.actuates_torque = preset.actuated_degrees == 6;
    test::Bench bench(spec);
    DeviceDynamics dynamics(preset, spec.parts[0].X_WP);
    dynamics.place(spec.parts[0].X_WP, {{0, 0, -0.1}, Vec3::Zero()});
    simulated::HandCoupling hand;
    hand.attached = true;
    hand.F_D_B.force = Vec3(0, 0, -0.3 * preset.max_force.value);
    return settle(
        bench, dynamics, hand, 1000, [](const Pose& X_BD) { return X_BD.p.z(); },
        [](const Wrench& F_D_B) { return F_D_B.force.z() > 0.0; });
}

TEST(StabilityBorder, AtNineteenTwentiethsOfItAPressedHandleComesToRest) {
    // Truth: closed form (the border) of the linear model; here the whole preset, with dry friction, encoder steps,
    // limits and a wall that only pushes: what swings must not grow. Encoder steps may keep it swinging by some of
    // them: the force steps by K q and B q / T, half a period long.
    for (DeviceParams preset : simulated::presets()) {
        for (int delay = 0; delay <= 3; ++delay) {
            preset.delay_ticks = delay;
            SampledWall wall = wallOf(preset, Axis::Translation);
            wall.delay_ticks = delay;
            const double stiffness = 0.95 * stableStiffnessBorder(wall);
            for (const auto method : {scene::ContactMethod::Penalty, scene::ContactMethod::GodObject}) {
                const Press found = press(preset, method, stiffness);
                std::printf("%-11s %d ms %-10s K %7.0f N/m: swing %8.2f um, later %8.2f um\n",
                            std::string(preset.name).c_str(), delay,
                            method == scene::ContactMethod::Penalty ? "penalty" : "god object", stiffness,
                            1e6 * found.early, 1e6 * found.late);
                EXPECT_TRUE(found.touches) << preset.name << delay;
                EXPECT_LE(found.late, found.early + 3.0 * preset.quantum.value) << preset.name << delay;
                EXPECT_LT(found.late, 1e-3) << preset.name << delay;
            }
        }
    }
}

/// As press(), for rotation: a bar is turned by a constant torque onto two posts beside its ends.
Press turnOntoPosts(const DeviceParams& preset, double stiffness) {
    scene::SceneSpec spec = test::scene(shape::Box{0.04, 0.004, 0.004}, Pose{}, shape::Cylinder{0.006, 0.02},
                                        Pose{Quat::Identity(), {0.015, 0.0052, 0}}, scene::ContactMethod::GodObject);
    spec.parts.push_back({.name = "other",
                          .geometry = shape::Shape(shape::Cylinder{0.006, 0.02}),
                          .X_WP = {Quat::Identity(), {-0.015, -0.0052, 0}}});
    spec.contact.two_way = true;
    spec.contact.stiffness = 200.0;
    spec.contact.rotational_stiffness = stiffness;
    spec.contact.rotational_damping = preset.recommended_rotational_damping.value;
    spec.limits.max_force = preset.max_force.value;
    spec.limits.max_torque = preset.max_torque.value;
    spec.limits.max_force_rate = preset.max_force_rate.value;
    test::Bench bench(spec);
    DeviceDynamics dynamics(preset, Pose{});
    dynamics.place(Pose{}, {Vec3::Zero(), {0, 0, 0.5}});
    simulated::HandCoupling hand;
    hand.attached = true;
    hand.F_D_B.torque = Vec3(0, 0, 0.3 * preset.max_torque.value);
    return settle(
        bench, dynamics, hand, 5000, [](const Pose& X_BD) { return rotationVector(X_BD.q).z(); },
        [&](const Wrench& F_D_B) {
            EXPECT_LE(F_D_B.torque.norm(), preset.max_torque.value);
            return F_D_B.torque.z() < 0.0;
        });
}

TEST(StabilityBorder, AtNineteenTwentiethsOfItABarTurnedOntoPostsComesToRest) {
    // Truth: closed form (the border), as above, for rotation in contact: of every preset that has torque.
    int tried = 0;
    for (DeviceParams preset : simulated::presets()) {
        if (preset.actuated_degrees < 6) continue;
        for (int delay = 0; delay <= 3; ++delay) {
            preset.delay_ticks = delay;
            SampledWall wall = wallOf(preset, Axis::Rotation);
            wall.delay_ticks = delay;
            const double border = stableStiffnessBorder(wall);
            if (!(border > 0.0)) continue;
            const Press found = turnOntoPosts(preset, 0.95 * border);
            std::printf("%-11s %d ms K %7.3f N m/rad: swing %8.3f mrad, later %8.3f mrad\n",
                        std::string(preset.name).c_str(), delay, 0.95 * border, 1e3 * found.early, 1e3 * found.late);
            ++tried;
            EXPECT_TRUE(found.touches) << preset.name << delay;
            EXPECT_LE(found.late, 0.1 * found.early + 3.0 * preset.rotational_quantum.value) << preset.name << delay;
        }
    }
    EXPECT_GE(tried, 8);
}

TEST(StabilityBorder, AtNineteenTwentiethsOfItTheWholePresetStopsSwinging) {
    // Truth: as above, on a spring that also pulls, translation and rotation, with dry friction, encoder steps and the
    // motors' limits: at most some encoder steps of swing are left.
    for (DeviceParams preset : simulated::presets()) {
        for (const Axis axis : {Axis::Translation, Axis::Rotation}) {
            if (axis == Axis::Rotation && preset.actuated_degrees < 6) continue;
            const double quantum = axis == Axis::Rotation ? preset.rotational_quantum.value : preset.quantum.value;
            for (int delay = 0; delay <= 3; ++delay) {
                preset.delay_ticks = delay;
                SampledWall wall = wallOf(preset, axis);
                wall.delay_ticks = delay;
                const double border = stableStiffnessBorder(wall);
                if (!(border > 0.0)) continue;
                Swing swing(preset, axis, 0.95 * border, wall.virtual_damping);
                double late = 0.0;
                for (int i = 0; i < 8000; ++i) {
                    const double away = std::abs(swing.tick());
                    if (i >= 7000) late = std::max(late, away);
                }
                // Friction may hold the handle where the spring does not reach it: K x <= f_c.
                const double friction =
                    axis == Axis::Rotation ? preset.coulomb_torque.value : preset.coulomb_force.value;
                EXPECT_LE(late, friction / (0.95 * border) + 3.0 * quantum)
                    << preset.name << (axis == Axis::Rotation ? " rotation " : " ") << delay;
            }
        }
    }
}

TEST(StabilityBorder, FrictionTakesWhatEncoderStepsGiveUpToTheQuantisedBound) {
    // Truth: closed form, K = 2 f_c/D: a spring below it, kicked by a few encoder steps, comes to rest for good; and
    // the bound is the least of the two that it names.
    for (const DeviceParams& preset : simulated::presets()) {
        if (!(preset.quantum.value > 0.0)) continue;
        SampledWall wall = wallOf(preset, Axis::Translation);
        wall.virtual_damping = 0.0;
        wall.delay_ticks = preset.delay_ticks;
        const double bound = passiveStiffness(wall, preset.coulomb_force.value, preset.quantum.value);
        EXPECT_DOUBLE_EQ(bound,
                         std::min(passiveStiffness(wall), 2.0 * preset.coulomb_force.value / preset.quantum.value));
        Swing swing(preset, Axis::Translation, 0.95 * bound, 0.0);
        for (int i = 0; i < 20000; ++i) swing.tick();
        const double x = swing.tick();
        for (int i = 0; i < 2000; ++i) ASSERT_EQ(swing.tick(), x) << preset.name;
    }
    const SampledWall wall{};
    EXPECT_EQ(passiveStiffness(wall, 0.0, 1e-6), 0.0);
    EXPECT_EQ(passiveStiffness(wall, 0.0, 0.0), passiveStiffness(wall));
    EXPECT_DOUBLE_EQ(passiveStiffness(wall, 0.1, 1e-3), 200.0);
}

}  // namespace
}  // namespace passung
