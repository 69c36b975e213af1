#include "core/model/mesh_import.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <minizip/unzip.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

namespace passung::model {

namespace {

Error fileError(const std::string& path, const std::string& message) {
    Error error;
    error.file = path;
    error.message = message;
    return error;
}

std::string extensionOf(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    if (!extension.empty()) extension.erase(0, 1);
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

/// The beginning of a 3MF package's model part, empty if there is none.
std::string readModelHead(const std::string& path) {
    std::string head;
    const unzFile package = unzOpen(path.c_str());
    if (package == nullptr) return head;
    constexpr int kIgnoreCase = 2;
    if (unzLocateFile(package, "3D/3dmodel.model", kIgnoreCase) == UNZ_OK && unzOpenCurrentFile(package) == UNZ_OK) {
        std::array<char, 16384> buffer{};
        const int read = unzReadCurrentFile(package, buffer.data(), static_cast<unsigned>(buffer.size()));
        if (read > 0) head.assign(buffer.data(), static_cast<std::size_t>(read));
        unzCloseCurrentFile(package);
    }
    unzClose(package);
    return head;
}

/// The value of the attribute `unit` of the element <model>, if there is one.
std::optional<std::string> modelUnit(const std::string& xml) {
    const std::size_t begin = xml.find("<model");
    if (begin == std::string::npos) return std::nullopt;
    const std::string_view tag = std::string_view(xml).substr(begin, xml.find('>', begin) - begin);
    for (std::size_t at = tag.find("unit"); at != std::string_view::npos; at = tag.find("unit", at + 1)) {
        if (std::isspace(static_cast<unsigned char>(tag[at - 1])) == 0) continue;
        const std::size_t open = tag.find_first_of("\"'", at);
        if (open == std::string_view::npos) return std::nullopt;
        const std::size_t close = tag.find(tag[open], open + 1);
        if (close == std::string_view::npos) return std::nullopt;
        return std::string(tag.substr(open + 1, close - open - 1));
    }
    return std::nullopt;
}

/// assimp hands over the numbers of a 3MF file and ignores their unit, so it is read here.
Result<double> unitOf3mf(const std::string& path) {
    const std::string head = readModelHead(path);
    if (head.empty()) return fileError(path, "must be a 3MF package that holds the part 3D/3dmodel.model");
    const std::string unit = modelUnit(head).value_or("millimeter");
    constexpr std::array<std::pair<std::string_view, double>, 6> kUnits{{{"micron", 1e-6},
                                                                         {"millimeter", 1e-3},
                                                                         {"centimeter", 1e-2},
                                                                         {"inch", 0.0254},
                                                                         {"foot", 0.3048},
                                                                         {"meter", 1.0}}};
    for (const auto& [name, metres] : kUnits)
        if (unit == name) return metres;
    Error error = fileError(path, "must be micron, millimeter, centimeter, inch, foot or meter");
    error.key = "unit";
    error.value = unit;
    return error;
}

Result<double> metresPerUnit(const std::string& path, const std::string& extension, double asked) {
    if (extension == "gltf" || extension == "glb") return 1.0;
    if (extension == "3mf") return unitOf3mf(path);
    if (std::isfinite(asked) && asked > 0.0) return asked;
    return fileError(path, "the unit must be a length above 0 m");
}

Eigen::Matrix4d toMatrix(const aiMatrix4x4& m) {
    Eigen::Matrix4d result;
    for (unsigned row = 0; row < 4; ++row)
        for (unsigned column = 0; column < 4; ++column) result(row, column) = static_cast<double>(m[row][column]);
    return result;
}

/// Appends the triangles of a node and of those below it; false if a vertex is not finite or an index out of range.
bool appendNode(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& parent, double scale,
                TriangleMesh& mesh) {
    const Eigen::Matrix4d X = parent * toMatrix(node.mTransformation);
    const bool mirrored = X.topLeftCorner<3, 3>().determinant() < 0.0;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
        const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
        for (unsigned i = 0; i < part.mNumVertices; ++i) {
            const aiVector3D& v = part.mVertices[i];
            const Eigen::Vector4d p = X * Eigen::Vector4d(v.x, v.y, v.z, 1.0);
            mesh.vertices.emplace_back(scale * p.head<3>());
            if (!mesh.vertices.back().allFinite()) return false;
        }
        for (unsigned i = 0; i < part.mNumFaces; ++i) {
            const aiFace& face = part.mFaces[i];
            if (face.mNumIndices != 3) continue;
            Triangle triangle{};
            for (unsigned k = 0; k < 3; ++k) {
                if (face.mIndices[k] >= part.mNumVertices) return false;
                triangle[k] = base + face.mIndices[k];
            }
            // A mirror turns a surface inside out; its triangles are turned back.
            if (mirrored) std::swap(triangle[1], triangle[2]);
            mesh.triangles.push_back(triangle);
        }
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i)
        if (!appendNode(scene, *node.mChildren[i], X, scale, mesh)) return false;
    return true;
}

}  // namespace

Result<ImportedMesh> importMesh(const std::string& path, double metres_per_unit) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return fileError(path, "the mesh file does not exist");
    if (!std::filesystem::is_regular_file(path, ignored) || !std::ifstream(path))
        return fileError(path, "the mesh file must be a file that may be read");
    const std::string extension = extensionOf(path);
    const Result<double> scale = metresPerUnit(path, extension, metres_per_unit);
    if (!scale) return scale.errors();

    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
    if (scene == nullptr || scene->mRootNode == nullptr)
        return fileError(path, std::string("must be a mesh that can be read: ") + importer.GetErrorString());
    TriangleMesh mesh;
    if (!appendNode(*scene, *scene->mRootNode, Eigen::Matrix4d::Identity(), *scale, mesh))
        return fileError(path, "every vertex must be finite and every triangle must name vertices that exist");
    if (mesh.triangles.empty()) return fileError(path, "the mesh must have triangles");

    ImportedMesh result = repairMesh(std::move(mesh));
    if (result.mesh.triangles.empty()) return fileError(path, "the mesh must have triangles with area");
    result.report.file = path;
    result.report.format = extension;
    result.report.metres_per_unit = *scale;
    return result;
}

}  // namespace passung::model
