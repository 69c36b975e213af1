#include "tests/bench/true_poses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "analysis/truth/mesh_oracle.h"

namespace passung::bench {
namespace {

const std::string kFolder = PASSUNG_SOURCE_DIR "/tests/data";

ContactScene storedScene(std::size_t count) {
    auto bunny = loadBunny(kFolder + "/bunny.off");
    auto scene = readTruePoses(std::move(*bunny), kFolder + "/bunny_torus_poses.csv", count);
    if (!scene) ADD_FAILURE() << toString(scene.errors().front());
    return std::move(*scene);
}

TEST(TruePoses, AreFiveHundredOfEachKindNearOneMillimetre) {
    // Truth: invariant. The search ends within 5 µm of 1 mm by a depth known to 10 µm.
    const ContactScene scene = storedScene(100'000);
    ASSERT_EQ(scene.pressed.size(), 500u);
    ASSERT_EQ(scene.apart.size(), 500u);
    for (const TruePose& pose : scene.pressed) {
        EXPECT_NEAR(pose.shell_in_field, -1e-3, 15e-6);
        EXPECT_LE(pose.uncertainty, 2e-6);
        EXPECT_GT(pose.one_way.force.norm(), 0.0);
        EXPECT_TRUE(isFinite(pose.one_way) && isFinite(pose.two_way));
    }
    for (const TruePose& pose : scene.apart) EXPECT_NEAR(pose.shell_in_field, 1e-3, 5e-6);
}

TEST(TruePoses, StoredDepthsAreThoseOfASearchOverAllTriangles) {
    // Truth: independent program (truth::deepestPoint, see surface_tree_test.cpp; FCL 0.7 distance).
    const ContactScene scene = storedScene(2);
    const truth::MeshOracle oracle(scene.bunny, scene.tool);
    for (const TruePose& pose : scene.pressed) {
        const truth::DeepestPoint deepest = *oracle.depth(pose.X_FS, 10e-6);
        EXPECT_LE(-pose.shell_in_field, deepest.depth + deepest.uncertainty);
        EXPECT_GE(-pose.shell_in_field + pose.uncertainty, deepest.depth);
    }
    for (const TruePose& pose : scene.apart)
        EXPECT_NEAR(pose.shell_in_field, *oracle.separation(pose.X_FS), 1e-11);  // stored with 9 digits
}

TEST(TruePoses, AreWhatTheSearchFindsToday) {
    // Truth: regression (the file was made by this search, which then cut triangles in four; it guards the file against
    // a change of either). Both depths are the true one to their uncertainty; the sums differ by their quadrature, by
    // at most 0.011 % of the force each (see kDenseEdge), on a lever of the tool's 26 mm.
    const ContactScene scene = storedScene(2);
    const double most = 2 * 1.1e-4, lever = 0.026;
    for (const TruePose& stored : scene.pressed) {
        const TruePose now = truthAt(scene, stored.X_FS);
        EXPECT_NEAR(now.shell_in_field, stored.shell_in_field, now.uncertainty + stored.uncertainty);
        EXPECT_NEAR(now.field_in_shell, stored.field_in_shell, now.uncertainty + stored.uncertainty);
        const double force = stored.one_way.force.norm();
        EXPECT_LT((now.one_way.force - stored.one_way.force).norm(), most * force);
        EXPECT_LT((now.two_way.torque - stored.two_way.torque).norm(), most * force * lever);
    }
}

TEST(TruePoses, RefuseOtherMeshes) {
    // Truth: invariant. A pose's truth belongs to the meshes it was found with.
    auto bunny = loadBunny(kFolder + "/bunny.off");
    bunny->vertices[0].x() += 1e-9;
    EXPECT_FALSE(readTruePoses(std::move(*bunny), kFolder + "/bunny_torus_poses.csv", 1));
}

}  // namespace
}  // namespace passung::bench
