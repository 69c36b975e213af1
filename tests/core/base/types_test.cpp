#include "core/base/types.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace passung {
namespace {

constexpr double kRounding = 1e-12;

TEST(RotationBetween, TurnsOneWayIntoTheOtherByTheAngleBetweenThem) {
    // Truth: closed form: the angle between two vectors. Any lengths.
    Random random(1);
    const auto any = [&random] { return Vec3(random.normal(), random.normal(), random.normal()); };
    for (int i = 0; i < 1000; ++i) {
        const Vec3 from = any(), to = 10.0 * any();
        const Quat turn = rotationBetween(from, to);
        EXPECT_LE((turn * from.normalized() - to.normalized()).norm(), kRounding);
        EXPECT_NEAR(rotationVector(turn).norm(), std::atan2(from.cross(to).norm(), from.dot(to)), kRounding);
    }
}

TEST(RotationBetween, TurnsByHalfATurnWhereTheWaysAreOpposite) {
    // Truth: invariant. Which axis serves is not said, only that it is across.
    for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 0, -2), Vec3(1, -2, 3)}) {
        const Quat turn = rotationBetween(way, -way);
        EXPECT_TRUE(isRotation(turn, kRounding));
        EXPECT_LE((turn * way + way).norm(), 1e-6 * way.norm());
    }
}

}  // namespace
}  // namespace passung
