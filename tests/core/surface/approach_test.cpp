#include "core/surface/approach.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace passung::surface {
namespace {

Vec3 anyDirection(Random& random) {
    const Vec3 n(random.normal(), random.normal(), random.normal());
    return n.normalized();
}

TEST(Approach, NoPointOfTheBoxComesNearerToAPlaneThanItsClassSays) {
    // Truth: closed form: a point moved by d comes -n · d nearer to a plane of normal n. Motions of a tick, boxes off
    // their origin, normals of all classes.
    Random random(3);
    std::array<bool, NormalClass::kCount> met{};
    double most = 0.0;
    for (int round = 0; round < 400; ++round) {
        geometry::Bounds box;
        const Vec3 middle = 0.05 * anyDirection(random);
        for (int i = 0; i < 2; ++i)
            box.extend(middle + Vec3(random.uniform(-.03, .03), random.uniform(-.03, .03), random.uniform(-.03, .03)));
        const Quat from(Eigen::AngleAxisd(random.uniform(0.0, 3.0), anyDirection(random))),
            to(Eigen::AngleAxisd(random.uniform(0.0, 0.01), anyDirection(random)) * from);
        const Mat3 turn = to.toRotationMatrix() - from.toRotationMatrix();
        const Vec3 move = 1e-4 * anyDirection(random);
        PerClass nearer;
        measureApproach(box, turn, move, nearer);
        for (int k = 0; k < 200; ++k) {
            const Vec3 n = anyDirection(random);
            Vec3 x = box.low;
            for (Eigen::Index axis = 0; axis < 3; ++axis)
                if (random.uniform() < 0.5)
                    x[axis] = random.uniform(box.low[axis], box.high[axis]);
                else if (random.uniform() < 0.5)
                    x[axis] = box.high[axis];
            const double comes = -n.dot(turn * x + move);
            const std::size_t normals = NormalClass::of(n);
            ASSERT_LT(normals, NormalClass::kCount);
            met[normals] = true;
            EXPECT_LE(comes, nearer[normals]);
            most = std::max(most, comes / nearer[normals]);
        }
    }
    EXPECT_GT(most, 0.95) << "the bounds are far from what happens";
    for (std::size_t c = 0; c < NormalClass::kCount; ++c) EXPECT_TRUE(met[c]) << "class " << c;
}

TEST(Approach, SlidingAlongAPlaneOrAwayFromItIsLittleOrNone) {
    // Truth: closed form: normals of a class lie within 17° of each other's middle, or 22.5° of the axis that is its
    // corner.
    geometry::Bounds box;
    box.extend(Vec3(-0.01, -0.02, -0.03));
    box.extend(Vec3(0.02, 0.01, 0.03));
    Random random(4);
    for (int round = 0; round < 1000; ++round) {
        const Vec3 n = anyDirection(random);
        const Vec3 along = n.cross(anyDirection(random)).normalized();
        PerClass nearer;
        measureApproach(box, Mat3::Zero(), 1e-4 * along, nearer);
        EXPECT_LE(nearer[NormalClass::of(n)], 0.62e-4);
        measureApproach(box, Mat3::Zero(), 1e-4 * n, nearer);
        EXPECT_EQ(nearer[NormalClass::of(n)], 0.0);
        measureApproach(box, Mat3::Zero(), -1e-4 * n, nearer);
        EXPECT_GE(nearer[NormalClass::of(n)], 1e-4);
        EXPECT_LE(nearer[NormalClass::of(n)], 1.1e-4);
    }
}

}  // namespace
}  // namespace passung::surface
