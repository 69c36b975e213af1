// Prints what the ticks of hard cases cost: processor time, looks, points, contacts; and the hash of their outputs.
//   hard_cost METHOD [CASE...]       METHOD: penalty, god_object_heuristic, god_object; all cases without a name
// PASSUNG_COST_SECONDS: of every run, in place of the case's own.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/hard/case.h"

namespace {

using passung::hard::Tick;

/// Of sorted values.
double quantile(const std::vector<double>& sorted, double share) {
    const auto place = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
    return sorted[std::max<std::size_t>(place, 1) - 1];
}

template <class Of>
double meanOf(const std::vector<Tick>& ticks, Of of) {
    double sum = 0.0;
    for (const Tick& t : ticks) sum += static_cast<double>(of(t));
    return sum / static_cast<double>(ticks.size());
}

}  // namespace

int main(int argc, char** argv) {
    using namespace passung;
    if (argc < 2) return 1;
    const std::string wanted = argv[1];
    const char* budget = std::getenv("PASSUNG_COST_NODES");
    const char* seconds = std::getenv("PASSUNG_COST_SECONDS");
    for (const auto& [method, name] : hard::methods()) {
        if (wanted != name) continue;
        for (const hard::Case& c : hard::cases()) {
            const bool named = argc == 2 || std::any_of(argv + 2, argv + argc,
                                                        [&](const char* a) { return a == std::string(c.name); });
            if (!named || c.compute != nullptr || !hard::applies(c, method)) continue;
            hard::Case some = c;
            if (seconds != nullptr) some.seconds = std::atof(seconds);
            auto spec = hard::readHardScene(c.scene);
            if (!spec) return 1;
            spec->contact.method = method;
            spec->contact.geometry = scene::Geometry::Field;
            if (budget != nullptr) spec->contact.budget_nodes = std::atoi(budget);
            const auto run = hard::runScene(*spec, some.drive(*spec, 0), std::llround(some.seconds * 1000.0));
            if (!run) {
                fmt::print("{}: {}\n", c.name, toString(run.errors().front()));
                return 1;
            }
            const auto found = hard::judgeRun(c, *run);
            std::vector<double> us;
            std::size_t late = 0, suspended = 0;
            for (const Tick& t : run->ticks) {
                us.push_back(static_cast<double>(t.us));
                suspended += (t.status & kSuspended) != 0 ? 1 : 0;
                late += t.us > 1000.0f ? 1 : 0;
            }
            std::sort(us.begin(), us.end());
            fmt::print(
                "{:18} p50 {:7.1f} p99 {:7.1f} p99.9 {:7.1f} max {:7.1f} us, late {:4}, suspended {:4}; a tick: "
                "{:5.2f} looks {:7.0f} points {:6.0f} nodes {:6.1f} inside {:4.1f} steps; {:.4g} {} {}\n",
                c.name, quantile(us, 0.5), quantile(us, 0.99), quantile(us, 0.999), us.back(), late, suspended,
                meanOf(run->ticks, [](const Tick& t) { return t.looks; }),
                meanOf(run->ticks, [](const Tick& t) { return t.read; }),
                meanOf(run->ticks, [](const Tick& t) { return t.nodes; }),
                meanOf(run->ticks, [](const Tick& t) { return t.contacts; }),
                meanOf(run->ticks, [](const Tick& t) { return t.iterations; }), found.value, c.unit, found.broken);
            std::fflush(stdout);
        }
    }
    return 0;
}
