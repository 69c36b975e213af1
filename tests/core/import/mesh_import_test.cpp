#include "core/import/mesh_import.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/shape/shape.h"
#include "tests/support/broken_mesh.h"
#include "tests/support/brute_force_mesh.h"
#include "tests/support/stored_zip.h"

namespace passung::importer {
namespace {

// The part of most tests: 20 × 30 × 40 mm.
const shape::Box kBox{0.02, 0.03, 0.04};

geometry::TriangleMesh boxMesh() { return shape::tessellate(kBox, 1.0); }

/// A folder of its own for every test, removed at the end.
class MeshImport : public testing::Test {
protected:
    void SetUp() override {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  ("passung_mesh_import_" + std::string(info->name()) + "_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& content) const {
        const std::string path = (folder_ / name).string();
        std::ofstream(path, std::ios::binary) << content;
        return path;
    }
    std::string folder() const { return folder_.string(); }

private:
    std::filesystem::path folder_;
};

std::ostringstream text() {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(9);
    return out;
}

// Writers; coordinates leave in millimetres.
std::string asciiStl(const geometry::TriangleMesh& mesh) {
    auto out = text();
    out << "solid part\n";
    for (const auto& t : mesh.triangles) {
        out << "facet normal 0 0 0\nouter loop\n";
        for (const auto v : t) out << "vertex " << (1e3 * mesh.vertices[v]).transpose() << "\n";
        out << "endloop\nendfacet\n";
    }
    out << "endsolid part\n";
    return out.str();
}

template <class T>
void appendBytes(std::string& bytes, T value) {
    static_assert(std::endian::native == std::endian::little);
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
}

std::string binaryStl(const geometry::TriangleMesh& mesh) {
    std::string bytes(80, ' ');
    appendBytes(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) appendBytes(bytes, 0.0f);
        for (const auto v : t)
            for (int k = 0; k < 3; ++k) appendBytes(bytes, static_cast<float>(1e3 * mesh.vertices[v][k]));
        appendBytes(bytes, std::uint16_t{0});
    }
    return bytes;
}

std::string off(const geometry::TriangleMesh& mesh) {
    auto out = text();
    out << "OFF\n" << mesh.vertices.size() << " " << mesh.triangles.size() << " 0\n";
    for (const Vec3& v : mesh.vertices) out << (1e3 * v).transpose() << "\n";
    for (const auto& t : mesh.triangles) out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
    return out.str();
}

std::string ply(const geometry::TriangleMesh& mesh) {
    auto out = text();
    out << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
        << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.triangles.size()
        << "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const Vec3& v : mesh.vertices) out << (1e3 * v).transpose() << "\n";
    for (const auto& t : mesh.triangles) out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
    return out.str();
}

std::string obj(const geometry::TriangleMesh& mesh) {
    auto out = text();
    for (const Vec3& v : mesh.vertices) out << "v " << (1e3 * v).transpose() << "\n";
    for (const auto& t : mesh.triangles) out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
    return out.str();
}

/// 3MF package with the box in numbers of `unit` that are millimetres by value.
std::string threeMf(const std::string& unit_attribute) {
    auto out = text();
    out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model" << unit_attribute
        << " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">"
        << "<resources><object id=\"1\" type=\"model\"><mesh><vertices>";
    const geometry::TriangleMesh mesh = boxMesh();
    for (const Vec3& v : mesh.vertices)
        out << "<vertex x=\"" << 1e3 * v.x() << "\" y=\"" << 1e3 * v.y() << "\" z=\"" << 1e3 * v.z() << "\"/>";
    out << "</vertices><triangles>";
    for (const auto& t : mesh.triangles)
        out << "<triangle v1=\"" << t[0] << "\" v2=\"" << t[1] << "\" v3=\"" << t[2] << "\"/>";
    out << "</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>";
    return test::storedZip(
        {{"[Content_Types].xml",
          "<?xml version=\"1.0\"?><Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
          "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
          "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>"
          "</Types>"},
         {"_rels/.rels",
          "<?xml version=\"1.0\"?><Relationships "
          "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
          "Target=\"/3D/3dmodel.model\" "
          "Id=\"rel0\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"},
         {"3D/3dmodel.model", out.str()}});
}

std::string base64(const std::string& bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t k) {
            return i + k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k])) : 0u;
        };
        const unsigned word = byte(0) << 16 | byte(1) << 8 | byte(2);
        for (unsigned k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63u];
    }
    return out;
}

/// The box in metres under a node that moves it by 1 m along x, under a node that scales by `scale`.
std::string gltf(const std::string& scale) {
    const geometry::TriangleMesh mesh = boxMesh();
    std::string bytes;
    for (const auto& t : mesh.triangles)
        for (const auto v : t) appendBytes(bytes, static_cast<std::uint16_t>(v));
    const std::size_t index_bytes = bytes.size();
    for (const Vec3& v : mesh.vertices)
        for (int k = 0; k < 3; ++k) appendBytes(bytes, static_cast<float>(v[k]));
    auto out = text();
    out << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"scale":)" << scale
        << R"(,"children":[1]},{"translation":[1,0,0],"mesh":0}],)"
        << R"("meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0,"mode":4}]}],)"
        << R"("accessors":[{"bufferView":0,"componentType":5123,"count":36,"type":"SCALAR"},)"
        << R"({"bufferView":1,"componentType":5126,"count":8,"type":"VEC3","min":[-0.01,-0.015,-0.02],"max":[0.01,0.015,0.02]}],)"
        << R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":)" << index_bytes
        << R"(},{"buffer":0,"byteOffset":)" << index_bytes << R"(,"byteLength":)" << bytes.size() - index_bytes
        << R"(}],"buffers":[{"byteLength":)" << bytes.size() << R"(,"uri":"data:application/octet-stream;base64,)"
        << base64(bytes) << R"("}]})";
    return out.str();
}

void expectSoundBox(const Result<ImportedMesh>& result, const std::string& what) {
    ASSERT_TRUE(result) << what << ": " << toString(result.errors()[0]);
    const MeshReport& r = result->report;
    EXPECT_EQ(r.triangles_read, 12u) << what;
    EXPECT_EQ(r.triangles, 12u) << what;
    EXPECT_EQ(r.vertices, 8u) << what;
    EXPECT_TRUE(r.watertight) << what;
    EXPECT_FALSE(r.turned_inside_out) << what;
    EXPECT_EQ(r.shells, 1u) << what;
    EXPECT_EQ(r.degenerate_triangles + r.duplicate_triangles + r.boundary_edges + r.holes + r.non_manifold_edges +
                  r.inconsistent_edges + r.turned_triangles,
              0u)
        << what;
    EXPECT_LE((r.size - Vec3(0.02, 0.03, 0.04)).norm(), 1e-8) << what;
    EXPECT_NEAR(r.area, 2 * (0.02 * 0.03 + 0.03 * 0.04 + 0.04 * 0.02), 1e-9) << what;
    EXPECT_NEAR(r.volume, 0.02 * 0.03 * 0.04, 1e-11) << what;
    EXPECT_NEAR(test::volume(result->mesh), r.volume, 1e-11) << what;
}

TEST_F(MeshImport, ReadsTheSameBoxFromEveryFormat) {
    // Truth: closed form. Size, area and volume of a box.
    expectSoundBox(importMesh(write("box_ascii.stl", asciiStl(boxMesh())), 1e-3), "ASCII STL");
    expectSoundBox(importMesh(write("box_binary.STL", binaryStl(boxMesh())), 1e-3), "binary STL");
    expectSoundBox(importMesh(write("box.obj", obj(boxMesh())), 1e-3), "OBJ");
    expectSoundBox(importMesh(write("box.ply", ply(boxMesh())), 1e-3), "PLY");
    expectSoundBox(importMesh(write("box.off", off(boxMesh())), 1e-3), "OFF");
    expectSoundBox(importMesh(write("box.gltf", gltf("[1,1,1]")), 1e-3), "glTF");
    expectSoundBox(importMesh(write("box.3mf", threeMf(" unit=\"millimeter\"")), 1.0), "3MF");
}

TEST_F(MeshImport, TakesTheUnitAskedForWhereAFormatHasNone) {
    // Truth: closed form. Numbers of millimetres read as inches.
    const auto result = importMesh(write("box.stl", asciiStl(boxMesh())), 0.0254);
    ASSERT_TRUE(result);
    EXPECT_NEAR(result->report.size.x(), 20 * 0.0254, 1e-7);
    EXPECT_EQ(result->report.metres_per_unit, 0.0254);
    EXPECT_EQ(result->report.format, "stl");
}

TEST_F(MeshImport, TakesTheUnitThatA3mfFileNames) {
    // Truth: closed form. The 3MF core specification: six units, millimetre if none is named.
    const std::vector<std::pair<std::string, double>> units{{" unit=\"micron\"", 1e-6},     {" unit='inch'", 0.0254},
                                                            {" unit=\"meter\"", 1.0},       {" unit=\"foot\"", 0.3048},
                                                            {" unit=\"centimeter\"", 1e-2}, {"", 1e-3}};
    for (const auto& [attribute, metres] : units) {
        const auto result = importMesh(write("box.3mf", threeMf(attribute)), 1e-3);
        ASSERT_TRUE(result) << attribute;
        EXPECT_NEAR(result->report.size.z(), 40 * metres, 1e-6 * metres) << attribute;
    }
    const auto wrong = importMesh(write("box.3mf", threeMf(" unit=\"furlong\"")), 1e-3);
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.errors()[0].key, "unit");
    EXPECT_EQ(wrong.errors()[0].value, "furlong");
}

TEST_F(MeshImport, AppliesTheTransformsOfAllNodes) {
    // Truth: closed form. Moved by 1 m, then scaled by 2, and by -2 along x: a mirror must not turn the solid inside
    // out.
    for (const double sign : {1.0, -1.0}) {
        const auto result = importMesh(write("box.gltf", gltf(sign > 0 ? "[2,2,2]" : "[-2,2,2]")), 1e-3);
        ASSERT_TRUE(result);
        const geometry::Bounds bounds = geometry::boundsOf(result->mesh);
        EXPECT_LE((bounds.low - Vec3(sign * 2.0 - 0.02, -0.03, -0.04)).norm(), 1e-6);
        EXPECT_LE((bounds.high - Vec3(sign * 2.0 + 0.02, 0.03, 0.04)).norm(), 1e-6);
        EXPECT_GT(test::volume(result->mesh), 0.0);
        EXPECT_FALSE(result->report.turned_inside_out);
    }
}

TEST_F(MeshImport, CutsPolygonsIntoTriangles) {
    // Truth: closed form. A cube of six quadrilaterals.
    const auto result = importMesh(write("cube.obj",
                                         "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                                         "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"),
                                   1.0);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->report.triangles, 12u);
    EXPECT_TRUE(result->report.watertight);
    EXPECT_NEAR(result->report.volume, 1.0, 1e-12);
}

TEST_F(MeshImport, CutsAConcavePolygonWithinItsBorder) {
    // Truth: closed form. An L of five unit squares, listed from each of its corners: a fan from most of them would
    // cover what is outside, and the areas would add up to more.
    const std::vector<std::string> corners{"0 0", "3 0", "3 1", "1 1", "1 3", "0 3"};
    for (std::size_t first = 0; first < corners.size(); ++first) {
        std::string text, face = "f";
        for (std::size_t k = 0; k < corners.size(); ++k) {
            text += "v " + corners[(first + k) % corners.size()] + " 0\n";
            face += " " + std::to_string(k + 1);
        }
        const auto result = importMesh(write("l.obj", text + face + "\n"), 1.0);
        ASSERT_TRUE(result);
        EXPECT_EQ(result->report.triangles, 4u);
        EXPECT_NEAR(result->report.area, 5.0, 1e-12) << first;
    }
}

TEST_F(MeshImport, ReadsBinaryPlyOfBothByteOrders) {
    // Truth: closed form. A tetrahedron, written here bit by bit: doubles, colours, faces of 16-bit numbers.
    for (const bool big : {false, true}) {
        std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                            "_endian 1.0\ncomment x\nelement vertex 4\nproperty double x\nproperty double y\n"
                            "property double z\nproperty uchar red\nelement face 4\n"
                            "property list uchar ushort vertex_index\nend_header\n";
        const auto put = [&](std::uint64_t value, int count) {
            for (int i = 0; i < count; ++i)
                bytes.push_back(static_cast<char>(value >> (8 * (big ? count - 1 - i : i))));
        };
        for (int v = 0; v < 4; ++v) {
            for (int axis = 1; axis <= 3; ++axis) put(std::bit_cast<std::uint64_t>(v == axis ? 1.0 : 0.0), 8);
            put(200, 1);
        }
        for (const geometry::Triangle& t : {geometry::Triangle{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
            put(3, 1);
            for (const std::uint32_t v : t) put(v, 2);
        }
        const auto result = importMesh(write("t.ply", bytes), 1.0);
        ASSERT_TRUE(result) << toString(result.errors()[0]);
        EXPECT_TRUE(result->report.watertight);
        EXPECT_NEAR(result->report.volume, 1.0 / 6.0, 1e-15);
    }
}

TEST_F(MeshImport, ReportsAHole) {
    // Truth: closed form. One triangle missing leaves one chain of three edges.
    const auto result = importMesh(write("hole.off", off(test::withHole(boxMesh(), {3}))), 1e-3);
    ASSERT_TRUE(result);
    EXPECT_FALSE(result->report.watertight);
    EXPECT_EQ(result->report.holes, 1u);
    EXPECT_EQ(result->report.boundary_edges, 3u);
    EXPECT_EQ(result->report.triangles, 11u);
    ASSERT_EQ(result->report.notes.size(), 3u);
    EXPECT_NE(result->report.notes[0].find("open: 3 edges"), std::string::npos) << result->report.notes[0];
    EXPECT_EQ(result->report.notes[1], "1 hole was closed.");
    EXPECT_EQ(result->report.notes[2], "1 triangle was added for that.");
    EXPECT_EQ(result->mesh.triangles.size(), 12u);
    EXPECT_NEAR(result->report.volume, 2.4e-5, 1e-10);
}

TEST_F(MeshImport, TurnsAFlippedTriangle) {
    // Truth: closed form. One flipped triangle quarrels along its three edges; turned, the box is sound again.
    const auto result = importMesh(write("flipped.ply", ply(test::withFlipped(boxMesh(), {5}))), 1e-3);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->report.inconsistent_edges, 3u);
    EXPECT_EQ(result->report.turned_triangles, 1u);
    EXPECT_TRUE(result->report.watertight);
    EXPECT_FALSE(result->report.turned_inside_out);
    EXPECT_NEAR(test::volume(result->mesh), 2.4e-5, 1e-10);
}

TEST_F(MeshImport, TurnsASolidThatIsInsideOut) {
    // Truth: closed form. The volume must come out positive.
    const auto result = importMesh(write("inverted.stl", binaryStl(test::insideOut(boxMesh()))), 1e-3);
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->report.turned_inside_out);
    EXPECT_TRUE(result->report.watertight);
    EXPECT_NEAR(test::volume(result->mesh), 2.4e-5, 1e-10);
}

TEST_F(MeshImport, DropsDuplicateAndDegenerateTriangles) {
    // Truth: closed form. Two repeats (one the other way round), a line and a point are added to a box.
    geometry::TriangleMesh mesh = test::withDuplicates(boxMesh(), {0, 7});
    std::swap(mesh.triangles.back()[0], mesh.triangles.back()[1]);
    mesh.vertices.push_back(0.5 * (mesh.vertices[0] + mesh.vertices[1]));
    mesh.triangles.push_back({0, 1, static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
    mesh.triangles.push_back({4, 4, 4});
    const auto result = importMesh(write("repeats.off", off(mesh)), 1e-3);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->report.triangles_read, 16u);
    EXPECT_EQ(result->report.duplicate_triangles, 2u);
    EXPECT_EQ(result->report.degenerate_triangles, 2u);
    EXPECT_EQ(result->report.triangles, 12u);
    EXPECT_EQ(result->report.vertices, 8u);
    EXPECT_TRUE(result->report.watertight);
}

TEST_F(MeshImport, ReportsEdgesOfThreeTriangles) {
    // Truth: closed form. A fin on one edge of a box: that edge has three triangles, the fin two open ones. The box is
    // a solid, the fin is no hole of it.
    geometry::TriangleMesh mesh = boxMesh();
    mesh.vertices.emplace_back(0.05, 0.05, 0.0);
    mesh.triangles.push_back({0, 1, 8});
    const auto result = importMesh(write("fin.obj", obj(mesh)), 1e-3);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->report.non_manifold_edges, 1u);
    EXPECT_EQ(result->report.boundary_edges, 2u);
    EXPECT_FALSE(result->report.watertight);
    EXPECT_EQ(result->report.kind, SurfaceKind::HoledSolid);
    EXPECT_EQ(result->report.open_edges_left, 3u);
    EXPECT_EQ(result->mesh.triangles.size(), 13u);
    EXPECT_EQ(result->report.notes.size(), 3u);
}

TEST_F(MeshImport, CountsShells) {
    // Truth: closed form. Two boxes apart, one of them with a hole.
    geometry::TriangleMesh mesh = boxMesh();
    const geometry::TriangleMesh other = test::withHole(boxMesh(), {0});
    for (const Vec3& v : other.vertices) mesh.vertices.push_back(v + Vec3(0.1, 0.0, 0.0));
    for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
    const auto result = importMesh(write("two.stl", asciiStl(mesh)), 1e-3);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->report.shells, 2u);
    EXPECT_EQ(result->report.holes, 1u);
    EXPECT_FALSE(result->report.watertight);
}

TEST_F(MeshImport, NamesFileAndReasonWhenItFails) {
    // Truth: closed form. One row per way to fail; nothing throws.
    std::filesystem::create_directories(folder() + "/folder.stl");
    geometry::TriangleMesh line;
    line.vertices = {Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(2, 2, 2)};
    line.triangles = {{0, 1, 2}};
    geometry::TriangleMesh broken = boxMesh();
    broken.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
    geometry::TriangleMesh endless = boxMesh();
    endless.vertices[3].z() = std::numeric_limits<double>::infinity();
    const std::vector<std::pair<std::string, std::string>> cases{
        {folder() + "/absent.stl", "does not exist"},
        {folder() + "/folder.stl", "may be read"},
        {write("empty.stl", ""), "is empty"},
        {write("noise.obj", "this is no mesh"), ""},
        {write("noise.3mf", "this is no package"), "3MF package"},
        {write("hollow.3mf", test::storedZip({{"readme.txt", "no model"}})), "3MF package"},
        {write("unknown.xyzzy", "1 2 3"), "must end in .stl"},
        {write("points.ply",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
               "property float z\nend_header\n0 0 0\n"),
         ""},
        {write("line.off", off(line)), "triangles with area"},
        {write("nan.stl", binaryStl(broken)), "finite"},
        {write("infinite.stl", binaryStl(endless)), "finite"},
    };
    for (const auto& [path, reason] : cases) {
        const auto result = importMesh(path, 1e-3);
        ASSERT_FALSE(result) << path;
        EXPECT_EQ(result.errors()[0].file, path);
        EXPECT_NE(result.errors()[0].message.find(reason), std::string::npos) << toString(result.errors()[0]);
        EXPECT_FALSE(result.errors()[0].message.empty());
    }
    EXPECT_FALSE(importMesh(write("box.stl", asciiStl(boxMesh())), 0.0));
    EXPECT_FALSE(importMesh(write("box.stl", asciiStl(boxMesh())), std::numeric_limits<double>::quiet_NaN()));
}

TEST(MeshRepair, FindsNothingToRepairInOurShapes) {
    // Truth: invariant. Tessellated shapes are sound: nothing dropped, joined or turned.
    for (const shape::Shape& shape :
         {shape::Shape(shape::Sphere{0.02}), shape::Shape(kBox), shape::Shape(shape::Cylinder{0.02, 0.03}),
          shape::Shape(shape::Peg{0.02, 0.05, 0.001}),
          shape::Shape(shape::BorePlate{0.06, 0.05, 0.03, 0.0202, 0.03, 0.001}),
          shape::Shape(shape::BorePlate{0.06, 0.05, 0.03, 0.0202, 0.02, 0.0})}) {
        const geometry::TriangleMesh mesh = shape::tessellate(shape, 1e-6);
        const ImportedMesh checked = repairMesh(mesh);
        EXPECT_EQ(checked.report.triangles, mesh.triangles.size()) << shape::kindName(shape);
        EXPECT_EQ(checked.report.vertices, mesh.vertices.size()) << shape::kindName(shape);
        EXPECT_TRUE(checked.report.watertight) << shape::kindName(shape);
        EXPECT_TRUE(checked.report.notes.empty()) << shape::kindName(shape);
        EXPECT_NEAR(checked.report.volume, test::volume(mesh), 1e-15) << shape::kindName(shape);
    }
    const ImportedMesh sheet = repairMesh(shape::tessellate(shape::Sheet{0.04, 0.03}, 1.0));
    EXPECT_FALSE(sheet.report.watertight);
    EXPECT_EQ(sheet.report.boundary_edges, 4u);
    EXPECT_EQ(sheet.report.holes, 1u);
}

TEST(MeshRepair, PutsAMangledMeshTogetherAgain) {
    // Truth: invariant. Corners unshared, a tenth of the triangles flipped, some repeated: the closed surface comes
    // back.
    const geometry::TriangleMesh sound = test::wavySphere(0.02, 5e-5);
    std::vector<std::size_t> flipped, repeated;
    for (std::size_t i = 0; i < sound.triangles.size(); i += 10) flipped.push_back(i);
    for (std::size_t i = 3; i < sound.triangles.size(); i += 50) repeated.push_back(i);
    const geometry::TriangleMesh mangled =
        test::unshared(test::withDuplicates(test::withFlipped(sound, flipped), repeated));
    const ImportedMesh mended = repairMesh(mangled);
    EXPECT_EQ(mended.report.vertices, sound.vertices.size());
    EXPECT_EQ(mended.report.triangles, sound.triangles.size());
    EXPECT_EQ(mended.report.duplicate_triangles, repeated.size());
    EXPECT_EQ(mended.report.turned_triangles, flipped.size());
    EXPECT_TRUE(mended.report.watertight);
    EXPECT_NEAR(mended.report.volume, test::volume(sound), 1e-15);
    const test::EdgeCount edges = test::countEdges(mended.mesh);
    EXPECT_EQ(edges.open + edges.crowded, 0u);
}

TEST(MeshRepair, JoinsVerticesThatOnlyRoundingParts) {
    // Truth: closed form. Every triangle with corners of its own, rounded apart by up to 1e-7 of the size: the box
    // comes back, its volume off by no more than that.
    geometry::TriangleMesh mesh = test::unshared(boxMesh());
    Random random(3);
    const double apart = 1e-7 * kBox.height;
    for (Vec3& v : mesh.vertices) v += apart * Vec3(random.uniform(), random.uniform(), random.uniform());
    const ImportedMesh repaired = repairMesh(mesh);
    EXPECT_EQ(repaired.report.joined_vertices, mesh.vertices.size() - 8);
    EXPECT_EQ(repaired.report.kind, SurfaceKind::Solid);
    EXPECT_TRUE(repaired.report.watertight);
    EXPECT_NEAR(repaired.report.volume, 2.4e-5, 2.4e-5 * 1e-5);
    // A gap of a thousandth is a gap.
    for (Vec3& v : mesh.vertices) v += 1e-3 * kBox.height * Vec3(random.uniform(), random.uniform(), random.uniform());
    EXPECT_EQ(repairMesh(mesh).report.joined_vertices, 0u);
}

TEST(MeshRepair, AsksForTheUnitOfPartsOfUnusualSize) {
    // Truth: closed form. 40 mm as metres are 40 m; as micrometres they are 0.04 mm.
    for (const auto& [scale, words] : {std::pair{1e3, "4e+04 mm long"}, {1e-3, "0.04 mm long"}}) {
        geometry::TriangleMesh mesh = boxMesh();
        for (Vec3& v : mesh.vertices) v *= scale;
        const MeshReport report = repairMesh(mesh).report;
        ASSERT_EQ(report.notes.size(), 1u);
        EXPECT_NE(report.notes[0].find(words), std::string::npos) << report.notes[0];
        EXPECT_EQ(report.kind, SurfaceKind::Solid);
    }
}

TEST(MeshRepair, SurvivesASurfaceWithOneSide) {
    // Truth: invariant. A Möbius strip has no orientation: it stays open, and the work ends.
    geometry::TriangleMesh mesh;
    const int n = 12;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * 3.14159265358979 * i / n;
        const Vec3 outward(std::cos(angle), std::sin(angle), 0.0);
        const Vec3 across = std::cos(angle / 2) * outward + std::sin(angle / 2) * Vec3::UnitZ();
        mesh.vertices.push_back(outward - 0.3 * across);
        mesh.vertices.push_back(outward + 0.3 * across);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const bool seam = i + 1 == n;
        const std::uint32_t a = 2 * i, b = a + 1, c = seam ? 1 : a + 2, d = seam ? 0 : a + 3;
        mesh.triangles.push_back({a, c, b});
        mesh.triangles.push_back({b, c, d});
    }
    const ImportedMesh checked = repairMesh(mesh);
    EXPECT_FALSE(checked.report.watertight);
    EXPECT_GT(checked.report.inconsistent_edges, 0u);
    EXPECT_EQ(checked.report.holes, 1u);  // its border is one line
    EXPECT_EQ(checked.report.shells, 1u);
}

TEST(MeshRepair, ReportsAnEmptyMeshAsSuch) {
    // Truth: closed form.
    const ImportedMesh empty = repairMesh(geometry::TriangleMesh{});
    EXPECT_EQ(empty.report.triangles, 0u);
    EXPECT_FALSE(empty.report.watertight);
    EXPECT_EQ(empty.report.size, Vec3(Vec3::Zero()));
}

}  // namespace
}  // namespace passung::importer
