#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/model/part.h"

namespace passung::model {
namespace {

Part fieldOf(const Shape& shape, double cell) {
    PartSpec spec;
    spec.name = kindName(shape);
    spec.geometry = shape;
    auto part = buildPart(spec, {.field = true, .cell = cell});
    EXPECT_TRUE(part);
    return std::move(*part);
}

const std::vector<Shape> kSolids{Sphere{0.03}, Box{0.02, 0.03, 0.04}, Cylinder{0.02, 0.03}, Peg{0.02, 0.05, 0.001},
                                 BorePlate{0.06, 0.06, 0.03, 0.0202, 0.025, 0.001}};

Vec3 anywhere(const Bounds& bounds, double margin, Random& random) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis)
        p[axis] = random.uniform(bounds.low[axis] - margin, bounds.high[axis] + margin);
    return p;
}

TEST(DistanceField, ErrsLessThanItsRigorousBoundEverywhere) {
    // Truth: closed form of each shape; points near, far and outside the grid.
    Random random(1);
    for (const Shape& shape : kSolids) {
        const Part part = fieldOf(shape, 0.7e-3);
        for (const FieldMode mode : {FieldMode::Trilinear, FieldMode::Linear}) {
            for (int i = 0; i < 20000; ++i) {
                const Vec3 p = anywhere(part.field->bounds(), i % 2 ? 0.002 : 0.15, random);
                const double error = std::abs(part.field->sample(p, mode).phi - signedDistance(shape, p));
                ASSERT_LE(error, part.field->errorBound(p, mode)) << kindName(shape) << " at " << p.transpose();
            }
        }
    }
}

TEST(DistanceField, LowerBoundIsNeverAboveTheTrueDistance) {
    // Truth: closed form.
    Random random(2);
    for (const Shape& shape : kSolids) {
        const Part part = fieldOf(shape, 0.7e-3);
        for (int i = 0; i < 20000; ++i) {
            const Vec3 p = anywhere(part.field->bounds(), i % 2 ? 0.002 : 0.15, random);
            ASSERT_LE(part.field->lowerBound(p), signedDistance(shape, p) + 1e-12) << kindName(shape);
        }
    }
}

TEST(DistanceField, LowerBoundFarFromAConvexPartIsAsNearAsDerived) {
    // Truth: closed form. d - bound ≤ S/d with S ≤ 3/4 of the squared edge of a coarse cell, plus rounding.
    constexpr double kCell = 0.7e-3, kEdge = DistanceField::kBrickCells * kCell;
    Random random(4);
    for (const Shape& shape : {Shape{Sphere{0.03}}, Shape{Box{0.02, 0.03, 0.04}}, Shape{Cylinder{0.02, 0.03}}}) {
        const Part part = fieldOf(shape, kCell);
        int far = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3 p = anywhere(part.field->bounds(), 0.03, random);
            const double d = signedDistance(shape, p);
            if (d < 2.0 * kEdge) continue;
            ++far;
            ASSERT_LE(d - part.field->lowerBound(p), 0.75 * kEdge * kEdge / d + 1e-8) << kindName(shape);
        }
        EXPECT_GT(far, 5000);
    }
}

TEST(DistanceField, TrilinearErrorOnAWallFallsWithTheSquareOfTheCell) {
    // Truth: closed form; worst error near a cylinder of radius R is at most about 0.13 s²/R (theory of interpolation).
    const double R = 0.01;
    Random random(3);
    double last = 0.0;
    for (const double cell : {1e-3, 0.5e-3, 0.25e-3}) {
        const Shape shape = Cylinder{2 * R, 0.04};
        const Part part = fieldOf(shape, cell);
        double worst = 0.0;
        for (int i = 0; i < 20000; ++i) {
            const double angle = random.uniform(0.0, 6.2831853), r = R + random.uniform(-0.5, 0.5) * cell;
            const Vec3 p(r * std::cos(angle), r * std::sin(angle), random.uniform(-0.01, 0.01));
            worst = std::max(worst, std::abs(part.field->sample(p, FieldMode::Trilinear).phi - (r - R)));
        }
        EXPECT_LT(worst, 0.14 * cell * cell / R);
        if (last > 0.0) {
            EXPECT_NEAR(last / worst, 4.0, 1.0);
        }
        last = worst;
    }
}

TEST(DistanceField, GradientIsThatOfTheInterpolantAndPointsOut) {
    // Truth: invariant (difference quotient of the same interpolant inside one cell), and closed form of a plane.
    const Part part = fieldOf(Box{0.04, 0.04, 0.04}, 0.5e-3);
    const Vec3 p(0.0012, -0.0033, 0.0203);
    for (const FieldMode mode : {FieldMode::Trilinear, FieldMode::Linear}) {
        const FieldSample s = part.field->sample(p, mode);
        EXPECT_NEAR(s.gradient.z(), 1.0, 1e-4);
        for (int axis = 0; axis < 3; ++axis) {
            const double h = 1e-7;
            const double slope = (part.field->sample(p + h * Vec3::Unit(axis), mode).phi - s.phi) / h;
            EXPECT_NEAR(s.gradient[axis], slope, 1e-3);
        }
    }
}

TEST(DistanceField, HoldsAnOpenSheetOffByItsStatedOffsetOnBothSides) {
    // Truth: closed form: |z| - offset above and below the sheet's middle, outside its kink.
    const Part part = fieldOf(Sheet{0.05, 0.05}, 0.5e-3);
    ASSERT_GT(part.field->sheetOffset(), 0.0);
    for (const double side : {1.0, -1.0}) {
        for (double z = 0.0005; z < 0.0018; z += 0.0001) {
            const FieldSample s = part.field->sample(Vec3(0.003, 0.002, side * z), FieldMode::Trilinear);
            EXPECT_NEAR(s.phi, z - part.field->sheetOffset(), 0.02e-3);
            EXPECT_NEAR(s.gradient.z(), side, 0.05);
        }
    }
}

TEST(DistanceField, OfASheetStaysSmallAndItsBoundHoldsInFrontOfTheOffset) {
    // Truth: closed form: the distance to the rectangle less the stated offset.
    const Shape shape = Sheet{0.1, 0.1};
    PartSpec spec;
    spec.geometry = shape;
    const auto part = buildPart(spec, {.field = true, .tolerance = 20e-6});
    ASSERT_TRUE(part);
    const DistanceField& field = *part->field;
    EXPECT_LT(field.memoryBytes(), 50u << 20);
    EXPECT_LE(field.sheetOffset(), 0.1 / 256);
    EXPECT_NE(part->report.notes.back().find("0.391 mm"), std::string::npos) << part->report.notes.back();
    Random random(6);
    int good = 0, near = 0;
    for (int i = 0; i < 40000; ++i) {
        const Vec3 p = anywhere(field.bounds(), i % 2 ? 0.002 : 0.15, random);
        const double truth = signedDistance(shape, p) - field.sheetOffset();
        const double error = std::abs(field.sample(p, FieldMode::Trilinear).phi - truth);
        ASSERT_LE(error, field.errorBound(p, FieldMode::Trilinear)) << p.transpose();
        ASSERT_LE(field.lowerBound(p), truth) << p.transpose();
        if (std::abs(truth) > 0.3e-3 || truth < 0.0) continue;
        ++near;
        good += error <= 20e-6 ? 1 : 0;
    }
    EXPECT_GT(good, 0.9 * near);
}

TEST(DistanceField, BoundsHoldForLargePartsWhereFloatsRoundTheMost) {
    // Truth: closed form. At the nodes nothing is interpolated: only the rounding of the stored floats is left, 6e-8 of
    // the distance. Points lie within 1e-9 of a cell of nodes of the fine cells and of the coarse grid.
    for (const double size : {1.0, 10.0}) {
        for (const Shape& shape : {Shape(Sphere{size}), Shape(Box{size, 0.7 * size, 0.3 * size})}) {
            const double cell = size / 40.0, brick = 8.0 * cell;
            const Part part = fieldOf(shape, cell);
            const Vec3 origin = part.field->bounds().low - Vec3::Constant(size + 4.0 * cell + brick);
            Random random(7);
            double worst = 0.0;
            for (int i = 0; i < 20000; ++i) {
                const double edge = i % 2 ? cell : brick;
                Vec3 p = anywhere(part.field->bounds(), i % 2 ? 2.0 * cell : 0.9 * size, random);
                for (int k = 0; k < 3; ++k)
                    p[k] =
                        origin[k] + edge * (std::round((p[k] - origin[k]) / edge) + 1e-9 * random.uniform(-1.0, 1.0));
                if (i % 8 == 0) p = anywhere(part.field->bounds(), size, random);
                const double truth = signedDistance(shape, p);
                ASSERT_LE(part.field->lowerBound(p), truth) << kindName(shape) << " at " << p.transpose();
                for (const FieldMode mode : {FieldMode::Trilinear, FieldMode::Linear}) {
                    const double error = std::abs(part.field->sample(p, mode).phi - truth);
                    const double bound = part.field->errorBound(p, mode);
                    ASSERT_LE(error, bound) << kindName(shape) << " at " << p.transpose();
                    if (bound < 1e-6 * size) worst = std::max(worst, error / bound);
                }
            }
            EXPECT_GT(worst, 0.2) << "the points do not come near the bound";
        }
    }
}

TEST(DistanceField, RefusesAGridThatWouldNotFitIntoMemory) {
    // Truth: invariant (the documented limit of 2 GiB).
    PartSpec spec;
    spec.name = "large";
    spec.geometry = Shape(Box{10, 10, 10});
    const auto part = buildPart(spec, {.field = true, .cell = 1e-4});
    ASSERT_FALSE(part);
    EXPECT_NE(toString(part.errors().front()).find("2 GiB"), std::string::npos);
}

TEST(DistanceField, MeetsTheAskedToleranceOnMostOfTheSurface) {
    // Truth: closed form; chooseCell promises the tolerance for nine points in ten near the surface.
    const Shape shape = Peg{0.02, 0.03, 0.001};
    PartSpec spec;
    spec.geometry = shape;
    for (const double tolerance : {50e-6, 10e-6}) {
        const auto part = buildPart(spec, {.field = true, .shell = true, .tolerance = tolerance});
        ASSERT_TRUE(part);
        int good = 0, all = 0;
        Random random(4);
        for (const SurfacePoint& point : part->shell->points()) {
            const Vec3 p = point.position + random.uniform(-0.2e-3, 0.2e-3) * point.normal;
            const double error = std::abs(part->field->sample(p, FieldMode::Trilinear).phi - signedDistance(shape, p));
            good += error <= tolerance ? 1 : 0;
            ++all;
        }
        EXPECT_GT(good, 0.85 * all) << tolerance;
    }
}

}  // namespace
}  // namespace passung::model
