#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/import/mesh_import.h"
#include "study/protocol/protocol_reader.h"
#include "study/run/files/known_names.h"
#include "tests/support/hostile_scene.h"
#include "tests/support/mutation.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

struct Sound {
    std::string name, content;
};

std::string littleFloat(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    std::string bytes;
    for (int k = 0; k < 4; ++k) bytes += static_cast<char>(bits >> (8 * k) & 255u);
    return bytes;
}

std::string binaryStl() {
    std::string bytes = std::string(80, ' ') + std::string("\x04\0\0\0", 4);
    const std::vector<std::array<float, 9>> triangles{{0, 0, 0, 0, 10, 0, 10, 0, 0},
                                                      {0, 0, 0, 10, 0, 0, 0, 0, 10},
                                                      {0, 0, 0, 0, 0, 10, 0, 10, 0},
                                                      {10, 0, 0, 0, 10, 0, 0, 0, 10}};
    for (const auto& triangle : triangles) {
        bytes += std::string(12, '\0');
        for (const float value : triangle) bytes += littleFloat(value);
        bytes += std::string(2, '\0');
    }
    return bytes;
}

std::string binaryPly() {
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 4\nproperty list uchar uchar vertex_indices\nend_header\n";
    for (const float value : {0.0F, 0.0F, 0.0F, 10.0F, 0.0F, 0.0F, 0.0F, 10.0F, 0.0F, 0.0F, 0.0F, 10.0F})
        bytes += littleFloat(value);
    return bytes + std::string("\3\0\2\1\3\0\1\3\3\0\3\2\3\1\2\3", 16);
}

const std::string kOff = "OFF\n4 4 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::vector<Sound> ownFormats() {
    return {{"a.off", kOff},
            {"a.obj", "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"},
            {"a.stl", binaryStl()},
            {"b.stl",
             "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
             "endfacet\nendsolid a\n"},
            {"a.ply", binaryPly()}};
}

std::vector<Sound> allMeshes() {
    std::vector<Sound> files = ownFormats();
    const std::string gltf = gltfOf(nodesOfTens(1));
    files.push_back({"a.gltf", gltf});
    files.push_back(
        {"a.glb", glb(static_cast<std::uint32_t>(20 + gltf.size()), static_cast<std::uint32_t>(gltf.size()), gltf)});
    files.push_back({"a.3mf", tens(1)});
    return files;
}

std::vector<Sound> protocols() {
    std::vector<Sound> files{{"small.toml", smallStudy()}};
    for (const char* name : {"peg_in_hole", "rendering_methods", "designs"}) {
        const std::filesystem::path path =
            std::filesystem::path(PASSUNG_SOURCE_DIR) / "protocols" / name / "study.toml";
        if (std::filesystem::exists(path)) files.push_back({std::string(name) + ".toml", readText(path)});
    }
    return files;
}

/// How many files, of each test; PASSUNG_MUTATIONS asks for more.
int mutations(int usual) {
    const char* wanted = std::getenv("PASSUNG_MUTATIONS");
    return wanted != nullptr ? std::atoi(wanted) : usual;
}

TEST(MutatedFiles, AreMeshesOrOneErrorForTheLibrary) {
    // Truth: invariant (a mesh that comes back is sound; else there is one error with a message).
    const TempFolder folder;
    const auto files = ownFormats();
    for (int i = 0; i < mutations(500); ++i) {
        const Sound& file = files[static_cast<std::size_t>(i) % files.size()];
        writeText(folder / file.name, mutated(file.content, static_cast<std::uint64_t>(i)));
        const auto mesh = importer::importMesh(folder / file.name, 1e-3);
        if (!mesh) {
            ASSERT_EQ(mesh.errors().size(), 1u) << i;
            ASSERT_FALSE(mesh.errors()[0].message.empty()) << i;
            continue;
        }
        for (const Vec3& v : mesh->mesh.vertices) ASSERT_TRUE(v.allFinite()) << i;
    }
}

TEST(MutatedFiles, AreStudiesOrErrorsWithAPlaceForTheLibrary) {
    // Truth: invariant (no input makes the reader throw; every error names the file).
    const auto files = protocols();
    const TempFolder folder;
    for (int i = 0; i < mutations(150); ++i) {
        const Sound& file = files[static_cast<std::size_t>(i) % files.size()];
        writeText(folder / file.name, mutated(file.content, static_cast<std::uint64_t>(i)));
        const auto examined = protocol::examineProtocol(folder / file.name, run::knownDevices(), run::knownMeasures());
        for (const Error& error : examined.errors) ASSERT_FALSE(error.file.empty()) << i << " " << toString(error);
    }
}

/// Exit code and output of the program; 124 if it takes longer than a minute.
Ended run(const std::filesystem::path& folder, const std::string& command, const std::string& file) {
    const std::string line =
        "cd '" + folder.string() + "' && timeout 60 '" PASSUNG_PROGRAM "' " + command + " '" + file + "' >.out 2>.err";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readText(folder / ".out"), readText(folder / ".err")};
}

TEST(MutatedFiles, NeverEndTheProgramOtherwiseThanByAnAnswer) {
    // Truth: invariant (exit code 0 with output, or 1 with lines on standard error, for a mesh one line).
    const TempFolder folder;
    const auto meshes = allMeshes(), studies = protocols();
    int sound = 0;
    const int count = mutations(40);
    for (int i = 0; i < count; ++i) {
        const bool mesh = i % 4 != 0;
        const auto& files = mesh ? meshes : studies;
        const Sound& file = files[static_cast<std::size_t>(i) % files.size()];
        writeText(folder / file.name, mutated(file.content, 7'000'000u + static_cast<std::uint64_t>(i)));
        const Ended ended = run(folder.path(), mesh ? "mesh" : "check", file.name);
        ASSERT_TRUE(ended.exit_code == 0 || ended.exit_code == 1) << i << " " << file.name << " " << ended.exit_code;
        if (ended.exit_code == 0) {
            ++sound;
            ASSERT_FALSE(ended.out.empty()) << i;
        } else if (mesh) {
            ASSERT_EQ(linesOf(ended.err).size(), 1u) << i << " " << ended.err;
        } else {
            ASSERT_FALSE(ended.err.empty()) << i;
        }
    }
    std::printf("of %d files %d are sound all the same\n", count, sound);
}

}  // namespace
}  // namespace passung::test
