#include <fmt/format.h>

#include <fstream>
#include <map>

#include "study/protocol/protocol_reader.h"
#include "study/protocol/scene_reader.h"
#include "study/session/plan_text.h"
#include "ui/app/run_study.h"
#include "ui/app/stage_cost.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace {

/// A protocol has a [study] table, a scene has not.
bool isProtocol(const std::string& path) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("[study]")) return true;
    }
    return false;
}

Result<Done> printStages(const model::SceneSpec& spec, model::PartCache& cache) {
    const auto scene = model::buildScene(spec, cache);
    if (!scene) return scene.errors();
    fmt::print("  {:<22}{:>10}{:>10}  {}\n", "stage of the tick", "median µs", "p99 µs", "why it runs");
    for (const app::StageCost& cost : app::measureStages(*scene)) {
        fmt::print("  {:<22}{:>10.1f}{:>10.1f}  {}\n", cost.name, cost.median_us, cost.p99_us, cost.reason);
    }
    return Done{};
}

/// What decides which stages run; conditions that agree in it share a table.
std::string effectsOf(const model::SceneSpec& spec) {
    const auto& c = spec.contact;
    return fmt::format("{} {} {} {}", static_cast<int>(c.method), c.proxy_filter > 0.0, spec.limits.delay_ticks > 0,
                       spec.start_gate.hold_ticks > 0);
}

Result<Done> explainEffects(const protocol::StudyPlan& plan, model::PartCache& cache) {
    fmt::print("\nEffects, their cost measured on this machine in sliding contact\n");
    std::map<std::string, std::vector<const protocol::Condition*>> groups;
    for (const auto& condition : plan.conditions) groups[effectsOf(condition.scene)].push_back(&condition);
    for (const auto& [effects, conditions] : groups) {
        fmt::print("\n  conditions");
        for (const auto* condition : conditions)
            fmt::print(" {}{}", condition->name, condition == conditions.back() ? "" : ",");
        fmt::print("\n");
        if (auto done = printStages(conditions.front()->scene, cache); !done) return done;
    }
    return Done{};
}

}  // namespace

int explain(const ExplainOptions& options) {
    model::PartCache cache;
    if (!isProtocol(options.file)) {
        const auto spec = protocol::readScene(options.file, app::knownDevices());
        if (!spec) return fail(spec.errors());
        const auto done = printStages(*spec, cache);
        return done ? 0 : fail(done.errors());
    }
    const auto plan = protocol::readProtocol(options.file, app::knownDevices(), app::knownMeasures());
    if (!plan) return fail(plan.errors());
    fmt::print("{}",
               session::describePlan(*plan, options.participants > 0 ? options.participants : plan->participants));
    const auto done = explainEffects(*plan, cache);
    return done ? 0 : fail(done.errors());
}

}  // namespace passung::cli
