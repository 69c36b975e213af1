#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/import/mesh_formats.h"
#include "core/import/mesh_import.h"

/// libFuzzer: any bytes are a mesh or an error, and a mesh is repaired to one that holds what its report says. The
/// first byte chooses the format; 'b' is a binary STL file whose count and size agree, which no mutation would find.
namespace {

using namespace passung;

constexpr std::size_t kMostTriangles = 3000;  // repaired: more take too long for a fuzzer

void require(bool holds) {
    if (!holds) std::abort();
}

std::string binaryStl(std::string_view records) {
    std::string bytes(80, ' ');
    const std::size_t count = records.size() / 50;
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(count >> (8 * i)));
    return bytes + std::string(records.substr(0, 50 * count));
}

Result<geometry::TriangleMesh> read(char format, std::string_view bytes) {
    switch (format) {
        case 'b':
            return importer::readMesh(binaryStl(bytes), "f", "stl");
        case 's':
            return importer::readMesh(bytes, "f", "stl");
        case 'o':
            return importer::readMesh(bytes, "f", "off");
        case 'w':
            return importer::readMesh(bytes, "f", "obj");
        case 'p':
            return importer::readMesh(bytes, "f", "ply");
        default:
            return Error{.message = "none"};
    }
}

void requireSound(const geometry::TriangleMesh& mesh) {
    for (const Vec3& v : mesh.vertices) require(v.allFinite());
    for (const geometry::Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) require(v < mesh.vertices.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 1) return 0;
    auto mesh = read(static_cast<char>(data[0]), {reinterpret_cast<const char*>(data) + 1, size - 1});
    if (!mesh) {
        require(!mesh.errors().empty() && !mesh.errors()[0].message.empty());
        return 0;
    }
    requireSound(*mesh);
    if (mesh->triangles.size() > kMostTriangles) return 0;
    for (const Vec3& v : mesh->vertices)
        if (v.cwiseAbs().maxCoeff() > 1e5) return 0;  // importMesh refuses it
    const std::size_t count = mesh->triangles.size();
    const importer::ImportedMesh repaired = importer::repairMesh(std::move(*mesh));
    requireSound(repaired.mesh);
    const importer::MeshReport& r = repaired.report;
    require(r.triangles_read == count && r.triangles <= count + r.split_edges);
    require(r.triangles + r.degenerate_triangles + r.duplicate_triangles == count + r.split_edges);
    require(repaired.mesh.triangles.size() == r.triangles + r.closing_triangles);
    require(r.size.allFinite());
    return 0;
}
