#include "core/geometry/cluster_tree.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/random.h"
#include "core/shape/shape.h"

namespace passung::geometry {
namespace {

constexpr double kRounding = 1e-15;  // [m]

std::vector<Vec3> cornersOf(const ClusterTree& tree, const Cluster& cluster) {
    std::vector<Vec3> corners;
    for (std::uint32_t i = 0; i < cluster.count; ++i) corners.push_back(tree.corner(cluster.first + i));
    return corners;
}

double leastAlong(const std::vector<Vec3>& corners, const Vec3& way) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& p : corners) least = std::min(least, way.dot(p));
    return least;
}

/// Corners of all faces below, after a check that the cluster is around them.
std::vector<Vec3> checkedBelow(const ClusterTree& tree, std::uint32_t at, const std::vector<Vec3>& ways) {
    const Cluster& cluster = tree[at];
    const std::vector<Vec3> own = cornersOf(tree, cluster);
    if (cluster.isFace()) return own;
    std::vector<Vec3> below = checkedBelow(tree, cluster.child, ways);
    const std::vector<Vec3> second = checkedBelow(tree, cluster.child + 1, ways);
    below.insert(below.end(), second.begin(), second.end());
    for (const Vec3& p : below) EXPECT_LE((p - cluster.centre).norm(), cluster.radius + kRounding) << at;
    for (const Vec3& way : ways) EXPECT_LE(leastAlong(own, way), leastAlong(below, way) + kRounding) << at;
    return below;
}

std::vector<std::uint32_t> trianglesOf(const ClusterTree& tree) {
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t i = 0; i < tree.size(); ++i)
        if (tree[i].isFace()) triangles.push_back(tree[i].triangle);
    return triangles;
}

TEST(ClusterTree, EveryClusterOfATreeAndOfSeveralIsAroundItsFaces) {
    // Truth: invariant; the placed vertices of each mesh by the pose itself.
    Random random(7);
    std::vector<Vec3> ways;
    for (int i = 0; i < 40; ++i) ways.push_back(Vec3(random.normal(), random.normal(), random.normal()).normalized());
    const std::vector<TriangleMesh> meshes{shape::tessellate(shape::Torus{0.03, 0.01}, 2e-5),
                                           shape::tessellate(shape::Box{0.01, 0.02, 0.03}, 1e-5),
                                           shape::tessellate(shape::Peg{0.02, 0.05, 0.001}, 1e-5)};
    std::vector<ClusterTree> trees;
    for (const TriangleMesh& mesh : meshes) trees.emplace_back(mesh);
    std::vector<PlacedTree> placed;
    for (const ClusterTree& tree : trees) {
        checkedBelow(tree, 0, ways);
        const Quat q(random.normal(), random.normal(), random.normal(), random.normal());
        placed.push_back({&tree, {q.normalized(), 0.1 * Vec3(random.normal(), random.normal(), random.normal())}});
    }
    const ClusterTree whole{std::span<const PlacedTree>(placed)};
    std::vector<Vec3> corners = checkedBelow(whole, 0, ways);
    std::size_t faces = 0, triangles = 0;
    double farthest = 0.0;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        faces += trianglesOf(trees[i]).size();
        for (const Vec3& v : meshes[i].vertices) {
            const Vec3 p = placed[i].X * v;
            farthest = std::max(farthest, p.norm());
            double nearest = std::numeric_limits<double>::infinity();
            for (const Vec3& way : ways) nearest = std::min(nearest, way.dot(p) - leastAlong(corners, way));
            EXPECT_GE(nearest, -1e-9) << "a vertex outside the hull of all faces";
        }
        // A face is of a triangle of its own mesh, and lies in that triangle's plane.
        for (std::uint32_t c = 0; c < whole.size(); ++c) {
            const std::uint32_t triangle = whole[c].triangle;
            if (!whole[c].isFace() || triangle < triangles || triangle >= triangles + meshes[i].triangles.size())
                continue;
            const auto& t = meshes[i].triangles[triangle - triangles];
            const Vec3 a = placed[i].X * meshes[i].vertices[t[0]], b = placed[i].X * meshes[i].vertices[t[1]],
                       d = placed[i].X * meshes[i].vertices[t[2]];
            const Vec3 n = (b - a).cross(d - a).normalized();
            EXPECT_GT(n.dot(whole[c].normal), 0.99);
            for (const Vec3& p : cornersOf(whole, whole[c])) EXPECT_LE(std::abs(n.dot(p - a)), 1e-9);
        }
        triangles += meshes[i].triangles.size();
    }
    EXPECT_EQ(trianglesOf(whole).size(), faces);
    EXPECT_EQ(whole.triangleCount(), triangles);
    EXPECT_NEAR(whole.reach(), farthest, 1e-9);
}

/// The parts of which faces lie below, told by their triangles.
void partsBelow(const ClusterTree& tree, std::uint32_t at, std::uint32_t triangles, std::vector<std::uint32_t>& parts) {
    const Cluster& cluster = tree[at];
    if (cluster.isFace()) return parts.push_back(cluster.triangle / triangles);
    partsBelow(tree, cluster.child, triangles, parts);
    partsBelow(tree, cluster.child + 1, triangles, parts);
}

TEST(ClusterTree, OfManyPartsThoseThatAreNearEachOtherAreClusters) {
    // Truth: closed form. Boxes along a line, in any order in the scene: each half of the line is a cluster. Triangles
    // are those of the part that they were given with.
    Random random(8);
    const auto mesh = shape::tessellate(shape::Box{0.01, 0.01, 0.01}, 1e-5);
    const ClusterTree box(mesh);
    const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size());
    std::vector<PlacedTree> placed;
    placed.reserve(64);
    for (int i = 0; i < 64; ++i) placed.push_back({&box, {Quat::Identity(), Vec3(0.1 * i, 0.001 * (i % 7), 0)}});
    shuffle(placed, random);
    const ClusterTree whole{std::span<const PlacedTree>(placed)};
    for (std::uint32_t c = 0; c < whole.size(); ++c) {
        if (!whole[c].isFace()) continue;
        const Vec3& middle = placed[whole[c].triangle / triangles].X.p;
        for (const Vec3& p : cornersOf(whole, whole[c])) EXPECT_LE((p - middle).cwiseAbs().maxCoeff(), 0.005 + 1e-12);
    }
    for (const std::uint32_t child : {whole[0].child, whole[0].child + 1}) {
        std::vector<std::uint32_t> parts;
        partsBelow(whole, child, triangles, parts);
        double least = 10.0, most = -10.0;
        for (const std::uint32_t part : parts) {
            least = std::min(least, placed[part].X.p.x());
            most = std::max(most, placed[part].X.p.x());
        }
        EXPECT_NEAR(most - least, 3.1, 1e-9) << "half of the line, less one";
    }
}

}  // namespace
}  // namespace passung::geometry
