#include "core/field/field_mode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "core/base/random.h"
#include "core/field/distance_field.h"

namespace passung::field {
namespace {

using Phi = std::function<double(const Vec3&)>;
constexpr double kHalf = 6e-3;  // of the cube around the origin whose surface counts
constexpr double kRadius = 0.01;

/// Cells of one size near φ = 0 in a cube around the origin.
DistanceField fieldOf(const Phi& phi, double cell) {
    DistanceSource source;
    source.bounds = {Vec3::Constant(-kHalf), Vec3::Constant(kHalf)};
    source.distance = [phi](const Vec3& p) { return std::abs(phi(p)); };
    source.inside = [phi](const Vec3& p) { return phi(p) < 0.0; };
    source.closed = true;
    auto field = DistanceField::build(source, cell, 3.0 * cell);
    EXPECT_TRUE(field);
    return std::move(*field);
}

Vec3 direction(Random& random) { return Vec3(random.normal(), random.normal(), random.normal()).normalized(); }

Vec3 inCube(double half, Random& random) {
    return {random.uniform(-half, half), random.uniform(-half, half), random.uniform(-half, half)};
}

/// What the number of a brick of such cells may be off by: half of 1/65535 of its span.
double rounding(double cell) { return 8.0 * std::sqrt(3.0) * cell / 131000.0; }

/// A cylinder's wall through the origin, the axis in no direction of the grid.
Phi wall(const Vec3& axis, const Vec3& out) {
    return [=](const Vec3& p) { return (p + kRadius * out).cross(axis).norm() - kRadius; };
}
Phi ball(const Vec3& out) {
    return [=](const Vec3& p) { return (p + kRadius * out).norm() - kRadius; };
}

TEST(FieldMode, IsNamedAsInSceneFiles) {
    // Truth: invariant.
    for (const FieldMode mode : kFieldModes) EXPECT_EQ(modeNamed(modeName(mode)), mode);
    EXPECT_EQ(modeNamed("surface_point"), FieldMode::SurfacePoint);
    EXPECT_EQ(modeNamed("quadratic"), std::nullopt);
}

TEST(FieldMode, OfAnyPlaneIsExactButForLayersWhichAreOffByHalfACell) {
    // Truth: closed form. The numbers' rounding enters by the sum of the weights: 4 and less.
    constexpr double kCell = 0.5e-3;
    Random random(1);
    for (int turn = 0; turn < 5; ++turn) {
        const Vec3 n = direction(random);
        const double shift = random.uniform(-1e-3, 1e-3);
        const DistanceField field = fieldOf([=](const Vec3& p) { return n.dot(p) - shift; }, kCell);
        double layered = 0.0;
        for (int i = 0; i < 4000; ++i) {
            const Vec3 p = inCube(kHalf, random);
            const double truth = n.dot(p) - shift;
            if (std::abs(truth) > kCell) continue;
            for (const FieldMode mode :
                 {FieldMode::SurfacePoint, FieldMode::Linear, FieldMode::Trilinear, FieldMode::Cubic}) {
                const FieldSample s = field.sample(p, mode);
                ASSERT_NEAR(s.phi, truth, 4.0 * rounding(kCell)) << modeName(mode);
                ASSERT_LT((s.gradient - n).norm(), 1e-3) << modeName(mode);
            }
            const double error = std::abs(field.sample(p, FieldMode::Layered, n).phi - truth);
            ASSERT_LE(error, 0.5 * kCell + rounding(kCell));
            ASSERT_LE(std::abs(field.sample(p, FieldMode::Layered).phi - truth), (0.5 + 0.8661) * kCell);
            layered = std::max(layered, error);
        }
        EXPECT_GT(layered, 0.4 * kCell);
    }
}

/// The largest error within half a cell of a wall or ball of kRadius, over several directions in the grid.
double worstError(FieldMode mode, double cell, bool sphere) {
    Random random(2);
    double worst = 0.0;
    for (int turn = 0; turn < 6; ++turn) {
        const Vec3 out = direction(random), axis = out.cross(direction(random)).normalized();
        const Phi phi = sphere ? ball(out) : wall(axis, out);
        const DistanceField field = fieldOf(phi, cell);
        for (int i = 0; i < 8000; ++i) {
            const Vec3 p = inCube(0.7 * kHalf, random);
            const double truth = phi(p);
            if (std::abs(truth) <= 0.5 * cell) worst = std::max(worst, std::abs(field.sample(p, mode).phi - truth));
        }
    }
    return worst;
}

TEST(FieldMode, ErrsOnWallsAndBallsAsStated) {
    // Truth: closed form; limits: the table of field_mode.h, with 15 % for the next order in s/R, which is 1/20. That
    // they are met within a third says that they are not loose.
    constexpr double kCell = 0.5e-3, kSquare = kCell * kCell / kRadius;
    for (const bool sphere : {false, true}) {
        const double sum = sphere ? 2.0 : 1.0;  // κ₁ + κ₂ in 1/R
        const std::array<std::pair<FieldMode, double>, 4> stated{
            std::pair{FieldMode::SurfacePoint, 0.375 * kSquare}, std::pair{FieldMode::Linear, 0.25 * sum * kSquare},
            std::pair{FieldMode::Trilinear, 0.13 * sum * kSquare},
            std::pair{FieldMode::Cubic, 0.3 * kSquare * kCell / kRadius}};
        for (const auto& [mode, limit] : stated) {
            const double worst = worstError(mode, kCell, sphere);
            EXPECT_LE(worst, 1.15 * limit + 2.0 * rounding(kCell)) << modeName(mode) << (sphere ? " ball" : " wall");
            EXPECT_GE(worst, 0.3 * limit) << modeName(mode) << (sphere ? " ball" : " wall");
        }
    }
}

TEST(FieldMode, ErrorFallsWithTheOrderOfEachMode) {
    // Truth: derived: s² where a tangent plane or the cell's corners decide, s³ of the cubic, whose error at the
    // smaller cells (0.2 µm) the rounding of the numbers enters with up to 0.05 µm.
    for (const bool sphere : {false, true}) {
        for (const FieldMode mode :
             {FieldMode::SurfacePoint, FieldMode::Linear, FieldMode::Trilinear, FieldMode::Cubic}) {
            const double ratio = worstError(mode, 1e-3, sphere) / worstError(mode, 0.5e-3, sphere);
            const bool cubic = mode == FieldMode::Cubic;
            EXPECT_NEAR(std::log2(ratio), cubic ? 3.0 : 2.0, cubic ? 0.4 : 0.2) << modeName(mode);
        }
    }
}

TEST(FieldMode, CubicIsContinuousEverywhereAndItsGradientInABrick) {
    // Truth: invariant. A step across a face of a cell by 2e-9 m changes φ by no more than that and, between bricks,
    // the rounding of two numbers by weights of 2; the gradient, between bricks, by what extrapolation errs by.
    constexpr double kCell = 0.5e-3, kStep = 1e-9;
    Random random(3);
    const Phi phi = ball(direction(random));
    const DistanceField field = fieldOf(phi, kCell);
    int within = 0, between = 0;
    for (int i = 0; i < 20000; ++i) {
        Vec3 p = inCube(kHalf, random);
        if (std::abs(phi(p)) > kCell) continue;
        const int axis = i % 3;
        const double face = std::round((p[axis] + kHalf) / kCell);
        p[axis] = -kHalf + face * kCell;  // the surface's bounds begin at a corner of a brick
        const Vec3 aside = kStep * Vec3::Unit(axis);
        const FieldSample a = field.sample(p - aside, FieldMode::Cubic), b = field.sample(p + aside, FieldMode::Cubic);
        const bool border = std::lround(face) % DistanceField::kBrickCells == 0;
        (border ? between : within) += 1;
        ASSERT_NEAR(a.phi, b.phi, 2.1 * kStep + (border ? 4.0 * rounding(kCell) : 0.0));
        ASSERT_LT((a.gradient - b.gradient).norm(), border ? 5e-3 : 1e-5) << border;
    }
    EXPECT_GT(within, 1000);
    EXPECT_GT(between, 100);
}

TEST(FieldMode, GradientIsThatOfTheValue) {
    // Truth: invariant: the difference quotient of the same value within a cell and voxel.
    constexpr double kCell = 0.5e-3, kStep = 1e-8;
    Random random(4);
    const Phi phi = ball(direction(random));
    const DistanceField field = fieldOf(phi, kCell);
    const Vec3 inward = direction(random);
    for (const FieldMode mode : kFieldModes) {
        for (int i = 0; i < 2000; ++i) {
            const Vec3 p = inCube(kHalf, random);
            // Away from where cells and voxels change.
            const Vec3 half_cells = (p + Vec3::Constant(kHalf)) / (0.5 * kCell);
            if ((half_cells - half_cells.array().round().matrix()).cwiseAbs().minCoeff() < 1e-3) continue;
            const FieldSample s = field.sample(p, mode, inward);
            for (int axis = 0; axis < 3; ++axis) {
                const double slope = (field.sample(p + kStep * Vec3::Unit(axis), mode, inward).phi - s.phi) / kStep;
                ASSERT_NEAR(s.gradient[axis], slope, 1e-5) << modeName(mode);
            }
        }
    }
}

}  // namespace
}  // namespace passung::field
