#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/import/mesh_formats.h"
#include "core/import/text_scanner.h"

namespace passung::importer {

namespace {

constexpr std::size_t kHead = 84, kRecord = 50;  // bytes of the head, and of a triangle

std::uint32_t word32(const char* bytes) {
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

Result<geometry::TriangleMesh> readBinary(std::string_view bytes, std::size_t count, const std::string& file) {
    geometry::TriangleMesh mesh;
    mesh.vertices.reserve(3 * count);
    mesh.triangles.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const char* corner = bytes.data() + kHead + i * kRecord + 12;
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (int k = 0; k < 3; ++k) {
            Vec3 v;
            for (int axis = 0; axis < 3; ++axis, corner += 4)
                v[axis] = static_cast<double>(std::bit_cast<float>(word32(corner)));
            if (!v.allFinite())
                return Error{.message = "every coordinate must be finite",
                             .file = file,
                             .key = "triangle " + std::to_string(i + 1)};
            mesh.vertices.push_back(v);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

/// Facets are read by their vertices; the other words frame them.
Result<geometry::TriangleMesh> readText(std::string_view bytes, const std::string& file) {
    geometry::TriangleMesh mesh;
    TextScanner text(bytes, file);
    std::size_t corners = 0;  // of the facet so far
    bool in_loop = false, in_facet = false, in_solid = false;
    while (text.nextLine(0)) {
        const std::string_view word = text.word();
        if (word == "outer") {
            in_loop = true;
            corners = 0;
        } else if (word == "vertex") {
            if (!in_loop || corners == 3) return text.error("a facet must have one loop of three vertices");
            const auto v = takeVertex(text);
            if (!v) return v.errors();
            mesh.vertices.push_back(*v);
            ++corners;
        } else if (word == "endloop") {
            if (!in_loop || corners != 3) return text.error("a facet must have one loop of three vertices");
            in_loop = false;
            const auto end = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.triangles.push_back({end - 3, end - 2, end - 1});
        } else if (word == "solid" || word == "endsolid") {
            in_solid = word == "solid";
        } else if (word == "facet" || word == "endfacet") {
            in_facet = word == "facet";
        } else {
            return text.error("must be one of solid, facet, outer loop, vertex, endloop, endfacet, endsolid", word);
        }
    }
    if (in_loop || in_facet) return text.error("the file ends within a facet");
    if (in_solid) return text.error("the file ends within a solid: it is cut off, or endsolid is missing");
    return mesh;
}

}  // namespace

Result<geometry::TriangleMesh> readStl(std::string_view bytes, const std::string& file) {
    if (bytes.size() >= kHead) {
        const std::uint64_t count = word32(bytes.data() + kHead - 4);
        if (bytes.size() == kHead + kRecord * count) return readBinary(bytes, static_cast<std::size_t>(count), file);
    }
    const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
    // A binary head may begin with "solid" too; text has no bytes of 0.
    if (begin != std::string_view::npos && bytes.substr(begin, 5) == "solid" &&
        bytes.substr(0, kHead).find('\0') == std::string_view::npos)
        return readText(bytes, file);
    if (bytes.size() < kHead)
        return Error{.message = "must begin with \"solid\" or with the 84 bytes of a binary STL file, has " +
                                std::to_string(bytes.size()) + " bytes",
                     .file = file};
    const std::uint64_t count = word32(bytes.data() + kHead - 4);
    return Error{.message = "must be an STL file: a binary one of " + std::to_string(count) + " triangles has " +
                            std::to_string(kHead + kRecord * count) + " bytes, this one " +
                            std::to_string(bytes.size()),
                 .file = file};
}

}  // namespace passung::importer
