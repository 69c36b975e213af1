#include "analysis/truth/surface_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"

namespace passung::truth {
namespace {

constexpr double mm = 1e-3;

const std::vector<shape::Shape> kShapes = {
    shape::Cylinder{10 * mm, 16 * mm},
    shape::Box{14 * mm, 9 * mm, 11 * mm},
    shape::Peg{10 * mm, 18 * mm, 1 * mm},
    shape::Peg{10 * mm, 18 * mm, 0.0},
    shape::BorePlate{24 * mm, 22 * mm, 14 * mm, 10.2 * mm, 9 * mm, 1 * mm},
    shape::BorePlate{24 * mm, 22 * mm, 14 * mm, 20.2 * mm, 14 * mm, 0.0},
    shape::BorePlate{60 * mm, 20.03 * mm, 14 * mm, 20 * mm, 14 * mm, 0.01 * mm},  // a wall of a few micrometres
};

Vec3 randomPoint(Random& random, double size) {
    return size * Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
}

/// A point of the piece; 0 ≤ along, around ≤ 1.
Vec3 pointOf(const TurnedPiece& piece, double around, double along) {
    const double angle =
        std::atan2(piece.sector.middle.y(), piece.sector.middle.x()) + (2.0 * around - 1.0) * piece.sector.half_angle;
    const double radius = piece.low.radius + along * (piece.high.radius - piece.low.radius);
    return {radius * std::cos(angle), radius * std::sin(angle),
            piece.low.height + along * (piece.high.height - piece.low.height)};
}

double areaOf(const FlatPiece& piece) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 2; i < piece.size(); ++i) sum += 0.5 * (piece[i - 1] - piece[0]).cross(piece[i] - piece[0]);
    return sum.norm();
}

/// Is the point on the flat piece?
bool holds(const FlatPiece& piece, const Vec3& p) {
    double around = 0.0;
    for (std::size_t i = 0; i < piece.size(); ++i)
        around += 0.5 * (piece[i] - p).cross(piece[(i + 1) % piece.size()] - p).norm();
    return around < areaOf(piece) + 1e-12;
}

/// Is it on the turned piece, a whole turn?
bool holds(const TurnedPiece& piece, const Vec3& p) {
    const Eigen::Vector2d from(piece.low.radius, piece.low.height), to(piece.high.radius, piece.high.height);
    const Eigen::Vector2d here(std::hypot(p.x(), p.y()), p.z());
    return (here - from).norm() + (to - here).norm() < (to - from).norm() + 1e-9;
}

TEST(SurfacePieces, AreOnTheSurfaceAndLeaveNothingOfItOut) {
    // Truth: closed form: the shape's own distance is 0 at every point of a piece; and every vertex and every middle of
    // a flat triangle of the tessellated shape is on a piece.
    Random random(2);
    for (const shape::Shape& shape : kShapes) {
        const SurfacePieces pieces = SurfacePieces::of(shape);
        ASSERT_FALSE(pieces.empty());
        for (const TurnedPiece& piece : pieces.turned)
            for (int i = 0; i < 100; ++i)
                EXPECT_LT(std::abs(shape::signedDistance(shape, pointOf(piece, random.uniform(), random.uniform()))),
                          1e-12)
                    << shape::kindName(shape);
        for (const FlatPiece& piece : pieces.flat) {
            ASSERT_LE(piece.size(), 6u);
            for (int i = 0; i < 100; ++i) {
                Vec3 p = piece[0];
                for (const Vec3& corner : piece) p += random.uniform() * (corner - p);
                EXPECT_LT(std::abs(shape::signedDistance(shape, p)), 1e-12) << shape::kindName(shape);
            }
        }
        const auto isHeld = [&](const Vec3& p) {
            const auto here = [&](const auto& piece) { return holds(piece, p); };
            return std::any_of(pieces.turned.begin(), pieces.turned.end(), here) ||
                   std::any_of(pieces.flat.begin(), pieces.flat.end(), here);
        };
        const geometry::TriangleMesh mesh = shape::tessellate(shape, 0.02 * mm);
        for (const geometry::Triangle& t : mesh.triangles)
            for (const double share : {0.0, 0.3, 0.7, 1.0}) {
                const Vec3 p = share * mesh.vertices[t[0]] +
                               (1.0 - share) * (0.4 * mesh.vertices[t[1]] + 0.6 * mesh.vertices[t[2]]);
                if (!(std::abs(shape::signedDistance(shape, p)) < 1e-12)) continue;  // of a chord
                EXPECT_TRUE(isHeld(p)) << shape::kindName(shape) << " " << p.transpose();
            }
    }
}

TurnedPiece randomPiece(Random& random) {
    const auto circle = [&] { return TurnedPiece::Circle{12 * mm * random.uniform(), 20 * mm * random.uniform()}; };
    TurnedPiece piece{{}, circle(), circle()};
    for (int cuts = static_cast<int>(7.0 * random.uniform()); cuts > 0; --cuts)
        piece = (random.uniform() < 0.6 ? piece.halvesAround() : piece.halvesAlong())[random.uniform() < 0.5 ? 0 : 1];
    return piece;
}

void expectWithin(const AxialExtent& extent, const Vec3& p) {
    const double radius = std::hypot(p.x(), p.y()), slope = radius - p.z();
    constexpr double kRounding = 1e-12;  // [m]
    EXPECT_GE(radius, extent.least_radius - kRounding);
    EXPECT_LE(radius, extent.most_radius + kRounding);
    EXPECT_GE(p.z(), extent.least_height - kRounding);
    EXPECT_LE(p.z(), extent.most_height + kRounding);
    EXPECT_GE(slope, extent.least_slope - kRounding);
    EXPECT_LE(slope, extent.most_slope + kRounding);
}

TEST(SurfacePieces, HaveNoPointOutsideTheirExtentHullAndRadius) {
    // Truth: invariant, at random points of random pieces seen from random axes, among them nearly parallel ones: the
    // definition of the extents; a hull's point is beyond no plane that all corners are before.
    Random random(4);
    for (int i = 0; i < 20'000; ++i) {
        const TurnedPiece piece = randomPiece(random);
        const double tilt = std::pow(10.0, -4.0 + 4.5 * random.uniform());
        const Pose X{rotationFromVector(randomPoint(random, 2.0 * tilt)), randomPoint(random, 8 * tilt * mm)};
        const AxialExtent extent = AxialView(X).extentOf(piece);
        for (int k = 0; k < 10; ++k) {
            const Vec3 p = pointOf(piece,
                                   k == 0   ? 0.0
                                   : k == 1 ? 1.0
                                            : random.uniform(),
                                   k == 2   ? 0.0
                                   : k == 3 ? 1.0
                                            : random.uniform());
            expectWithin(extent, X * p);
            EXPECT_LE((p - piece.middle()).norm(), piece.radius() + 1e-12);
            if (!piece.hasHull()) continue;
            const Vec3 n = randomPoint(random, 1.0).normalized();
            double most = -1.0;
            for (const Vec3& corner : piece.corners()) most = std::max(most, n.dot(corner));
            EXPECT_LE(n.dot(p), most + 1e-12);
        }
        if (testing::Test::HasFailure()) FAIL() << "piece " << i << ", tilt " << tilt;
    }
}

TEST(SurfacePieces, AreSeenExactlyFromAParallelAxis) {
    // Truth: closed form: a circle of radius q, e off the axis, is from |e - q| to e + q away; in a sector that does
    // not point along e, as far as its ends are.
    const TurnedPiece mantle{{}, {10 * mm, 0.0}, {10 * mm, 30 * mm}};
    const AxialExtent whole = AxialView({Quat::Identity(), Vec3(0.1 * mm, 0, -5 * mm)}).extentOf(mantle);
    EXPECT_NEAR(whole.least_radius, 9.9 * mm, 1e-12);
    EXPECT_NEAR(whole.most_radius, 10.1 * mm, 1e-12);
    EXPECT_NEAR(whole.least_height, -5 * mm, 1e-12);
    EXPECT_NEAR(whole.most_height, 25 * mm, 1e-12);
    const TurnedPiece quarter =
        mantle.halvesAround()[1].halvesAround()[1];  // its directions are from 90 to 180 degrees
    const AxialExtent beside = AxialView({Quat::Identity(), Vec3(0.1 * mm, 0, 0)}).extentOf(quarter);
    EXPECT_NEAR(beside.least_radius, 9.9 * mm, 1e-12);
    EXPECT_NEAR(beside.most_radius, std::hypot(10 * mm, 0.1 * mm), 1e-12);
}

}  // namespace
}  // namespace passung::truth
