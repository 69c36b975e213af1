#include "analysis/truth/least_energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/random.h"

namespace passung::truth {
namespace {

const double kRho = std::sqrt(1.0 / 2000.0);  // [m]

std::unique_ptr<Separation> between(const shape::Shape& held, const shape::Shape& fixed, const Pose& X_WF = {}) {
    const PlacedShape placed{fixed, X_WF};
    return separationOf(held, {&placed, 1});
}

const shape::Peg kPeg{.02, .05, .0005};
shape::BorePlate bore(double play) { return {.06, .06, .03, .02 + 2.0 * play, .025, .0005}; }

TEST(LeastEnergy, CrossedEdgesPushAcrossBothAlone) {
    // Truth: closed form: two boxes edge on edge, upper one turned by 72 degrees: the hand's way below is held, none of
    // the way along either edge is.
    const Quat on_edge(Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitX()));
    const Quat turned = Quat(Eigen::AngleAxisd(0.4 * std::numbers::pi, Vec3::UnitZ())) * on_edge;
    const double half = .01 * std::sqrt(2.0);
    const auto boxes = between(shape::Box{.02, .02, .02}, shape::Box{.02, .02, .02}, {on_edge, {0, 0, -half}});
    const auto found =
        leastEnergyFrom(*boxes, kRho, {turned, {3e-4, 2e-4, half}}, {turned, {3.5e-4, 2.3e-4, half - 1e-4}});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->X.p.x(), 3.5e-4, 2e-6);  // the crossing is beside the centre: the box turns a little
    EXPECT_NEAR(found->X.p.y(), 2.3e-4, 2e-6);
    EXPECT_LE(found->overlap, 2e-9);
    // What holds acts at the crossing, along z: force and torque about the centre agree.
    const auto pull = pullTo(found->X, {turned, {3.5e-4, 2.3e-4, half - 1e-4}}, kRho);
    EXPECT_NEAR(pull.head<2>().norm(), 0.0, 1e-8);
    const Vec3 lever(-found->X.p.y() / std::tan(0.4 * std::numbers::pi), -found->X.p.y(), 0.0);
    const Vec3 expected = lever.cross(Vec3(0, 0, pull[2]));
    EXPECT_LE((kRho * pull.tail<3>() - expected).norm(), 1e-9);
}

TEST(LeastEnergy, ABoxPressedFlatOnABoxRestsFlat) {
    // Truth: closed form: the face's middle lies over the other face, so that no torque of the pull tips it.
    const auto boxes = between(shape::Box{.02, .02, .01}, shape::Box{.06, .06, .02}, {Quat::Identity(), {0, 0, -.01}});
    const Pose hand{rotationFromVector({0.002, -0.003, 0.01}), {1e-3, 0, .0045}};
    const auto found = leastEnergyFrom(*boxes, kRho, {Quat::Identity(), {1e-3, 0, .005}}, hand);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->X.p.z(), .005, 2e-8);
    EXPECT_NEAR(rotationVector(found->X.q).head<2>().norm(), 0.0, 2e-6);
    EXPECT_NEAR(rotationVector(found->X.q).z(), 0.01, 1e-5);
}

TEST(LeastEnergy, OfAPegIsFreeAtDensePointsAndBetteredByNoSmallMotion) {
    // Truth: closed form (shape::signedDistance at dense points of all edges both ways), and sampling: no free pose
    // nearby has less energy.
    const auto plate = bore(1e-4);
    const auto pair = between(kPeg, plate);
    const auto leastGap = [&](const Pose& X) {
        double least = 1.0;
        const auto circle = [&](double radius, double z, const Pose& to, const shape::Shape& other) {
            for (int i = 0; i < 2048; ++i) {
                const double t = 2.0 * std::numbers::pi * i / 2048;
                const Vec3 p(radius * std::cos(t), radius * std::sin(t), z);
                least = std::min(least, shape::signedDistance(other, to * p));
            }
        };
        circle(.0095, 0.0, X, plate);
        circle(.01, .0005, X, plate);
        circle(.0101, -.0005, X.inverse(), kPeg);
        circle(.0106, 0.0, X.inverse(), kPeg);
        return least;
    };
    Random random(3);
    const auto part = [&] { return random.uniform(-1.0, 1.0); };
    int judged = 0;
    for (int i = 0; i < 12; ++i) {
        Pose X{Quat::Identity(), {0, 0, i % 2 == 0 ? .0003 : -.002}};
        const Vec3 to(0.002 * part(), 0.002 * part(), X.p.z() - 0.0015), turn(0.03 * part(), 0.03 * part(), 0.0);
        bool known = true;
        for (int step = 1; step <= 40 && known; ++step) {
            const double s = step / 40.0;
            const auto found = leastEnergyFrom(*pair, kRho, X, {rotationFromVector(s * turn), X.p + s * (to - X.p)});
            known = found.has_value();
            if (known) X = found->X;
        }
        const Pose hand{rotationFromVector(turn), to};
        const auto found = leastEnergyFrom(*pair, kRho, X, hand);
        if (!known || !found) continue;
        ++judged;
        EXPECT_GE(leastGap(found->X), -3e-9) << i;
        for (int tried = 0; tried < 300; ++tried) {
            const double size = std::pow(10.0, random.uniform(-7.0, -5.0));
            const Pose near{rotationFromVector(size / kRho * Vec3(part(), part(), part())) * found->X.q,
                            found->X.p + size * Vec3(part(), part(), part())};
            const double energy = 0.5 * pullTo(near, hand, kRho).squaredNorm();
            if (energy < found->energy - 1e-12 - 3e-9 * std::sqrt(found->energy)) {
                EXPECT_LT(leastGap(near), 0.0) << i << ' ' << tried;
            }
        }
    }
    EXPECT_GE(judged, 10);
}

}  // namespace
}  // namespace passung::truth
