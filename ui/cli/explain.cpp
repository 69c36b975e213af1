#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/digest.h"
#include "core/base/regular_file.h"
#include "core/scene/contact_geometry.h"
#include "core/scene/part_mass.h"
#include "core/tick/scene_sequence.h"
#include "study/protocol/document.h"
#include "study/run/files/builds.h"
#include "study/run/files/known_names.h"
#include "study/run/files/protocol_files.h"
#include "study/run/files/stored_plans.h"
#include "study/run/freeze.h"
#include "study/run/machine/auto_accuracy.h"
#include "study/run/machine/calibration.h"
#include "study/run/machine/stability_report.h"
#include "study/run/machine/stage_cost.h"
#include "study/session/plan_text.h"
#include "study/store/read/store_reader.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"
#include "ui/cli/order_table.h"

namespace passung::cli {

namespace {

Result<bool> isStudy(const std::string& path) {
    const auto text = readFile(path);
    if (!text) return text.errors();
    const auto document = protocol::parseDocument(*text, path);
    if (!document) return document.errors();
    return protocol::kindOf(*document) == protocol::FileKind::Study;
}

/// The sizes that shapes have in the end, whatever gave them: a fit, a factor.
void printShapes(const scene::SceneSpec& spec) {
    for (const auto& part : spec.parts) {
        const auto* shape = std::get_if<shape::Shape>(&part.geometry);
        if (shape == nullptr) continue;
        std::string text;
        for (const auto& [key, value] : shape::namedDimensions(*shape))
            text += fmt::format(", {} {:.7g}", key, 1e3 * value);
        fmt::print("  {:<22}{}{} mm\n", part.name, shape::kindName(*shape), text);
    }
}

/// The steps of an assembly in an order in which they may be done, and the states that each goes through.
void printSteps(const scene::SceneSpec& spec) {
    const auto& steps = spec.effects.pick.steps;
    if (steps.empty()) return;
    const auto partOf = [&](std::size_t i) -> const std::string& { return spec.parts[steps[i].part].name; };
    const char* head = "steps";
    for (const std::size_t i : scene::orderOf(steps)) {
        const scene::AssemblyStep& step = steps[i];
        std::vector<std::string> before;
        for (std::size_t other = 0; other < steps.size(); ++other)
            if ((step.after & scene::stepBit(other)) != 0) before.push_back(partOf(other));
        const bool world = step.into == scene::AssemblyStep::kWorld;
        fmt::print("  {:<22}{}{}: within {:.4g} mm and {:.3g}°{}{}\n", std::exchange(head, ""), partOf(i),
                   world ? "" : " into " + spec.parts[step.into].name, 1e3 * step.position_tolerance,
                   step.angle_tolerance * 180.0 / std::numbers::pi, step.folds == 0 ? ", turned anyhow" : "",
                   before.empty() ? "" : fmt::format(", after {}", fmt::join(before, ", ")));
    }
    fmt::print("  {:<22}idle, picked, carried, near, inserted; locked once it is let go there\n", "states of a step");
}

/// Which hand holds what, where there are several or they pick parts up.
void printHands(const scene::SceneSpec& spec) {
    if (spec.handCount() < 2 && !spec.effects.picks()) return;
    for (std::size_t i = 0; i < spec.handCount(); ++i) {
        const std::size_t held = spec.heldBy(i);
        fmt::print("  {:<22}{}\n", i == 0 ? "the first hand" : "hand " + spec.hand(i).name,
                   held == spec.parts.size() ? "begins with nothing" : "holds " + spec.parts[held].name);
    }
    if (!spec.effects.picks()) return;
    std::vector<std::string> names;
    for (const scene::PartSpec& part : spec.parts)
        if (part.pickable) names.push_back(part.name);
    const scene::Pick& pick = spec.effects.pick;
    fmt::print("  {:<22}{} within {:.4g} mm, by button {}, {}; what is let go {}\n", "picked up",
               fmt::join(names, ", "), 1e3 * pick.reach, pick.button,
               pick.on_press ? "at each press" : "while it is down",
               pick.locks ? "stays for good" : "can be picked up again");
    printSteps(spec);
}

/// What a scene does not cost, and why.
void printSpared(const scene::Scene& scene) {
    const tick::SceneModels models(scene);
    const auto line = [](const std::string& what, const std::string& why) { fmt::print("  {:<24}{}\n", what, why); };
    line("not run", "why not");
    for (const tick::SparedStage& stage : models.spared(0)) line(stage.name, stage.reason);
    const auto anyPart = [&](auto has) { return std::any_of(scene.parts.begin(), scene.parts.end(), has); };
    const auto geometry = scene::geometryOf(scene.spec).geometry;
    const std::string from = geometry == scene::Geometry::ClosedForm ? "contact is computed from closed forms"
                             : geometry == scene::Geometry::Surface  ? "contact is computed from surfaces"
                                                                     : "contact is computed from distance fields";
    line("not built", "why not");
    if (!anyPart([](const auto& part) { return part->field != nullptr; })) line("distance fields", from);
    if (!anyPart([](const auto& part) { return part->shell.has_value(); })) line("point shells", from);
    if (!anyPart([](const auto& part) { return part->clusters != nullptr; })) line("trees of surfaces", from);
    const auto still = static_cast<std::size_t>(std::count_if(
        scene.spec.parts.begin(), scene.spec.parts.end(), [](const scene::PartSpec& part) { return !part.moves(); }));
    if (still < 2) return;
    const std::size_t pairs = still * (still - 1) / 2;
    line("not paired", "why not");
    line(fmt::format("{} pair{} of parts", pairs, pairs == 1 ? "" : "s"),
         fmt::format("nobody holds either of them; {} of {} parts rest", still, scene.parts.size()));
}

/// Of a hand's part, if the scene has gravity or inertia: what is felt and seen of it, and what is not.
void printMass(const scene::Scene& scene, std::size_t hand) {
    const std::size_t i = scene.spec.heldBy(hand);
    if (i == scene.spec.parts.size()) return;
    const scene::PartSpec& held = scene.spec.parts[i];
    const scene::Effects& effects = scene.spec.effects;
    if (!(held.density > 0.0) || (effects.weight.gravity.isZero(0.0) && !effects.inertia.any())) return;
    const auto body = scene::massOf(*scene.parts[i], held.density);
    if (!body) return;
    const auto weight = scene::weigh(scene.spec, *body);
    if (weight) fmt::print("  {:<22}{} {}\n", "weight", held.name, scene::describe(*weight));
    const Vec3 centre = 1e3 * body->centre, inertia = 1e6 * body->inertia.diagonal();
    const std::string rendered = effects.inertia.any()
                                     ? fmt::format("felt {:.4g} times, {:.3g} g", effects.inertia.scale,
                                                   1e3 * effects.inertia.scale * body->mass)
                                     : "not rendered, so that it does not move the border of stability";
    fmt::print(
        "  {:<22}{}centre of mass at {:.4g}, {:.4g}, {:.4g} mm; inertia about its x, y, z {:.3g}, {:.3g}, {:.3g} kg "
        "mm²: {}\n",
        weight ? "" : "inertia", weight ? "" : held.name + ": ", centre.x(), centre.y(), centre.z(), inertia.x(),
        inertia.y(), inertia.z(), rendered);
}

Result<Done> printStages(const scene::SceneSpec& spec, scene::PartCache& cache, ProgressLine& progress) {
    const auto scene = scene::buildScene(spec, cache);
    progress.show("");
    if (!scene) return scene.errors();
    printShapes(spec);
    printHands(spec);
    for (std::size_t hand = 0; hand < spec.handCount(); ++hand) printMass(*scene, hand);
    const scene::GeometryChoice choice = scene::geometryOf(spec);
    fmt::print("  {:<22}{}: {}\n", "geometry of contact", scene::geometryName(choice.geometry), choice.reason);
    fmt::print("  {:<22}{:>10}{:>10}  {}\n", "stage of the tick", "median µs", "p99 µs", "why it runs");
    const run::TickCost tick = run::measureTick(*scene);
    for (const run::StageCost& cost : tick.stages)
        fmt::print("  {:<22}{:>10.1f}{:>10.1f}  {}\n", cost.name, cost.median_us, cost.p99_us, cost.reason);
    fmt::print("  {:<22}{:>10.1f}{:>10.1f}  {}: most {:.1f} µs; processor time of {} ticks {}, the least of {} runs\n",
               "whole tick", tick.median_us, tick.p99_us, tick.fits() ? "fits 1 kHz here" : "does not fit 1 kHz here",
               tick.most_us, tick.ticks, tick.in_contact ? "in contact" : "without contact", run::TickCost::kRuns);
    if (tick.work_cap > 0)
        fmt::print(
            "  {:<22}{} units of work, of which these ticks took {} at most; one that takes all of them: about {:.0f} "
            "µs here, what is left goes on in the next\n",
            "cap of a tick", tick.work_cap, tick.most_work, tick.at_cap_us);
    printSpared(*scene);
    return Done{};
}

/// A line of the stiffness of a scene: how far it is from what its device bears, by the model of its mechanism.
void printWall(const std::string& what, std::size_t width, const char* unit, double maximum,
               const run::SceneWall& wall) {
    const run::WallBounds& b = wall.bounds;
    const auto cell = [](double bound) { return bound > 0.0 ? fmt::format("{:.4g}", bound) : std::string("none"); };
    const auto share = [&](double bound) {
        return bound > 0.0 ? fmt::format("{:.2f}", wall.stiffness / bound) : std::string("-");
    };
    fmt::print("  {:<{}}  {:>10.4g} {:<6}{:>8}{:>11}{:>10}{:>10}{:>10}{:>12}{}\n", what, width, wall.stiffness, unit,
               share(maximum), share(b.border), cell(b.border), cell(b.linear), cell(b.passive),
               cell(b.passive_undamped), wall.stiffness < b.border ? "" : "  UNSTABLE by the model");
}

void printStabilityHead(std::size_t width) {
    fmt::print(
        "\nStability of the wall that the device feels: share of its \"max\" and of the model's exact border; linear "
        "rule, passive bound, the same undamped\n");
    fmt::print("  {:<{}}  {:>10} {:<6}{:>8}{:>11}{:>10}{:>10}{:>10}{:>12}\n", "", width, "stiffness", "", "of max",
               "of border", "border", "linear", "passive", "(undamped)");
}

void printStability(const std::string& what, std::size_t width, const DeviceDescription& device,
                    const scene::SceneSpec& scene) {
    if (!device.mechanism) {
        fmt::print("  {:<{}}  {}: no model of its mechanism\n", what, width, device.name);
        return;
    }
    printWall(what, width, "N/m", device.stable_stiffness_N_per_m, run::translationWall(device, scene));
    if (device.actuated_degrees >= 6 && scene.contact.rotational_stiffness > 0.0)
        printWall("", width, "Nm/rad", device.stable_rotational_stiffness_Nm_per_rad, run::rotationWall(device, scene));
    if (scene.contact.method != scene::ContactMethod::Penalty ||
        scene.contact.coupling == scene::PenaltyCoupling::Direct)
        return;
    if (run::feltThroughTool(scene.contact))
        fmt::print("  {:<{}}  (coupled penalty: N/m border of the coupling through its tool, contacts of {:.4g} N/m)\n",
                   "", width, scene.contact.penalty_stiffness);
    else
        fmt::print("  {:<{}}  (coupled penalty: of a rigid wall; the tool and soft contacts move the border)\n", "",
                   width);
}

void explainStability(const plan::StudyPlan& plan, std::span<const DeviceDescription> devices) {
    const auto conditions = std::span(plan.conditions).first(plan::plannedConditions(plan));
    std::size_t width = 0;
    for (const auto& condition : conditions) width = std::max(width, condition.name.size());
    printStabilityHead(width);
    for (const auto& condition : conditions)
        if (const auto* device = run::deviceNamed(condition.device, devices))
            printStability(condition.name, width, *device, condition.scene);
    for (const auto& stable : plan.stable_stiffness) fmt::print("  {}: {}\n", stable.device, stable.origin);
}

/// What the study's database keeps, or a run that began it now on this machine would keep.
Result<run::KeptPlan> keptFor(const std::string& database, const plan::StudyPlan& draft, scene::BuildStore* builds) {
    const std::string sha256 = sha256Hex(draft.source_text);
    if (!database.empty()) {
        const auto reader = store::StoreReader::open(database);
        if (!reader) return reader.errors();
        return run::keptPlan(*reader, sha256);
    }
    run::KeptPlan kept{sha256, draft.stable_stiffness, {}, {}};
    if (run::asksForAccuracy(draft)) {
        ProgressLine progress;
        auto measured = run::measureAccuracy(
            draft, sha256, [&](const std::string& what, double share) { progress.show(progressBar(what, share)); },
            builds);
        if (!measured) return measured.errors();
        kept.accuracy = *std::move(measured);
    }
    return kept;
}

void explainAccuracy(const std::string& database, std::span<const store::AccuracyRow> rows) {
    fmt::print("\nAccuracy, {}\n{}",
               database.empty() ? "measured now on this machine: a study keeps what its first run picks, which --db "
                                  "shows; the keys picked, written into the protocol, hold everywhere"
                                : "as " + database + " keeps it",
               run::describeAccuracy(rows));
}

/// When hints of an assembly come up: a line for each time that differs.
void printHints(const std::vector<const plan::Condition*>& conditions) {
    std::set<double> times;
    for (const plan::Condition* condition : conditions)
        if (const auto* assembly = std::get_if<plan::AssemblyTask>(&condition->task.form))
            times.insert(assembly->hint_after);
    for (const double after : times)
        if (after > 0.0)
            fmt::print("  {:<22}{}after {:.4g} s without a step done: part, line and goal of the next are marked\n",
                       "hint", times.size() > 1 ? "of some " : "", after);
}

Result<Done> explainEffects(const plan::StudyPlan& plan, scene::PartCache& cache, ProgressLine& progress) {
    fmt::print("\nEffects, their cost measured on this machine in sliding contact\n");
    for (const auto& conditions : run::costGroups(plan)) {
        fmt::print("\n  conditions");
        for (const auto* condition : conditions)
            fmt::print(" {}{}", condition->name, condition == conditions.back() ? "" : ",");
        fmt::print("\n");
        printHints(conditions);
        if (auto done = printStages(conditions.front()->scene, cache, progress); !done) return done;
    }
    return Done{};
}

}  // namespace

int explain(const ExplainArguments& options) {
    ProgressLine progress;
    const auto store = run::openBuilds(options.import_limits, showBuilds(progress));
    scene::PartCache cache(store.get());
    const auto is_study = isStudy(options.file);
    if (!is_study) return fail(is_study.errors());
    if (!*is_study) {
        if (!options.orders.empty())
            return fail({{"a scene has no orders: --orders is for study files", options.file}});
        const auto text = readFile(options.file);
        if (!text) return fail(text.errors());
        const auto spec = progress.whileReading(
            options.file, [&] { return run::readSceneOnDevice(*text, options.file, options.import_limits); });
        if (!spec) return fail(spec.errors());
        warn(options.file, spec->warnings);
        const auto done = printStages(spec->scene, cache, progress);
        if (const auto* device = run::deviceNamed(spec->device, run::knownDevices())) {
            printStabilityHead(device->name.size());
            printStability(device->name, device->name.size(), *device, spec->scene);
            fmt::print("  {}: {}\n", device->name, device->stability_source);
        }
        return done ? 0 : fail(done.errors());
    }
    const auto draft =
        progress.whileReading(options.file, [&] { return run::readProtocol(options.file, options.import_limits); });
    if (!draft) return fail(draft.errors());
    const int participants = options.participants > 0 ? options.participants : draft->participants;
    if (options.orders == "csv") {
        const auto sessions = session::plannedSessions(*draft, participants, options.stations);
        if (!sessions) return fail(sessions.errors());
        fmt::print("{}", orderCsv(*draft, *sessions));
        return 0;
    }
    const auto kept = keptFor(options.database, *draft, store.get());
    if (!kept) return fail(kept.errors());
    const auto plan = run::freeze(*draft, *kept, {}, options.import_limits);
    if (!plan) return fail(plan.errors());
    const auto described = session::describePlan(**plan, participants, options.stations);
    if (!described) return fail(described.errors());
    fmt::print("{}", *described);
    explainStability(**plan,
                     options.database.empty() ? run::knownDevices() : run::devicesAsKept(kept->stable_stiffness));
    if (run::asksForAccuracy(*draft)) explainAccuracy(options.database, kept->accuracy);
    const auto done = explainEffects(**plan, cache, progress);
    return done ? 0 : fail(done.errors());
}

}  // namespace passung::cli
