#include "core/import/mesh_import.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <minizip/unzip.h>

#include <algorithm>
#include <array>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/regular_file.h"
#include "core/import/mesh_formats.h"
#include "core/import/scene_file_limits.h"

namespace passung::importer {

namespace {

constexpr double kFarthest = 1e5;  // from the origin [m]

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
bool appendNode(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& parent, geometry::TriangleMesh& mesh) {
    const Eigen::Matrix4d X = parent * toMatrix(node.mTransformation);
    const bool mirrored = X.topLeftCorner<3, 3>().determinant() < 0.0;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
        const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
        for (unsigned i = 0; i < part.mNumVertices; ++i) {
            const aiVector3D& v = part.mVertices[i];
            const Eigen::Vector4d p = X * Eigen::Vector4d(v.x, v.y, v.z, 1.0);
            mesh.vertices.emplace_back(p.head<3>());
            if (!mesh.vertices.back().allFinite()) return false;
        }
        for (unsigned i = 0; i < part.mNumFaces; ++i) {
            const aiFace& face = part.mFaces[i];
            if (face.mNumIndices != 3) continue;
            geometry::Triangle triangle{};
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
        if (!appendNode(scene, *node.mChildren[i], X, mesh)) return false;
    return true;
}

/// A file in memory for assimp, to be read only.
class FileInMemory final : public Assimp::IOStream {
public:
    explicit FileInMemory(std::string bytes) : bytes_(std::move(bytes)) {}
    size_t Read(void* to, size_t size, size_t count) override {
        const size_t whole = size == 0 ? 0 : std::min(count, (bytes_.size() - at_) / size);
        std::memcpy(to, bytes_.data() + at_, whole * size);
        at_ += whole * size;
        return whole;
    }
    size_t Write(const void*, size_t, size_t) override { return 0; }
    aiReturn Seek(size_t offset, aiOrigin origin) override {
        const size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
        if (offset > bytes_.size() - from) return aiReturn_FAILURE;
        at_ = from + offset;
        return aiReturn_SUCCESS;
    }
    size_t Tell() const override { return at_; }
    size_t FileSize() const override { return bytes_.size(); }
    void Flush() override {}

private:
    std::string bytes_;
    size_t at_ = 0;
};

/// Lets assimp read regular files, of kMostMeshBytes together.
class RegularFiles final : public Assimp::IOSystem {
public:
    bool Exists(const char* path) const override {
        std::error_code none;
        return std::filesystem::is_regular_file(path, none);
    }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* path, const char* mode) override {
        if (std::strchr(mode, 'r') == nullptr) return nullptr;
        auto bytes = readRegularFile(path, left_);
        if (!bytes) return nullptr;
        left_ -= std::min(left_, bytes->size());
        return new FileInMemory(std::move(*bytes));
    }
    void Close(Assimp::IOStream* file) override {
        left_ += file->FileSize();
        delete file;
    }

private:
    std::uintmax_t left_ = kMostMeshBytes;
};

/// What speaks against giving the file to assimp.
std::optional<Error> beyondLimits(std::string_view bytes, const std::string& path, const std::string& extension) {
    if (extension == "3mf") return beyond3mfLimits(path, bytes.size());
    return beyondGltfLimits(bytes, extension == "glb", path, [&](const std::string& uri) {
        const auto named = std::filesystem::path(path).parent_path() / uri;
        std::error_code failure;
        const bool regular = std::filesystem::is_regular_file(named, failure);
        const std::uintmax_t size = regular ? std::filesystem::file_size(named, failure) : 0;
        return regular && !failure ? std::optional(size) : std::nullopt;
    });
}

/// What a person can make of an exception's text: of a number that is none the standard library names its function.
std::string reasonOf(const std::string& why) {
    if (why.empty()) return "no reason is given";
    const bool number = why.size() < 8 && why.starts_with("sto");
    return number ? "a number in it is none, or out of range" : why;
}

/// By assimp: the formats that are more than triangles. They may name other files, hence the path.
Result<geometry::TriangleMesh> readScene(std::string_view bytes, const std::string& path,
                                         const std::string& extension) {
    if (const auto beyond = beyondLimits(bytes, path, extension)) return *beyond;
    Assimp::Importer importer;
    importer.SetIOHandler(new RegularFiles);  // the importer deletes it
    const aiScene* scene = nullptr;
    std::string why;
    try {
        scene = importer.ReadFile(path, aiProcess_Triangulate);
        why = importer.GetErrorString();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& thrown) {  // some of its readers throw what it does not catch
        scene = nullptr;
        why = thrown.what();
    }
    if (scene == nullptr || scene->mRootNode == nullptr)
        return fileError(path, "must be a mesh that can be read: " + reasonOf(why));
    geometry::TriangleMesh mesh;
    if (!appendNode(*scene, *scene->mRootNode, Eigen::Matrix4d::Identity(), mesh))
        return fileError(path, "every vertex must be finite and every triangle must name vertices that exist");
    return mesh;
}

/// The file, if it is a regular one of at most kMostMeshBytes.
Result<std::string> readBytes(const std::string& path) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return fileError(path, "the mesh file does not exist");
    auto bytes = readRegularFile(path, kMostMeshBytes);
    if (!bytes) return fileError(path, "the mesh file must be one that may be read: " + bytes.errors()[0].message);
    if (bytes->empty()) return fileError(path, "the mesh file is empty");
    return bytes;
}

/// Metres from now on; no coordinate may be farther than kFarthest.
Result<Done> toMetres(geometry::TriangleMesh& mesh, double metres_per_unit, const std::string& path) {
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        mesh.vertices[i] *= metres_per_unit;
        const double far = mesh.vertices[i].cwiseAbs().maxCoeff();
        if (far <= kFarthest) continue;
        Error error = fileError(path, "coordinates must lie within 100 km of the origin: check the unit");
        error.key = "vertex " + std::to_string(i);
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%.3g m", far);
        error.value = text.data();
        return error;
    }
    return Done{};
}

/// A surface that passes through itself nearly everywhere has no inside that could be told, nor an end of work on it.
std::optional<std::string> tangle(const MeshReport& report) {
    const double crossings = static_cast<double>(report.crossing_pairs) / static_cast<double>(report.triangles);
    const bool scraps = report.kind == SurfaceKind::HoledSolid &&
                        static_cast<double>(report.open_edges_left) > kScraps * static_cast<double>(report.triangles);
    const double most = scraps ? kMostCrossingsOfScraps : kMostCrossings;
    if (!(crossings > most)) return std::nullopt;
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  "the surface crosses itself so often that it has no inside: each triangle passes through %.1f others "
                  "(mean), at most %.1f",
                  crossings, most);
    return std::string(text.data());
}

}  // namespace

Result<geometry::TriangleMesh> readMesh(std::string_view bytes, const std::string& path, const std::string& extension) {
    if (extension == "stl") return readStl(bytes, path);
    if (extension == "off") return readOff(bytes, path);
    if (extension == "obj") return readObj(bytes, path);
    if (extension == "ply") return readPly(bytes, path);
    if (extension == "gltf" || extension == "glb" || extension == "3mf") return readScene(bytes, path, extension);
    return fileError(path, "the name of a mesh file must end in .stl, .obj, .ply, .off, .gltf, .glb or .3mf");
}

Result<ImportedMesh> importMesh(const std::string& path, double metres_per_unit) {
    const auto bytes = readBytes(path);
    if (!bytes) return bytes.errors();
    const std::string extension = extensionOf(path);
    const Result<double> scale = metresPerUnit(path, extension, metres_per_unit);
    if (!scale) return scale.errors();
    auto read = readMesh(*bytes, path, extension);
    if (!read) return read.errors();
    geometry::TriangleMesh mesh = std::move(*read);
    if (mesh.triangles.empty()) return fileError(path, "the mesh must have triangles");
    if (auto fits = toMetres(mesh, *scale, path); !fits) return fits.errors();

    ImportedMesh result = repairMesh(std::move(mesh));
    if (result.mesh.triangles.empty()) return fileError(path, "the mesh must have triangles with area");
    if (auto tangled = tangle(result.report)) return fileError(path, *tangled);
    result.report.file = path;
    result.report.format = extension;
    result.report.metres_per_unit = *scale;
    return result;
}

}  // namespace passung::importer
