#include "core/tick/weight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/scene/part_mass.h"
#include "core/tick/hand_state.h"
#include "tests/support/rt_guard.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

using enum scene::ContactMethod;
using scene::ContactMethod;
using scene::Geometry;
using scene::PenaltyCoupling;

constexpr double kStiffness = 1000.0;   // [N/m]
constexpr double kTurnStiffness = 2.0;  // [N·m/rad]
constexpr double kSteel = 7850.0;       // [kg/m³]
const Vec3 kDown(0.0, 0.0, -scene::kStandardGravity);

/// How contact is computed in a test.
struct Way {
    const char* name;
    ContactMethod method;
    Geometry geometry;
    PenaltyCoupling coupling = PenaltyCoupling::Direct;
    double overlap = 0.0;  // or gap, in which it leaves a part that lies, at most [m]
};
void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }

constexpr Way kClosedForm{"closed_form", GodObject, Geometry::ClosedForm, PenaltyCoupling::Direct, 1e-7};
constexpr Way kWays[] = {
    kClosedForm,
    {"closed_form_heuristic", GodObjectHeuristic, Geometry::ClosedForm, PenaltyCoupling::Direct, 1e-7},
    {"surface", GodObject, Geometry::Surface, PenaltyCoupling::Direct, 1.1e-6},
    {"surface_heuristic", GodObjectHeuristic, Geometry::Surface, PenaltyCoupling::Direct, 1.1e-6},
    {"field", GodObject, Geometry::Field, PenaltyCoupling::Direct, 3e-6},
    {"field_heuristic", GodObjectHeuristic, Geometry::Field, PenaltyCoupling::Direct, 6e-6},
};
/// With those that have no proxy, or a tool.
std::vector<Way> allWays() {
    std::vector<Way> ways(std::begin(kWays), std::end(kWays));
    ways.push_back({"penalty", Penalty, Geometry::Field});
    ways.push_back({"quasi_static", Penalty, Geometry::Field, PenaltyCoupling::QuasiStatic});
    ways.push_back({"virtual", Penalty, Geometry::Field, PenaltyCoupling::Virtual});
    return ways;
}

scene::SceneSpec weighed(scene::SceneSpec spec, const Way& way) {
    spec.contact.geometry = way.geometry;
    spec.contact.coupling = way.coupling;
    spec.contact.stiffness = kStiffness;
    spec.contact.rotational_stiffness = kTurnStiffness;
    spec.contact.damping = 2.0;
    spec.contact.rotational_damping = 1e-2;
    spec.limits.max_speed = 1e4;
    spec.limits.max_spin = 1e4;
    spec.effects.weight.gravity = kDown;
    for (auto& part : spec.parts) part.density = kSteel;
    return spec;
}

/// A peg, whose origin is at its tip, far above a plate.
scene::SceneSpec pegInTheAir(const Way& way) {
    return weighed(test::scene(shape::Peg{0.02, 0.05, 0.002}, {Quat::Identity(), Vec3(0, 0, 0.3)},
                               shape::Box{0.06, 0.06, 0.01}, Pose{}, way.method),
                   way);
}

/// A cube on a plate whose top is z = 0: at its centre's height kHalf it lies.
constexpr double kHalf = 0.01;
scene::SceneSpec cubeOnATable(const Way& way) {
    return weighed(test::scene(shape::Box{0.02, 0.02, 0.02}, {Quat::Identity(), Vec3(0, 0, kHalf + 0.01)},
                               shape::Box{0.06, 0.06, 0.02}, {Quat::Identity(), Vec3(0, 0, -0.01)}, way.method),
                   way);
}
constexpr double kCubeWeight = kSteel * 8e-6 * scene::kStandardGravity;  // [N]

Pose at(double z) { return {Quat::Identity(), Vec3(0, 0, z)}; }

Quat anyRotation(Random& random) {
    return Quat(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
}

class WeightOf : public testing::TestWithParam<Way> {};
class WeightOfLying : public testing::TestWithParam<Way> {};

TEST_P(WeightOf, APartInTheAirIsItsMassTimesGravityAtEveryOrientation) {
    // Truth: closed form. m g, and (R c) × m g, of the peg's own volume and centre; asked for is 0.1 %. The damper sees
    // a part that hangs still, so that the last tick of each orientation is without it.
    const auto spec = pegInTheAir(GetParam());
    test::Bench bench(spec);
    const auto mass = scene::massOf(std::get<shape::Shape>(spec.parts[0].geometry), kSteel);
    ASSERT_GT(mass->mass * mass->centre.z() * scene::kStandardGravity, 0.01);
    Random random(5);
    double force_off = 0.0, torque_off = 0.0;
    const bool swings = GetParam().coupling == PenaltyCoupling::Virtual;  // its tool has a mass, which comes to rest
    Pose last = at(0.3);
    for (int i = 0; i < 200; ++i) {
        const Pose X{anyRotation(random), Vec3(0.01 * random.normal(), 0.01 * random.normal(), 0.3)};
        tick::TickOutput out;
        for (int k = 1; k <= 40; ++k)
            out = bench.step(Pose{last.q.slerp(k / 40.0, X.q), last.p + k / 40.0 * (X.p - last.p)});
        for (int k = 0; k < (swings ? 1500 : 10); ++k) out = bench.step(X);
        last = X;
        const Vec3 force = mass->mass * kDown, torque = (X.q * mass->centre).cross(force);
        force_off = std::max(force_off, (out.frame.F_H_W.force - force).norm() / force.norm());
        torque_off =
            std::max(torque_off, (out.frame.F_H_W.torque - torque).norm() / (mass->centre.norm() * force.norm()));
        // Limit case of the header: a spring from the proxy to the hand.
        if (!bench.model().hasProxy()) continue;
        const Vec3 turned = rotationVector(out.X_WG.q * X.q.conjugate());
        EXPECT_LT((kStiffness * (out.X_WG.p - X.p) - out.frame.F_H_W.force).norm(), 1e-6 * force.norm());
        EXPECT_LT((kTurnStiffness * turned - out.frame.F_H_W.torque).norm(), 1e-6 * force.norm() * 0.02);
    }
    // A tool with mass rests where less than kSettled of its equation is open: K D kSettled = 0.5 mN.
    EXPECT_LT(force_off, swings ? 1e-3 : 1e-6) << GetParam().name;
    EXPECT_LT(torque_off, 1e-6) << GetParam().name;
    std::printf("%-24s force within %.4f %%, torque within %.4f %% at 200 orientations\n", GetParam().name,
                100.0 * force_off, 100.0 * torque_off);
}

TEST_P(WeightOfLying, APartOnATableIsNoneOnceTheHandIsDown) {
    // Truth: closed form. The hand h above where it would hold the lying cube feels all of the weight for h ≥ f/K, K h
    // between, 0 at h = 0, and below that the contact -K h. Tolerance: K times the overlap or gap that contact leaves.
    const Way& way = GetParam();
    test::Bench bench(cubeOnATable(way));
    const double hang = kCubeWeight / kStiffness, slack = kStiffness * way.overlap;
    double before = -kCubeWeight - slack;
    constexpr int kSteps = 60;
    for (int i = -10; i <= kSteps; ++i) {
        const double h = hang * (1.0 - 2.0 * static_cast<double>(i) / kSteps);  // down to -f/K
        tick::TickOutput out;
        for (int k = 0; k < 10; ++k) out = bench.step(at(kHalf + h));
        const double force = out.frame.F_H_W.force.z();
        EXPECT_NEAR(force, h > hang ? -kCubeWeight : -kStiffness * h, slack) << h;  // i ≤ 0: all of it
        EXPECT_GE(force, before - 1e-9) << h;
        EXPECT_LT(out.frame.F_H_W.force.head<2>().norm(), slack);
        EXPECT_LT(out.frame.F_H_W.torque.norm(), kTurnStiffness * way.overlap / kHalf);
        before = force;
    }
}

TEST_P(WeightOfLying, APartThatIsPressedDownIsNotAddedToTheContact) {
    // Truth: closed form. 3 mm below the table the hand feels K · 3 mm, as without weight.
    const Way& way = GetParam();
    auto light = cubeOnATable(way);
    light.effects.weight = {};
    test::Bench with(cubeOnATable(way)), without(light);
    Vec3 heavy, none;
    for (int i = 0; i < 200; ++i) {
        const Pose X = at(kHalf + 0.002 - 2.5e-5 * i);
        heavy = with.step(X).frame.F_H_W.force;
        none = without.step(X).frame.F_H_W.force;
    }
    EXPECT_LT((heavy - none).norm(), 2.0 * kStiffness * way.overlap + 1e-9);
    EXPECT_NEAR(none.z(), kStiffness * (2.5e-5 * 199 - 0.002), 0.2);
}

INSTANTIATE_TEST_SUITE_P(Proxies, WeightOfLying, testing::ValuesIn(kWays),
                         [](const auto& way) { return std::string(way.param.name); });
INSTANTIATE_TEST_SUITE_P(Ways, WeightOf, testing::ValuesIn(allWays()),
                         [](const auto& way) { return std::string(way.param.name); });

TEST(Weight, OfAPartThatSinksIsCarriedByTheContactsSpringsWithoutAProxy) {
    // Truth: closed form. Penalty at the hand: f - K d, d the depth (max_normalised), so that f/K of it carry the part.
    const Way way{"penalty", Penalty, Geometry::Field};
    auto spec = cubeOnATable(way);
    spec.contact.damping = 0.0;
    test::Bench bench(spec);
    for (const double d : {-1e-3, 0.2e-3, kCubeWeight / kStiffness, 1e-3}) {
        const Wrench F = bench.step(at(kHalf - d)).frame.F_H_W;
        EXPECT_NEAR(F.force.z(), kStiffness * std::max(0.0, d) - kCubeWeight, 0.01 * kCubeWeight) << d;
    }
}

TEST(Weight, OfAToolIsSharedBetweenTheHandAndTheContactsSprings) {
    // Truth: closed form. A tool d deep, the hand h above where it would hold the lying cube: K (h + d) - f + k d = 0,
    // k the contacts' stiffness, and the hand feels -K (h + d) = -K (f + k h)/(K + k). Held flat by max_normalised.
    auto spec = cubeOnATable({"quasi_static", Penalty, Geometry::Field, PenaltyCoupling::QuasiStatic});
    const double k = spec.contact.penalty_stiffness, hang = kCubeWeight / kStiffness;
    test::Bench bench(spec);
    for (const double h : {2.0 * hang, 0.5 * hang, 0.0, -kCubeWeight / k, -hang}) {
        Wrench F;
        for (int i = 0; i < 100; ++i) F = bench.step(at(kHalf + h)).frame.F_H_W;
        const double truth = h > hang ? -kCubeWeight : -kStiffness * (kCubeWeight + k * h) / (kStiffness + k);
        EXPECT_NEAR(F.force.z(), truth, 0.01 * kCubeWeight) << h;
    }
}

TEST(Weight, OfALyingPegIsNeitherForceNorTorque) {
    // Truth: closed form. A peg on its side, its origin at one end: in the air its centre turns the hand, lying it does
    // not.
    const Quat lying(Eigen::AngleAxisd(0.5 * 3.14159265358979, Vec3::UnitY()));
    auto spec = weighed(test::scene(shape::Peg{0.02, 0.05, 0.0}, {lying, Vec3(-0.025, 0, 0.03)},
                                    shape::Box{0.1, 0.06, 0.02}, at(-0.01), GodObject),
                        kClosedForm);
    test::Bench bench(spec);
    const double weight = kSteel * 3.14159265358979 * 1e-4 * 0.05 * scene::kStandardGravity;
    Wrench F;
    for (int i = 0; i < 50; ++i) F = bench.step(Pose{lying, Vec3(-0.025, 0, 0.03)}).frame.F_H_W;
    EXPECT_NEAR(F.torque.y(), 0.025 * weight, 1e-6 * weight);
    for (int i = 0; i < 400; ++i) F = bench.step(Pose{lying, Vec3(-0.025, 0, 0.03 - 5e-5 * i)}).frame.F_H_W;
    for (int i = 0; i < 50; ++i) F = bench.step(Pose{lying, Vec3(-0.025, 0, 0.01)}).frame.F_H_W;
    EXPECT_LT(F.force.norm(), 1e-3 * weight);
    EXPECT_LT(F.torque.norm(), 1e-3 * 0.025 * weight);
}

TEST(Weight, TurnsNothingWhereTheCouplingHasNoRotationalStiffness) {
    // Truth: closed form (limit case of the header).
    auto spec = pegInTheAir(kClosedForm);
    spec.contact.rotational_stiffness = 0.0;
    test::Bench bench(spec);
    const Pose X{rotationFromVector(Vec3(1.0, 0.5, 0)), Vec3(0, 0, 0.3)};
    tick::TickOutput out;
    for (int i = 0; i < 20; ++i) out = bench.step(X);
    EXPECT_EQ(out.frame.F_H_W.torque.norm(), 0.0);
    EXPECT_LT(rotationVector(out.X_WG.q * X.q.conjugate()).norm(), 1e-9);
    EXPECT_NEAR(out.frame.F_H_W.force.z(), bench.model().weight.z(), 1e-9);
}

TEST(Weight, IsFeltWithoutAnObstacle) {
    // Truth: closed form. No contact, no proxy.
    auto spec = pegInTheAir(kClosedForm);
    spec.parts.resize(1);
    test::Bench bench(spec);
    const Wrench F = bench.step(Pose{rotationFromVector(Vec3(1.0, 0.5, 0)), Vec3(0, 0, 0.3)}).frame.F_H_W;
    const Vec3 arm = rotationFromVector(Vec3(1.0, 0.5, 0)) * bench.model().centre;
    EXPECT_LT((F.force - bench.model().weight).norm(), 1e-12);
    EXPECT_LT((F.torque - arm.cross(bench.model().weight)).norm(), 1e-12);
}

TEST(Weight, LeavesEveryBitOfAPartWithoutDensityOrGravityAlone) {
    // Truth: invariant. The stages and the hash of all outputs of a hand that presses, slides and turns.
    for (const Way& way : allWays()) {
        const auto run = [&](double density, const Vec3& gravity) {
            auto spec = cubeOnATable(way);
            spec.effects.weight.gravity = gravity;
            for (auto& part : spec.parts) part.density = density;
            test::Bench bench(spec);
            for (const tick::Stage& stage : bench.model().stages)
                EXPECT_EQ(std::string(stage.name).find("weight"), std::string::npos);
            for (int i = 0; i < 600; ++i) {
                const double t = 1e-3 * i;
                bench.step(
                    Pose{rotationFromVector(0.1 * Vec3(std::sin(9 * t), std::cos(7 * t), std::sin(5 * t))),
                         Vec3(0.004 * std::sin(11 * t), 0.004 * std::sin(6 * t), kHalf + 0.002 * std::cos(17 * t))});
            }
            return bench.wholeState().hash;
        };
        const std::uint64_t none = run(0.0, Vec3::Zero());
        EXPECT_EQ(run(0.0, kDown), none) << way.name;
        EXPECT_EQ(run(kSteel, Vec3::Zero()), none) << way.name;
    }
}

TEST(Weight, DoesNotSinkWhileTheDeviceIsSilent) {
    // Truth: invariant. Until a sample comes the hand is where the proxy is: a proxy that hung from it would fall.
    for (const Way& way : allWays()) {
        test::Bench bench(pegInTheAir(way));
        DeviceReading silent;
        silent.fresh = false;
        for (int i = 0; i < 300; ++i) {
            const tick::TickOutput out = bench.step(silent);
            EXPECT_EQ(out.X_WG.p.z(), 0.3) << way.name;
            EXPECT_EQ(out.F_D_B.force.norm(), 0.0);
        }
    }
}

/// Off the handle's origin, scaled, in a base that is turned, with encoder steps.
scene::SceneSpec elsewhere(scene::SceneSpec spec) {
    spec.registration.X_WB = {Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())), {0.1, -0.2, 0.3}};
    spec.registration.scale = 2.0;
    spec.registration.X_DH = {Quat(Eigen::AngleAxisd(-0.4, Vec3(0, 1, 1).normalized())), {0.01, 0.02, -0.03}};
    spec.limits.quantum = 1e-5;
    spec.limits.rotational_quantum = 1e-4;
    return spec;
}

/// The device reading that puts the held part there.
Pose deviceAt(const scene::SceneSpec& spec, const Pose& X_WH) {
    Pose X = spec.registration.X_WB.inverse() * X_WH * spec.registration.X_DH.inverse();
    X.p /= spec.registration.scale;
    return X;
}

TEST(Weight, IsNoEnergyThatTheControllerTakesInOrGives) {
    // Truth: closed form. What lifting takes comes back: 0 throughout. Held for a tick, the torque τ of a part that
    // turns by ω gives out ½ |τ| ω² T a second; encoder steps add their own |f| q, |τ| q_φ.
    for (const Way& way : allWays()) {
        for (const bool moved : {false, true}) {
            auto spec = pegInTheAir(way);
            if (moved) spec = elsewhere(spec);
            test::Bench bench(spec);
            const double f = bench.model().weight.norm(), arm = bench.model().centre.norm() + 0.04;
            double least = 0.0, most = 0.0;
            constexpr int kTicks = 4000;
            constexpr double kSpin = 3.0;
            for (int i = 0; i < kTicks; ++i) {
                const double t = 1e-3 * i;
                const Pose X{rotationFromVector(Vec3(std::sin(kSpin * t), 0.5 * std::sin(kSpin * t), 0)),
                             Vec3(0.02 * std::sin(5 * t), 0, 0.3 + 0.1 * std::sin(4 * t))};
                const double energy = bench.step(deviceAt(spec, X)).frame.energy;
                least = std::min(least, energy);
                most = std::max(most, energy);
            }
            // Damper and tool move with the turning hand; the virtual tool has a mass that is swung, at half a metre a
            // second.
            const bool swings = way.coupling == PenaltyCoupling::Virtual;
            const double held = 0.5 * f * arm * (kSpin * kSpin * 1.25) * 1e-3 * 1e-3 * kTicks;
            const double steps = moved ? 2.0 * f * (1e-5 + arm * 1e-4) : 0.0;
            EXPECT_GT(least, -held - steps - 1e-6 - (swings ? 2e-3 : 0.0)) << way.name << moved;
            EXPECT_LT(most, held + steps + 1e-6 + (swings ? 2e-2 : 0.0)) << way.name << moved;
            EXPECT_GT(f * 0.1, 50.0 * (held + steps));  // what was lifted
        }
    }
}

TEST(Weight, IsLeftOutOfTheAccountOnlyWhereItIsSent) {
    // Truth: closed form. Nothing displayed → nothing taken in. Half of it cut by the device's limit → lifting takes in
    // half of it less than lowering is due: -f/2 per height, and 0 again down. A delay changes nothing in the end.
    const auto lift = [](const scene::SceneSpec& spec, double& up) {
        test::Bench bench(spec);
        double energy = 0.0;
        for (int i = 0; i <= 2400; ++i) {
            const double h = 1e-4 * std::clamp(std::min(i - 200, 2200 - i), 0, 1000);
            energy = bench.step(Pose{Quat::Identity(), Vec3(0, 0, 0.2 + h)}).frame.energy;
            if (i == 1200) up = energy;
        }
        return energy;
    };
    auto spec = pegInTheAir(kClosedForm);
    const double f = test::Bench(spec).model().weight.norm();
    double up = 0.0;
    EXPECT_NEAR(lift(spec, up), 0.0, 1e-9);
    EXPECT_NEAR(up, 0.0, 1e-9);
    auto dark = spec;
    dark.display_wrench = false;
    EXPECT_EQ(lift(dark, up), 0.0);
    EXPECT_EQ(up, 0.0);
    auto late = spec;
    late.limits.delay_ticks = 20;
    EXPECT_NEAR(lift(late, up), 0.0, 1e-9);
    auto weak = spec;
    weak.limits.max_force = 0.5 * f;
    EXPECT_NEAR(lift(weak, up), 0.0, 1e-9);
    EXPECT_NEAR(up, -0.5 * f * 0.1, 1e-6 * f);
}

TEST(Weight, OfAPartThatIsPutDownAndTakenUpGivesOutNoEnergy) {
    // Truth: invariant. Down on the table, pressed, dragged, up again, for each way: what comes out of the springs went
    // in. Held for a tick, the spring K gives out K δ² a step δ: K v² T a second while it is stretched.
    for (const Way& way : kWays) {
        auto spec = cubeOnATable(way);
        spec.contact.damping = spec.contact.rotational_damping = 0.0;
        test::Bench bench(spec);
        double energy = 0.0, least = 0.0;
        for (int i = 0; i < 6000; ++i) {
            const double t = 1e-3 * i;
            const tick::TickOutput out = bench.step(
                Pose{Quat::Identity(), Vec3(0.005 * std::sin(3 * t), 0, kHalf + 0.001 + 0.003 * std::cos(4 * t))});
            energy = out.frame.energy;
            least = std::min(least, energy);
        }
        constexpr double kSpeed = 0.012;
        EXPECT_GT(least, -kStiffness * kSpeed * kSpeed * 1e-3 * 6.0 - 20.0 * kStiffness * way.overlap * way.overlap)
            << way.name;
    }
}

TEST(Weight, IsNoObstaclesShareOfTheEnergy) {
    // Truth: invariant. A cube that is pressed against a wall and lifted along it: the wall takes what it took of one
    // without weight, and all accounts add up to the whole.
    const auto run = [](bool weighs) {
        auto spec = weighed(test::scene(shape::Box{0.02, 0.02, 0.02}, at(0), shape::Box{0.02, 0.2, 0.4},
                                        Pose{Quat::Identity(), Vec3(0.025, 0, 0)}, GodObject),
                            kClosedForm);
        if (!weighs) spec.effects.weight = {};
        test::Bench bench(spec);
        double energy = 0.0;
        for (int i = 0; i < 1000; ++i)
            energy = bench.step(Pose{Quat::Identity(), Vec3(std::min(1e-5 * i, 6e-3), 0, 5e-5 * i)}).frame.energy;
        const auto& pairs = bench.state().pairs;
        EXPECT_NEAR(pairs[1].taken_in + pairs[2].taken_in, energy, 1e-9);
        return pairs[1].taken_in;
    };
    const double without = run(false);
    EXPECT_GT(without, 1e-4);
    EXPECT_NEAR(run(true), without, 1e-7);
}

TEST(Weight, RingsAtAnImpactAsAPartWithoutWeight) {
    // Truth: invariant. A cube that is shaken in the air rings not at all, and where it lands by the speed of the
    // landing, although what the hand feels still pulls it down. Speed and amplitude are those of the light one, whose
    // hand is f/K lower.
    const auto largest = [](const Vec3& gravity, double high) {
        auto spec = cubeOnATable(kClosedForm);
        spec.contact.damping = 0.0;
        spec.effects.weight.gravity = gravity;
        test::Bench plain(spec);
        spec.effects.transients = {.amplitude = 20.0, .frequency = 150.0, .decay = 0.05};
        test::Bench ringing(spec);
        double most = 0.0;
        for (int i = 0; i < 400; ++i) {
            const double h = i < 200 ? high + 0.004 * std::sin(0.05 * i) : high - 5e-5 * (i - 200);
            const double added =
                (ringing.step(at(kHalf + h)).frame.F_H_W.force - plain.step(at(kHalf + h)).frame.F_H_W.force).norm();
            if (i < 200) {
                EXPECT_EQ(added, 0.0);
            }
            most = std::max(most, added);
        }
        return most;
    };
    const double light = largest(Vec3::Zero(), 0.0075);
    EXPECT_GT(light, 0.5);
    EXPECT_NEAR(largest(kDown, 0.0075), light, 0.01 * light);
}

TEST(Weight, OfAPartThatLiesOnAnothersHandIsFeltThere) {
    // Truth: closed form. A cube in one hand is let down on a plate in the other: the sum of both wrenches is the
    // weight of both throughout, and at last the other hand has all of it.
    for (const Way& way : {kWays[0], kWays[2], kWays[4]}) {
        auto spec = cubeOnATable(way);
        spec.contact.damping = 0.0;
        spec.parts[1].held = true;
        spec.parts[1].hand = 1;
        spec.other_hands.push_back({spec.limits, spec.registration, spec.start_gate});
        test::Bench bench(spec);
        std::vector<tick::TickOutput> outputs(2);
        std::vector<DeviceReading> readings(2);
        const double plate = kSteel * 0.06 * 0.06 * 0.02 * scene::kStandardGravity, both = kCubeWeight + plate;
        const double hang = both / kStiffness;  // of the plate, with the cube on it
        for (int i = 0; i < 2000; ++i) {
            readings[0] = DeviceReading{at(kHalf + 0.01 - std::min(1e-5 * i, 0.01 + hang))};
            readings[1] = DeviceReading{at(-0.01)};
            tick::step(bench.whole(), bench.wholeState(), readings, outputs);
            if (i % 100 != 99) continue;
            const Vec3 sum = outputs[0].frame.F_H_W.force + outputs[1].frame.F_H_W.force;
            EXPECT_NEAR(sum.z(), -both, 1e-3 * both + 2.0 * kStiffness * way.overlap) << way.name << " " << i;
        }
        EXPECT_NEAR(outputs[0].frame.F_H_W.force.z(), 0.0, 1e-3 * both + 2.0 * kStiffness * way.overlap) << way.name;
        EXPECT_NEAR(outputs[1].frame.F_H_W.force.z(), -both, 1e-3 * both + 2.0 * kStiffness * way.overlap) << way.name;
    }
}

TEST(Weight, IsRenderedInRealTime) {
    // Truth: invariant.
    if (!support::RtGuard::available()) GTEST_SKIP();
    for (const Way& way : allWays()) {
        test::Bench bench(cubeOnATable(way));
        for (int i = 0; i < 50; ++i) bench.step(at(kHalf + 0.01));
        const support::RtGuard guard;
        for (int i = 0; i < 1000; ++i) bench.step(at(kHalf + 0.01 * std::cos(0.01 * i)));
        EXPECT_EQ(guard.violations(), 0) << way.name << guard.describe();
    }
}

}  // namespace
}  // namespace passung
