#include "core/closed_form/solid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/closed_form/shape_pairs.h"

namespace passung::closed_form {
namespace {

constexpr double kPiecewise = 5e-9;  // of a conic in straight pieces [m]

class SolidOfShape : public testing::TestWithParam<ShapePair> {};

void expectSameInside(const shape::Shape& shape, Random& random) {
    const SmoothSolid solid = solidOf(shape).value();
    for (int i = 0; i < 50'000; ++i) {
        const Vec3 p = randomVector(random, {0.04, 0.04, 0.06});
        const double distance = shape::signedDistance(shape, p), value = valueOf(solid, p);
        if (std::abs(distance) < 1e-9) continue;
        ASSERT_EQ(value > 0.0, distance > 0.0) << p.transpose();
        ASSERT_LE(std::abs(value), std::abs(distance) + 1e-12) << p.transpose();
    }
}

TEST_P(SolidOfShape, IsInsideWhereTheShapeIsAndNowhereSaysMoreThanTheDistance) {
    // Truth: closed form (shape::signedDistance, which knows no lumps).
    Random random(1);
    expectSameInside(GetParam().held, random);
    expectSameInside(GetParam().obstacle, random);
}

void expectLinesInMaterial(const shape::Shape& shape) {
    const SmoothSolid solid = solidOf(shape).value();
    for (const Lump& lump : solid.lumps) EXPECT_LE(lump.faces.size(), kMostFaces);
    for (const Curve& edge : solid.edges)
        for (int i = 0; i <= 100; ++i) {
            const double begin = pieceOf(edge, 0).begin;
            const Vec3 p = pointOf(edge, begin + 0.01 * i * (edge.end - begin));
            ASSERT_LE(shape::signedDistance(shape, p), kPiecewise) << p.transpose();
        }
    for (const Curve& core : solid.cores)
        for (int i = 0; i <= 100; ++i) {
            const Vec3 p = pointOf(core, core.end * (0.02 * i - 1.0));
            ASSERT_LE(shape::signedDistance(shape, p), 1e-12) << p.transpose();
        }
}

TEST_P(SolidOfShape, HasNoLineOutsideOfItsMaterial) {
    // Truth: closed form. A line in free space would be a contact with nothing.
    expectLinesInMaterial(GetParam().held);
    expectLinesInMaterial(GetParam().obstacle);
}

INSTANTIATE_TEST_SUITE_P(All, SolidOfShape, testing::ValuesIn(allPairs()), nameOfPair);

TEST(SolidOfSheet, IsNoneBecauseASheetHasNoInside) {
    // Truth: invariant.
    EXPECT_FALSE(solidOf(shape::Sheet{0.1, 0.1}));
}

}  // namespace
}  // namespace passung::closed_form
