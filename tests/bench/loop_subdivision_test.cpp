#include "tests/bench/loop_subdivision.h"

#include <gtest/gtest.h>

#include "tests/bench/contact_scene.h"
#include "tests/support/brute_force_mesh.h"

namespace passung::bench {
namespace {

geometry::TriangleMesh octahedron() {
    return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
            {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

TEST(LoopSubdivision, MovesTheOctahedronAsTheRulesSay) {
    // Truth: closed form. Valence 4: 4 β = 5/8 - (3/8)² = 31/64, so a vertex (its neighbours sum to 0) shrinks to
    // 33/64; the edge between x and y, with opposite corners ±z, goes to 3/8 (x + y).
    const geometry::TriangleMesh fine = subdivideLoop(octahedron());
    ASSERT_EQ(fine.vertices.size(), 18u);
    ASSERT_EQ(fine.triangles.size(), 32u);
    EXPECT_NEAR((fine.vertices[0] - Vec3(33.0 / 64, 0, 0)).norm(), 0.0, 1e-15);
    int found = 0;
    for (const Vec3& v : fine.vertices) found += (v - Vec3(0.375, 0.375, 0)).norm() < 1e-15 ? 1 : 0;
    EXPECT_EQ(found, 1);
}

TEST(LoopSubdivision, MovesATetrahedronsCornersAsTheRulesSay) {
    // Truth: closed form. Valence 3: 3 β = 5/8 - (3/8 - 1/8)² = 9/16; a corner's neighbours sum to its negative, so it
    // goes to (1 - 9/16 - 3/16) v = v / 4.
    const geometry::TriangleMesh tetrahedron{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                                             {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
    const geometry::TriangleMesh fine = subdivideLoop(tetrahedron);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR((fine.vertices[i] - 0.25 * tetrahedron.vertices[i]).norm(), 0.0, 1e-15);
}

TEST(LoopSubdivision, KeepsAClosedMeshClosedAndItsOrientation) {
    // Truth: invariant. Every directed edge is used once and has its opposite; the volume keeps its sign.
    const geometry::TriangleMesh fine = subdivideLoop(subdivideLoop(octahedron()));
    const test::EdgeCount edges = test::countEdges(fine);
    EXPECT_EQ(edges.open, 0u);
    EXPECT_EQ(edges.crowded, 0u);
    EXPECT_GT(test::volume(fine), 0.0);
}

TEST(LoopSubdivision, MakesTheBenchBunny) {
    // Truth: invariant. Each step makes four triangles of one: 3 674 · 16 = 58 784; longest side 0.15 m.
    const auto bunny = loadBunny(PASSUNG_SOURCE_DIR "/tests/data/bunny.off");
    ASSERT_TRUE(bunny);
    EXPECT_EQ(bunny->triangles.size(), 58'784u);
    EXPECT_NEAR(geometry::boundsOf(*bunny).size().maxCoeff(), 0.15, 1e-12);
    EXPECT_EQ(test::countEdges(*bunny).open, 0u);
    EXPECT_GT(test::volume(*bunny), 0.0);
}

}  // namespace
}  // namespace passung::bench
