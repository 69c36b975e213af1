#include "core/tick/transients.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

constexpr double kAmplitude = 8.0, kFrequency = 120.0, kDecay = 0.015;  // [N·s/m], [Hz], [s]

/// A ball over a plate whose top is z = 0; its lowest point at `height`.
scene::SceneSpec ballOverPlate(scene::ContactMethod method, double height) {
    scene::SceneSpec spec = test::scene(shape::Sphere{0.02}, Pose{Quat::Identity(), {0, 0, 0.01 + height}},
                                        shape::Box{0.06, 0.06, 0.02}, Pose{Quat::Identity(), {0, 0, -0.01}}, method);
    spec.contact.rotational_stiffness = 0.0;
    return spec;
}

scene::SceneSpec withTransients(scene::SceneSpec spec) {
    spec.effects.transients = {.amplitude = kAmplitude, .frequency = kFrequency, .decay = kDecay};
    return spec;
}

/// The waveform of an impact of speed 1, `ticks` after it.
double waveform(int ticks) {
    const double t = kTickSeconds * ticks;
    return kAmplitude * std::exp(-t / kDecay) * std::sin(2 * std::numbers::pi * kFrequency * t);
}

/// What the transients alone do along a motion: the same scene with them and without.
class Added {
public:
    explicit Added(const scene::SceneSpec& spec) : with_(withTransients(spec)), without_(spec) {}

    Vec3 step(const DeviceReading& reading) {
        const auto a = with_.step(reading), b = without_.step(reading);
        energy = a.frame.energy - b.frame.energy;
        contact = b.frame.F_H_W.force;
        return a.frame.F_H_W.force - b.frame.F_H_W.force;
    }
    Vec3 step(const Pose& X_WH) { return step(DeviceReading{X_WH}); }

    double energy = 0.0;  // that the controller took in because of them [J]
    Vec3 contact;

private:
    test::Bench with_, without_;
};

constexpr scene::ContactMethod kMethods[] = {scene::ContactMethod::Penalty, scene::ContactMethod::GodObjectHeuristic,
                                             scene::ContactMethod::GodObject};

TEST(Transients, OfAnImpactOnAPlaneAreADecayingSineInProportionToItsSpeed) {
    // Truth: closed form, A s exp(-t/tau) sin(2 pi f t) along the contact's force n at the impact, zero in the impact's
    // own tick, s = v n_z; and the work that it takes in while the hand goes on: A s² times the sum of exp sin over the
    // ticks times the tick. n is the normal but for the sampled ball's share, below half a percent.
    for (const auto method : kMethods) {
        for (const double speed : {0.02, 0.2}) {
            const auto spec = ballOverPlate(method, 2.5 * speed * kTickSeconds);
            Added added(spec);
            int since = -1;
            Vec3 n = Vec3::UnitZ();
            double integral = 0.0;
            for (int i = 0; i < 25; ++i) {
                Pose X = spec.parts[0].X_WP;
                X.p.z() -= speed * kTickSeconds * i;
                const Vec3 force = added.step(X);
                EXPECT_NEAR(added.energy, std::pow(speed * n.z(), 2) * integral, 1e-12) << i;
                if (since < 0 && added.contact.norm() > 0.0) n = added.contact.normalized();
                if (since >= 0 || added.contact.norm() > 0.0) ++since;
                const double expected = since >= 0 ? waveform(since) : 0.0;
                EXPECT_NEAR((force - speed * n.z() * expected * n).norm(), 0.0, 1e-11) << i;
                integral += expected * kTickSeconds;
            }
            EXPECT_GT(n.z(), 0.995);
            EXPECT_GE(since, 20);
            EXPECT_GT(std::abs(integral), 1e-3);
        }
    }
}

/// The whole scene carried by `way`.
scene::SceneSpec carried(scene::SceneSpec spec, const Vec3& way) {
    for (scene::PartSpec& part : spec.parts) part.X_WP.p += way;
    return spec;
}

TEST(Transients, AreNotThereAtTheFirstSampleWhereverTheSceneLies) {
    // Truth: closed form, speed zero: where the hand was before its first sample is not known. Above, below and beside
    // the origin of the world, from where a hand would have come at hundreds of metres per second; so at the start,
    // when a start gate opens, and after rejected samples.
    for (const auto method : kMethods) {
        for (const Vec3& way : {Vec3(0, 0, -0.4), Vec3(0, 0, 0.4), Vec3(0.3, -0.2, -0.1), Vec3(-0.5, 0.1, 0.2)}) {
            const auto inside = carried(ballOverPlate(method, -1e-3), way);
            auto gated_spec = inside;
            gated_spec.start_gate = {0.001, 0.1, 5};
            Added resting(inside), gated(gated_spec);
            DeviceReading bad{inside.parts[0].X_WP};
            bad.fresh = false;
            for (int i = 0; i < 60; ++i) {
                const bool lost = i == 30 || i == 31;
                EXPECT_EQ(resting.step(lost ? bad : DeviceReading{inside.parts[0].X_WP}).norm(), 0.0) << i;
                EXPECT_EQ(gated.step(inside.parts[0].X_WP).norm(), 0.0) << i;
            }
            EXPECT_GT(resting.contact.norm(), 0.5);
            EXPECT_GT(gated.contact.norm(), 0.5);
        }
    }
}

TEST(Transients, AreNotThereWithoutAnImpact) {
    // Truth: closed form, speed zero. A hand that rests in contact; contact that is there again after lost samples,
    // however fast the hand was; and no contact at all.
    for (const auto method : kMethods) {
        const auto inside = ballOverPlate(method, -1e-3);
        Added resting(inside);
        for (int i = 0; i < 50; ++i) EXPECT_EQ(resting.step(inside.parts[0].X_WP).norm(), 0.0);
        EXPECT_GT(resting.contact.norm(), 0.5);

        const auto above = ballOverPlate(method, 1e-3);
        Added lost(above), flying(above);
        lost.step(above.parts[0].X_WP);
        DeviceReading bad{above.parts[0].X_WP};
        bad.X_BD.p.z() = std::numeric_limits<double>::quiet_NaN();
        for (int i = 0; i < 5; ++i) EXPECT_EQ(lost.step(bad).norm(), 0.0);
        for (int i = 0; i < 20; ++i) {
            EXPECT_EQ(lost.step(inside.parts[0].X_WP).norm(), 0.0);
            Pose X = above.parts[0].X_WP;
            X.p.x() += 1e-4 * i;
            EXPECT_EQ(flying.step(X).norm(), 0.0);
        }
        EXPECT_GT(lost.contact.norm(), 0.5);
    }
}

TEST(Transients, DoNotComeFromAProxyThatLagsBehindInFreeRoom) {
    // Truth: closed form. A block that moves along a plate, 20 um above it, touches nothing.
    for (const auto method : kMethods) {
        auto spec = ballOverPlate(method, 0.0);
        spec.parts[0].geometry = shape::Box{0.01, 0.01, 0.01};
        spec.parts[0].X_WP.p = Vec3(-0.02, 0, 0.00502);
        spec.contact.cell = 0.1e-3;
        Added sliding(spec);
        for (int i = 0; i < 40; ++i) {
            Pose X = spec.parts[0].X_WP;
            X.p.x() += 1e-3 * i;
            EXPECT_EQ(sliding.step(X).norm(), 0.0) << i;
        }
    }
}

TEST(Transients, OfContactsWhoseForcesCancelAreNoStrongerThanTheirPointsAreFast) {
    // Truth: invariant, s ≤ V: a bar that turns against two posts at once has hardly a force there, but a torque.
    for (const auto method : kMethods) {
        auto spec = ballOverPlate(method, 0.0);
        spec.parts[0].geometry = shape::Box{0.03, 0.004, 0.004};
        spec.parts[0].X_WP = Pose{};
        spec.parts[1].geometry = shape::Cylinder{0.006, 0.02};
        spec.parts[1].X_WP.p = Vec3(0.012, 0.006, 0);
        spec.parts.push_back(spec.parts[1]);
        spec.parts[2].name = "other";
        spec.parts[2].X_WP.p = Vec3(-0.012, -0.006, 0);
        spec.contact.rotational_stiffness = 1.0;
        Added turning(spec);
        double largest = 0.0;
        constexpr double kSpin = 6.0;  // [rad/s]
        for (int i = 0; i < 60; ++i)
            largest = std::max(
                largest,
                turning.step(Pose{rotationFromVector(Vec3(0, 0, kSpin * kTickSeconds * i)), Vec3::Zero()}).norm());
        EXPECT_LE(largest, kAmplitude * kSpin * Vec3(0.015, 0.002, 0.002).norm());
    }
}

TEST(Transients, OfImpactsThatFollowOneAnotherAddUp) {
    // Truth: closed form. Two taps 10 ticks apart: the sum of two waveforms.
    const auto spec = ballOverPlate(scene::ContactMethod::GodObjectHeuristic, 0.5e-4);
    Added added(spec);
    std::vector<int> impacts;
    bool before = false;
    for (int i = 0; i < 60; ++i) {
        Pose X = spec.parts[0].X_WP;
        X.p.z() -= 1e-4 * ((i % 10) < 5 && i < 20 ? i % 10 : 0);
        const Vec3 force = added.step(X);
        const bool now = added.contact.norm() > 0.0;
        if (now && !before) impacts.push_back(i);
        before = now;
        double expected = 0.0;
        for (const int impact : impacts) expected += 0.1 * waveform(i - impact);
        EXPECT_NEAR(force.z(), expected, 1e-5 * kAmplitude * 0.1) << i;
    }
    EXPECT_EQ(impacts.size(), 2u);
}

TEST(Transients, OfAPartThatTurnsComeFromTheSpeedOfThePointThatHits) {
    // Truth: closed form. A bar whose end lies 50 mm beside its own axis of rotation: turning at w, with the origin
    // at rest, its point in contact comes down at about 0.05 w, and the vibration has the contact's line of action.
    auto spec = ballOverPlate(scene::ContactMethod::GodObjectHeuristic, 0.0);
    spec.parts[0].geometry = shape::Box{0.1, 0.01, 0.01};
    spec.parts[0].X_WP = {Quat::Identity(), Vec3(0, 0, 0.0065)};
    spec.parts[1].geometry = shape::Box{0.2, 0.06, 0.02};
    spec.contact.rotational_stiffness = 2.0;
    test::Bench with(withTransients(spec)), without(spec);
    constexpr double kSpin = 3.0;  // [rad/s]
    double rings = 0.0, expected = 0.0;
    Vec3 torque = Vec3::Zero(), contact_torque = Vec3::Zero();
    double contact_force = 0.0;
    int since = -1;
    for (int i = 0; i < 20; ++i) {
        const Pose X{rotationFromVector(Vec3(0, kSpin * kTickSeconds * i, 0)), spec.parts[0].X_WP.p};
        const auto a = with.step(X), b = without.step(X);
        if (since < 0 && b.frame.F_H_W.force.z() > 0.0) {
            contact_force = b.frame.F_H_W.force.norm();
            contact_torque = b.frame.F_H_W.torque;
        }
        if (since >= 0 || b.frame.F_H_W.force.z() > 0.0) ++since;
        if (since != 2) continue;
        rings = (a.frame.F_H_W.force - b.frame.F_H_W.force).norm();
        torque = a.frame.F_H_W.torque - b.frame.F_H_W.torque;
        expected = 0.05 * kSpin * waveform(2);
    }
    ASSERT_GT(contact_force, 0.0);
    EXPECT_NEAR(rings, expected, 0.03 * expected);
    EXPECT_NEAR((torque - rings / contact_force * contact_torque).norm(), 0.0, 1e-9 * torque.norm());
    EXPECT_NEAR(torque.norm(), 0.05 * rings, 0.03 * 0.05 * rings);
}

TEST(Transients, GiveOutNoMoreThanTheirBoundOfEnergy) {
    // Truth: invariant. Along any motion not faster than V the impacts so far, of speeds s, give out at most
    // A tau V sum(s). The worst hand: V = 0.5 m/s, always along the vibration's force, so that a share of about 2/pi of
    // the bound comes out; and one that hammers at random.
    constexpr double kMost = 0.5;
    for (const auto method : kMethods) {
        for (const bool worst : {true, false}) {
            Random random(3);
            const auto spec = ballOverPlate(method, 1e-3);
            Added added(spec);
            Pose X = spec.parts[0].X_WP;
            const double low = X.p.z() - 3e-3, high = X.p.z() + 1e-3;
            double bound = 0.0, speed = -kMost;
            bool before = false;
            for (int i = 0; i < 2000; ++i) {
                const double z = std::clamp(X.p.z() + speed * kTickSeconds, low, high);
                const double down = (X.p.z() - z) / kTickSeconds;
                X.p.z() = z;
                const double force = added.step(X).z();
                const bool now = added.contact.norm() > 0.0;
                if (now && !before) bound += kAmplitude * kDecay * kMost * std::max(0.0, down);
                before = now;
                ASSERT_LE(-added.energy, bound + 1e-9) << i;
                if (worst && force != 0.0) speed = force > 0.0 ? kMost : -kMost;
                if (!worst && i % 20 == 0) speed = random.uniform(-kMost, kMost);
            }
            EXPECT_GT(bound, 0.02);
            if (worst) {
                EXPECT_GT(-added.energy, 0.3 * bound);
            }
        }
    }
}

TEST(Transients, AreLimitedWithTheContactByTheOutputStage) {
    // Truth: invariant: the device's limit holds for the sum, at 0.5 m/s some eight times over it.
    auto spec = withTransients(ballOverPlate(scene::ContactMethod::GodObjectHeuristic, 1e-3));
    spec.limits.max_force = 0.4;
    test::Bench bench(spec);
    int limited = 0;
    for (int i = 0; i < 30; ++i) {
        Pose X = spec.parts[0].X_WP;
        X.p.z() -= 5e-4 * std::min(i, 3);
        const auto out = bench.step(X);
        EXPECT_LE(out.F_D_B.force.norm(), 0.4);
        limited += out.frame.status & kForceLimited ? 1 : 0;
    }
    EXPECT_GT(limited, 5);
}

TEST(Transients, AreNoStageOfASceneWithoutThem) {
    // Truth: invariant. Only the effects that a scene names are built; they come before delay and limits.
    const auto stagesOf = [](const scene::SceneSpec& spec) {
        test::Bench bench(spec);
        std::vector<std::string> names;
        for (const auto& stage : bench.model().stages) names.emplace_back(stage.name);
        return names;
    };
    auto spec = ballOverPlate(scene::ContactMethod::Penalty, 0.0);
    spec.limits.delay_ticks = 1;
    auto names = stagesOf(spec);
    EXPECT_EQ(std::count(names.begin(), names.end(), "contact transients"), 0);
    names = stagesOf(withTransients(spec));
    ASSERT_GE(names.size(), 5u);
    EXPECT_EQ(std::vector<std::string>(names.end() - 5, names.end()),
              (std::vector<std::string>{"contact transients", "contact shares", "sum of effects", "output delay",
                                        "output limits"}));
}

}  // namespace
}  // namespace passung
