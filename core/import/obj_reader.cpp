#include <cstdint>
#include <vector>

#include "core/import/mesh_formats.h"
#include "core/import/text_scanner.h"

namespace passung::importer {

namespace {

/// `f 1 2/5 3//7 -1`: the first number of each group names a vertex, from 1, or back from the last one.
Result<Done> readFace(TextScanner& text, geometry::TriangleMesh& mesh) {
    std::vector<std::uint32_t> corners;
    const auto count = static_cast<std::int64_t>(mesh.vertices.size());
    for (std::string_view word = text.word(); !word.empty(); word = text.word()) {
        const auto number = numberIn<std::int64_t>(word.substr(0, word.find('/')));
        const std::int64_t index = !number ? -1 : *number < 0 ? count + *number : *number - 1;
        if (index < 0 || index >= count)
            return text.error("must be the number of a vertex above, 1 to " + std::to_string(count), word);
        corners.push_back(static_cast<std::uint32_t>(index));
    }
    if (corners.size() < 3) return text.error("a face needs three vertices or more");
    if (corners.size() > kMostPolygonCorners) return text.error(kTooManyCorners, std::to_string(corners.size()));
    addPolygon(mesh, corners);
    return Done{};
}

}  // namespace

Result<geometry::TriangleMesh> readObj(std::string_view bytes, const std::string& file) {
    geometry::TriangleMesh mesh;
    TextScanner text(bytes, file);
    while (text.nextLine('#')) {
        const std::string_view keyword = text.word();
        if (keyword == "v") {
            const auto v = takeVertex(text);
            if (!v) return v.errors();
            if (mesh.vertices.size() >= 0xfffffffeu) return text.error("more vertices than can be numbered");
            mesh.vertices.push_back(*v);
        } else if (keyword == "f") {
            if (auto face = readFace(text, mesh); !face) return face.errors();
        }
    }
    return mesh;
}

}  // namespace passung::importer
