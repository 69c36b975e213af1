#include "analysis/truth/accuracy_ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <set>

#include "analysis/truth/accuracy_tick_tables.h"
#include "analysis/truth/exact_overlap.h"
#include "analysis/truth/force_reference.h"
#include "core/base/processor_clock.h"
#include "core/scene/contact_geometry.h"
#include "core/scene/scene.h"
#include "core/tick/scene_sequence.h"

namespace passung::truth {

namespace {

using scene::ContactMethod;
using scene::Geometry;

constexpr std::size_t kMostStriking = 20;  // ticks of largest recorded overlap, and of largest force
constexpr OverlapEffort kOverlap{.tolerance = 5e-7, .share = 0.01, .most_pieces = 100'000};

double rankOf(const std::vector<double>& sorted, double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
    return sorted[std::max<std::size_t>(rank, 1) - 1];
}

/// What a run along the path showed, tick by tick.
struct Shown {
    std::vector<Pose> X_WH, X_WG;
    std::vector<Vec3> force;    // of the spring [N]
    std::vector<double> depth;  // recorded [m]
    std::vector<bool> usable;   // the hand was where the path says
    std::vector<bool> suspended;
};

scene::ContactSpec contactOf(const scene::ContactSpec& own, const TickSetting& setting) {
    scene::ContactSpec contact = own;
    contact.method = setting.method;
    contact.geometry = setting.geometry;
    contact.mode = setting.field.mode;
    contact.budget_nodes = setting.field.budget_nodes;
    contact.two_way = setting.two_way;
    contact.spacing = setting.field.spacing;
    contact.cell = cellOf(own, setting);
    contact.tolerance = setting.field.tolerance;
    return contact;
}

/// Without all that a scene adds to the spring.
scene::Scene springOf(const scene::Scene& whole) {
    scene::Scene scene = whole;
    scene::SceneSpec& spec = scene.spec;
    spec.effects = {};
    spec.display_wrench = true;
    spec.limits.max_force = spec.limits.max_torque = 1e9;
    spec.limits.max_force_rate = 1e15;
    spec.limits.actuates_torque = true;
    spec.limits.delay_ticks = 0;
    if (spec.contact.rendersAtHand()) spec.contact.damping = spec.contact.rotational_damping = 0.0;
    return scene;
}

DeviceReading readingAt(const Pose& X_WH) {
    DeviceReading reading;
    reading.X_BD = X_WH;
    return reading;
}

/// Tells whoever waits how far one setting is. Its work: what is shown, what is judged, what is timed.
class SettingSteps {
public:
    SettingSteps(const StepReport& report, std::string what, std::size_t setting, std::size_t settings)
        : report_(report), what_(std::move(what)), first_(setting), all_(settings) {}

    void begin() const { tell(0.0); }
    void shown(std::size_t tick, std::size_t ticks) const { every(tick, ticks, kBuilt, kShown); }
    void judged(std::size_t tick, std::size_t ticks) const { tell(between(tick, ticks, kShown, kJudged)); }
    void timed(std::size_t tick, std::size_t ticks) const { every(tick, ticks, kJudged, 1.0); }

private:
    static constexpr double kBuilt = 0.1, kShown = 0.25, kJudged = 0.5;  // of a setting, about
    static constexpr std::size_t kTicks = 500;                           // seldom enough to cost no tick anything

    static double between(std::size_t i, std::size_t n, double from, double to) {
        return from + (to - from) * static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(n, 1));
    }
    void every(std::size_t i, std::size_t n, double from, double to) const {
        if (i % kTicks == 0) tell(between(i, n, from, to));
    }
    void tell(double share) const { report_(what_, (static_cast<double>(first_) + share) / static_cast<double>(all_)); }

    const StepReport& report_;
    std::string what_;
    std::size_t first_, all_;
};

Shown show(const scene::Scene& scene, std::span<const Pose> path, const SettingSteps& steps) {
    const scene::Scene spring = springOf(scene);
    const tick::SceneModels models(spring);
    tick::SceneSequence ticks(std::array{tick::SceneTurn{&models[0]}});
    const scene::ContactSpec& contact = spring.spec.contact;
    Shown shown;
    for (const Pose& pose : path) {
        steps.shown(shown.X_WG.size(), path.size());
        const tick::TickOutput output = ticks.step(readingAt(pose));
        const tick::TickFrame& frame = output.frame;
        shown.X_WH.push_back(frame.X_WH);
        shown.X_WG.push_back(output.X_WG);
        shown.force.push_back(contact.rendersAtHand() ? frame.F_H_W.force
                                                      : Vec3(contact.stiffness * (output.X_WG.p - frame.X_WH.p)));
        shown.depth.push_back(frame.proxy_depth);
        shown.usable.push_back(frame.input_usable && !frame.relocated && frame.sample_periods == 1);
        shown.suspended.push_back((frame.status & kSuspended) != 0);
    }
    return shown;
}

void timeTicks(const scene::Scene& scene, std::span<const Pose> path, int repetitions, const SettingSteps& steps,
               PathCost& row) {
    constexpr double kUnlimited = std::numeric_limits<double>::infinity();
    const tick::SceneModels models(scene);
    std::vector<double> time(path.size(), kUnlimited), wall(path.size(), kUnlimited);
    for (int run = 0; run < repetitions; ++run) {
        tick::SceneSequence ticks(std::array{tick::SceneTurn{&models[0]}});
        for (std::size_t i = 0; i < path.size(); ++i) {
            steps.timed(static_cast<std::size_t>(run) * path.size() + i,
                        static_cast<std::size_t>(repetitions) * path.size());
            const DeviceReading reading = readingAt(path[i]);
            const auto begin = std::chrono::steady_clock::now();
            const std::int64_t processor = threadProcessorNanoseconds();
            ticks.step(reading);
            const std::int64_t spent = threadProcessorNanoseconds() - processor;
            const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
            time[i] = std::min(time[i], 1e-9 * static_cast<double>(spent));
            wall[i] = std::min(wall[i], took.count());
        }
    }
    row.time = tickSpreadOf(std::move(time));
    row.wall = tickSpreadOf(std::move(wall));
}

/// Points, and memory of what contact is computed from.
void measureSize(const scene::Scene& scene, PathCost& row) {
    if (row.setting.geometry == Geometry::Field) {
        const auto& shell = scene.parts[scene.held]->shell;
        row.points = shell ? shell->points().size() : 0;
        for (const auto& part : scene.parts) {
            row.bytes += static_cast<double>(scene::fieldBytes(*part));
            if (part->shell) row.bytes += static_cast<double>(part->shell->memoryBytes());
        }
        return;
    }
    row.bytes = static_cast<double>(tick::SceneModels(scene).memoryBytes(0));
}

/// Every so many, and the most striking; in their order.
std::vector<std::size_t> ticksToJudge(const Shown& shown, int every) {
    std::set<std::size_t> ticks;
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < shown.X_WG.size(); ++i) {
        if (!shown.usable[i]) continue;
        if (i % static_cast<std::size_t>(every) == 0) ticks.insert(i);
        order.push_back(i);
    }
    const auto addLargest = [&](const auto& sizeOf) {
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return sizeOf(a) > sizeOf(b); });
        for (std::size_t i = 0; i < std::min(kMostStriking, order.size()); ++i)
            if (sizeOf(order[i]) > 0.0) ticks.insert(order[i]);
    };
    addLargest([&](std::size_t i) { return shown.depth[i]; });
    addLargest([&](std::size_t i) { return shown.force[i].norm(); });
    return {ticks.begin(), ticks.end()};
}

void judgeOverlap(const Shown& shown, const std::vector<std::size_t>& ticks, const SceneOverlap& truth,
                  const SettingSteps& steps, PathCost& row) {
    row.judged = ticks.size();
    for (std::size_t k = 0; k < ticks.size(); ++k) {
        steps.judged(k, ticks.size());
        const Overlap found = truth.at(shown.X_WG[ticks[k]], kOverlap);
        row.overlap = std::fmax(row.overlap, found.depth);
        row.overlap_bound = std::fmax(row.overlap_bound, found.bound);
    }
}

void judgeForce(const Shown& shown, const std::vector<std::size_t>& ticks, const ForceReference& truth, PathCost& row) {
    std::vector<std::pair<Vec3, Vec3>> pairs;  // felt, true
    double largest = 0.0;
    for (const std::size_t i : ticks) {
        const std::size_t last = i > 0 && shown.usable[i - 1] ? i - 1 : i;
        const auto force = truth.at(shown.X_WG[last], shown.X_WH[i]);
        if (!force) continue;
        pairs.emplace_back(shown.force[i], *force);
        largest = std::max(largest, force->norm());
    }
    row.referenced = pairs.size();
    std::vector<double> share, angle;
    for (const auto& [felt, meant] : pairs) {
        const double size = meant.norm(), error = std::abs(felt.norm() - size);
        row.force_error = std::fmax(row.force_error, error);
        if (!(size > 0.0 && size >= kLeastForce * largest)) continue;
        share.push_back(error / size);
        if (felt.norm() > 0.0) angle.push_back(std::atan2(felt.cross(meant).norm(), felt.dot(meant)));
    }
    row.force = spreadOf(std::move(share));
    row.direction = spreadOf(std::move(angle));
}

void judgeGrain(const Shown& shown, const scene::ContactSpec& contact, PathCost& row) {
    const double rho = std::sqrt(contact.rotational_stiffness / contact.stiffness);
    std::vector<double> grain;
    for (std::size_t i = 1; i < shown.force.size(); ++i) {
        if (!shown.usable[i] || !shown.usable[i - 1]) continue;
        const Pose &a = shown.X_WH[i - 1], &b = shown.X_WH[i];
        const double hand = std::hypot((b.p - a.p).norm(), rho * rotationVector(b.q * a.q.conjugate()).norm());
        grain.push_back(std::max(0.0, (shown.force[i] - shown.force[i - 1]).norm() - contact.stiffness * hand));
    }
    row.grain = tickSpreadOf(std::move(grain));
}

void countSuspended(const Shown& shown, PathCost& row) {
    std::size_t now = 0;
    for (const bool suspended : shown.suspended) {
        now = suspended ? now + 1 : 0;
        row.suspended += suspended ? 1 : 0;
        row.suspended_in_a_row = std::max(row.suspended_in_a_row, now);
    }
    for (const double depth : shown.depth) row.recorded = std::max(row.recorded, depth);
}

/// Of shapes whose overlap is judged [m]: balls and rings take very many triangles.
double chordFor(const scene::SceneSpec& scene) {
    const bool many = std::any_of(scene.parts.begin(), scene.parts.end(), [](const scene::PartSpec& part) {
        const auto* shape = std::get_if<shape::Shape>(&part.geometry);
        return shape != nullptr &&
               (std::holds_alternative<shape::Sphere>(*shape) || std::holds_alternative<shape::Torus>(*shape));
    });
    return many ? 5e-7 : 1e-7;
}

/// Why the forces of a contact are not those of a spring to a pose; empty if they are.
std::string noSpring(const scene::ContactSpec& contact) {
    const bool by_depth = !contact.rendersAtHand() || contact.variant == scene::PenaltyVariant::MaxNormalised;
    return by_depth ? "" : "no force to compare the penalty with: its variant is not a stiffness times a depth";
}

template <class T>
std::vector<T> orOwn(const std::vector<T>& list, std::vector<T> own) {
    return list.empty() ? std::move(own) : list;
}

/// The field settings of a method, from coarse to fine.
void addFieldSettings(const scene::ContactSpec& own, const TickSpace& space, ContactMethod method,
                      std::vector<TickSetting>& settings) {
    const auto tolerances = orOwn(space.tolerances, own.cell > 0.0 ? std::vector{own.tolerance}
                                                                   : std::vector{2.0 * own.tolerance, own.tolerance});
    for (const double tolerance : tolerances)
        for (const double spacing : orOwn(space.spacings, {2.0 * own.spacing, own.spacing}))
            for (const field::FieldMode mode : orOwn(space.modes, {own.mode}))
                for (const int ways : orOwn(space.ways, {own.two_way ? 2 : 1}))
                    for (const int budget : orOwn(space.budgets, {own.budget_nodes}))
                        settings.push_back({method, Geometry::Field, {mode, tolerance, spacing, budget}, ways == 2});
}

template <class ErrorOf>
void markFront(std::vector<PathCost>& rows, const ErrorOf& errorOf, bool PathCost::*flag) {
    for (PathCost& row : rows)
        row.*flag = std::isfinite(errorOf(row)) && std::none_of(rows.begin(), rows.end(), [&](const PathCost& other) {
                        return std::isfinite(errorOf(other)) && other.time.p999 <= row.time.p999 &&
                               errorOf(other) <= errorOf(row) &&
                               (other.time.p999 < row.time.p999 || errorOf(other) < errorOf(row));
                    });
}

}  // namespace

double cellOf(const scene::ContactSpec& own, const TickSetting& setting) {
    return setting.field.tolerance == own.tolerance ? own.cell : 0.0;
}

TickSpread tickSpreadOf(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    return {rankOf(values, 0.5), rankOf(values, 0.999), values.back()};
}

TickSettings tickSettings(const scene::SceneSpec& scene, const TickSpace& space) {
    TickSettings all;
    for (const ContactMethod method :
         orOwn(space.methods, {ContactMethod::Penalty, ContactMethod::GodObjectHeuristic, ContactMethod::GodObject}))
        for (const Geometry geometry :
             orOwn(space.geometries, {Geometry::ClosedForm, Geometry::Surface, Geometry::Field})) {
            scene::SceneSpec asked = scene;
            asked.contact.method = method;
            asked.contact.geometry = geometry;
            if (const auto problem = scene::geometryProblem(asked))
                all.left_out.push_back(fmt::format("{}: {}", scene::methodName(method), *problem));
            else if (geometry == Geometry::Field)
                addFieldSettings(scene.contact, space, method, all.settings);
            else
                all.settings.push_back({.method = method, .geometry = geometry});
        }
    return all;
}

void markTickFronts(std::vector<PathCost>& rows) {
    markFront(
        rows, [](const PathCost& row) { return row.overlap_bound; }, &PathCost::on_overlap_front);
    markFront(
        rows, [](const PathCost& row) { return row.force.p99; }, &PathCost::on_force_front);
}

Result<TickAccuracy> measureTicks(const scene::SceneSpec& scene, std::span<const Pose> path,
                                  const std::vector<TickSetting>& settings, const TickEffort& effort,
                                  const StepReport& report, scene::BuildStore* store) {
    if (scene.handCount() > 1)
        return Error{.message = "has more than one hand: what accuracy costs is measured with one", .key = "hand"};
    TickAccuracy result;
    scene::SceneSpec spec = scene;
    spec.registration = {};
    spec.effects.navigation = {};  // the path is that of the held part
    spec.start_gate = {};
    const ForceReference reference(spec);
    if (!reference.missing().empty()) result.notes.push_back("no force to compare with: " + reference.missing());
    scene::PartCache cache(store);
    OverlapBodies bodies(chordFor(scene));
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const SettingSteps steps(report, settingText(settings[i]), i, settings.size());
        steps.begin();
        spec.contact = contactOf(scene.contact, settings[i]);
        const auto built = scene::buildScene(spec, cache);
        if (!built) return built.errors();
        const Shown shown = show(*built, path, steps);
        const auto ticks = ticksToJudge(shown, effort.every);
        PathCost row{.setting = settings[i], .ticks = path.size()};
        measureSize(*built, row);
        countSuspended(shown, row);
        judgeGrain(shown, spec.contact, row);
        const SceneOverlap truth(*built, bodies);
        if (truth.hasObstacles()) judgeOverlap(shown, ticks, truth, steps, row);
        const std::string no_spring = noSpring(spec.contact);
        if (reference.missing().empty() && no_spring.empty()) judgeForce(shown, ticks, reference, row);
        if (!no_spring.empty() && std::find(result.notes.begin(), result.notes.end(), no_spring) == result.notes.end())
            result.notes.push_back(no_spring);
        timeTicks(*built, path, effort.repetitions, steps, row);
        result.rows.push_back(row);
    }
    report("", 1.0);
    markTickFronts(result.rows);
    return result;
}

}  // namespace passung::truth
