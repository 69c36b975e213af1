#include "core/geometry/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/shape/shape.h"

namespace passung::geometry {
namespace {

TriangleMesh smallMesh() {
    return {{Vec3(0.0, 0.0, 0.0), Vec3(0.01, 0.0, 0.0), Vec3(0.0, 0.02, 0.0), Vec3(-0.0, 0.0, 1e-9)},
            {{0, 1, 2}, {0, 3, 1}}};
}

TEST(ContentHash, IsFnv1aOfCountsVerticesAndTriangles) {
    // Truth: independent program (Python 3: struct.pack('<QQ', 4, 2) + '<3d' per vertex + '<3I' per triangle, FNV-1a
    // 64)
    EXPECT_EQ(contentHash(smallMesh()), 0x4b95138f16f1b6ddu);
    // Truth: closed form. FNV-1a of sixteen zero bytes is the offset basis times the prime to the sixteenth.
    std::uint64_t empty = 0xcbf29ce484222325u;
    for (int i = 0; i < 16; ++i) empty *= 0x100000001b3u;
    EXPECT_EQ(contentHash(TriangleMesh{}), empty);
}

TEST(ContentHash, ChangesWithTheLastBitOfAnyCoordinateAndWithAnyCorner) {
    // Truth: invariant.
    std::set<std::uint64_t> hashes{contentHash(smallMesh())};
    for (std::size_t v = 0; v < 4; ++v)
        for (int axis = 0; axis < 3; ++axis) {
            TriangleMesh mesh = smallMesh();
            mesh.vertices[v][axis] = std::nextafter(mesh.vertices[v][axis], 1.0);
            hashes.insert(contentHash(mesh));
        }
    for (std::size_t t = 0; t < 2; ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            TriangleMesh mesh = smallMesh();
            mesh.triangles[t][k] ^= 1u;
            hashes.insert(contentHash(mesh));
        }
    TriangleMesh signless = smallMesh();
    signless.vertices[3].x() = 0.0;
    hashes.insert(contentHash(signless));
    TriangleMesh reordered = smallMesh();
    std::swap(reordered.triangles[0], reordered.triangles[1]);
    hashes.insert(contentHash(reordered));
    EXPECT_EQ(hashes.size(), 1u + 12u + 6u + 2u);
}

TEST(ContentHash, TellsShapesApartByTheirDimensions) {
    // Truth: invariant.
    const auto hashOf = [](const shape::Shape& shape) { return contentHash(shape::tessellate(shape, 1e-5)); };
    EXPECT_EQ(hashOf(shape::Peg{0.02, 0.05, 0.001}), hashOf(shape::Peg{0.02, 0.05, 0.001}));
    EXPECT_NE(hashOf(shape::Peg{0.02, 0.05, 0.001}), hashOf(shape::Peg{0.02, 0.05, 0.0010001}));
    EXPECT_NE(hashOf(shape::Box{0.02, 0.03, 0.04}), hashOf(shape::Box{0.03, 0.02, 0.04}));
}

}  // namespace
}  // namespace passung::geometry
