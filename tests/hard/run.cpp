#include "tests/hard/run.h"

#include <fmt/format.h>

#include <array>
#include <iterator>

#include "devices/simulated/presets.h"
#include "study/protocol/scene_reader.h"
#include "tests/bench/stopwatch.h"

namespace passung::hard {

std::string hardScenePath(const std::string& name) { return hardScenesFile(name + ".toml"); }
std::string hardScenesFile(const std::string& name) { return PASSUNG_HARD_SCENES "/" + name; }

Result<scene::SceneSpec> readHardScene(const std::string& name) {
    std::vector<DeviceDescription> devices;
    for (const simulated::DeviceParams& preset : simulated::presets()) devices.push_back(describe(preset));
    auto spec = protocol::readScene(hardScenePath(name), devices);
    if (!spec) return spec;
    spec->registration = scene::Registration{};
    spec->start_gate = scene::StartGate{};
    return spec;
}

Result<Run> runScene(const scene::SceneSpec& spec, const Drive& drive, std::int64_t ticks, const Onlooker& look) {
    static scene::PartCache cache;  // methods and seeds of a case share their parts
    const auto scene = scene::buildScene(spec, cache);
    if (!scene) return scene.errors();
    const tick::TickModel model = tick::makeModel(*scene);
    tick::TickState state = tick::makeState(model);
    Run run;
    run.spec = run.solids = spec;
    for (const auto& part : scene->parts)
        if (part->shell) {
            run.most_points += part->shell->points().size() + 2 * part->shell->nodes().size();
            run.all_nodes += part->shell->nodes().size();
        }
    run.most_points *= model.hands.front().obstacles.size();
    run.all_nodes *= model.hands.front().obstacles.size();
    run.readings.reserve(static_cast<std::size_t>(ticks));
    run.ticks.reserve(static_cast<std::size_t>(ticks));
    tick::TickOutput output;
    for (std::int64_t i = 0; i < ticks; ++i) {
        run.readings.push_back(drive(i, i > 0 ? &output : nullptr));
        const bench::Stopwatch watch;
        output = tick::step(model, state, run.readings.back());
        const double us = 1e6 * watch.seconds();
        if (look) look(model.hands.front(), state.hands.front(), output);
        const tick::TickFrame& f = output.frame;
        run.ticks.push_back({.device = f.X_WH,
                             .proxy = output.X_WG,
                             .sent = f.F_H_W,
                             .commanded = output.F_D_B,
                             .energy = f.energy,
                             .proxy_depth = f.proxy_depth,
                             .lag = f.proxy_lag,
                             .status = f.status,
                             .contacts = f.contacts,
                             .iterations = f.iterations,
                             .nodes = f.nodes_visited,
                             .rows = f.rows_taken,
                             .turns = f.friction_turns,
                             .us = static_cast<float>(us)});
    }
    return run;
}

std::string trajectoryCsv(const Run& run) {
    std::string text = "t_s,x_m,y_m,z_m,qw,qx,qy,qz\n";
    for (std::size_t i = 0; i < run.readings.size(); ++i) {
        const Pose& X = run.readings[i].X_BD;
        fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{}\n", static_cast<double>(i) / 1000.0, X.p.x(),
                       X.p.y(), X.p.z(), X.q.w(), X.q.x(), X.q.y(), X.q.z());
    }
    return text;
}

}  // namespace passung::hard
