#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "analysis/export/table.h"
#include "core/base/printable.h"
#include "study/feasible/step_paths.h"
#include "study/run/files/builds.h"
#include "study/run/files/protocol_files.h"
#include "ui/cli/console.h"
#include "ui/cli/path_report.h"
#include "ui/cli/safe_output.h"

// The program passung-feasible: `passung feasible` becomes it, so that nothing else loads OMPL. Words: PROTOCOL FORM
// OUT SEED SECONDS IMPORT_SECONDS IMPORT_BYTES; OUT may be empty.

namespace {

using namespace passung;

using cli::GeometryGroup;

constexpr int kWords = 8;

struct Words {
    std::string protocol;
    std::string form;  // table; keys: lines for the protocol follow it; json: in place of it
    std::string out;
    feasible::Settings settings;
    run::ImportLimits import_limits;
};

Words wordsOf(char** argv) {
    Words words{argv[1], argv[2], argv[3], {}, {}};
    words.settings.seed = static_cast<std::uint32_t>(std::strtoul(argv[4], nullptr, 10));
    words.settings.seconds = std::strtod(argv[5], nullptr);
    words.import_limits = {std::strtod(argv[6], nullptr), std::strtoull(argv[7], nullptr, 10)};
    return words;
}

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

/// Searches all paths and prints them as they are found, unless they are printed as JSON.
Result<Done> searchAll(const Words& words, scene::BuildStore* builds, std::vector<GeometryGroup>& groups,
                       cli::ProgressLine& progress) {
    const bool prints = words.form != "json";
    scene::PartCache cache(builds);
    truth::OverlapBodies bodies;
    for (GeometryGroup& group : groups) {
        if (prints) cli::printHead(group);
        for (const feasible::PathProblem& problem : group.problems) {
            progress.show("searching a path for " + printable(problem.name));
            const auto path = feasible::pathOf(*group.scene, problem, cache, bodies, words.settings);
            if (!path) return path.errors();
            progress.show("");
            if (prints) cli::printPath(*path);
            std::fflush(stdout);
            group.paths.push_back(*path);
        }
        if (words.form == "keys") cli::printKeys(group);
    }
    return Done{};
}

int search(const Words& words) {
    cli::ProgressLine progress;
    const auto store = run::openBuilds(words.import_limits, cli::showBuilds(progress));
    const auto plan =
        progress.whileReading(words.protocol, [&] { return run::readProtocol(words.protocol, words.import_limits); });
    if (!plan) return cli::fail(plan.errors());
    std::vector<GeometryGroup> groups = groupsOf(*plan);
    if (groups.empty() && words.form != "json") {
        fmt::print("there is nothing to search: no condition is an assembly or a peg_in_hole\n");
        return 0;
    }
    feasible::seed(words.settings);
    if (const auto done = searchAll(words, store.get(), groups, progress); !done) return cli::fail(done.errors());
    if (words.form == "json") fmt::print("{}", cli::pathsJson(groups));
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
