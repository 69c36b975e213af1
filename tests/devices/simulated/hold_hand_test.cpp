#include "devices/simulated/hold_hand.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "devices/simulated/presets.h"
#include "devices/simulated/simulated_device.h"

namespace passung::simulated {
namespace {

TEST(HoldHand, GivesWayToAPushAndComesBackToWhereThePartStarts) {
    // Truth: closed form of the arm. Pushed by 2 N its spring gives way by F/k at first; then the hand asks for what it
    // feels to be missing, so that the part comes back as long as that is within what a hand asks for. The 2 mm left
    // are the tremor and the device's friction over the spring.
    VisibleTask task;
    task.X_WHeldStart.p = Vec3(0.01, 0.02, 0.03);
    task.goal = HoldGoal{};
    HandParams params;
    SimulatedDevice device(*findPreset("sigma7"), params, task, {}, 3);
    const auto away = [&] { return (device.dynamics().truePose().p - task.X_WHeldStart.p).norm(); };
    const auto run = [&](int ticks, const Vec3& force) {
        double most = 0.0;
        for (int i = 0; i < ticks; ++i) {
            device.read();
            device.command({force, Vec3::Zero()});
            most = std::max(most, away());
        }
        return most;
    };
    run(3000, Vec3::Zero());
    EXPECT_LT(away(), 1e-3) << "it has reached the start";
    const Vec3 push(0, 0, -2.0);
    EXPECT_GT(run(400, push), 0.5 * push.norm() / params.stiffness) << "a push is felt";
    run(4000, push);
    EXPECT_LT(away(), 2e-3) << "it is back";
    run(4000, Vec3::Zero());
    EXPECT_LT(away(), 2e-3) << "and stays when nothing pushes any more";
}

}  // namespace
}  // namespace passung::simulated
