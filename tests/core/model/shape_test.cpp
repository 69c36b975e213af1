#include "core/model/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "tests/support/brute_force_mesh.h"

namespace passung::model {
namespace {

using std::numbers::pi;

const std::vector<Shape>& allShapes() {
    static const std::vector<Shape> shapes{
        Sphere{0.02},
        Box{0.03, 0.02, 0.01},
        Cylinder{0.02, 0.03},
        Sheet{0.04, 0.03},
        Peg{0.02, 0.05, 0.0},
        Peg{0.02, 0.05, 0.002},
        BorePlate{0.06, 0.05, 0.03, 0.0202, 0.02, 0.0},
        BorePlate{0.06, 0.05, 0.03, 0.0202, 0.02, 0.0015},
        BorePlate{0.06, 0.05, 0.03, 0.0202, 0.03, 0.0},
        BorePlate{0.06, 0.05, 0.03, 0.0202, 0.03, 0.0015},
        BorePlate{0.05, 0.021, 0.004, 0.02, 0.0039, 0.0004},
    };
    return shapes;
}

std::string described(const Shape& shape) {
    std::ostringstream text;
    text << kindName(shape) << " [mm]";
    for (const double d : dimensions(shape)) text << ' ' << 1e3 * d;
    return text.str();
}

/// Half uniform in the bounds and around them, half close to the surface.
std::vector<Vec3> pointsAround(const Shape& shape, int count, Random& random) {
    const TriangleMesh mesh = tessellate(shape, 1e-5);
    const Bounds bounds = boundsOf(mesh);
    const double margin = 0.3 * bounds.size().norm();
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        Vec3 p;
        if (i % 2 == 0) {
            for (int k = 0; k < 3; ++k) p[k] = random.uniform(bounds.low[k] - margin, bounds.high[k] + margin);
        } else {
            const auto& t = mesh.triangles[random.below(mesh.triangles.size())];
            double u = random.uniform(), v = random.uniform();
            if (u + v > 1.0) {
                u = 1.0 - u;
                v = 1.0 - v;
            }
            const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
            const double reach = std::pow(10.0, random.uniform(-6.0, -2.0));
            p = a + u * (b - a) + v * (c - a) + reach * Vec3(random.normal(), random.normal(), random.normal());
        }
        points.push_back(p);
    }
    return points;
}

/// Membership, straight from what the shapes are said to be.
bool isInside(const Shape& shape, const Vec3& p) {
    const double x = p.x(), y = p.y(), z = p.z(), r = std::hypot(x, y);
    if (const auto* s = std::get_if<Sphere>(&shape)) return x * x + y * y + z * z < s->diameter * s->diameter / 4;
    if (const auto* b = std::get_if<Box>(&shape))
        return std::abs(x) < b->width / 2 && std::abs(y) < b->depth / 2 && std::abs(z) < b->height / 2;
    if (const auto* c = std::get_if<Cylinder>(&shape)) return r < c->diameter / 2 && std::abs(z) < c->length / 2;
    if (const auto* g = std::get_if<Peg>(&shape)) {
        const double allowed = z < g->chamfer ? g->diameter / 2 - (g->chamfer - z) : g->diameter / 2;
        return z > 0.0 && z < g->length && r < allowed;
    }
    if (const auto* b = std::get_if<BorePlate>(&shape)) {
        const bool in_block = std::abs(x) < b->width / 2 && std::abs(y) < b->depth / 2 && z < 0.0 && z > -b->height;
        const double widened = z > -b->chamfer ? b->chamfer + z : 0.0;
        const bool in_bore = z >= -b->bore_depth && r <= b->bore_diameter / 2 + widened;
        return in_block && !in_bore;
    }
    return false;
}

double frustum(double r1, double r2, double h) { return pi * h / 3 * (r1 * r1 + r1 * r2 + r2 * r2); }

double exactVolume(const Shape& shape) {
    if (const auto* s = std::get_if<Sphere>(&shape)) return pi / 6 * std::pow(s->diameter, 3);
    if (const auto* b = std::get_if<Box>(&shape)) return b->width * b->depth * b->height;
    if (const auto* c = std::get_if<Cylinder>(&shape)) return pi / 4 * c->diameter * c->diameter * c->length;
    if (const auto* g = std::get_if<Peg>(&shape)) {
        const double r = g->diameter / 2, c = g->chamfer;
        return pi * r * r * (g->length - c) + frustum(r - c, r, c);
    }
    if (const auto* b = std::get_if<BorePlate>(&shape)) {
        const double r = b->bore_diameter / 2, c = b->chamfer;
        return b->width * b->depth * b->height - pi * r * r * (b->bore_depth - c) - frustum(r, r + c, c);
    }
    return 0.0;
}

double exactArea(const Shape& shape) {
    if (const auto* s = std::get_if<Sphere>(&shape)) return pi * s->diameter * s->diameter;
    if (const auto* b = std::get_if<Box>(&shape))
        return 2 * (b->width * b->depth + b->width * b->height + b->depth * b->height);
    if (const auto* c = std::get_if<Cylinder>(&shape)) return pi * c->diameter * (c->length + c->diameter / 2);
    if (const auto* s = std::get_if<Sheet>(&shape)) return s->width * s->depth;
    if (const auto* g = std::get_if<Peg>(&shape)) {
        const double r = g->diameter / 2, c = g->chamfer, tip = r - c;
        return pi * (tip * tip + (tip + r) * c * std::sqrt(2.0) + 2 * r * (g->length - c) + r * r);
    }
    const auto& b = std::get<BorePlate>(shape);
    const double r = b.bore_diameter / 2, c = b.chamfer, mouth = r + c;
    const double floor = b.bore_depth >= b.height ? -r * r : r * r;
    return 2 * (b.width * b.depth + b.width * b.height + b.depth * b.height) +
           pi * (-mouth * mouth + (mouth + r) * c * std::sqrt(2.0) + 2 * r * (b.bore_depth - c) + floor);
}

TEST(Shape, DistanceIsThatToItsTrianglesWithinTheChordError) {
    // Truth: closed form against a plain search over all triangles. The triangles lie within the chord error of the
    // surface and the surface within the chord error of the triangles, so distances differ by no more.
    const double chord_error = 4e-6;
    Random random(1);
    for (const Shape& shape : allShapes()) {
        const TriangleMesh mesh = tessellate(shape, chord_error);
        for (const Vec3& p : pointsAround(shape, 600, random))
            ASSERT_NEAR(std::abs(signedDistance(shape, p)), test::distanceToMesh(mesh, p), chord_error + 1e-12)
                << described(shape) << " at " << p.transpose();
    }
}

TEST(Shape, DistanceIsExactWhereFacesAreFlat) {
    // Truth: closed form. Distances counted by hand: box corner, in the bore, under the plate, beside the peg's
    // chamfer.
    const Shape box = Box{0.02, 0.04, 0.06};
    EXPECT_NEAR(signedDistance(box, Vec3(0.013, 0.024, 0.03)), 0.005, 1e-15);
    EXPECT_NEAR(signedDistance(box, Vec3(0.007, 0.0, 0.0)), -0.003, 1e-15);
    const Shape plate = BorePlate{0.06, 0.06, 0.03, 0.02, 0.02, 0.001};
    EXPECT_NEAR(signedDistance(plate, Vec3(0.0, 0.0, -0.015)), 0.005, 1e-15);   // floor
    EXPECT_NEAR(signedDistance(plate, Vec3(0.008, 0.0, -0.01)), 0.002, 1e-15);  // wall
    EXPECT_NEAR(signedDistance(plate, Vec3(0.0, 0.0, -0.025)), -0.005, 1e-15);  // between floor and underside
    EXPECT_NEAR(signedDistance(plate, Vec3(0.0, 0.0, 0.0)), std::hypot(0.01, 0.001), 1e-15);  // cone's end
    EXPECT_NEAR(signedDistance(plate, Vec3(0.0, 0.02, 0.004)), 0.004, 1e-15);                 // above the top face
    const Shape peg = Peg{0.02, 0.05, 0.002};
    EXPECT_NEAR(signedDistance(peg, Vec3(0.01, 0.0, 0.0)), 0.002 / std::sqrt(2.0), 1e-15);
    EXPECT_NEAR(signedDistance(peg, Vec3(0.0, 0.0, -0.003)), 0.003, 1e-15);
    EXPECT_NEAR(signedDistance(peg, Vec3(0.0, 0.0, 0.049)), -0.001, 1e-15);
}

TEST(Shape, DistanceChangesNoFasterThanThePoint) {
    // Truth: invariant. A distance is 1-Lipschitz; a jump anywhere, the sign's included, breaks it.
    Random random(2);
    for (const Shape& shape : allShapes()) {
        const std::vector<Vec3> points = pointsAround(shape, 20000, random);
        for (const Vec3& p : points) {
            const double reach = std::pow(10.0, random.uniform(-7.0, -2.0));
            const Vec3 q = p + reach * Vec3(random.normal(), random.normal(), random.normal());
            ASSERT_LE(std::abs(signedDistance(shape, p) - signedDistance(shape, q)),
                      (p - q).norm() * (1 + 1e-9) + 1e-15)
                << described(shape) << " at " << p.transpose();
        }
    }
}

TEST(Shape, IsNegativeExactlyInside) {
    // Truth: closed form. The inequalities that define each solid.
    Random random(3);
    for (const Shape& shape : allShapes()) {
        int inside = 0;
        for (const Vec3& p : pointsAround(shape, 20000, random)) {
            const double distance = signedDistance(shape, p);
            if (std::abs(distance) < 1e-15) continue;
            ASSERT_EQ(distance < 0.0, isInside(shape, p)) << described(shape) << " at " << p.transpose();
            inside += distance < 0.0 ? 1 : 0;
        }
        EXPECT_GE(inside, std::holds_alternative<Sheet>(shape) ? 0 : 1000) << described(shape);
    }
}

TEST(Tessellation, VerticesLieOnTheSurfaceAndTrianglesWithinTheChordError) {
    // Truth: closed form. Points spread over every triangle, corners and edges included.
    for (const double chord_error : {1e-4, 1e-5, 1e-6}) {
        for (const Shape& shape : allShapes()) {
            const TriangleMesh mesh = tessellate(shape, chord_error);
            double worst = 0.0;
            for (const Vec3& v : mesh.vertices) ASSERT_NEAR(signedDistance(shape, v), 0.0, 1e-14) << described(shape);
            for (const auto& t : mesh.triangles)
                for (int i = 0; i <= 4; ++i)
                    for (int j = 0; i + j <= 4; ++j) {
                        const Vec3 p = 0.25 * (i * mesh.vertices[t[0]] + j * mesh.vertices[t[1]] +
                                               (4 - i - j) * mesh.vertices[t[2]]);
                        worst = std::max(worst, std::abs(signedDistance(shape, p)));
                    }
            EXPECT_LE(worst, chord_error + 1e-14) << described(shape);
        }
    }
}

TEST(Tessellation, UsesEveryEdgeOnceInEachDirection) {
    // Truth: invariant. What watertight and consistently oriented means; a sheet has its border, four edges.
    for (const Shape& shape : allShapes()) {
        const test::EdgeCount edges = test::countEdges(tessellate(shape, 1e-5));
        EXPECT_EQ(edges.crowded, 0u) << described(shape);
        EXPECT_EQ(edges.open, std::holds_alternative<Sheet>(shape) ? 4u : 0u) << described(shape);
    }
}

TEST(Tessellation, HasTheVolumeAndAreaOfTheShape) {
    // Truth: closed form. The surface moves by the chord error at most, the volume by that times the area; the area of
    // an inscribed polygon falls short by its relative sagitta, here below 1e-4.
    const double chord_error = 5e-7;
    for (const Shape& shape : allShapes()) {
        const TriangleMesh mesh = tessellate(shape, chord_error);
        EXPECT_NEAR(test::area(mesh), exactArea(shape), 1e-4 * exactArea(shape)) << described(shape);
        EXPECT_NEAR(test::volume(mesh), exactVolume(shape), chord_error * exactArea(shape)) << described(shape);
    }
}

TEST(Tessellation, ReachesTheExtremePointsOnTheAxes) {
    // Truth: closed form. Segment counts are divisible by four, so the bounds of a round part are exact.
    const Bounds bounds = boundsOf(tessellate(Peg{0.02, 0.05, 0.001}, 1e-5));
    EXPECT_EQ(bounds.low, Vec3(-0.01, -0.01, 0.0));
    EXPECT_EQ(bounds.high, Vec3(0.01, 0.01, 0.05));
}

TEST(Tessellation, StaysCoarseAndStaysFiniteAtTheEnds) {
    // Truth: closed form. At least 12 segments however coarse, at most 2048 however fine: 4 (caps, walls) triangles
    // each.
    EXPECT_EQ(tessellate(Cylinder{0.02, 0.03}, 1.0).triangles.size(), 4u * 12u);
    EXPECT_EQ(tessellate(Cylinder{0.02, 0.03}, 1e-18).triangles.size(), 4u * 2048u);
}

TEST(Tessellation, ReachesNoSmallerChordErrorThanItSays) {
    // Truth: closed form. The middle of a chord of n segments is r(1 - cos π/n) off; 2048 segments are the most. The
    // worst point of the triangles is looked for on a lattice over each: it must lie within the error that is said, and
    // nearly reach it.
    for (const double asked : {1e-4, 1e-6, 1e-9}) {
        for (const Shape& shape : {Shape(Sphere{1.0}), Shape(Cylinder{2.0, 0.5}), Shape(Peg{1.5, 0.5, 0.1}),
                                   Shape(BorePlate{3.0, 3.0, 0.5, 2.0, 0.3, 0.05}), Shape(Sphere{0.02})}) {
            const TriangleMesh mesh = tessellate(shape, asked);
            const double said = chordError(shape, asked);
            double worst = 0.0;
            for (const auto& t : mesh.triangles)
                for (int i = 0; i <= 6; ++i)
                    for (int j = 0; i + j <= 6; ++j) {
                        const Vec3 p =
                            (i * mesh.vertices[t[0]] + j * mesh.vertices[t[1]] + (6 - i - j) * mesh.vertices[t[2]]) / 6;
                        worst = std::max(worst, std::abs(signedDistance(shape, p)));
                    }
            EXPECT_LE(worst, said + 1e-15) << described(shape) << " asked " << asked;
            EXPECT_GT(worst, 0.9 * said) << described(shape) << " asked " << asked;
            if (asked < 1e-8) {
                EXPECT_GT(said, asked) << described(shape);
            }
        }
    }
    EXPECT_LE(chordError(Sphere{0.02}, 1e-6), 1e-6);
    EXPECT_EQ(chordError(Box{1.0, 1.0, 1.0}, 1e-9), 0.0);
    EXPECT_EQ(chordError(Sheet{1.0, 1.0}, 1e-9), 0.0);
}

std::vector<std::string> keysOf(const Shape& shape) {
    std::vector<std::string> keys;
    for (const Error& error : validate(shape)) keys.push_back(error.key);
    return keys;
}

TEST(ShapeValidation, AcceptsWhatCanBeMade) {
    // Truth: closed form. The shapes of this file, and a through bore that is said deeper than the plate.
    for (const Shape& shape : allShapes()) EXPECT_TRUE(validate(shape).empty()) << described(shape);
    EXPECT_TRUE(validate(BorePlate{0.06, 0.06, 0.03, 0.02, 0.04, 0.001}).empty());
}

TEST(ShapeValidation, NamesEachValueThatCannotBe) {
    // Truth: closed form. One row per rule.
    using Keys = std::vector<std::string>;
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    EXPECT_EQ(keysOf(Sphere{nan}), Keys{"diameter"});
    EXPECT_EQ(keysOf(Sphere{inf}), Keys{"diameter"});
    EXPECT_EQ(keysOf(Sphere{0.0}), Keys{"diameter"});
    EXPECT_EQ(keysOf(Box{0.01, -0.01, nan}), (Keys{"depth", "height"}));
    EXPECT_EQ(keysOf(Cylinder{0.01, 0.0}), Keys{"length"});
    EXPECT_EQ(keysOf(Sheet{1001.0, 0.1}), Keys{"width"});
    EXPECT_EQ(keysOf(Peg{0.02, 0.05, -1e-3}), Keys{"chamfer"});
    EXPECT_EQ(keysOf(Peg{0.02, 0.05, nan}), Keys{"chamfer"});
    EXPECT_EQ(keysOf(Peg{0.02, 0.05, 0.01}), Keys{"chamfer"});    // no tip face left
    EXPECT_EQ(keysOf(Peg{0.02, 0.001, 0.001}), Keys{"chamfer"});  // no wall left
    EXPECT_EQ(keysOf(BorePlate{0.06, 0.02, 0.03, 0.02, 0.02, 0.0}), Keys{"bore_diameter"});
    EXPECT_EQ(keysOf(BorePlate{0.06, 0.022, 0.03, 0.02, 0.02, 0.001}), Keys{"chamfer"});  // mouth reaches the side
    EXPECT_EQ(keysOf(BorePlate{0.06, 0.06, 0.03, 0.02, 0.002, 0.002}), Keys{"chamfer"});
    EXPECT_EQ(keysOf(BorePlate{0.06, 0.06, 0.03, 0.02, inf, 0.0}), Keys{"bore_depth"});
    EXPECT_EQ(validate(Sphere{-0.02})[0].value, "-0.02 m");
}

}  // namespace
}  // namespace passung::model
