#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/tick/proxy.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

using scene::ContactMethod;

constexpr std::array kGods{ContactMethod::GodObjectHeuristic, ContactMethod::GodObject};

/// A peg of 20 mm stands in a bore with 50 µm of radial clearance; points so dense that a look takes about a third of
/// what a tick may look at.
scene::SceneSpec pegInBore(ContactMethod method) {
    auto spec = test::scene(shape::Peg{0.02, 0.024, 0.5e-3}, {Quat::Identity(), Vec3(0, 0, -0.01)},
                            shape::BorePlate{0.026, 0.026, 0.023, 0.0201, 0.02, 0.5e-3}, Pose{}, method);
    spec.contact.cell = 0.0;
    spec.contact.tolerance = 5e-6;
    spec.contact.spacing = 1e-3;
    spec.contact.two_way = true;
    return spec;
}

/// Pushed aside by 1 mm, and about the axis at so many metres a second at the peg's wall.
Pose handAt(double t, double speed) {
    const double angle = speed / 0.01 * t;
    const Vec3 aside = 1e-3 * Vec3(std::cos(angle), std::sin(angle), 0.0);
    return {rotationFromVector(Vec3(0.02 * std::sin(5.0 * angle), 0.0, angle)),
            Vec3(0, 0, -0.01) + std::min(1.0, t / 0.05) * aside};
}

TEST(FieldBudget, SuspendsWhatATickCannotLookAtAndGoesOnInTheNext) {
    // Truth: invariants. The work of a tick ends at the cap, but for the looks begun before and the hand's depth; what
    // was suspended is made up for, so that in the end the proxy is where an unhurried hand would have brought it.
    constexpr double kHurry = 0.5, kSeconds = 0.4;
    for (const ContactMethod method : kGods) {
        test::Bench hurried(pegInBore(method)), unhurried(pegInBore(method));
        int suspended = 0, suspended_at_rest = 0;
        std::uint32_t most_work = 0;
        double deepest = 0.0;
        tick::TickOutput end, slow_end;
        for (int i = 0; i < 1400; ++i) {
            const double t = std::min(kSeconds, i * kTickSeconds);
            end = hurried.step(handAt(t, kHurry));
            const bool was = (end.frame.status & kSuspended) != 0;
            suspended += was ? 1 : 0;
            suspended_at_rest += was && i >= 1200 ? 1 : 0;
            most_work = std::max(most_work, end.frame.work);
            deepest = std::max(deepest, end.frame.proxy_depth);
        }
        EXPECT_GT(suspended, 10);
        EXPECT_EQ(suspended_at_rest, 0);
        EXPECT_LE(most_work, 2 * tick::kFieldBudget);
        EXPECT_LE(deepest, 5e-6);
        for (int i = 0; i < 4200; ++i)
            slow_end = unhurried.step(handAt(std::min(kSeconds, i * 0.1 * kTickSeconds), kHurry));
        EXPECT_LT((end.X_WG.p - slow_end.X_WG.p).norm(), 2e-6);
        EXPECT_LT(rotationVector(end.X_WG.q * slow_end.X_WG.q.conjugate()).norm(), 2e-4);
    }
}

}  // namespace
}  // namespace passung
