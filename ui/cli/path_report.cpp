#include "ui/cli/path_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <span>

#include "core/base/json.h"
#include "core/base/printable.h"

namespace passung::cli {

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kShortestPrinted = 5e-6;  // [m] less is a length of 0.00 mm

/// Clearances of this path are those of contacts.
bool slides(const path::PathMeasures& of) { return !(of.proven > 0.0) && of.least.distance < feasible::kTouch; }

/// What is known of a path that was found.
void addPath(JsonObject& json, const feasible::StepPath& path) {
    const path::PathMeasures& of = path.measures;
    json.number("length_m", of.length).number("turn_rad", of.turn).number("clearance_m", of.least.distance);
    if (of.proven > 0.0) json.number("proven_clearance_m", of.proven);
    json.boolean("slides", slides(of));
    if (!path.nearest.empty()) json.text("nearest", path.nearest).json("nearest_at_m", jsonVector(of.least.where));
}

std::string stepJson(const feasible::StepPath& path) {
    JsonObject json;
    json.text("step", path.name).text("part", path.part).boolean("found", path.found);
    if (path.found)
        addPath(json, path);
    else
        json.text("why", path.why).boolean("is_proof", path.is_proof);
    return json.number("search_s", path.seconds).str();
}

std::string groupJson(const GeometryGroup& group) {
    std::vector<std::string> conditions, steps;
    for (const std::string& name : group.conditions) conditions.push_back(jsonText(name));
    for (const feasible::StepPath& path : group.paths) steps.push_back("\n" + stepJson(path));
    return JsonObject().json("conditions", jsonList(conditions)).json("steps", jsonList(steps)).str();
}

}  // namespace

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
    std::string proven;
    if (of.proven > 0.0)
        proven = fmt::format("; nowhere less than {:.1f} um", 1e6 * of.proven);
    else if (slides(of))
        proven = "; slides along contacts";
    fmt::print("  {:<16}{:<7}{:>10.1f}{:>10.1f}{:>14.1f}{:>9.1f}  {}{}\n", printable(path.name), "found",
               1e3 * of.length, kDegrees * of.turn, 1e6 * of.least.distance, path.seconds, where, proven);
}

void printKeys(const GeometryGroup& group) {
    if (group.scene->effects.pick.steps.empty()) return;
    fmt::print("  for the [[task.step]] of each:\n");
    for (const feasible::StepPath& path : group.paths)
        if (path.found && path.measures.length > kShortestPrinted)
            fmt::print("  path_mm = {:<10.2f}# {}\n", 1e3 * path.measures.length, printable(path.name));
}

std::string pathsJson(const std::vector<GeometryGroup>& groups) {
    std::vector<std::string> geometries;
    geometries.reserve(groups.size());
    for (const GeometryGroup& group : groups) geometries.push_back("\n" + groupJson(group));
    return JsonObject().json("geometries", jsonList(geometries)).str() + "\n";
}

}  // namespace passung::cli
