#include "analysis/truth/exact_overlap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/truth/grown_shape.h"
#include "analysis/truth/shape_outside.h"
#include "core/base/random.h"
#include "core/scene/part.h"

namespace passung::truth {
namespace {

constexpr double kChord = 1e-7;  // [m]
constexpr double kTight = 1e-8;  // of the search [m]
constexpr double mm = 1e-3, um = 1e-6;

OverlapEffort tight() { return {.tolerance = kTight, .ignore = 0.0, .most_pieces = 2'000'000}; }

Pose at(double x, double y, double z) { return {Quat::Identity(), Vec3(x, y, z)}; }
Pose tilted(double angle, const Vec3& p) { return {rotationFromVector(Vec3(0.0, angle, 0.0)), p}; }

void expectDepth(const Overlap& found, double depth, double chord, const char* what) {
    EXPECT_LE(found.depth, depth + chord) << what;
    EXPECT_GE(found.bound, depth - chord) << what;
    EXPECT_LE(found.bound - found.depth, 2.0 * um) << what << ": " << found.pieces << " pieces";
}

TEST(ExactOverlap, OfTwoBallsIsWhatTheirRadiiLackOfTheirDistance) {
    // Truth: closed form: r + R - d while neither holds the other's centre. As shapes, and as the meshes of them, which
    // lie up to a chord error inside.
    const shape::Shape small = shape::Sphere{10 * mm}, large = shape::Sphere{30 * mm};
    constexpr double kShapeChord = 0.5 * um, kMeshChord = 10 * um;
    const OverlapBody large_body(large, kShapeChord), small_body(small, kShapeChord);
    for (const double depth : {0.0001 * mm, 0.01 * mm, 1 * mm, 3 * mm}) {
        const Vec3 direction = Vec3(0.3, -0.5, 0.81).normalized();
        const Pose X{rotationFromVector(Vec3(0.2, 0.1, 0.7)), (20 * mm - depth) * direction};
        expectDepth(overlapOf(large_body, Pose{}, small_body, X, {.tolerance = 0.1 * um}), depth, kShapeChord,
                    "shapes");
        if (depth < 0.1 * mm) continue;
        expectDepth(overlapOf(OverlapBody(shape::tessellate(large, kMeshChord)), Pose{},
                              OverlapBody(shape::tessellate(small, kMeshChord)), X),
                    depth, 2 * kMeshChord, "meshes");
    }
    const Overlap apart = overlapOf(large_body, Pose{}, small_body, at(0, 0, 20.001 * mm), tight());
    EXPECT_EQ(apart.depth, 0.0);
    EXPECT_EQ(apart.bound, 0.0) << "it is proven that they do not meet";
}

TEST(ExactOverlap, OfACubesCornerInAFaceIsHowFarItReachesBeyond) {
    // Truth: closed form. A cube of edge a on its corner: that lies a √3 / 2 below its middle.
    const shape::Shape cube = shape::Box{10 * mm, 10 * mm, 10 * mm}, block = shape::Box{40 * mm, 40 * mm, 20 * mm};
    const Quat on_corner = rotationBetween(Vec3(1, 1, 1).normalized(), Vec3(0, 0, -1));
    for (const double depth : {1 * um, 648 * um, 2 * mm}) {
        const Pose X{on_corner, Vec3(1 * mm, 2 * mm, 10 * mm + 5 * std::sqrt(3.0) * mm - depth)};
        expectDepth(overlapOf(OverlapBody(block, kChord), Pose{}, OverlapBody(cube, kChord), X), depth, kChord,
                    "shapes");
        const OverlapBody block_mesh(shape::tessellate(block, kChord)), cube_mesh(shape::tessellate(cube, kChord));
        expectDepth(overlapOf(block_mesh, Pose{}, cube_mesh, X), depth, kTight, "meshes");
        EXPECT_TRUE(surfacesMeet(block_mesh, Pose{}, cube_mesh, X));
        expectDepth(overlapOf(cube_mesh, X, block_mesh, Pose{}), depth, kTight, "the other way round");
        const Pose X_apart{on_corner, X.p + Vec3(0, 0, depth + 0.1 * um)};
        EXPECT_EQ(overlapOf(block_mesh, Pose{}, cube_mesh, X_apart).bound, 0.0);
        EXPECT_FALSE(surfacesMeet(block_mesh, Pose{}, cube_mesh, X_apart));
    }
}

TEST(ExactOverlap, OfATiltedPegInABoreIsThatOfItsEndOrOfTheBoresRim) {
    // Truth: closed form. A peg tilted by a about a point of the bore's axis, l above its flat end and h below the
    // mouth:
    //   its end's rim is l sin a + r cos a off the axis, so  l sin a + r cos a - R  deep in the wall;
    //   the mouth's rim is R cos a - h sin a off the peg's axis, so  r - R cos a + h sin a  deep in the peg.
    const double r = 10 * mm, R = 10.05 * mm;
    const OverlapBody peg(shape::Peg{2 * r, 60 * mm, 0.0}, 0.02 * um);
    const OverlapBody plate(shape::BorePlate{60 * mm, 60 * mm, 40 * mm, 2 * R, 40 * mm, 0.0}, 0.02 * um);
    int of_end = 0, of_rim = 0;
    for (const double angle : {0.002, 0.005, 0.01})
        for (const double l : {5 * mm, 12 * mm, 16 * mm})
            for (const double h : {6 * mm, 15 * mm}) {
                const double end = l * std::sin(angle) + r * std::cos(angle) - R;
                const double rim = r - R * std::cos(angle) + h * std::sin(angle);
                const double depth = std::max({0.0, end, rim});
                if (depth > 0.0) ++(end > rim ? of_end : of_rim);
                const Quat q = rotationFromVector(Vec3(0.0, angle, 0.0));
                const Pose X{q, Vec3(0, 0, -h) - q * Vec3(0, 0, l)};
                const Overlap found = overlapOf(plate, Pose{}, peg, X, {.tolerance = 0.1 * um, .ignore = 0.05 * um});
                EXPECT_NEAR(found.depth, depth, 0.15 * um) << angle << " " << l << " " << h << " " << found.pieces;
                EXPECT_LE(found.bound, depth + 0.2 * um) << found.pieces;
                EXPECT_GE(found.bound, depth - 0.05 * um);
            }
    EXPECT_GE(of_end, 2);
    EXPECT_GE(of_rim, 2);
}

TEST(ExactOverlap, OfAPinThroughABlockIsHalfTheBlocksHeight) {
    // Truth: closed form: a ring of the pin's side, half way through, is as far from both faces of the block.
    const shape::Shape pin = shape::Cylinder{1 * mm, 20 * mm}, block = shape::Box{20 * mm, 20 * mm, 4 * mm};
    for (const Pose& X : {at(1 * mm, 2 * mm, 0), tilted(0.0, Vec3(-3 * mm, 0, 0.5 * mm))}) {
        expectDepth(overlapOf(OverlapBody(block, kChord), Pose{}, OverlapBody(pin, kChord), X), 2 * mm, kTight,
                    "shapes");
        expectDepth(overlapOf(OverlapBody(shape::tessellate(block, kChord)), Pose{},
                              OverlapBody(shape::tessellate(pin, 5 * um)), X),
                    2 * mm, kTight, "meshes");
    }
}

TEST(ExactOverlap, OfMeshesWithGapsIsThatOfTheClosedOnes) {
    // Truth: invariant: where the winding number is, a missing triangle far away changes no distance to the others.
    geometry::TriangleMesh ball = shape::tessellate(shape::Sphere{20 * mm}, 20 * um);
    const OverlapBody box(shape::Box{40 * mm, 40 * mm, 20 * mm}, kChord), whole(ball);
    const Pose X = at(1 * mm, 0, 19.5 * mm);
    const double depth = overlapOf(box, Pose{}, whole, X).depth;
    EXPECT_NEAR(depth, 0.5 * mm, 22 * um);
    std::erase_if(ball.triangles, [&](const geometry::Triangle& t) { return ball.vertices[t[0]].z() > 9.9 * mm; });
    EXPECT_NEAR(overlapOf(box, Pose{}, OverlapBody(ball), X).depth, depth, 2 * um);
}

/// All kinds of shapes with an inside.
const std::vector<shape::Shape> kShapes = {
    shape::Sphere{12 * mm},
    shape::Box{14 * mm, 9 * mm, 11 * mm},
    shape::Cylinder{10 * mm, 16 * mm},
    shape::Torus{16 * mm, 5 * mm},
    shape::Peg{10 * mm, 18 * mm, 1 * mm},
    shape::SquarePeg{10 * mm, 8 * mm, 18 * mm, 1 * mm},
    shape::KeyedPeg{10 * mm, 18 * mm, 3 * mm, 2 * mm, 0.8 * mm},
    shape::BorePlate{24 * mm, 22 * mm, 14 * mm, 10.2 * mm, 9 * mm, 1 * mm},
    shape::SquareBorePlate{24 * mm, 22 * mm, 14 * mm, 10.2 * mm, 8.2 * mm, 14 * mm, 1 * mm},
    shape::KeyedBorePlate{26 * mm, 24 * mm, 14 * mm, 10.2 * mm, 3.2 * mm, 2.1 * mm, 14 * mm, 0.8 * mm},
    shape::ThreadBolt{12 * mm, 2 * mm, 16 * mm, 1.5 * mm},
    shape::ThreadNut{12.2 * mm, 2 * mm, 19 * mm, 10 * mm, 1.4 * mm},
};

bool isThread(const shape::Shape& shape) {
    return std::holds_alternative<shape::ThreadBolt>(shape) || std::holds_alternative<shape::ThreadNut>(shape);
}
bool isBox(const shape::Shape& shape) { return std::holds_alternative<shape::Box>(shape); }

Vec3 randomPoint(Random& random, double size) {
    return size * Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
}

TEST(ExactOverlap, BoundsOfAHullHoldForEveryPointOfIt) {
    // Truth: invariant, held against the closed forms: no point of a triangle is deeper than its bound; and for small
    // ones near a face the bound is hardly above the depth.
    Random random(5);
    for (const shape::Shape& shape : kShapes) {
        int inside = 0, close = 0;
        for (int i = 0; i < 20'000; ++i) {
            const double size = std::pow(10.0, -5.0 + 3.0 * random.uniform());
            const Vec3 centre = randomPoint(random, 32 * mm);
            Corners t;
            for (Vec3& corner : t) corner = centre + randomPoint(random, size);
            const Vec3 middle = (t[0] + t[1] + t[2]) / 3.0;
            const double bound = deepestOver(shape, t, middle);
            ASSERT_GE(bound, 0.0);
            double deepest = 0.0;
            for (int k = 0; k < 8; ++k) {
                double u = random.uniform(), v = random.uniform();
                if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
                deepest =
                    std::max(deepest, -shape::signedDistance(shape, t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0])));
            }
            ASSERT_LE(deepest, bound * (1.0 + 1e-9) + 1e-12) << shape::kindName(shape) << " " << middle.transpose();
            if (deepest > 0.0 && size < 1e-4) {
                ++inside;
                close += bound < deepest + 2.0 * size ? 1 : 0;
            }
        }
        EXPECT_GT(close, 0.85 * inside) << shape::kindName(shape) << ": useless where it is most needed";
        EXPECT_GT(inside, 100);
    }
}

/// The deepest of many points of either surface, by loops over everything.
double sampledDepth(const OverlapBody& surface, const Pose& X, const OverlapBody& solid, double spacing) {
    double deepest = 0.0;
    for (const Corners& t : surface.surface().triangles()) {
        const double longest = std::max({(t[1] - t[0]).norm(), (t[2] - t[0]).norm(), (t[2] - t[1]).norm()});
        const int n = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
        for (int i = 0; i <= n; ++i)
            for (int k = 0; i + k <= n; ++k)
                deepest = std::max(
                    deepest, -solid.signedDistance(X * Vec3(t[0] + (t[1] - t[0]) * i / n + (t[2] - t[0]) * k / n)));
    }
    return deepest;
}

TEST(ExactOverlap, IsThatOfDensePointsOfBothSurfacesForEveryPairOfShapes) {
    // Truth: independent loops over points of both surfaces, 0.5 mm apart, with the closed forms: none is deeper than
    // the bound, and the depth that was found is less than a spacing above theirs, and real: its point lies so deep in
    // one part and on the other's surface.
    Random random(11);
    int met = 0;
    for (const shape::Shape& a : kShapes)
        for (const shape::Shape& b : kShapes) {
            // Exact distances to threads take microseconds.
            if ((isThread(a) && !isThread(b) && !isBox(b)) || (isThread(b) && !isThread(a) && !isBox(a))) continue;
            const OverlapBody body_a(a, 10 * um), body_b(b, 10 * um);
            for (int i = 0; i < 2; ++i) {
                const Pose X{rotationFromVector(randomPoint(random, 3.0)), randomPoint(random, 24 * mm)};
                const Overlap found = overlapOf(body_a, Pose{}, body_b, X, {.tolerance = 20 * um});
                const double dense = std::max(sampledDepth(body_b, X, body_a, 0.5 * mm),
                                              sampledDepth(body_a, X.inverse(), body_b, 0.5 * mm));
                ASSERT_LE(dense, found.bound + 1e-9) << shape::kindName(a) << " " << shape::kindName(b);
                ASSERT_LE(found.bound, found.depth + 20 * um + 1e-9);
                ASSERT_LE(found.depth, dense + 0.5 * mm);
                if (!(found.depth > 0.0)) continue;
                ++met;
                const double in_a = shape::signedDistance(a, found.point);
                const double in_b = shape::signedDistance(b, X.inverse() * found.point);
                EXPECT_NEAR(std::min(in_a, in_b), -found.depth, 1e-12);
                EXPECT_LE(std::abs(std::max(in_a, in_b)), 10 * um + 1e-9) << "not on the surface";
            }
        }
    EXPECT_GT(met, 60);
}

TEST(ExactOverlap, OfARingInItsSeatIsFoundWithFewPieces) {
    // Truth: closed form. The ring (R = 10 mm, t = 3.4 mm) in a seat of radius 13.5 mm, as in the shipped gearbox: flat
    // and moved aside by d it reaches R + t + d - 13.5 mm into the wall; flat on the floor, sunk by s, it is s deep all
    // around; about a peg of 12.5 mm that is moved aside by d it is 6.25 + t + d - R deep.
    const shape::Torus torus{20 * mm, 6.8 * mm};
    const OverlapBody ring(torus, 0.5 * um);
    const OverlapBody seat(shape::BorePlate{44 * mm, 44 * mm, 12 * mm, 27 * mm, 12 * mm, 0.5 * mm}, 0.5 * um);
    const OverlapBody floor(shape::BorePlate{44 * mm, 44 * mm, 12 * mm, 12.7 * mm, 10 * mm, 0.5 * mm}, 0.5 * um);
    const OverlapBody block(shape::Box{44 * mm, 44 * mm, 12 * mm}, 0.5 * um);
    const OverlapBody shaft(shape::Peg{12.5 * mm, 40 * mm, 0.5 * mm}, 0.5 * um);
    const OverlapEffort effort{.tolerance = 2 * um, .share = 0.03, .ignore = 2 * um, .most_pieces = 20'000};
    const auto expect = [&](const OverlapBody& other, const Pose& X, double depth, const char* what) {
        const Overlap found = overlapOf(other, Pose{}, ring, X, effort);
        EXPECT_LE(found.depth, std::max(depth, 0.0) + 1e-9) << what;
        EXPECT_GE(found.bound, std::max(depth, 0.0) - 1e-9) << what;
        EXPECT_LE(found.bound, 1.03 * found.depth + 2 * um + 1e-9) << what;
        EXPECT_LT(found.pieces, 3000u) << what;
        const Overlap turned = overlapOf(ring, X, other, Pose{}, effort);
        EXPECT_EQ(turned.depth, found.depth) << what;
        if (!(found.depth > 0.0)) return;
        // Its point is on the other's surface and so deep in the ring.
        EXPECT_NEAR(shape::signedDistance(torus, X.inverse() * found.point), -found.depth, 1e-12) << what;
        EXPECT_NEAR(other.signedDistance(found.point), 0.0, 1e-9) << what;
    };
    for (const double deep : {-0.05 * mm, -0.05 * um, 0.0, 1 * um, 20 * um, 0.3 * mm}) {
        expect(seat, at((0.1 * mm + deep) * 0.6, (0.1 * mm + deep) * 0.8, -6 * mm), deep, "wall");
        expect(floor, at(0, 0, 3.4 * mm - deep), deep, "floor with a bore");
        expect(block, at(1 * mm, 2 * mm, 9.4 * mm - deep), deep, "block");
        expect(shaft, at(0.35 * mm + deep, 0, 15 * mm), deep, "shaft");
    }
}

TEST(ExactOverlap, BoundsOfAGrownShapeHoldForEveryPointOfAHull) {
    // Truth: the closed form of the shape itself: a point is as deep in what was grown by t as t exceeds its distance.
    Random random(17);
    int near = 0;
    for (const shape::Shape& shape : kShapes)
        for (const double by : {0.5 * mm, 3 * mm, 9 * mm}) {
            const auto around = grown(shape, by);
            if (!around) continue;
            for (int i = 0; i < 2000; ++i) {
                const Vec3 middle = randomPoint(random, 30 * mm);
                const double size = (i % 3 == 0 ? 5.0 : i % 3 == 1 ? 0.5 : 0.01) * mm;
                std::array<Vec3, 4> corners;
                for (Vec3& corner : corners) corner = middle + randomPoint(random, size);
                const Vec3 lift(0.0, 0.0, around->lift);
                std::array<Vec3, 4> lifted;
                for (std::size_t k = 0; k < 4; ++k) lifted[k] = corners[k] + lift;
                const double bound = deepestOver(around->shape, lifted, middle + lift);
                for (int k = 0; k < 30; ++k) {
                    Eigen::Vector4d w = Eigen::Vector4d::NullaryExpr([&] { return random.uniform(0.0, 1.0); });
                    w /= w.sum();
                    const Vec3 p = w[0] * corners[0] + w[1] * corners[1] + w[2] * corners[2] + w[3] * corners[3];
                    const double deep = by - shape::signedDistance(shape, p);
                    ASSERT_LE(deep, bound + 1e-12) << shape::kindName(shape) << " grown by " << by;
                    near += deep > 0.0 && deep < by;
                }
            }
        }
    EXPECT_GT(near, 10000);
}

TEST(ExactOverlap, OfSeveralHeldPartsIsTheDeepestOfAllPairsWithOneOfThem) {
    // Truth: closed form: boxes of 20 mm side by side along x, each pair overlaps by what their distance lacks of
    // 20 mm. Parts 0 and 1 reach 1 mm into each other, 1 and 2 by 2 mm, 2 and 3 by 3 mm.
    scene::Scene scene;
    for (const double x : {0.0, 19.0, 37.0, 54.0}) {
        scene::PartSpec spec{
            .name = "box", .geometry = shape::Box{20 * mm, 20 * mm, 20 * mm}, .X_WP = at(x * mm, 0, 0)};
        scene.parts.push_back(std::make_shared<const scene::Part>(*scene::buildPart(spec, {})));
        scene.spec.parts.push_back(spec);
    }
    OverlapBodies bodies;
    const SceneOverlap overlap(scene, bodies);
    const auto of = [&](std::vector<std::size_t> held) { return overlap.of(held, tight()).depth; };
    EXPECT_NEAR(of({0}), 1 * mm, 1 * um);
    EXPECT_NEAR(of({3}), 3 * mm, 1 * um);
    EXPECT_NEAR(of({1}), 2 * mm, 1 * um);
    EXPECT_NEAR(of({0, 1}), 2 * mm, 1 * um);
    EXPECT_NEAR(of({0, 3}), 3 * mm, 1 * um);
    EXPECT_NEAR(of({3, 2}), 3 * mm, 1 * um);
    EXPECT_EQ(of({}), 0.0);
}

TEST(ExactOverlap, TheTreesAnswersAreThoseOfLoopsOverAllTriangles) {
    // Truth: independent loops: the least distance, the sum of solid angles (exact for one triangle at a time), and
    // every pair of triangles.
    const geometry::TriangleMesh mesh = shape::tessellate(shape::Torus{16 * mm, 5 * mm}, 20 * um);
    const TriangleBoxes tree(mesh);
    Random random(3);
    for (int i = 0; i < 300; ++i) {
        const Vec3 p = randomPoint(random, 26 * mm);
        double least = 1.0;
        for (const Corners& t : tree.triangles()) least = std::min(least, distanceToTriangle(p, t));
        EXPECT_EQ(tree.nearest(p).distance, least);
        const double winding = tree.windingNumber(p);
        const double torus = shape::signedDistance(shape::Torus{16 * mm, 5 * mm}, p);
        if (std::abs(torus) > 20 * um) {
            EXPECT_NEAR(winding, torus < 0.0 ? 1.0 : 0.0, 0.05) << p.transpose();
        }
        Corners t;
        for (Vec3& corner : t) corner = p + randomPoint(random, 6 * mm);
        bool met = false;
        for (const Corners& other : tree.triangles()) met = met || triangleMeets(t, other);
        EXPECT_EQ(tree.isMetBy(t), met);
    }
}

TEST(ExactOverlap, TwoTrianglesMeetWhereAnEdgeOfOnePassesThroughTheOther) {
    // Truth: closed form. A triangle in z = 0 and a needle through a chosen point of that plane, inside or outside.
    Random random(9);
    const Corners flat{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    for (int i = 0; i < 1000; ++i) {
        const double u = 1.4 * random.uniform() - 0.2, v = 1.4 * random.uniform() - 0.2;
        const Vec3 through(u, v, 0.0), way(random.normal(), random.normal(), 1.0);
        const Corners needle{through + 0.5 * way, through - 0.7 * way, through + 0.5 * way + Vec3(1e-6, 0, 0)};
        const double margin = std::min({u, v, 1.0 - u - v});
        if (std::abs(margin) < 1e-5) continue;
        EXPECT_EQ(triangleMeets(flat, needle), margin > 0.0) << u << " " << v;
        EXPECT_EQ(triangleMeets(needle, flat), margin > 0.0);
        const Corners above{through + 0.5 * way, through + 0.01 * way, through + 0.5 * way + Vec3(0.1, 0, 0)};
        EXPECT_FALSE(triangleMeets(flat, above));
    }
    EXPECT_FALSE(triangleMeets(flat, flat)) << "in one plane";
}

}  // namespace
}  // namespace passung::truth
