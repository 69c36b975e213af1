#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <deque>
#include <filesystem>
#include <iterator>
#include <vector>

#include "core/base/processor_clock.h"
#include "core/base/regular_file.h"
#include "core/scene/scene.h"
#include "core/tick/scene_sequence.h"
#include "devices/scripted/trajectory.h"
#include "study/run/files/builds.h"
#include "study/run/files/protocol_files.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace {

constexpr const char* kHeader =
    "tick,t_s,device_x_m,device_y_m,device_z_m,device_qw,device_qx,device_qy,device_qz,proxy_x_m,proxy_y_m,proxy_z_m,"
    "proxy_qw,proxy_qx,proxy_qy,proxy_qz,force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,proxy_depth_"
    "m,"
    "device_depth_m,contacts,quality,status,iterations,tick_us,proxy_gap_m,suspended,tick_cpu_us,proxy_lag_m";
/// Of a hand with navigation.
constexpr const char* kNavigationHeader =
    ",navigation_clutched,navigation_scale,navigation_x_m,navigation_y_m,navigation_z_m,navigation_qw,navigation_qx,"
    "navigation_qy,navigation_qz";
/// Of a scene whose parts are picked up.
constexpr const char* kHeldHeader = ",held_part";

/// How long a tick took [µs].
struct TickTime {
    double wall, processor;
};

void writeRow(fmt::memory_buffer& text, std::int64_t tick, const scene::SceneSpec& spec, const tick::TickOutput& output,
              const TickTime& us) {
    auto out = std::back_inserter(text);
    const tick::TickFrame& f = output.frame;
    fmt::format_to(out, "{},{}", tick, static_cast<double>(tick) / 1000.0);
    for (const Pose& pose : {f.X_WH, output.X_WG}) {
        fmt::format_to(out, ",{},{},{},{},{},{},{}", pose.p.x(), pose.p.y(), pose.p.z(), pose.q.w(), pose.q.x(),
                       pose.q.y(), pose.q.z());
    }
    for (const Vec3& v : {f.F_H_W.force, f.F_H_W.torque}) fmt::format_to(out, ",{},{},{}", v.x(), v.y(), v.z());
    fmt::format_to(out, ",{},{},{},{},{},{},{:.3f}", f.proxy_depth, f.hand_depth, f.contacts, f.quality, f.status,
                   f.iterations, us.wall);
    const auto known = [](double value) { return std::isnan(value) ? "NA" : fmt::format("{}", value); };
    fmt::format_to(out, ",{},{},{:.3f},{}", known(f.proxy_gap), (f.status & kSuspended) != 0 ? 1 : 0, us.processor,
                   known(f.proxy_lag));
    if (!std::isnan(f.scale))
        fmt::format_to(out, ",{},{},{},{},{},{},{},{},{}", f.clutched ? 1 : 0, f.scale, f.offset.x(), f.offset.y(),
                       f.offset.z(), f.turn.w(), f.turn.x(), f.turn.y(), f.turn.z());
    if (spec.effects.picks())
        fmt::format_to(out, ",{}",
                       output.held == kNoPart ? "NA" : spec.parts[static_cast<std::size_t>(output.held)].name);
    fmt::format_to(out, "\n");
}

/// Where a path leads.
std::filesystem::path fileOf(const std::string& path) {
    std::error_code unknown;
    auto file = std::filesystem::weakly_canonical(path, unknown);
    return unknown ? std::filesystem::path(path) : file;
}

/// Puts all tables in their places, or none.
Result<Done> commitAll(std::deque<OutputFile>& outs, const std::vector<std::string>& paths) {
    for (std::size_t i = 0; i < outs.size(); ++i) {
        auto done = outs[i].commit();
        if (done) continue;
        std::error_code ignored;
        for (std::size_t k = 0; k < i; ++k)  // no pipe, no device
            if (std::filesystem::is_regular_file(paths[k], ignored)) std::filesystem::remove(paths[k], ignored);
        return done.errors();
    }
    return Done{};
}

/// Refuses outputs that would overwrite an input or have one name, and a number of them that is not the inputs'.
Result<Done> checkFiles(const SimulateArguments& options) {
    std::vector<std::string> inputs{options.scene};
    inputs.insert(inputs.end(), options.trajectories.begin(), options.trajectories.end());
    if (options.outs.size() != options.trajectories.size())
        return Error{.message = "must be given as often as --trajectory, once for each hand",
                     .key = "--out",
                     .value = fmt::format("{} files", options.outs.size())};
    for (const std::string& out : options.outs) {
        if (auto free = refuseOverwriting(out, inputs); !free) return free.errors();
        const auto same = [&](const std::string& other) { return fileOf(other) == fileOf(out); };
        if (std::count_if(options.outs.begin(), options.outs.end(), same) > 1)
            return Error{.message = "must be another file for each hand", .key = "--out", .value = out};
    }
    return Done{};
}

}  // namespace

int simulate(const SimulateArguments& options) {
    const std::size_t hands = options.trajectories.size();
    if (const auto free = checkFiles(options); !free) return fail(free.errors());
    const auto source = readFile(options.scene);
    if (!source) return fail(source.errors());
    ProgressLine progress;
    auto read = progress.whileReading(
        options.scene, [&] { return run::readSceneOnDevice(*source, options.scene, options.import_limits); });
    if (!read) return fail(read.errors());
    warn(options.scene, read->warnings);
    scene::SceneSpec* spec = &read->scene;
    if (spec->handCount() != hands)
        return fail(
            {{.message = fmt::format("must be given once for each hand of the scene, which has {}", spec->handCount()),
              .key = "--trajectory",
              .value = fmt::format("{} files", hands)}});
    std::vector<scripted::Trajectory> trajectories;
    std::int64_t last = 0;
    for (const std::string& path : options.trajectories) {
        auto trajectory = scripted::Trajectory::read(path);
        if (!trajectory) return fail(trajectory.errors());
        last = std::max(last, trajectory->lastTick());
        trajectories.push_back(*std::move(trajectory));
    }
    // The files hold poses of the held parts in the world, so that the registrations have nothing to do; and the run
    // begins with their first rows, wherever these are.
    scene::dropRegistrations(*spec);
    spec->start_gate = scene::StartGate{};
    for (scene::HandSpec& hand : spec->other_hands) hand.start_gate = scene::StartGate{};
    const auto store = run::openBuilds(options.import_limits, showBuilds(progress));
    scene::PartCache cache(store.get());
    progress.show("building the scene");
    auto scene = scene::buildScene(*spec, cache);
    if (!scene) return fail(scene.errors());
    const tick::SceneModels models(*scene);
    tick::SceneSequence ticks(std::array{tick::SceneTurn{&models[0]}});
    std::deque<OutputFile> outs;
    for (std::size_t hand = 0; hand < hands; ++hand) {
        OutputFile& out = outs.emplace_back(options.outs[hand]);
        out.write(kHeader);
        if (spec->hand(hand).navigation.any()) out.write(kNavigationHeader);
        if (spec->effects.picks()) out.write(kHeldHeader);
        out.write("\n");
    }
    std::vector<DeviceReading> readings(hands);
    std::vector<tick::TickOutput> outputs(hands);
    fmt::memory_buffer text;
    for (std::int64_t i = 0; i <= last; ++i) {
        for (std::size_t hand = 0; hand < hands; ++hand) {
            const std::int64_t at = std::min(i, trajectories[hand].lastTick());
            readings[hand].X_BD = trajectories[hand].at(at);
            readings[hand].buttons = trajectories[hand].buttonsAt(at);
        }
        const std::int64_t processor_begin = threadProcessorNanoseconds();
        const auto begin = std::chrono::steady_clock::now();
        ticks.step(readings, outputs);
        const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
        const std::int64_t processor = threadProcessorNanoseconds() - processor_begin;
        for (std::size_t hand = 0; hand < hands; ++hand) {
            text.clear();
            writeRow(text, i, *spec, outputs[hand], {took.count(), 1e-3 * static_cast<double>(processor)});
            outs[hand].write({text.data(), text.size()});
        }
        if (i % 10000 == 0) progress.show(fmt::format("{} of {} ticks", i, last + 1));
    }
    const auto done = commitAll(outs, options.outs);
    return done ? 0 : fail(done.errors());
}

}  // namespace passung::cli
