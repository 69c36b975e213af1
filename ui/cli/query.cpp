#include <fmt/format.h>

#include <chrono>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/json.h"
#include "core/base/number_table.h"
#include "core/query/part_query.h"
#include "study/run/files/builds.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"
#include "ui/cli/part_argument.h"
#include "ui/cli/pose_table.h"

namespace passung::cli {

namespace {

constexpr std::size_t kPoseColumns = 7;

constexpr const char* kResultColumns =
    ",signed_distance_m,field_error_bound_m,error_bound_m,quality,status,closest_x_m,closest_y_m,closest_z_m,normal_x,"
    "normal_y,normal_z,force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,contacts,nodes_visited,points_"
    "tested,query_us";

Result<scene::Part> build(const std::string& path, const std::string& unit, const scene::PartNeeds& needs,
                          const run::ImportLimits& limits, ProgressLine& progress) {
    auto spec = partArgument(path, unit);
    if (!spec) return spec.errors();
    const auto store = run::openBuilds(limits, showBuilds(progress));
    auto part = scene::buildPart(*spec, needs, store.get());
    if (!part) {
        Errors errors = part.errors();
        for (Error& error : errors) {
            if (error.file.empty()) error.file = path;
        }
        return errors;
    }
    return part;
}

/// Columns of the poses' file that have the name of a result.
Errors refuseResultNames(const std::string& path, const NumberTable& table) {
    Errors errors;
    for (std::size_t i = kPoseColumns; i < table.columns.size(); ++i) {
        const std::string& name = table.columns[i];
        if (std::string(kResultColumns).append(",").find("," + name + ",") == std::string::npos) continue;
        errors.push_back({.message = "is the name of a result; give this column another",
                          .file = path,
                          .line = 1,
                          .column = 1,
                          .value = name});
    }
    return errors;
}

/// `tolerance`: asked for [m].
std::string statusOf(const query::PartQueryResult& r, double tolerance) {
    std::string status;
    const auto add = [&](bool holds, const char* word) {
        if (!holds) return;
        if (!status.empty()) status += '+';
        status += word;
    };
    add(r.beyond_proximity, "beyond_proximity");
    add(r.budget_reached, "budget_reached");
    add(r.quality_overruled_budget, "quality_overruled_budget");
    add(!r.beyond_proximity && !(r.error_bound <= tolerance), "bound_not_reached");
    return status.empty() ? "ok" : status;
}

/// `input`: the row as the file writes it.
void writeRow(fmt::memory_buffer& text, std::string_view input, const query::PartQueryResult& r, double tolerance,
              double us) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{},", input);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Vec3 closest = r.beyond_proximity ? Vec3(Vec3::Constant(nan)) : r.closest;
    const Vec3 normal = r.beyond_proximity ? Vec3(Vec3::Constant(nan)) : r.normal;
    fmt::format_to(out, "{},{},{},{},{}", r.signed_distance, r.field_error_bound, r.error_bound, r.quality,
                   statusOf(r, tolerance));
    for (const Vec3& v : {closest, normal, r.wrench.force, r.wrench.torque}) {
        for (int axis = 0; axis < 3; ++axis) fmt::format_to(out, ",{}", v[axis]);
    }
    fmt::format_to(out, ",{},{},{},{:.3f}\n", r.contacts, r.nodes_visited, r.points_tested, us);
}

std::string patchJson(const contact::ContactCluster& patch, double area_stiffness) {
    return JsonObject()
        .json("deepest_m", jsonVector(patch.deepest))
        .number("depth_m", -patch.phi)
        .json("normal", jsonVector(patch.normal))
        .number("area_m2", patch.area)
        .number("volume_m3", patch.volume)
        .json("pressure_point_m", jsonVector(patch.pressure_point))
        .json("force_N", jsonVector(area_stiffness * patch.push))
        .integer("points", patch.points)
        .str();
}

/// One pose's patches, in the FIELD's frame; `row` counts the poses from 1.
std::string patchesJson(std::size_t row, const query::PartQueryResult& result, double area_stiffness) {
    std::vector<std::string> patches;
    for (const contact::ContactCluster& patch : result.patches) patches.push_back(patchJson(patch, area_stiffness));
    return JsonObject()
        .integer("row", static_cast<std::int64_t>(row))
        .integer("patches_found", static_cast<std::int64_t>(result.patches_found))
        .json("patches", jsonList(patches))
        .str();
}

}  // namespace

int query(const QueryArguments& options) {
    for (const std::string& out : {options.out, options.patches}) {
        if (out.empty()) continue;
        if (const auto free = refuseOverwriting(out, {options.field, options.shell, options.poses}); !free)
            return fail(free.errors());
    }
    if (options.patches == options.out)
        return fail({{.message = "is the file of the results too; give the patches another", .file = options.patches}});
    if (options.two_way && !options.patches.empty())
        return fail({{.message = "--patches lists SHELL's points in FIELD only: leave out --two-way, or ask again with "
                                 "FIELD and SHELL exchanged for the other way",
                      .file = options.patches}});
    NumberTable table;
    const auto poses = readPoses(options.poses, table);
    if (!poses) return fail(poses.errors());
    if (const Errors errors = refuseResultNames(options.poses, table); !errors.empty()) return fail(errors);
    const scene::PartNeeds common{
        .tolerance = options.tolerance_um * 1e-6, .cell = options.cell_mm * 1e-3, .spacing = options.spacing_mm * 1e-3};
    scene::PartNeeds field_needs = common, shell_needs = common;
    field_needs.field = shell_needs.shell = true;
    field_needs.shell = shell_needs.field = options.two_way;
    ProgressLine progress;
    progress.show("building " + options.field);
    const auto field = build(options.field, options.field_unit.empty() ? options.unit : options.field_unit, field_needs,
                             options.import_limits, progress);
    if (!field) return fail(field.errors());
    progress.show("building " + options.shell);
    const auto shell = build(options.shell, options.shell_unit.empty() ? options.unit : options.shell_unit, shell_needs,
                             options.import_limits, progress);
    if (!shell) return fail(shell.errors());

    query::PartQueryRequest request;
    if (options.proximity_mm) request.proximity = *options.proximity_mm * 1e-3;
    request.max_nodes = options.budget_nodes;
    request.quality = options.quality;
    request.tolerance = options.tolerance_um * 1e-6;
    request.two_way = options.two_way;
    request.patches = !options.patches.empty();
    request.mode = field::modeNamed(options.mode).value_or(request.mode);
    query::PartQuery part_query(*field, *shell, request);
    OutputFile out(options.out);
    out.write(table.headerLine() + kResultColumns + '\n');
    std::optional<OutputFile> patches;
    if (request.patches) patches.emplace(options.patches).write("{\"poses\": [");
    fmt::memory_buffer text;
    for (std::size_t i = 0; i < poses->size(); ++i) {
        const auto begin = std::chrono::steady_clock::now();
        const query::PartQueryResult result = part_query.at((*poses)[i]);
        const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
        text.clear();
        writeRow(text, table.rowLine(i), result, request.tolerance, took.count());
        out.write({text.data(), text.size()});
        if (patches) patches->write((i > 0 ? ",\n" : "\n") + patchesJson(i + 1, result, request.area_stiffness));
        if (i % 1000 == 0) progress.show(fmt::format("{} of {} poses", i, poses->size()));
    }
    if (patches) {
        patches->write("\n]}\n");
        if (const auto done = patches->commit(); !done) return fail(done.errors());
    }
    const auto done = out.commit();
    return done ? 0 : fail(done.errors());
}

}  // namespace passung::cli
