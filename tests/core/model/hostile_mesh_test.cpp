#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/model/mesh_bytes.h"
#include "core/model/mesh_import.h"
#include "core/model/shape.h"
#include "tests/support/hostile_scene.h"
#include "tests/support/temp_folder.h"

namespace passung::model {
namespace {

std::string written(const test::TempFolder& folder, const std::string& name, const std::string& content) {
    std::ofstream(folder / name, std::ios::binary) << content;
    return folder / name;
}

TEST(HostileMesh, IsRefusedInThisProcessBeforeAnotherLibraryReadsIt) {
    // Truth: closed form. Each file would take the reader's stack or memory: see its row.
    const test::TempFolder folder;
    const std::string deep(200'000, '[');
    const std::vector<std::array<std::string, 3>> rows{
        {"itself.3mf", test::package(test::assembly("1", "1", 1), test::item("1")), "contain itself"},
        {"circle.3mf", test::package(test::assembly("1", "2", 1) + test::assembly("2", "0x1", 1), test::item("1")),
         "contain itself"},
        {"referred.3mf", test::package(test::assembly("1", "&#49;", 1), test::item("1")), "character reference"},
        {"tens.3mf", test::tens(10), "at most 100000 objects"},
        {"bomb.3mf", test::bomb(0xf0000000u), "at most 256 MiB unpacked"},
        {"deep.gltf", deep, "64 levels deep"},
        {"deep_inside.gltf", test::gltfOf("[{\"mesh\":0}]", "36", "3", ",\"extras\":" + deep), "64 levels deep"},
        {"cut.gltf", "{\"asset\":{\"version\":\"2.0\"}", "JSON"},
        {"tens.gltf", test::gltfOf(test::nodesOfTens(10)), "at most 100000 objects"},
        {"itself.gltf", test::gltfOf("[{\"children\":[0]}]"), "contain itself"},
        {"spelt.gltf",
         R"({"asset":{"version":"1.0"},"scene":"s","scenes":{"s":{"nodes":["é"]}},"nodes":{"é":{"children":["\u00e9"]}}})",
         "contain itself"},
        {"buffer.gltf", test::gltfOf("[{\"mesh\":0}]", "4000000000"), "more bytes than are there"},
        {"count.gltf", test::gltfOf("[{\"mesh\":0}]", "36", "4000000000"), "more than is there"},
        {"claims.glb", test::glb(0xfffffff0u, 0xf0000000u, "{}"), "more bytes than are there"},
    };
    for (const auto& [name, content, requirement] : rows) {
        const auto imported = importMesh(written(folder, name, content), 1e-3);
        ASSERT_FALSE(imported) << name;
        ASSERT_EQ(imported.errors().size(), 1u) << name;
        EXPECT_NE(imported.errors()[0].message.find(requirement), std::string::npos) << toString(imported.errors()[0]);
    }
}

TEST(HostileMesh, LeavesAloneWhatIsSound) {
    // Truth: closed form (10^2 tetrahedra of 1000/6 mm³ in one place are one, others are dropped; a triangle).
    const test::TempFolder folder;
    const auto package = importMesh(written(folder, "tens.3mf", test::tens(2)), 1e-3);
    ASSERT_TRUE(package) << toString(package.errors()[0]);
    EXPECT_NEAR(package->report.volume, 1e-6 / 6.0, 1e-12);
    EXPECT_EQ(package->report.triangles_read, 400u);
    const auto scene = importMesh(written(folder, "one.gltf", test::gltfOf(test::nodesOfTens(1))), 1e-3);
    ASSERT_TRUE(scene) << toString(scene.errors()[0]);
    EXPECT_EQ(scene->report.triangles_read, 10u);
}

ImportedMesh imported() {
    ImportedMesh result = repairMesh(tessellate(BorePlate{0.06, 0.05, 0.03, 0.0202, 0.03, 0.001}, 1e-4));
    result.report.file = "plate\n.stl";
    result.report.format = "stl";
    result.report.notes = {"one", "", "three"};
    return result;
}

TEST(MeshBytes, BringTheSameMeshReportAndErrorsBack) {
    // Truth: invariant (there and back; bytes of what came back are the bytes).
    const Result<ImportedMesh> mesh = imported();
    const Result<ImportedMesh> errors =
        Errors{{.message = "a", .file = "b", .line = 3, .column = 4, .key = "c", .value = "d"}, {.message = "e"}};
    for (const auto* answer : {&mesh, &errors}) {
        const std::string bytes = toBytes(*answer);
        const auto back = importedFrom(bytes);
        ASSERT_TRUE(back);
        EXPECT_EQ(toBytes(*back), bytes);
    }
    const auto back = importedFrom(toBytes(mesh));
    EXPECT_EQ(contentHash((*back)->mesh), contentHash(mesh->mesh));
    EXPECT_EQ((*back)->report.notes, mesh->report.notes);
    EXPECT_EQ((*back)->report.kind, mesh->report.kind);
    EXPECT_EQ(importedFrom(toBytes(errors))->errors()[0].line, 3);
}

TEST(MeshBytes, OfAnUntrueWriterAreRefusedWhateverTheySay) {
    // Truth: invariant (a mesh that comes back is sound: finite, its triangles name vertices; nothing else comes back).
    const std::string sound = toBytes(Result<ImportedMesh>(imported()));
    EXPECT_FALSE(importedFrom(""));
    EXPECT_FALSE(importedFrom(sound + "x"));
    for (std::size_t size = 0; size < sound.size(); size += 97) EXPECT_FALSE(importedFrom(sound.substr(0, size)));
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
        std::string bytes = sound;
        const std::size_t places = 1 + random.below(3);
        for (std::size_t k = 0; k < places; ++k)
            bytes[random.below(k == 0 ? 40 : bytes.size())] = static_cast<char>(random.below(256));
        const auto back = importedFrom(bytes);
        if (!back || !*back) continue;
        for (const Vec3& v : (*back)->mesh.vertices) ASSERT_TRUE(v.allFinite());
        for (const auto& t : (*back)->mesh.triangles)
            for (const auto corner : t) ASSERT_LT(corner, (*back)->mesh.vertices.size());
    }
}

}  // namespace
}  // namespace passung::model
