#include "devices/simulated/impression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/tick_record.h"

namespace passung::simulated {
namespace {

constexpr double kOmega = 2.0 * std::numbers::pi * kShakes;

/// Three seconds of a hand that moves by amplitude · sin along `axis`, with a force that `law` makes of way, speed and
/// acceleration there; out of phase with the feeler's own clock.
template <class Law>
double felt(Quantity quantity, int axis, double offset, double amplitude, Law law) {
    Impression impression(quantity);
    for (int tick = 0; tick < 3000; ++tick) {
        const double phase = kOmega * kTickSeconds * tick + 0.7;
        Vec3 p = Vec3::Zero(), force = Vec3::Zero();
        p[axis] = offset + amplitude * std::sin(phase);
        force[axis] =
            law(p[axis], amplitude * kOmega * std::cos(phase), -amplitude * kOmega * kOmega * std::sin(phase));
        impression.learn(p, force);
    }
    return impression.value();
}

TEST(Impression, IsTheConstantOfTheForcesLaw) {
    // Truth: closed form: the force on the hand of a spring, a damper and a mass; each quantity leaves the others
    // aside.
    const auto law = [](double x, double v, double a) { return -150.0 * x - 10.0 * v - 0.2 * a; };
    EXPECT_NEAR(felt(Quantity::Viscosity, 2, -8e-3, 2e-3, law), 10.0, 1e-9);
    EXPECT_NEAR(felt(Quantity::Inertia, 0, 0.0, 12e-3, [](double, double v, double a) { return -3.0 * v - 0.2 * a; }),
                0.2, 1e-12);
    EXPECT_NEAR(felt(Quantity::Stiffness, 2, -8e-3, 2e-3, [](double x, double, double) { return -150.0 * x; }), 150.0,
                1e-9);
    EXPECT_NEAR(felt(Quantity::Force, 2, 0.0, 1e-3, [](double, double, double) { return -1.5; }), 1.5, 1e-12);
}

TEST(Impression, NothingFeltIsNothing) {
    // Truth: invariant
    for (const Quantity quantity : {Quantity::Stiffness, Quantity::Roughness, Quantity::Force, Quantity::Viscosity,
                                    Quantity::Inertia, Quantity::Position}) {
        Impression impression(quantity);
        EXPECT_EQ(impression.value(), 0.0);
        for (int tick = 0; tick < 2000; ++tick) impression.learn(Vec3::Zero(), Vec3::Zero());
        EXPECT_EQ(impression.value(), 0.0);
    }
}

TEST(Impression, BeginsAnewWithEachInterval) {
    // Truth: invariant
    Impression impression(Quantity::Position);
    impression.touch(0.015);
    EXPECT_EQ(impression.value(), 0.015);
    impression.clear();
    EXPECT_EQ(impression.value(), 0.0);
}

}  // namespace
}  // namespace passung::simulated
