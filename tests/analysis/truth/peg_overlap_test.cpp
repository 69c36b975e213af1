#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/truth/exact_mesh.h"
#include "core/base/random.h"
#include "core/shape/shape.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

constexpr double kCell = 0.5e-3;

/// Deepest overlap of the true peg (dense points) with the true plate (closed form): independent of the shell's points
/// and of the field.
double trueOverlap(const std::vector<Vec3>& peg_points, const shape::Shape& plate, const Pose& X_WPlate,
                   const Pose& X_WG) {
    const Pose X_PG = X_WPlate.inverse() * X_WG;
    double depth = 0.0;
    for (const Vec3& p : peg_points) depth = std::max(depth, -shape::signedDistance(plate, X_PG * p));
    return depth;
}

/// Points of a chamfered peg by its closed form: rings every 0.3 mm along its outline (tip disc, chamfer, side), the
/// two rims included, a point every degree and a half.
std::vector<Vec3> densePoints(const shape::Peg& peg) {
    const double R = 0.5 * peg.diameter, c = peg.chamfer;
    const Eigen::Vector2d outline[] = {{0, 0}, {R - c, 0}, {R, c}, {R, peg.length}};  // r, z
    std::vector<Vec3> points;
    for (int segment = 0; segment < 3; ++segment) {
        const Eigen::Vector2d way = outline[segment + 1] - outline[segment];
        const int rings = static_cast<int>(std::ceil(way.norm() / 0.3e-3));
        for (int i = 0; i <= rings; ++i) {
            const Eigen::Vector2d rz = outline[segment] + way * (static_cast<double>(i) / rings);
            for (int k = 0; k < 240; ++k) {
                const double angle = 2.0 * std::numbers::pi * k / 240.0;
                points.push_back({rz.x() * std::cos(angle), rz.x() * std::sin(angle), rz.y()});
            }
        }
    }
    return points;
}

TEST(PegOverlap, GodObjectHoldsATrueOverlapOfAFewHundredthsOfAMillimetreWherePenaltyLosesIt) {
    // Truth: independent dense geometry: closed form of the plate at dense points of the peg, every twentieth tick of a
    // path that presses, slides, tilts and inserts with 0.1 mm radial clearance. What is allowed is stated: the overlap
    // that the proxy accepts (5 % of a cell) plus what lies between the shell's samples and the field's error at the
    // rims.
    const shape::Peg peg{0.02, 0.05, 0.001};
    const shape::Shape plate = shape::BorePlate{0.06, 0.06, 0.03, 0.0202, 0.03, 0.001};
    const std::vector<Vec3> points = densePoints(peg);
    double deepest[2] = {0, 0};
    Random random(3);
    const Pose X_WPlate{rotationFromVector(Vec3(0.3, -0.2, 0.5)), Vec3(0.011, -0.007, 0.003)};  // off the grid
    for (const auto method : {scene::ContactMethod::Penalty, scene::ContactMethod::GodObjectHeuristic}) {
        auto spec = test::scene(peg, X_WPlate * Pose{Quat::Identity(), Vec3(0, 0, 0.01)}, plate, X_WPlate, method);
        spec.contact.cell = kCell;
        spec.contact.stiffness = 4000;
        spec.contact.rotational_stiffness = 1;
        test::Bench bench(spec);
        double& worst = deepest[method == scene::ContactMethod::Penalty ? 0 : 1];
        for (int i = 0; i < 8000; ++i) {
            const double t = i * 1e-3;
            Vec3 p(0.003, 0, 0.01 - 0.011 * t);
            if (t > 1)
                p = 0.003 * std::max(0.0, 2 - t) * Vec3(std::cos(6 * t), std::sin(6 * t), 0) + Vec3(0, 0, -0.001);
            if (t > 2) p += Vec3(6e-4 * std::cos(20 * t), 6e-4 * std::sin(17 * t), -0.003 * (t - 2));
            const Pose X_PH{
                rotationFromVector(Vec3(0.02 * std::sin(9 * t), 0.02 * std::cos(7 * t), 0.05 * std::sin(t))), p};
            const auto out = bench.step(X_WPlate * X_PH);
            if (i % 20 == 0) worst = std::max(worst, trueOverlap(points, plate, X_WPlate, out.X_WG));
        }
    }
    std::printf("deepest true overlap: penalty %.3f mm, god object %.3f mm\n", deepest[0] * 1e3, deepest[1] * 1e3);
    EXPECT_GT(deepest[0], 0.5e-3);
    EXPECT_LT(deepest[1], 0.12e-3);
    EXPECT_LT(deepest[1], 0.2 * deepest[0]);
}

}  // namespace
}  // namespace passung
