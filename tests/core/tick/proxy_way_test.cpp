#include "core/tick/proxy_way.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/base/random.h"
#include "tests/support/scenes.h"

namespace passung::tick {
namespace {

scene::SceneSpec twoBoxes() {
    return test::scene(shape::Box{0.02, 0.02, 0.01}, {Quat::Identity(), Vec3(0, 0, 0.02)}, shape::Box{0.06, 0.06, 0.02},
                       Pose{}, scene::ContactMethod::GodObject);
}

motion::Motion shift(double x, double y) {
    motion::Motion u = motion::Motion::Zero();
    u.head<2>() << x, y;
    return u;
}

TEST(ProxyWay, IsBentByTheHeightOfItsJointOverTheLine) {
    // Truth: closed form. Two legs a and b at a right angle: the joint is a b / sqrt(a² + b²) off the line.
    const test::Bench bench(twoBoxes());
    ProxyWay way(bench.model(), motion::Metric{bench.model().metric_radius});
    EXPECT_EQ(way.bentBy(shift(1e-3, 0)), 0.0);
    way.add(shift(3e-4, 0));
    EXPECT_NEAR(way.bentBy(shift(1e-3, 0)), 0.0, 1e-18);
    EXPECT_NEAR(way.bentBy(shift(0, 4e-4)), 2.4e-4, 1e-15);
    EXPECT_NEAR(way.bentBy(shift(-3e-4, 0)), 3e-4, 1e-15);  // there and back: the line is a point
    way.add(shift(0, 4e-4));
    EXPECT_NEAR(way.length(), 7e-4, 1e-15);
    EXPECT_NEAR(way.bentBy(motion::Motion::Zero()), 2.4e-4, 1e-15);
}

TEST(ProxyWay, LeavesNoPlaceOfTheLineFartherFromItThanItsBend) {
    // Truth: brute force. Random ways of up to five legs: the line's places against 400 places of each leg.
    const test::Bench bench(twoBoxes());
    const double turn_scale = bench.model().shell->reach() / bench.model().metric_radius;
    Random random(9);
    const auto leg = [&random] {
        motion::Motion u;
        for (int i = 0; i < 6; ++i) u[i] = 1e-4 * random.normal();
        return u;
    };
    for (int run = 0; run < 50; ++run) {
        ProxyWay way(bench.model(), motion::Metric{bench.model().metric_radius});
        std::vector<motion::Motion> joints{motion::Motion::Zero()};
        const int legs = 2 + run % 4;
        double bent = 0.0;
        for (int i = 0; i < legs; ++i) {
            const motion::Motion u = leg();
            bent = way.bentBy(u);
            way.add(u);
            motion::Motion scaled = u;
            scaled.tail<3>() *= turn_scale;
            joints.push_back(joints.back() + scaled);
        }
        double farthest = 0.0;
        for (int k = 0; k <= 200; ++k) {
            const motion::Motion place = k / 200.0 * joints.back();
            double nearest = 1e300;
            for (std::size_t i = 0; i + 1 < joints.size(); ++i)
                for (int m = 0; m <= 400; ++m)
                    nearest = std::min(nearest, (joints[i] + m / 400.0 * (joints[i + 1] - joints[i]) - place).norm());
            farthest = std::max(farthest, nearest);
        }
        EXPECT_LE(farthest, bent + 2e-6) << run;  // half the distance of two places
        EXPECT_GT(bent, 0.0);
    }
}

}  // namespace
}  // namespace passung::tick
