#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/import/mesh_formats.h"
#include "core/import/text_scanner.h"

namespace passung::importer {

namespace {

constexpr std::uint64_t kMost = 0xffffffffu;

/// The numbers of one face line after its count.
Result<Done> readFace(TextScanner& text, std::size_t vertices, geometry::TriangleMesh& mesh) {
    const std::string_view count_word = text.word();
    const auto count = numberIn<std::uint32_t>(count_word);
    if (!count) return text.error("a face must begin with its number of vertices", count_word);
    if (*count > kMostPolygonCorners) return text.error(kTooManyCorners, count_word);
    std::vector<std::uint32_t> corners;
    for (std::uint32_t k = 0; k < *count; ++k) {
        const std::string_view word = text.word();
        if (word.empty()) return text.error("the face must name " + std::to_string(*count) + " vertices");
        const auto v = numberIn<std::uint32_t>(word);
        if (vertices == 0) return text.error("a face names a vertex, and there are none", word);
        if (!v || *v >= vertices)
            return text.error("must be the number of a vertex, 0 to " + std::to_string(vertices - 1), word);
        corners.push_back(*v);
    }
    if (corners.size() >= 3) addPolygon(mesh, corners);
    return Done{};
}

}  // namespace

Result<geometry::TriangleMesh> readOff(std::string_view bytes, const std::string& file) {
    TextScanner text(bytes, file);
    if (!text.nextLine('#')) return text.error("must be an OFF file; this one is empty");
    const std::string_view keyword = text.word();
    if (keyword.size() < 3 || keyword.substr(keyword.size() - 3) != "OFF" || keyword.find("4") != keyword.npos ||
        keyword.find("n") != keyword.npos)
        return text.error("must begin with OFF, COFF, NOFF, STOFF or a mix of these", keyword);
    if (text.atLineEnd() && !text.nextLine('#'))
        return text.error("the file ends before its numbers of vertices and faces");
    std::uint64_t counts[2] = {0, 0};
    for (std::uint64_t& count : counts) {
        const std::string_view word = text.word();
        const auto value = numberIn<std::uint64_t>(word);
        if (!value || *value >= kMost) return text.error("must be the number of vertices, faces and edges", word);
        count = *value;
    }
    geometry::TriangleMesh mesh;
    for (std::uint64_t i = 0; i < counts[0]; ++i) {
        if (!text.nextLine('#'))
            return text.error("the file ends after " + std::to_string(i) + " of " + std::to_string(counts[0]) +
                              " vertices");
        const auto v = takeVertex(text);
        if (!v) return v.errors();
        mesh.vertices.push_back(*v);
    }
    for (std::uint64_t i = 0; i < counts[1]; ++i) {
        if (!text.nextLine('#'))
            return text.error("the file ends after " + std::to_string(i) + " of " + std::to_string(counts[1]) +
                              " faces");
        if (auto face = readFace(text, mesh.vertices.size(), mesh); !face) return face.errors();
    }
    return mesh;
}

}  // namespace passung::importer
