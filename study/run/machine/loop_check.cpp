#include "study/run/machine/loop_check.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "core/scene/scene.h"
#include "devices/simulated/presets.h"
#include "devices/simulated/simulated_device.h"

namespace passung::run {

namespace {

constexpr double kFewMissed = 1e-4;  // share of cycles: one in ten thousand
constexpr double kManyMissed = 1e-2;

scene::SceneSpec smallScene() {
    scene::SceneSpec spec;
    spec.parts.push_back({.name = "ball",
                          .geometry = shape::Sphere{0.02},
                          .X_WP = {Quat::Identity(), Vec3(0.0, 0.0, 0.03)},
                          .held = true});
    spec.parts.push_back(
        {.name = "table", .geometry = shape::Box{0.06, 0.06, 0.02}, .X_WP = {Quat::Identity(), Vec3(0.0, 0.0, -0.01)}});
    spec.contact.cell = 1e-3;
    return spec;
}

LoopFitness fitnessOf(const LoopCheck& check) {
    const double share =
        static_cast<double>(check.missed) / static_cast<double>(std::max<std::int64_t>(1, check.ticks));
    if (share <= kFewMissed) return check.scheduling.fifo ? LoopFitness::Studies : LoopFitness::StudiesIfAlone;
    return share <= kManyMissed ? LoopFitness::TryOuts : LoopFitness::Nothing;
}

std::string verdictOf(const LoopCheck& check) {
    const std::string counted = fmt::format("{} of {} cycles were missed", check.missed, check.ticks + check.missed);
    switch (check.fitness) {
        case LoopFitness::Studies:
            return "fit for studies: " + counted;
        case LoopFitness::StudiesIfAlone:
            return "good now, but without real-time scheduling another program can spoil it: " + counted;
        case LoopFitness::TryOuts:
            return "fit for trying out, not for studies: " + counted;
        case LoopFitness::Nothing:
            break;
    }
    return "not fit: " + counted + "; close other programs, grant real-time scheduling, or use another machine";
}

}  // namespace

LoopCheck checkLoop(double seconds) {
    scene::PartCache cache;
    auto scene = scene::buildScene(smallScene(), cache);
    LoopCheck check;
    if (!scene) {
        check.verdict = toString(scene.errors().front());
        return check;
    }
    const tick::SceneModels models(*scene);
    simulated::VisibleTask task;
    task.X_WHeldStart = scene->spec.parts[scene->held].X_WP;
    simulated::SimulatedDevice device(simulated::presets().front(), {}, task, {}, 1);
    loop::RecordRing ring(static_cast<std::size_t>(seconds * 1000.0) + 2048);
    loop::HapticCycle cycle(models[0], device, ring, true);
    loop::RealTimeThread thread(cycle);
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    thread.stop();
    check.scheduling = thread.scheduling();
    check.ticks = cycle.ticks();
    check.missed = thread.overruns();
    check.p50_us = thread.lateness().quantileMicroseconds(0.5);
    check.p99_us = thread.lateness().quantileMicroseconds(0.99);
    check.p999_us = thread.lateness().quantileMicroseconds(0.999);
    check.max_us = thread.lateness().maxMicroseconds();
    check.compute_p99_us = cycle.timing().quantileMicroseconds(0.99);
    check.fitness = fitnessOf(check);
    check.verdict = verdictOf(check);
    check.fit = check.fitness == LoopFitness::Studies;
    return check;
}

}  // namespace passung::run
