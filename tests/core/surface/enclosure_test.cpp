#include "core/surface/enclosure.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "tests/support/surface_cases.h"

namespace passung::surface {
namespace {

constexpr int kNoBudget = std::numeric_limits<int>::max();

geometry::TriangleMesh cube(double half, const Vec3& at = Vec3::Zero()) {
    return test::boxMesh(at - Vec3::Constant(half), at + Vec3::Constant(half));
}

geometry::TriangleMesh both(geometry::TriangleMesh one, const geometry::TriangleMesh& other) {
    test::append(one, other);
    return one;
}

geometry::TriangleMesh turnedInsideOut(geometry::TriangleMesh mesh) {
    for (geometry::Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

/// The way out; zero: nothing lies within the other.
Vec3 wayOut(const geometry::TriangleMesh& held, const geometry::TriangleMesh& obstacle, const Pose& X,
            const Vec3& hand = Vec3::Zero()) {
    const ClusterTree of_held(held), of_obstacle(obstacle);
    EnclosureSearch search(of_held, of_obstacle);
    search.restart();
    int work = 0;
    EXPECT_TRUE(search.advance(Placement(X), hand, work, kNoBudget));
    return search.encloses() ? search.wayOut() : Vec3::Zero();
}

TEST(Enclosure, OfBoxesIsTheLeastWayThroughAFace) {
    // Truth: closed form. A cube of 4 mm whose middle lies 7 mm below the top of one of 20 mm: 7 + 2 mm up.
    const Vec3 out = wayOut(cube(.002), cube(.01), {Quat::Identity(), Vec3(.001, 0, .003)});
    EXPECT_NEAR(out.z(), .009, 2e-5);
    EXPECT_NEAR(out.head<2>().norm(), 0.0, 1e-12);
}

TEST(Enclosure, OfAnObstacleWithinTheHeldPartMovesTheHeldPart) {
    // Truth: closed form, the case above seen from the other side: the obstacle leaves upwards, the held part goes
    // down.
    const Vec3 out = wayOut(cube(.01), cube(.002, Vec3(.001, 0, .003)), Pose{});
    EXPECT_NEAR(out.z(), -.009, 2e-5);
    const Quat turned(Eigen::AngleAxisd(0.5, Vec3::UnitX()));
    const Vec3 along = wayOut(cube(.01), cube(.0001, turned * Vec3(.001, 0, .003)), {turned, Vec3::Zero()});
    EXPECT_NEAR(along.normalized().dot(turned * Vec3::UnitZ()), -1.0, 1e-9);
}

TEST(Enclosure, GoesAlongTheHandWhereThatLeadsOut) {
    // Truth: closed form. From the middle 10 + 2 mm along x; 20 mm to the hand are enough, 11 are not.
    const Pose X{Quat::Identity(), Vec3(0, 0, .003)};
    EXPECT_NEAR((wayOut(cube(.002), cube(.01), X, Vec3(.02, 0, 0)) - Vec3(.012, 0, 0)).norm(), 0.0, 2e-5);
    EXPECT_NEAR(wayOut(cube(.002), cube(.01), X, Vec3(.011, 0, 0)).z(), .009, 2e-5);
}

TEST(Enclosure, IsOfSolidsOnly) {
    // Truth: closed form. Beside a body, in its cavity, and beside a sheet nothing encloses; between them it does.
    const geometry::TriangleMesh hollow = both(cube(.01), turnedInsideOut(cube(.006)));
    EXPECT_EQ(wayOut(cube(.001), cube(.01), {Quat::Identity(), Vec3(.0, 0, .0111)}), Vec3::Zero());
    EXPECT_EQ(wayOut(cube(.001), hollow, {Quat::Identity(), Vec3(.001, 0, .002)}), Vec3::Zero());
    EXPECT_NEAR(wayOut(cube(.001), hollow, {Quat::Identity(), Vec3(.008, 0, .0)}).x(), .003, 2e-5);
    const geometry::TriangleMesh sheet{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    for (const double z : {-.0011, .0011})
        EXPECT_EQ(wayOut(cube(.001), sheet, {Quat::Identity(), Vec3(0, 0, z)}), Vec3::Zero());
}

TEST(Enclosure, AsksEveryPieceAndEveryBody) {
    // Truth: closed form. Of two cubes the second stands in the second of two blocks.
    const geometry::TriangleMesh pieces = both(cube(.001, Vec3(-.05, 0, 0)), cube(.001, Vec3(.05, 0, 0)));
    const ClusterTree held(pieces), block(cube(.01));
    const std::vector<geometry::PlacedTree> blocks{{&block, {Quat::Identity(), Vec3(0, 0, 1)}},
                                                   {&block, {Quat::Identity(), Vec3(.057, 0, 0)}}};
    const ClusterTree obstacles{std::span<const geometry::PlacedTree>(blocks)};
    EnclosureSearch search(held, obstacles);
    search.restart();
    int work = 0;
    ASSERT_TRUE(search.advance(Placement(Pose{}), Vec3::Zero(), work, kNoBudget));
    ASSERT_TRUE(search.encloses());
    EXPECT_NEAR((search.wayOut() - Vec3(-.004, 0, 0)).norm(), 0.0, 2e-5);
}

TEST(Enclosure, GoesOnWhereABudgetEndedAndComesToTheSame) {
    // Truth: invariant, of a scan's coarse faces and a ball in it.
    const test::SurfaceCase scan = test::scanOnScan(.03, 60);
    const ClusterTree held(cube(.001)), obstacle(scan.obstacle);
    const Placement X(Pose{Quat::Identity(), Vec3(.001, .002, 0)});
    EnclosureSearch search(held, obstacle);
    search.restart();
    int work = 0;
    ASSERT_TRUE(search.advance(X, Vec3::Zero(), work, kNoBudget));
    ASSERT_TRUE(search.encloses());
    const Vec3 whole = search.wayOut();
    search.restart();
    int ticks = 1;
    for (int spent = 0; !search.advance(X, Vec3::Zero(), spent, 2000); spent = 0) {
        EXPECT_LE(spent, 2000 + 60);
        ++ticks;
    }
    EXPECT_EQ(search.wayOut(), whole);
    EXPECT_GT(ticks, 3);
}

}  // namespace
}  // namespace passung::surface
