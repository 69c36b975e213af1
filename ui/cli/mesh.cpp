#include <fmt/format.h>

#include "core/scene/part.h"
#include "study/run/files/builds.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"
#include "ui/cli/part_argument.h"

namespace passung::cli {

namespace {

std::string volume(const importer::MeshReport& r) {
    if (r.kind == importer::SurfaceKind::OpenSheet) return "none (an open sheet)";
    if (r.kind == importer::SurfaceKind::HoledSolid) return "not defined (gaps are left)";
    const bool overlaps = r.crossing_triangles + r.nested_solids > 0;
    return fmt::format("{:.6g} mm³{}{}", r.volume * 1e9, r.watertight ? "" : " (as repaired)",
                       overlaps ? " (overlaps counted twice)" : "");
}

/// How contact takes the surface.
std::string inside(const importer::MeshReport& r) {
    switch (r.kind) {
        case importer::SurfaceKind::OpenSheet:
            return "none: an open sheet, felt on both sides";
        case importer::SurfaceKind::HoledSolid:
            return "by the winding number: a solid with gaps, without error bounds";
        case importer::SurfaceKind::Solid:
            break;
    }
    return r.watertight ? "a closed solid" : "a closed solid, as repaired";
}

/// Where the part's own origin, about which it is placed and turned, lies.
std::string originOf(const Vec3& low, const Vec3& high) {
    const double least = (low.cwiseMax(-high)).maxCoeff();  // > 0: how far outside the bounds, along one axis
    const double from_centre = (0.5 * (low + high)).norm();
    return fmt::format("{} the bounds, {:.6g} mm from their centre", least > 0.0 ? "outside" : "within",
                       1e3 * from_centre);
}

}  // namespace

int mesh(const MeshArguments& options) {
    const auto spec = partArgument(options.file, options.unit);
    if (!spec) return fail(spec.errors());
    const auto part = scene::buildPart(*spec, {}, run::openBuilds(options.import_limits).get());
    if (!part) return fail(part.errors());
    const importer::MeshReport& r = part->report;
    fmt::print("{}\n", options.file);
    const auto line = [](std::string_view name, const std::string& value) { fmt::print("  {:<22}{}\n", name, value); };
    line("format", r.format);
    if (part->shape) {
        for (const auto& [key, value] : shape::namedDimensions(*part->shape))
            line(key, fmt::format("{:.7g} mm", 1e3 * value));
        line("chord error", fmt::format("{:.2g} mm", 1e3 * part->chord_error));
    } else {
        line("unit", fmt::format("{} m", r.metres_per_unit));
    }
    line("triangles", r.triangles == r.triangles_read ? std::to_string(r.triangles)
                                                      : fmt::format("{} of {} read", r.triangles, r.triangles_read));
    line("vertices", std::to_string(r.vertices));
    line("size", fmt::format("{:.6g} x {:.6g} x {:.6g} mm", r.size.x() * 1e3, r.size.y() * 1e3, r.size.z() * 1e3));
    const auto corner = [](const Vec3& v) {
        return fmt::format("{:.6g}, {:.6g}, {:.6g} mm", v.x() * 1e3, v.y() * 1e3, v.z() * 1e3);
    };
    const auto [low, high] = geometry::boundsOf(part->mesh);
    line("least x, y, z", corner(low));
    line("greatest x, y, z", corner(high));
    line("centre of bounds", corner(0.5 * (low + high)));
    line("origin", originOf(low, high));
    line("area", fmt::format("{:.6g} mm²", r.area * 1e6));
    line("volume", volume(r));
    line("inside", inside(r));
    line("watertight", r.watertight ? "yes" : "no");
    line("shells", std::to_string(r.shells));
    line("holes", std::to_string(r.holes));
    line("boundary edges", std::to_string(r.boundary_edges));
    line("non-manifold edges", std::to_string(r.non_manifold_edges));
    line("inconsistent edges", std::to_string(r.inconsistent_edges));
    line("crossing triangles", std::to_string(r.crossing_triangles));
    line("degenerate triangles", std::to_string(r.degenerate_triangles));
    line("duplicate triangles", std::to_string(r.duplicate_triangles));
    fmt::print("  {}\n", r.notes.empty() ? "nothing to repair" : "found, and what was done:");
    for (const std::string& note : r.notes) fmt::print("    - {}\n", note);
    return 0;
}

}  // namespace passung::cli
