#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geometry/mesh.h"
#include "core/geometry/mesh_edges.h"

namespace passung::importer {

/// What was found about patches that share no edges, and done.
struct PatchOrientation {
    bool turned_all = false;         // the first patch to be judged bounds a solid inside out: so does the file
    std::size_t turned_patches = 0;  // not counting that
    std::size_t turned_triangles = 0;
    std::size_t cavities = 0;       // closed patches inside a solid that face its hollow
    std::size_t nested_solids = 0;  // closed patches inside a solid that face outwards like it
};

/// The triangles of each piece that is to be judged as a whole: patches that hang together by edges of two triangles.
/// Patches that are closed only together, at edges of more triangles, are one piece if they use every edge as often in
/// one direction as in the other: they agree as they are written, and the volume tells which way they face.
std::vector<std::vector<std::uint32_t>> piecesToOrient(const geometry::TriangleMesh& mesh,
                                                       const std::vector<geometry::HalfEdge>& edges);

/// Turns patches that no edge tells which way to face, because they are cut off from the rest by gaps, cracks or edges
/// of three and more triangles. Each patch is asked two things:
///   - what the others say: their winding number rises from its front to its back by D ∈ [-1, 1] (of a piece cut out of
///     a smooth solid, D = h/√(R² + h²) at a distance h in front of and behind a disk of radius R);
///   - what it says itself: B, the mean over its area of its own winding number just behind and just in front, added; 1
///     if it bounds a solid, 0 if it is flat, -1 if it bounds a solid inside out. This counts only where the others
///     leave it outside: inside a solid, a patch that faces inwards bounds a cavity.
/// It is turned if D + B < 0 (by more than the winding number's own error).
///   The kLargePatches largest are judged one after the other against those judged before: always the one with the
/// clearest D, or if none has any the one with the largest box, since what holds another has the larger box. The small
/// ones are many, so most face the right way; they are judged together against all others, some times over.
/// Where the mesh is nearer to a solid's winding numbers as it was written, all stays so: what is told from a patch's
/// surroundings errs where seams part it from them.
/// `patches`: the triangles of each; every triangle in one patch, neighbours within a patch agree.
PatchOrientation orientPatches(geometry::TriangleMesh& mesh, const std::vector<std::vector<std::uint32_t>>& patches);

}  // namespace passung::importer
