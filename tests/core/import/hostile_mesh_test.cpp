#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/import/mesh_bytes.h"
#include "core/import/mesh_import.h"
#include "core/shape/shape.h"
#include "tests/support/hostile_scene.h"
#include "tests/support/temp_folder.h"

namespace passung::importer {
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
        {"nan.3mf",
         test::package(test::tetrahedron("1"), "<item objectid=\"1\" transform=\"nan x 0 0 1 0 0 0 1 0 0 0\"/>"),
         "a transform in it must be of finite numbers alone"},
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

TEST(HostileMesh, ASurfaceThatCrossesItselfNearlyEverywhereIsRefused) {
    // Truth: invariant: triangles at random places of a cube have no inside; of 20 balls, each a millimetre from the
    // next, it is what any of them encloses, though most of their triangles cross others.
    const test::TempFolder folder;
    Random random(1);
    std::string soup = "OFF\n900 300 0\n", balls = "OFF\n";
    for (int i = 0; i < 900; ++i)
        soup += std::to_string(random.uniform()) + ' ' + std::to_string(random.uniform()) + ' ' +
                std::to_string(random.uniform()) + '\n';
    for (int i = 0; i < 900; i += 3)
        soup += "3 " + std::to_string(i) + ' ' + std::to_string(i + 1) + ' ' + std::to_string(i + 2) + '\n';
    const auto refused = importMesh(written(folder, "soup.off", soup), 1e-3);
    ASSERT_FALSE(refused);
    ASSERT_EQ(refused.errors().size(), 1u);
    EXPECT_NE(refused.errors()[0].message.find("crosses itself so often"), std::string::npos);

    // Of 30 of these triangles a field is still not built in minutes: they have gaps, so that fewer crossings do.
    std::string thirty = "OFF\n90 30 0\n";
    Random gaps(5);
    for (int i = 0; i < 270; ++i) thirty += std::to_string(gaps.uniform()) + (i % 3 == 2 ? '\n' : ' ');
    for (int i = 0; i < 90; i += 3)
        thirty += "3 " + std::to_string(i) + ' ' + std::to_string(i + 1) + ' ' + std::to_string(i + 2) + '\n';
    const auto scraps = importMesh(written(folder, "thirty.off", thirty), 1e-3);
    ASSERT_FALSE(scraps);
    EXPECT_NE(scraps.errors()[0].message.find("passes through 8.1 others (mean), at most 5.0"), std::string::npos)
        << toString(scraps.errors()[0]);

    const geometry::TriangleMesh ball = shape::tessellate(shape::Sphere{20}, 0.1);
    const std::size_t corners = ball.vertices.size(), faces = ball.triangles.size();
    balls += std::to_string(20 * corners) + ' ' + std::to_string(20 * faces) + " 0\n";
    for (int i = 0; i < 20; ++i)
        for (const Vec3& v : ball.vertices)
            balls += std::to_string(v.x() + i) + ' ' + std::to_string(v.y() + 0.1 * i) + ' ' +
                     std::to_string(v.z() + 0.3 * i) + '\n';
    for (std::size_t i = 0; i < 20; ++i)
        for (const geometry::Triangle& t : ball.triangles)
            balls += "3 " + std::to_string(t[0] + i * corners) + ' ' + std::to_string(t[1] + i * corners) + ' ' +
                     std::to_string(t[2] + i * corners) + '\n';
    const auto read = importMesh(written(folder, "balls.off", balls), 1e-3);
    ASSERT_TRUE(read) << toString(read.errors()[0]);
    EXPECT_GT(2 * read->report.crossing_triangles, 20 * faces);
}

/// Bars with three sides from node to node of a cube of 2 x 2 x 2 cells, along its edges and diagonals, each closed by
/// itself; the first without its second end. OFF text.
std::string latticeOfBars() {
    std::vector<Vec3> corners;
    std::vector<geometry::Triangle> faces;
    const auto bar = [&](const Vec3& from, const Vec3& to) {
        const Vec3 along = (to - from).normalized(), right = along.unitOrthogonal(), up = along.cross(right);
        const bool open = corners.empty();
        const auto first = static_cast<std::uint32_t>(corners.size());
        for (std::uint32_t k = 0; k < 3; ++k) {
            const double turn = 2.0 * std::numbers::pi * k / 3.0;
            const Vec3 off = 2.0 * (std::cos(turn) * right + std::sin(turn) * up);
            corners.push_back(from + off);
            corners.push_back(to + off);
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t a = first + 2 * k, b = first + 2 * ((k + 1) % 3);
            faces.push_back({a, b, b + 1});
            faces.push_back({a, b + 1, a + 1});
            faces.push_back({first + 6, b, a});
            if (!open) faces.push_back({first + 7, a + 1, b + 1});
        }
        corners.push_back(from);
        corners.push_back(to);
    };
    const auto isNode = [](const Vec3& p) { return p.minCoeff() >= 0.0 && p.maxCoeff() <= 40.0; };
    for (int node = 0; node < 27; ++node) {
        const Vec3 p = 20.0 * Vec3(node / 9, node / 3 % 3, node % 3);
        for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1), Vec3(1, -1, 1),
                                Vec3(-1, 1, 1), Vec3(-1, -1, 1)})
            if (isNode(p + 20.0 * way)) bar(p, p + 20.0 * way);
    }
    std::string text = "OFF\n" + std::to_string(corners.size()) + ' ' + std::to_string(faces.size()) + " 0\n";
    for (const Vec3& v : corners)
        text += std::to_string(v.x()) + ' ' + std::to_string(v.y()) + ' ' + std::to_string(v.z()) + '\n';
    for (const geometry::Triangle& t : faces)
        text += "3 " + std::to_string(t[0]) + ' ' + std::to_string(t[1]) + ' ' + std::to_string(t[2]) + '\n';
    return text;
}

TEST(HostileMesh, ALatticeOfBarsThatWereNeverMergedIsReadThoughAnEndIsOpen) {
    // Truth: invariant: each bar has an inside, and hardly an edge is open; at a node up to 14 bars run through each
    // other.
    const test::TempFolder folder;
    const auto lattice = importMesh(written(folder, "lattice.off", latticeOfBars()), 1e-3);
    ASSERT_TRUE(lattice) << toString(lattice.errors()[0]);
    EXPECT_EQ(lattice->report.kind, SurfaceKind::HoledSolid);
    EXPECT_GT(lattice->report.crossing_pairs, 10 * lattice->report.triangles);
}

TEST(HostileMesh, AFaceOfTooManyCornersIsRefusedInEveryFormat) {
    // Truth: closed form: a polygon of n corners is n - 2 triangles; 1000 corners are allowed, 1001 are not.
    const test::TempFolder folder;
    for (const int n : {1000, 1001}) {
        std::string obj, off = "OFF\n" + std::to_string(n) + " 1 0\n",
                         ply = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(n) +
                               "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                               "property list int int vertex_indices\nend_header\n";
        std::string from_one, from_zero;
        for (int i = 0; i < n; ++i) {
            const double turn = 2.0 * std::numbers::pi * i / n;
            const std::string at = std::to_string(20 * std::cos(turn)) + ' ' + std::to_string(20 * std::sin(turn));
            obj += "v " + at + " 0\n";
            off += at + " 0\n";
            ply += at + " 0\n";
            from_one += ' ' + std::to_string(i + 1);
            from_zero += ' ' + std::to_string(i);
        }
        obj += "f" + from_one + '\n';
        off += std::to_string(n) + from_zero + '\n';
        ply += std::to_string(n) + from_zero + '\n';
        const std::pair<std::string, std::string> files[] = {{"face.obj", obj}, {"face.off", off}, {"face.ply", ply}};
        for (const auto& [name, content] : files) {
            const auto read = importMesh(written(folder, name, content), 1e-3);
            if (n <= 1000) {
                ASSERT_TRUE(read) << name << toString(read.errors()[0]);
                EXPECT_EQ(read->report.triangles_read, 998u) << name;
            } else {
                ASSERT_FALSE(read) << name;
                EXPECT_NE(toString(read.errors()[0]).find("at most 1000 corners"), std::string::npos)
                    << toString(read.errors()[0]);
            }
        }
    }
}

ImportedMesh imported() {
    ImportedMesh result = repairMesh(shape::tessellate(shape::BorePlate{0.06, 0.05, 0.03, 0.0202, 0.03, 0.001}, 1e-4));
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
    EXPECT_EQ(geometry::contentHash((*back)->mesh), geometry::contentHash(mesh->mesh));
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
}  // namespace passung::importer
