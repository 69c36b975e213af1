#include "tests/hard/case.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/motion/friction_balance.h"
#include "core/tick/god_object.h"
#include "core/tick/god_object_heuristic.h"
#include "core/tick/proxy.h"
#include "core/tick/surface_follow.h"
#include "core/tick/tick_model.h"
#include "tests/hard/follow.h"
#include "tests/hard/relaid.h"

namespace passung::hard {

namespace {

struct Caps {
    std::uint32_t iterations, looks;  // of a tick
    int rows, turns;                  // of a motion
};

/// Each look perhaps with a second one for its proof.
Caps capsOf(const Run& run) {
    const bool rubs = std::any_of(run.spec.parts.begin(), run.spec.parts.end(),
                                  [](const scene::PartSpec& part) { return part.friction > 0.0; });
    // Without friction every motion is found before the cap. With it a tight fit may come to the cap, and then every
    // solution of a turn, of which there are two at most, and the last one notices that by one more.
    const int rows = rubs ? motion::kMostSteps + 2 * motion::kFrictionSweeps + 1 : motion::kMaxIterations - 1;
    const int turns = rubs ? motion::kFrictionSweeps : 0;
    if (run.spec.contact.method == scene::ContactMethod::GodObject)
        return {tick::kSweeps, 2 * tick::kSweeps * (tick::kCuts + tick::kHalvings + 3), rows, turns};
    // Corrections with their halvings, then per sub-step an arrival, its return and the halvings with their reliefs.
    const int sub_step = 3 + (tick::kHalvings + 1) * (1 + tick::kReliefs);
    const int looks = 2 * (1 + tick::kCorrections * (tick::kHalvings + 2) + tick::kSubSteps * sub_step);
    return {tick::kSubSteps, static_cast<std::uint32_t>(looks), rows, turns};
}

/// What holds in every case.
std::string commonFaults(const Run& run) {
    const Caps caps = capsOf(run);
    const bool by_surfaces = run.spec.contact.geometry == scene::Geometry::Surface;  // nodes are units of work
    const scene::OutputLimits& limits = run.spec.limits;
    const double most_torque = limits.actuates_torque ? limits.max_torque : 0.0;
    for (std::size_t i = 0; i < run.ticks.size(); ++i) {
        const Tick& t = run.ticks[i];
        const auto fault = [&](const char* what) { return fmt::format("{} at tick {}", what, i); };
        if (!isFinite(t.sent) || !isFinite(t.proxy)) return fault("not finite");
        if (!(t.commanded.force.norm() <= limits.max_force)) return fault("above the force limit");
        if (!(t.commanded.torque.norm() <= most_torque)) return fault("above the torque limit");
        if (t.status & kNonFiniteLatched) return fault("a computed wrench was not finite");
        if (t.status & kContactCap) return fault("the manifold was full");
        if (!by_surfaces && t.contacts > run.most_points) return fault("more points than the cap");
        if (t.iterations > caps.iterations) return fault("more sub-steps than the cap");
        if (t.nodes > (by_surfaces ? 2u * tick::kSurfaceBudget : caps.looks * run.all_nodes))
            return fault("more nodes than the cap");
        if (static_cast<int>(t.rows) > caps.rows) return fault("a motion that took up more contacts than the cap");
        if (static_cast<int>(t.turns) > caps.turns) return fault("more turns of friction than the cap");
    }
    return {};
}

/// With the parts laid otherwise in their frames; the ticks are of the frames of `spec`.
Result<Run> runRelaid(const scene::SceneSpec& spec, std::uint64_t seed, double chord_error, const Drive& drive,
                      std::int64_t ticks) {
    const auto other = relaid(spec, seed, chord_error);
    if (!other) return other.errors();
    auto run = runScene(other->spec, drive, ticks);
    if (!run) return run;
    const Pose X_NH = other->X_HN.inverse();
    for (Tick& t : run->ticks) {
        const Vec3 from = t.device.p;
        t.device = t.device * X_NH;
        t.proxy = t.proxy * X_NH;
        t.sent.torque += (from - t.device.p).cross(t.sent.force);
    }
    run->spec = run->solids = spec;
    return run;
}

}  // namespace

std::span<const std::pair<scene::ContactMethod, const char*>> methods() {
    static constexpr std::array kMethods{std::pair{scene::ContactMethod::Penalty, "penalty"},
                                         std::pair{scene::ContactMethod::GodObjectHeuristic, "god_object_heuristic"},
                                         std::pair{scene::ContactMethod::GodObject, "god_object"}};
    return kMethods;
}

bool Measured::met(const Case& c) const { return judgement.value <= c.mark && judgement.broken.empty(); }

double Measured::p999_us() const {
    if (us.empty()) return 0.0;
    std::vector<double> sorted = us;
    const auto place = static_cast<std::size_t>(std::ceil(0.999 * static_cast<double>(us.size()))) - 1;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(place), sorted.end());
    return sorted[place];
}

bool fullSize() { return std::getenv("PASSUNG_HARD_FULL") != nullptr; }

const Case* findCase(const std::string& name) {
    for (const Case& c : cases())
        if (name == c.name) return &c;
    return nullptr;
}

Result<Run> runCase(const Case& c, scene::ContactMethod method, std::uint64_t seed, bool full) {
    auto spec = readHardScene(c.scene);
    if (!spec) return spec.errors();
    spec->contact.method = method;
    spec->contact.geometry = c.geometry;
    if (c.vary != nullptr && seed > 0) c.vary(*spec, seed);
    const Drive drive = c.drive(*spec, seed);
    const std::int64_t ticks = std::llround((full ? c.full_seconds : c.seconds) / kTickSeconds);
    auto run = c.relaid_chord > 0.0 && seed > 0 ? runRelaid(*spec, seed, c.relaid_chord, drive, ticks)
                                                : runScene(*spec, drive, ticks);
    if (run && c.solids != nullptr) run->solids = c.solids(*spec);
    return run;
}

std::string brokenRule(const Run& run) {
    const std::string fault = commonFaults(run);
    return fault.empty() ? followFault(run) : fault;
}

Judgement judgeRun(const Case& c, const Run& run) {
    Judgement found = c.judge(run);
    if (!std::isfinite(found.value) && found.broken.empty()) found.broken = "not a number";
    if (found.broken.empty()) found.broken = brokenRule(run);
    return found;
}

Result<Measured> measure(const Case& c, scene::ContactMethod method, bool full) {
    if (c.compute != nullptr) return c.compute();
    Measured result;
    result.judgement.value = c.adds ? 0.0 : -1e300;
    for (int seed = 0; seed < (full ? c.full_seeds : c.seeds); ++seed) {
        const auto run = runCase(c, method, static_cast<std::uint64_t>(seed), full);
        if (!run) return run.errors();
        const Judgement found = judgeRun(c, *run);
        result.judgement.value =
            c.adds ? result.judgement.value + found.value : std::max(result.judgement.value, found.value);
        if (result.judgement.broken.empty() && !found.broken.empty())
            result.judgement.broken = fmt::format("seed {}: {}", seed, found.broken);
        if (full) {  // hours: what is done is told
            fmt::print(stderr, "{} seed {}: {:.4g} {} {}\n", c.name, seed, found.value, c.unit, found.broken);
        }
        for (const Tick& t : run->ticks) {
            result.us.push_back(static_cast<double>(t.us));
            result.nodes = std::max(result.nodes, t.nodes);
            result.points = std::max(result.points, t.contacts);
            result.iterations = std::max(result.iterations, t.iterations);
            result.rows = std::max(result.rows, t.rows);
            result.turns = std::max(result.turns, t.turns);
        }
    }
    return result;
}

std::string describe(const Case& c, const char* method, const Measured& m) {
    return fmt::format(
        "{:6} {:28} {:20} {:>10.4g} <= {:<8.4g} {:5} {}{}{}; p99.9 {:.0f} us, {} nodes, {} points, {} "
        "iterations, {} rows, {} turns, {} ticks\n",
        m.met(c) ? "met" : "MISSED", c.name, method, m.judgement.value, c.mark, c.unit, c.figure,
        m.judgement.broken.empty() ? "" : "; ", m.judgement.broken, m.p999_us(), m.nodes, m.points, m.iterations,
        m.rows, m.turns, m.us.size());
}

}  // namespace passung::hard
