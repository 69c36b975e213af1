#include "analysis/truth/mesh_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "core/shape/shape.h"

namespace passung::truth {
namespace {

constexpr double kChord = 20e-6;  // of the tessellated balls [m]

MeshOracle oracleOf(const shape::Shape& a, const shape::Shape& b) {
    return {shape::tessellate(a, kChord), shape::tessellate(b, kChord)};
}

Quat randomTurn(Random& random) {
    return Quat(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
}

TEST(MeshOracle, SeparatesTwoBalls) {
    // Truth: closed form (distance of the centres minus both radii; each mesh lies up to a chord error inside)
    const MeshOracle oracle = oracleOf(shape::Sphere{0.04}, shape::Sphere{0.02});
    Random random(1);
    for (int i = 0; i < 200; ++i) {
        const double gap = random.uniform(1e-4, 0.02);
        const Pose X_AB{randomTurn(random), randomTurn(random) * Vec3(0, 0, 0.03 + gap)};
        EXPECT_EQ(*oracle.relation(X_AB), Relation::Apart);
        EXPECT_GE(*oracle.separation(X_AB), gap - 1e-12);
        EXPECT_LE(*oracle.separation(X_AB), gap + 2 * kChord);
        EXPECT_EQ(oracle.depth(X_AB, 1e-5)->depth, 0.0);
    }
}

TEST(MeshOracle, SeparatesACornerFromABallOfTinyTriangles) {
    // Truth: closed form (the corner is nearest to a ball in its octant). The ball's triangles have edges of about
    // 0.1 mm, whose faces FCL in metres leaves out: it would say 0, or how far an edge is.
    constexpr double kFine = 0.5e-6, kRadius = 2.5e-3;
    const MeshOracle oracle(shape::tessellate(shape::Box{0.01, 0.01, 0.01}, kFine),
                            shape::tessellate(shape::Sphere{2 * kRadius}, kFine));
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const double gap = random.uniform(2e-6, 20e-6);
        const Vec3 away = Vec3(random.uniform(), random.uniform(), random.uniform()).normalized();
        const Pose X_AB{randomTurn(random), Vec3::Constant(5e-3) + (kRadius + gap) * away};
        EXPECT_FALSE(*oracle.surfacesIntersect(X_AB));
        EXPECT_GE(*oracle.separation(X_AB), gap - 1e-12);
        EXPECT_LE(*oracle.separation(X_AB), gap + kFine);
    }
}

TEST(MeshOracle, FindsBallsThatOverlap) {
    // Truth: closed form (surfaces meet if |r1 - r2| < centres' distance < r1 + r2, chord errors kept off)
    const MeshOracle oracle = oracleOf(shape::Sphere{0.04}, shape::Sphere{0.02});
    Random random(2);
    for (int i = 0; i < 200; ++i) {
        const double centres = random.uniform(0.01 + 1e-4, 0.03 - 1e-4);
        const Pose X_AB{randomTurn(random), randomTurn(random) * Vec3(0, 0, centres)};
        EXPECT_EQ(*oracle.relation(X_AB), Relation::SurfacesIntersect);
        EXPECT_EQ(*oracle.separation(X_AB), 0.0);
    }
}

TEST(MeshOracle, KnowsContainmentFromBothSidesAndFromAbsence) {
    // Truth: closed form (the small ball lies wholly in the big one while the centres are closer than r1 - r2)
    const MeshOracle big_small = oracleOf(shape::Sphere{0.04}, shape::Sphere{0.02});
    const MeshOracle small_big = oracleOf(shape::Sphere{0.02}, shape::Sphere{0.04});
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const double centres = random.uniform(0.0, 0.01 - 1e-4);
        const Pose X_AB{randomTurn(random), randomTurn(random) * Vec3(0, 0, centres)};
        EXPECT_FALSE(*big_small.surfacesIntersect(X_AB));  // free, says FCL
        EXPECT_EQ(*big_small.relation(X_AB), Relation::BInsideA);
        EXPECT_EQ(*small_big.relation(X_AB), Relation::AInsideB);
        EXPECT_NEAR(*big_small.separation(X_AB), 0.01 - centres, 2 * kChord);
    }
}

TEST(MeshOracle, MeasuresTheDepthOfABallInABox) {
    // Truth: closed form (box face at z = 50 mm, ball of 20 mm sunk by a known depth)
    const MeshOracle oracle = oracleOf(shape::Box{0.1, 0.1, 0.1}, shape::Sphere{0.02});
    Random random(4);
    for (int i = 0; i < 20; ++i) {
        const double depth = random.uniform(1e-4, 0.015);
        const auto deepest = oracle.depth({randomTurn(random), Vec3(0.004, -0.007, 0.05 + 0.01 - depth)}, 1e-6);
        ASSERT_TRUE(deepest);
        EXPECT_NEAR(deepest->depth, depth, kChord + 1e-6);
    }
}

TEST(MeshOracle, SeparatesAndIntersectsBoxesExactly) {
    // Truth: closed form (boxes along x, faces parallel; both meshes are exact)
    const MeshOracle oracle = oracleOf(shape::Box{0.02, 0.02, 0.02}, shape::Box{0.04, 0.01, 0.01});
    EXPECT_NEAR(*oracle.separation({.p = Vec3(0.035, 0, 0)}), 0.005, 1e-12);
    EXPECT_FALSE(*oracle.surfacesIntersect({.p = Vec3(0.03 + 1e-9, 0, 0)}));
    EXPECT_TRUE(*oracle.surfacesIntersect({.p = Vec3(0.03 - 1e-9, 0, 0)}));
    // Corner to corner, 3-4-12 times 1 mm apart.
    EXPECT_NEAR(*oracle.separation({.p = Vec3(0.033, 0.019, 0.027)}), 0.013, 1e-12);
}

TEST(MeshOracle, RefusesAPoseThatIsNotFinite) {
    // Truth: invariant (no answer about a pose that does not exist)
    const MeshOracle oracle = oracleOf(shape::Box{1, 1, 1}, shape::Box{1, 1, 1});
    Pose broken;
    broken.p.y() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(oracle.surfacesIntersect(broken));
    EXPECT_FALSE(oracle.separation(broken));
    EXPECT_FALSE(oracle.relation(broken));
    EXPECT_FALSE(oracle.depth(broken, 1e-6));
}

}  // namespace
}  // namespace passung::truth
