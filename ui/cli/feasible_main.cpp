#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "analysis/export/table.h"
#include "core/base/printable.h"
#include "study/feasible/step_paths.h"
#include "study/run/files/builds.h"
#include "study/run/files/protocol_files.h"
#include "ui/cli/console.h"
#include "ui/cli/safe_output.h"

// The program passung-feasible: `passung feasible` becomes it, so that nothing else loads OMPL. Words: PROTOCOL OUT
// SEED SECONDS IMPORT_SECONDS IMPORT_BYTES; OUT may be empty.

namespace {

using namespace passung;

constexpr int kWords = 7;
constexpr double kDegrees = 180.0 / std::numbers::pi;

struct Words {
    std::string protocol, out;
    feasible::Settings settings;
    run::ImportLimits import_limits;
};

Words wordsOf(char** argv) {
    Words words{argv[1], argv[2], {}, {}};
    words.settings.seed = static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 10));
    words.settings.seconds = std::strtod(argv[4], nullptr);
    words.import_limits = {std::strtod(argv[5], nullptr), std::strtoull(argv[6], nullptr, 10)};
    return words;
}

/// Conditions of one geometry, and what was found out for them.
struct GeometryGroup {
    std::vector<std::string> conditions;
    const scene::SceneSpec* scene = nullptr;
    std::vector<feasible::PathProblem> problems;
    std::vector<feasible::StepPath> paths = {};
};

std::vector<GeometryGroup> groupsOf(const plan::StudyPlan& plan) {
    std::vector<GeometryGroup> groups;
    std::map<std::string, std::size_t> known;
    const std::size_t count = plan::plannedConditions(plan);
    for (std::size_t i = 0; i < count; ++i) {
        const plan::Condition& condition = plan.conditions[i];
        auto problems = feasible::problemsOf(condition);
        if (problems.empty()) continue;
        const auto [at, is_new] = known.emplace(feasible::geometryText(condition.scene, problems), groups.size());
        if (is_new) groups.push_back({{}, &condition.scene, std::move(problems)});
        groups[at->second].conditions.push_back(condition.name);
    }
    return groups;
}

void printHead(const GeometryGroup& group) {
    constexpr std::size_t kNamed = 4;
    const auto named = std::span(group.conditions).first(std::min(kNamed, group.conditions.size()));
    const std::size_t more = group.conditions.size() - named.size();
    fmt::print("\nconditions {}{}\n", printable(fmt::format("{}", fmt::join(named, ", "))),
               more > 0 ? fmt::format(" and {} more", more) : "");
    fmt::print("  {:<16}{:<7}{:>10}{:>10}{:>14}{:>9}  {}\n", "step", "path", "length mm", "turn deg", "clearance um",
               "seconds", "nearest");
}

void printPath(const feasible::StepPath& path) {
    if (!path.found) {
        fmt::print("  {:<16}{:<7}{:>10}{:>10}{:>14}{:>9.1f}\n", printable(path.name), "none", "-", "-", "-",
                   path.seconds);
        return;
    }
    const path::PathMeasures& of = path.measures;
    const Vec3 at = 1e3 * of.least.where;
    const std::string where = path.nearest.empty() ? "nothing within 10 mm"
                                                   : fmt::format("{} at {:.4g}, {:.4g}, {:.4g} mm",
                                                                 printable(path.nearest), at.x(), at.y(), at.z());
    constexpr double kTouching = 2e-6;  // [m]
    std::string proven;
    if (of.proven > 0.0)
        proven = fmt::format("; nowhere less than {:.1f} um", 1e6 * of.proven);
    else if (of.least.distance < kTouching)
        proven = "; slides along contacts";
    fmt::print("  {:<16}{:<7}{:>10.1f}{:>10.1f}{:>14.1f}{:>9.1f}  {}{}\n", printable(path.name), "found",
               1e3 * of.length, kDegrees * of.turn, 1e6 * of.least.distance, path.seconds, where, proven);
}

exporter::Table tableOf(std::initializer_list<const char*> columns) {
    exporter::Table table;
    for (const char* name : columns) table.columns.push_back({name, "", "", "", "", 1, {}});
    return table;
}

exporter::Table waypointsOf(const GeometryGroup& group) {
    exporter::Table table = tableOf({"step", "waypoint", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz", "clearance_m"});
    for (const feasible::StepPath& path : group.paths) {
        for (std::size_t i = 0; i < path.poses.size(); ++i) {
            const Pose& X = path.poses[i];
            std::vector<std::string> row{path.name, exporter::cell(static_cast<std::int64_t>(i + 1))};
            for (const double value :
                 {X.p.x(), X.p.y(), X.p.z(), X.q.w(), X.q.x(), X.q.y(), X.q.z(), path.measures.at_waypoints[i]})
                row.push_back(exporter::cell(value));
            table.rows.push_back(std::move(row));
        }
    }
    return table;
}

Result<Done> writeTable(const std::string& path, const exporter::Table& table) {
    cli::OutputFile file(path);
    file.write(exporter::toCsv(table));
    return file.commit();
}

Result<Done> write(const std::string& folder, const std::vector<GeometryGroup>& groups) {
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (problem) return Error{.message = problem.message(), .file = folder};
    exporter::Table key = tableOf({"geometry", "condition"});
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const std::string path = fmt::format("{}/paths_{}.csv", folder, i + 1);
        if (auto done = writeTable(path, waypointsOf(groups[i])); !done) return done;
        for (const std::string& name : groups[i].conditions)
            key.rows.push_back({exporter::cell(static_cast<std::int64_t>(i + 1)), name});
    }
    return writeTable(folder + "/geometries.csv", key);
}

/// Steps without a path, a line each.
Errors missing(const std::string& protocol, const std::vector<GeometryGroup>& groups) {
    Errors errors;
    for (const GeometryGroup& group : groups)
        for (const feasible::StepPath& path : group.paths)
            if (!path.found)
                errors.push_back(
                    {.message = path.why,
                     .file = protocol,
                     .key = "step " + path.name,
                     .value = group.conditions.front() + (group.conditions.size() > 1
                                                              ? fmt::format(" and {} more", group.conditions.size() - 1)
                                                              : "")});
    return errors;
}

int search(const Words& words) {
    cli::ProgressLine progress;
    const auto store = run::openBuilds(words.import_limits, cli::showBuilds(progress));
    const auto plan =
        progress.whileReading(words.protocol, [&] { return run::readProtocol(words.protocol, words.import_limits); });
    if (!plan) return cli::fail(plan.errors());
    std::vector<GeometryGroup> groups = groupsOf(*plan);
    if (groups.empty()) {
        fmt::print("there is nothing to search: no condition is an assembly or a peg_in_hole\n");
        return 0;
    }
    feasible::seed(words.settings);
    scene::PartCache cache(store.get());
    truth::OverlapBodies bodies;
    for (GeometryGroup& group : groups) {
        printHead(group);
        for (const feasible::PathProblem& problem : group.problems) {
            progress.show("searching a path for " + printable(problem.name));
            const auto path = feasible::pathOf(*group.scene, problem, cache, bodies, words.settings);
            if (!path) return cli::fail(path.errors());
            progress.show("");
            printPath(*path);
            std::fflush(stdout);
            group.paths.push_back(*path);
        }
    }
    if (!words.out.empty())
        if (const auto done = write(words.out, groups); !done) return cli::fail(done.errors());
    const Errors errors = missing(words.protocol, groups);
    return errors.empty() ? 0 : cli::fail(errors);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != kWords) {
        std::fprintf(stderr, "passung-feasible searches paths for passung: passung feasible PROTOCOL\n");
        return 2;
    }
    cli::makeOutputSafe();
    try {
        return search(wordsOf(argv));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
}
