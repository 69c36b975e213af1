#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/mesh.h"

namespace passung::importer {

/// The formats that are read here, from the bytes of a file, as they stand: no unit, no repair. Whatever the bytes are,
/// the answer is a mesh whose coordinates are finite and whose triangles name vertices that exist, or one error with
/// the line of a text file; memory stays within a few times the bytes. Polygons are cut into triangles; points and
/// lines, normals, colours and textures are passed over. `file` is for errors.

/// Text or binary; which of them is decided by the size that a binary file states.
Result<geometry::TriangleMesh> readStl(std::string_view bytes, const std::string& file);
/// Text.
Result<geometry::TriangleMesh> readOff(std::string_view bytes, const std::string& file);
/// Text; vertices and faces of all groups.
Result<geometry::TriangleMesh> readObj(std::string_view bytes, const std::string& file);
/// Text, little and big endian.
Result<geometry::TriangleMesh> readPly(std::string_view bytes, const std::string& file);

/// By what the file's name ends in (lower case): one of these, or glTF and 3MF by assimp, from the file
/// itself.
Result<geometry::TriangleMesh> readMesh(std::string_view bytes, const std::string& file, const std::string& extension);

/// Corners that a polygon may have: the search for its ears grows with the square, and a fan of many more, slivers
/// about one corner, would take a distance field minutes and gigabytes.
inline constexpr std::size_t kMostPolygonCorners = 1000;
inline constexpr const char* kTooManyCorners = "a face must have at most 1000 corners: cut it into triangles";

/// Cuts a polygon of `mesh` into triangles by ears, so that a concave one is not filled beyond its border; one that is
/// not simple becomes a fan. @pre three to kMostPolygonCorners corners, all in range.
void addPolygon(geometry::TriangleMesh& mesh, const std::vector<std::uint32_t>& corners);

}  // namespace passung::importer
