#pragma once

#include "devices/simulated/hand.h"
#include "devices/simulated/presets.h"
#include "devices/simulated/simulated_device.h"
#include "tests/devices/simulated/peg_bore_environment.h"

namespace passung::simulated {

struct PegTrial {
    PegBoreEnvironment::Setup environment;
    HandParams hand;
    const char* device = "sigma7";
    double timeout = 20.0;  // [s] from the go sign
    bool show_proxy = true;
    std::uint64_t seed = 1;
    Vec3 hidden_offset = Vec3::Zero();  // the real bore against the drawn one [m]
};

struct PegOutcome {
    bool inserted = false;
    double time = 0.0;            // [s] from the go sign; the time-out if it failed
    bool touched_before = false;  // contact before the asked depth
    double search_time = 0.0;     // [s] in the phases Press and Search
    double most_force = 0.0;      // [N]
    bool finite = true;
    Pose last;  // reading at the end
};

/// One trial as the session would run it: hold the start pose, go, insert and hold 95 % of 20 mm for half a second.
inline PegOutcome runPegTrial(PegTrial trial) {
    const DeviceParams& params = *findPreset(trial.device);
    VisibleTask task;
    task.X_WHeldStart = {Quat::Identity(), Vec3(-0.015, 0.010, 0.030)};
    task.insertion_depth = 0.020;
    HandRegistration registration;
    registration.X_DH.p = Vec3(0, 0, -0.04);  // the tip below the hand
    registration.X_WB.p = Vec3(0, 0, 0.045);  // the hand's way lies in the smallest workspace
    trial.environment.X_WP.p = trial.hidden_offset;
    trial.environment.X_WStart = task.X_WHeldStart;
    PegBoreEnvironment environment(trial.environment);
    SimulatedDevice device(params, trial.hand, task, registration, trial.seed);

    PegOutcome outcome;
    outcome.time = trial.timeout;
    std::int64_t go = -1, held = 0, at_start = 0;
    std::array<Vec3, 50> past{};
    const auto budget = static_cast<std::int64_t>((trial.timeout + 10.0) * 1000);
    for (std::int64_t k = 0; k < budget; ++k) {
        const Pose X_BD = device.read().X_BD;
        const Pose X_WH = registration.partFromHandle(X_BD);
        const Wrench F_H_W = environment.render(X_WH);
        // about the handle: its origin lies above the part's
        const Vec3 lever = X_WH.p - X_BD.p;
        device.command({F_H_W.force, F_H_W.torque + lever.cross(F_H_W.force)});

        const Pose shown = trial.show_proxy ? environment.proxy() : X_WH;
        if (go < 0) {
            const bool there = (X_WH.p - task.X_WHeldStart.p).norm() < 2e-3;
            at_start = there ? at_start + 1 : 0;
            if (at_start >= 300) go = k;
        }
        if (k % 16 == 0) device.show({.tick = k, .X_WShown = shown, .running = go >= 0});

        Vec3& before = past[static_cast<std::size_t>(k) % past.size()];
        const double speed = k >= 50 ? (shown.p - before).norm() / 0.05 : 1.0;  // mean over 50 ms
        before = shown.p;
        outcome.most_force = std::max(outcome.most_force, device.dynamics().actingWrench().force.norm());
        outcome.finite = outcome.finite && isFinite(X_BD) && isFinite(F_H_W);
        outcome.last = X_BD;
        if (go < 0) continue;
        if (environment.touching() && environment.depth(shown) < 0.019) outcome.touched_before = true;
        const HandPhase phase = dynamic_cast<const Hand&>(device.hand()).phase();
        if (phase == HandPhase::Press || phase == HandPhase::Search) outcome.search_time += 1e-3;
        held = environment.depth(shown) >= 0.019 && speed < 5e-3 ? held + 1 : 0;
        if (held >= 500) {
            outcome.inserted = true;
            outcome.time = static_cast<double>(k - go) * 1e-3;
            break;
        }
        if (static_cast<double>(k - go) * 1e-3 > trial.timeout) break;
    }
    return outcome;
}

}  // namespace passung::simulated
