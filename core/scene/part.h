#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/geometry/mesh.h"
#include "core/import/mesh_import.h"
#include "core/scene/build_store.h"
#include "core/scene/scene_spec.h"
#include "core/shell/sphere_tree.h"

namespace passung::field {
class DistanceField;
struct DistanceSource;
}  // namespace passung::field

namespace passung::geometry {
class ClusterTree;
}

namespace passung::shell {
class EdgeCurves;
}

namespace passung::scene {

/// How deep the tolerance holds: from there on a tenth of the depth is wrong at most (FieldAccuracy), where the ridge
/// of the distances of two faces meets fine cells whose number grows with the depth.
inline constexpr double kDepthTolerances = 40.0;

/// What a scene needs of a part; what is not needed is not built.
struct PartNeeds {
    bool field = false;
    bool shell = false;
    bool clusters = false;
    double tolerance = 20e-6;  // of the field [m]; see chooseCell
    double cell = 0.0;         // of the field [m], the same everywhere; 0 = chosen from the tolerance
    double depth = 0.0;        // to which the tolerance holds [m]; 0 = kDepthTolerances times the tolerance
    double spacing = 1e-3;     // of the shell [m]
};

/// A part ready for contact: geometry, and what contact is computed from. Built once, then const.
struct Part {
    std::string name;
    std::optional<shape::Shape> shape;  // if parametric: its closed form is the truth
    geometry::TriangleMesh mesh;        // part frame, metres
    importer::MeshReport report;
    double chord_error = 0.0;                           // of the mesh against the shape, as reached [m]
    std::shared_ptr<const field::DistanceField> field;  // these two are shared by copies of the part
    std::optional<shell::SphereTree> shell;
    std::shared_ptr<const shell::EdgeCurves> edges;         // with the shell
    std::shared_ptr<const geometry::ClusterTree> clusters;  // of its triangles: a shape's are 1 µm off it at most, or
                                                            // as near as 200 000 of them get
};

/// Most points of a point shell, roughly: more take gigabytes and minutes to sample and do not fit a tick.
inline constexpr double kMaxShellPoints = 2e6;

/// Says that points `spacing` apart on a surface of this size and area would be more than kMaxShellPoints, mostly
/// because the unit is not what its author meant, and what to change; nothing if they are not. SI units.
std::optional<std::string> tooManyPoints(const Vec3& size, double area, double spacing);

/// Of the fields and shells in a store: whoever changes a bit of what is built from the same geometry and needs counts
/// on. tests/core/scene/kept_format_test.cpp holds the bits of this one.
inline constexpr int kKeptFormat = 2;

/// With a store, field and shell are taken from it if they are there for this geometry, these needs and kKeptFormat,
/// else kept there; they are the same bits. One that is damaged is built anew, which a note tells.
/// Errors: unreadable mesh, invalid shape, a field too large, a shell of too many points.
Result<Part> buildPart(const PartSpec& spec, const PartNeeds& needs, BuildStore* store = nullptr);

/// What the field of `part` takes of memory [bytes]; 0 without one.
std::size_t fieldBytes(const Part& part);

/// Exact distances to the geometry of `part`: the closed form of a shape, the triangles of a mesh.
/// The result holds what it needs; `part` may go.
field::DistanceSource exactSource(const Part& part);

/// The largest cell whose trilinear error, measured at fixed random points near the zero level, is ≤ `tolerance` for 90
/// % of them: about what smooth surface takes; edges are left to refinement. Tried are those halvings of a length that
/// end at kRidgeCells tolerances, from 1/32 of the part's longest side down to 1/1024. An open sheet begins at 1/256:
/// its zero level lies one cell in front of the surface, and that is the greater error.
double chooseCell(const field::DistanceSource& source, const geometry::TriangleMesh& mesh, double tolerance);

}  // namespace passung::scene
