#include "devices/simulated/presets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/tick_record.h"
#include "core/loop/stability.h"

using namespace passung;
using namespace passung::simulated;

TEST(Presets, TheSixDevicesAreThereAndValid) {
    // Truth: invariant; the names are what protocols may say.
    for (const char* name : {"sigma7", "hug", "virtuose6d", "falcon", "whi", "touch"}) {
        const DeviceParams* p = findPreset(name);
        ASSERT_NE(p, nullptr) << name;
        EXPECT_EQ(p->name, name);
        EXPECT_TRUE(p->validate().empty()) << name;
    }
    EXPECT_EQ(presets().size(), 6u);
    EXPECT_EQ(findPreset("sigma"), nullptr);
}

TEST(Presets, EveryValueSaysWhereItComesFrom) {
    // Truth: invariant.
    for (const DeviceParams& p : presets()) {
        for (const Sourced& s :
             {p.mass, p.inertia, p.damping, p.rotational_damping, p.coulomb_force, p.coulomb_torque, p.quantum,
              p.rotational_quantum, p.max_force, p.max_torque, p.peak_force, p.peak_torque, p.max_force_rate,
              p.workspace_radius, p.vendor_stiffness, p.vendor_rotational_stiffness, p.recommended_damping,
              p.recommended_rotational_damping})
            EXPECT_FALSE(s.source.empty()) << p.name;
        EXPECT_FALSE(p.degrees_source.empty());
        EXPECT_FALSE(describe(p).stability_source.empty());
    }
}

TEST(Presets, SigmaSevenAllowsItsPublishedLimits) {
    // Truth: published driver limits of the device (CHAI3D): 4000 N/m, 1 N·m/rad, 12 N, 0.2 N·m.
    const DeviceDescription d = describe(*findPreset("sigma7"));
    EXPECT_DOUBLE_EQ(d.stable_stiffness_N_per_m, 4000);
    EXPECT_DOUBLE_EQ(d.stable_rotational_stiffness_Nm_per_rad, 1);
    EXPECT_DOUBLE_EQ(d.max_force_N, 12);
    EXPECT_DOUBLE_EQ(d.max_torque_Nm, 0.2);
    EXPECT_TRUE(d.simulated);
}

TEST(Presets, StableStiffnessLeavesAMargin) {
    // Truth: invariant; stable at the stated stiffness and still at 1/0.7 of it, less 1 %, at the recommended damping.
    for (const DeviceParams& p : presets()) {
        const DeviceDescription d = describe(p);
        loop::SampledWall wall{.mass = p.mass.value,
                               .damping = p.damping.value,
                               .stiffness = d.stable_stiffness_N_per_m,
                               .virtual_damping = d.recommended_damping_Ns_per_m,
                               .period = kTickSeconds,
                               .delay_ticks = p.delay_ticks};
        EXPECT_GT(wall.stiffness, 0) << p.name;
        wall.stiffness *= 0.99 / kStableShare;
        EXPECT_TRUE(loop::isStable(wall)) << p.name;
        if (p.actuated_degrees < 6) {
            EXPECT_EQ(d.max_torque_Nm, 0) << p.name;
            EXPECT_EQ(d.stable_rotational_stiffness_Nm_per_rad, 0) << p.name;
            continue;
        }
        wall.mass = p.inertia.value;
        wall.damping = p.rotational_damping.value;
        wall.virtual_damping = d.recommended_rotational_damping_Nms_per_rad;
        wall.stiffness = d.stable_rotational_stiffness_Nm_per_rad * 0.99 / kStableShare;
        EXPECT_TRUE(loop::isStable(wall)) << p.name;
    }
}

TEST(Presets, NonsenseIsNamed) {
    // Truth: invariant; one issue per planted fault, with its key.
    const double nan = std::numeric_limits<double>::quiet_NaN();
    DeviceParams p = *findPreset("sigma7");
    p.mass.value = nan;
    ASSERT_EQ(p.validate().size(), 1u);
    EXPECT_EQ(p.validate()[0].key, "mass");
    p.coulomb_force.value = -1;
    p.delay_ticks = kMaxCommandDelay + 1;
    EXPECT_EQ(p.validate().size(), 3u);
    DeviceParams t = *findPreset("touch");
    t.max_torque.value = 0.1;
    ASSERT_EQ(t.validate().size(), 1u);
    EXPECT_EQ(t.validate()[0].key, "max_torque");
}
