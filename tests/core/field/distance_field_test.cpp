#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/base/random.h"
#include "core/field/distance_field.h"
#include "core/scene/part.h"

namespace passung::field {
namespace {

scene::Part fieldOf(const shape::Shape& shape, double cell, double tolerance = 20e-6) {
    scene::PartSpec spec;
    spec.name = shape::kindName(shape);
    spec.geometry = shape;
    auto part = scene::buildPart(spec, {.field = true, .tolerance = tolerance, .cell = cell});
    EXPECT_TRUE(part);
    return std::move(*part);
}

const std::vector<shape::Shape> kSolids{shape::Sphere{0.03}, shape::Box{0.02, 0.03, 0.04}, shape::Cylinder{0.02, 0.03},
                                        shape::Peg{0.02, 0.05, 0.001},
                                        shape::BorePlate{0.06, 0.06, 0.03, 0.0202, 0.025, 0.001}};

Vec3 anywhere(const geometry::Bounds& bounds, double margin, Random& random) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis)
        p[axis] = random.uniform(bounds.low[axis] - margin, bounds.high[axis] + margin);
    return p;
}

TEST(DistanceField, ErrsLessThanItsRigorousBoundEverywhere) {
    // Truth: closed form of each shape; points near, far and outside the grid.
    Random random(1);
    for (const shape::Shape& shape : kSolids) {
        const scene::Part part = fieldOf(shape, 0.7e-3);
        for (const FieldMode mode : kFieldModes) {
            for (int i = 0; i < 20000; ++i) {
                const Vec3 p = anywhere(part.field->bounds(), i % 2 ? 0.002 : 0.15, random);
                const Vec3 inward(random.normal(), random.normal(), random.normal());
                const double error =
                    std::abs(part.field->sample(p, mode, inward.normalized()).phi - shape::signedDistance(shape, p));
                ASSERT_LE(error, part.field->errorBound(p, mode)) << shape::kindName(shape) << " at " << p.transpose();
            }
        }
    }
}

TEST(DistanceField, LowerBoundIsNeverAboveTheTrueDistance) {
    // Truth: closed form.
    Random random(2);
    for (const shape::Shape& shape : kSolids) {
        const scene::Part part = fieldOf(shape, 0.7e-3);
        for (int i = 0; i < 20000; ++i) {
            const Vec3 p = anywhere(part.field->bounds(), i % 2 ? 0.002 : 0.15, random);
            ASSERT_LE(part.field->lowerBound(p), shape::signedDistance(shape, p) + 1e-12) << shape::kindName(shape);
        }
    }
}

TEST(DistanceField, LowerBoundFarFromAConvexPartIsAsNearAsDerived) {
    // Truth: closed form. d - bound ≤ S/d with S ≤ 3/4 of the squared edge of a coarse cell, plus rounding.
    constexpr double kCell = 0.7e-3, kEdge = DistanceField::kBrickCells * kCell;
    Random random(4);
    for (const shape::Shape& shape : {shape::Shape{shape::Sphere{0.03}}, shape::Shape{shape::Box{0.02, 0.03, 0.04}},
                                      shape::Shape{shape::Cylinder{0.02, 0.03}}}) {
        const scene::Part part = fieldOf(shape, kCell);
        int far = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3 p = anywhere(part.field->bounds(), 0.03, random);
            const double d = shape::signedDistance(shape, p);
            if (d < 2.0 * kEdge) continue;
            ++far;
            ASSERT_LE(d - part.field->lowerBound(p), 0.75 * kEdge * kEdge / d + 1e-8) << shape::kindName(shape);
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
        const shape::Shape shape = shape::Cylinder{2 * R, 0.04};
        const scene::Part part = fieldOf(shape, cell);
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
    const scene::Part part = fieldOf(shape::Box{0.04, 0.04, 0.04}, 0.5e-3);
    const Vec3 p(0.0012, -0.0033, 0.0203);
    for (const FieldMode mode : {FieldMode::SurfacePoint, FieldMode::Linear, FieldMode::Trilinear, FieldMode::Cubic}) {
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
    const scene::Part part = fieldOf(shape::Sheet{0.05, 0.05}, 0.5e-3);
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
    const shape::Shape shape = shape::Sheet{0.1, 0.1};
    scene::PartSpec spec;
    spec.geometry = shape;
    const auto part = scene::buildPart(spec, {.field = true, .tolerance = 20e-6});
    ASSERT_TRUE(part);
    const DistanceField& field = *part->field;
    EXPECT_LT(field.memoryBytes(), 50u << 20);
    EXPECT_LE(field.sheetOffset(), 0.1 / 256);
    EXPECT_NE(part->report.notes.back().find("0.391 mm"), std::string::npos) << part->report.notes.back();
    Random random(6);
    int good = 0, near = 0;
    for (int i = 0; i < 40000; ++i) {
        const Vec3 p = anywhere(field.bounds(), i % 2 ? 0.002 : 0.15, random);
        const double truth = shape::signedDistance(shape, p) - field.sheetOffset();
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
        for (const shape::Shape& shape :
             {shape::Shape(shape::Sphere{size}), shape::Shape(shape::Box{size, 0.7 * size, 0.3 * size})}) {
            const double cell = size / 40.0, brick = 8.0 * cell;
            const scene::Part part = fieldOf(shape, cell, 1e-4 * size);  // of the triangles, which are not needed
            const Vec3 origin = part.field->bounds().low;                // a node of the coarse grid
            Random random(7);
            double worst = 0.0;
            for (int i = 0; i < 8000; ++i) {
                const double edge = i % 2 ? cell : brick;
                Vec3 p = anywhere(part.field->bounds(), i % 2 ? 2.0 * cell : 0.9 * size, random);
                for (int k = 0; k < 3; ++k)
                    p[k] =
                        origin[k] + edge * (std::round((p[k] - origin[k]) / edge) + 1e-9 * random.uniform(-1.0, 1.0));
                if (i % 8 == 0) p = anywhere(part.field->bounds(), size, random);
                const double truth = shape::signedDistance(shape, p);
                ASSERT_LE(part.field->lowerBound(p), truth) << shape::kindName(shape) << " at " << p.transpose();
                for (const FieldMode mode : {FieldMode::Trilinear, FieldMode::Linear}) {
                    const double error = std::abs(part.field->sample(p, mode).phi - truth);
                    const double bound = part.field->errorBound(p, mode);
                    ASSERT_LE(error, bound) << shape::kindName(shape) << " at " << p.transpose();
                    if (bound < 1e-6 * size) worst = std::max(worst, error / bound);
                }
            }
            EXPECT_GT(worst, 0.2) << "the points do not come near the bound";
        }
    }
}

TEST(DistanceField, RefusesAGridThatWouldNotFitIntoMemory) {
    // Truth: invariant (the documented limit of 2 GiB).
    scene::PartSpec spec;
    spec.name = "large";
    spec.geometry = shape::Shape(shape::Box{10, 10, 10});
    const auto part = scene::buildPart(spec, {.field = true, .cell = 1e-4});
    ASSERT_FALSE(part);
    EXPECT_NE(toString(part.errors().front()).find("2 GiB"), std::string::npos);
}

/// A plate with a bore of 10 mm through it; sharp.
const shape::BorePlate kSharpPlate{0.04, 0.04, 0.02, 0.01, 0.02, 0.0};

/// A point up to `reach` (per axis) from the plate's surface: by turns on its faces, the bore's wall, a rim, an edge.
Vec3 nearPlate(int turn, double reach, Random& random) {
    const double angle = random.uniform(0.0, 6.2831853), r = 0.5 * kSharpPlate.bore_diameter;
    const Vec3 wall(r * std::cos(angle), r * std::sin(angle), -kSharpPlate.height * random.uniform());
    const double x = random.uniform(-0.5, 0.5) * kSharpPlate.width, side = 0.5 * kSharpPlate.depth;
    const double face_z = random.below(2) == 0 ? 0.0 : -kSharpPlate.height;
    const std::array<Vec3, 6> seeds{wall,
                                    Vec3(wall.x(), wall.y(), face_z),
                                    Vec3(x, random.uniform(-0.5, 0.5) * kSharpPlate.depth, face_z),
                                    Vec3(x, side, face_z),
                                    Vec3(side, -side, wall.z()),
                                    Vec3(side, -side, face_z)};
    return seeds[static_cast<std::size_t>(turn) % seeds.size()] +
           anywhere({-Vec3::Ones(), Vec3::Ones()}, 0.0, random) * reach;
}

TEST(DistanceField, MeetsTheAskedToleranceAtRimsEdgesAndCorners) {
    // Truth: closed form. Depth: PartNeeds (40 tolerances, here 0.2 mm and more).
    scene::PartSpec spec;
    spec.geometry = shape::Shape{kSharpPlate};
    for (const double tolerance : {20e-6, 5e-6}) {
        const auto part = scene::buildPart(spec, {.field = true, .tolerance = tolerance});
        ASSERT_TRUE(part);
        const DistanceField& field = *part->field;
        EXPECT_TRUE(field.refined());
        EXPECT_LT(field.memoryBytes(), 30'000'000u);
        Random random(8);
        double worst = 0.0;
        for (int i = 0; i < 300'000; ++i) {
            const Vec3 p = nearPlate(i, 0.2e-3, random);
            const double truth = shape::signedDistance(*part->shape, p);
            if (std::abs(truth) > 0.2e-3) continue;
            worst = std::max(worst, std::abs(field.sample(p, FieldMode::Trilinear).phi - truth));
        }
        EXPECT_LE(worst, tolerance);
    }
}

TEST(DistanceField, HoldsAPegOffThatFitsWithFiftyMicrometres) {
    // Truth: closed form: a peg of 9.9 mm in the middle of a bore of 10 mm touches nothing.
    scene::PartSpec spec;
    spec.geometry = shape::Shape{kSharpPlate};
    const auto part = scene::buildPart(spec, {.field = true, .tolerance = 5e-6});
    ASSERT_TRUE(part);
    for (int i = 0; i < 6000; ++i) {
        const double angle = 2.39996323 * i;  // the golden angle
        const Vec3 p(4.95e-3 * std::cos(angle), 4.95e-3 * std::sin(angle), -kSharpPlate.height * (i + 0.5) / 6000);
        const FieldSample s = part->field->sample(p, FieldMode::Trilinear);
        ASSERT_NEAR(s.phi, 50e-6, 5e-6) << p.transpose();
        ASSERT_GT(s.gradient.dot(Vec3(-std::cos(angle), -std::sin(angle), 0.0)), 0.9);
    }
}

TEST(DistanceField, IsOffByATenthOfTheDepthAtMostBelowItsFineCells) {
    // Truth: closed form. Below the depth of the tolerance, as deep as bricks reach (two largest cells are less).
    scene::PartSpec spec;
    spec.geometry = shape::Shape{kSharpPlate};
    const auto part = scene::buildPart(spec, {.field = true, .tolerance = 10e-6});
    ASSERT_TRUE(part);
    Random random(9);
    int deep = 0;
    for (int i = 0; i < 100'000; ++i) {
        const Vec3 p = nearPlate(i, 1e-3, random);
        const double truth = shape::signedDistance(*part->shape, p);
        if (std::abs(truth) < 0.4e-3 || std::abs(truth) > 1e-3) continue;
        ++deep;
        ASSERT_LE(std::abs(part->field->sample(p, FieldMode::Trilinear).phi - truth), 0.1 * std::abs(truth));
    }
    EXPECT_GT(deep, 20'000);
}

TEST(DistanceField, BoundsHoldWhereCellsOfSeveralSizesMeet) {
    // Truth: closed form.
    Random random(10);
    for (const shape::Shape& shape : kSolids) {
        scene::PartSpec spec;
        spec.geometry = shape;
        const auto part = scene::buildPart(spec, {.field = true, .tolerance = 10e-6});
        ASSERT_TRUE(part);
        const DistanceField& field = *part->field;
        if (!std::holds_alternative<shape::Sphere>(shape)) {
            EXPECT_LT(field.finestCell(), field.cell()) << shape::kindName(shape);
        }
        for (int i = 0; i < 30'000; ++i) {
            const Vec3 p = anywhere(field.bounds(), i % 2 ? 0.001 : 0.1, random);
            const double truth = shape::signedDistance(shape, p);
            ASSERT_LE(field.lowerBound(p), truth) << shape::kindName(shape) << " at " << p.transpose();
            for (const FieldMode mode : kFieldModes)
                ASSERT_LE(std::abs(field.sample(p, mode).phi - truth), field.errorBound(p, mode))
                    << shape::kindName(shape) << " at " << p.transpose();
        }
    }
}

TEST(DistanceField, SeesASpikeThatIsThinnerThanTheLargestCells) {
    // Truth: closed form of the spike's tip: its surface, φ = 0. A block of 60 mm carries a spike 0.4 mm high and wide
    // in the middle of a face; the cells begin at 0.5 mm and more.
    const shape::Shape block = shape::Box{0.06, 0.06, 0.06};
    DistanceSource source;
    const Vec3 tip(0.0013, 0.0017, 0.0304);
    const double spike = 0.2e-3;
    source.bounds = {Vec3::Constant(-0.03), Vec3(0.03, 0.03, tip.z())};
    const auto phi = [=](const Vec3& p) {
        const Vec3 q = (p - (tip - Vec3(0, 0, spike))).cwiseAbs() - Vec3::Constant(spike);
        const double box = q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
        return std::min(box, shape::signedDistance(block, p));
    };
    source.distance = [=](const Vec3& p) { return std::abs(phi(p)); };
    source.inside = [=](const Vec3& p) { return phi(p) < 0.0; };
    source.closed = true;
    source.landmarks = {tip};
    FieldAccuracy accuracy;
    accuracy.tolerance = 20e-6;
    accuracy.depth = 0.2e-3;
    const auto field = DistanceField::build(source, 2e-3, 4e-3, accuracy);
    ASSERT_TRUE(field);
    EXPECT_NEAR(field->sample(tip, FieldMode::Trilinear).phi, 0.0, 20e-6);
}

TEST(DistanceField, IsSampledAtTheLastLevelWhereTheCellAskedForLiesBelow) {
    // Truth: closed form, a sphere. With cells h the trilinear value errs by at most h²/8 times the sum of the second
    // derivatives, 2/r: 13 um.
    const double cell = 1e-3, radius = 80.0 * cell, last = 2.0 * cell;
    DistanceSource source;
    source.bounds = {Vec3::Constant(-radius), Vec3::Constant(radius)};
    source.closed = true;
    source.distance = [&](const Vec3& p) { return std::abs(p.norm() - radius); };
    source.inside = [&](const Vec3& p) { return p.norm() < radius; };
    FieldAccuracy accuracy;
    accuracy.largest_cell = std::ldexp(cell, DistanceField::kMostLevels + 1);
    const auto field = DistanceField::build(source, cell, 2.0 * cell, accuracy);
    ASSERT_TRUE(field);
    EXPECT_DOUBLE_EQ(field->finestCell(), last);
    Random random(4);
    for (int i = 0; i < 2000; ++i) {
        const double phi = random.uniform(-cell, cell);
        const Vec3 way = Vec3(random.normal(), random.normal(), random.normal()).normalized();
        EXPECT_NEAR(field->sample((radius + phi) * way, FieldMode::Trilinear).phi, phi, 14e-6);
    }
}

TEST(DistanceField, StopsRefiningAtItsLimitOfMemoryAndSaysSo) {
    // Truth: invariant.
    const shape::Shape shape{kSharpPlate};
    scene::PartSpec spec;
    spec.geometry = shape;
    const auto part = scene::buildPart(spec, {});
    ASSERT_TRUE(part);
    FieldAccuracy accuracy;
    accuracy.tolerance = 10e-6;
    accuracy.depth = 0.4e-3;
    accuracy.bytes = 6'000'000;
    const auto field = DistanceField::build(scene::exactSource(*part), 0.5e-3, 2e-3, accuracy);
    ASSERT_TRUE(field);
    EXPECT_FALSE(field->refined());
    EXPECT_LE(field->memoryBytes(), accuracy.bytes);
    EXPECT_GT(static_cast<double>(field->memoryBytes()),
              0.9 * static_cast<double>(accuracy.bytes));  // the index takes up to a tenth
}

TEST(DistanceField, KeepsCellsOfOneSizeWhereACellIsNamed) {
    // Truth: invariant.
    const scene::Part part = fieldOf(shape::Shape{kSharpPlate}, 0.5e-3);
    EXPECT_EQ(part.field->cell(), 0.5e-3);
    EXPECT_EQ(part.field->finestCell(), 0.5e-3);
}

}  // namespace
}  // namespace passung::field
