#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/mesh.h"

namespace passung::importer {

/// What a mesh bounds, decided when it is repaired.
enum class SurfaceKind {
    Solid,       // closed, or all holes were closed: every edge is used as often in one direction as in the other
    HoledSolid,  // has an inside by the winding number, but some open edges were left
    OpenSheet,   // has no inside: felt on both sides
};

/// What a loaded mesh is like and what was done about it. Edges are those of the mesh after welding and dropping,
/// before triangles were turned; a count of what was wrong stays although it was put right. Triangles that close holes
/// are counted on their own.
struct MeshReport {
    std::string file;
    std::string format;
    double metres_per_unit = 1e-3;
    std::size_t triangles_read = 0;
    std::size_t triangles = 0;             // after the repair, before holes were closed
    std::size_t vertices = 0;              // after the repair, before holes were closed
    std::size_t welded_vertices = 0;       // equal positions joined; usual: STL repeats every corner
    std::size_t joined_vertices = 0;       // of open edges, closer than a millionth of the part's size: joined too
    std::size_t split_edges = 0;           // of one triangle, at a vertex of another such edge that lies on it
    std::size_t degenerate_triangles = 0;  // without area: dropped
    std::size_t duplicate_triangles = 0;   // same three corners, whichever way round: dropped but for the first
    std::size_t boundary_edges = 0;        // edges of one triangle
    std::size_t holes = 0;                 // closed chains of boundary edges; the border of an open sheet is one
    std::size_t non_manifold_edges = 0;    // edges of three or more triangles
    std::size_t inconsistent_edges = 0;    // two neighbours run the same way along an edge
    std::size_t turned_triangles = 0;      // the smaller side of such a quarrel: turned to agree with the other
    std::size_t shells = 0;                // pieces that hang together by edges
    std::size_t turned_patches = 0;        // cut off from the rest and facing the wrong way: turned
    std::size_t turned_patch_triangles = 0;
    std::size_t cavities = 0;            // shells inside a solid that bound a hollow in it
    std::size_t nested_solids = 0;       // shells inside a solid that face outwards like it
    std::size_t crossing_triangles = 0;  // an edge of another passes through them, or one of theirs through another
    std::size_t crossing_pairs = 0;      // of triangles that do so, counted from both sides
    bool watertight = false;             // every edge is used once in each direction, before holes were closed
    bool turned_inside_out = false;      // the inside was outside: all triangles were turned
    SurfaceKind kind = SurfaceKind::OpenSheet;
    std::size_t closed_holes = 0;
    std::size_t closed_seams = 0;       // open by name only: a vertex lies on a neighbour's edge
    std::size_t closing_triangles = 0;  // added for both: ImportedMesh::mesh has triangles + closing_triangles
    std::size_t open_edges_left = 0;    // of a solid: cracks, and holes that could not be closed
    Vec3 size = Vec3::Zero();           // [m]
    double area = 0.0;                  // [m²], before holes were closed
    double volume = 0.0;                // [m³]; of a solid, its holes closed; otherwise 0
    std::vector<std::string> notes;     // sentences: each defect and what was done about it
};

struct ImportedMesh {
    geometry::TriangleMesh mesh;
    MeshReport report;
};

/// How often a triangle may pass through others, in the mean: two solids that overlap have about 5, a lattice of struts
/// that were never merged 12. Scraps have more open edges than kScraps for a triangle: their field jumps wherever their
/// winding number passes a half, where there is no surface to refine it at, and would take many minutes.
inline constexpr double kMostCrossings = 20.0;
inline constexpr double kMostCrossingsOfScraps = 5.0;
inline constexpr double kScraps = 1.0;  // of three; 3 for triangles that share no edge

/// Reads a mesh file: STL, OBJ, PLY and OFF by ourselves (mesh_formats.h), glTF and 3MF by assimp, all nodes with their
/// transforms; as metres. `metres_per_unit` (> 0) applies to formats without a unit. glTF is in metres; a 3MF file
/// names its unit, millimetre if it names none. Polygons are cut into triangles; points and lines are ignored. Errors:
/// file missing, unreadable, empty, cut off or of another kind; no triangles with area; vertices that are not finite or
/// farther than 100 km from the origin; faces that name no vertex or too many; a surface whose triangles pass through
/// more than kMostCrossings others each, in the mean; fewer, kMostCrossingsOfScraps, of scraps that hardly hang
/// together.
Result<ImportedMesh> importMesh(const std::string& path, double metres_per_unit);

/// The same checks and repairs for triangles that are already in memory. @pre finite vertices, indices in range.
ImportedMesh repairMesh(geometry::TriangleMesh mesh);

}  // namespace passung::importer
