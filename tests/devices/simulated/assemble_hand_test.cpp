#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <vector>

#include "core/loop/haptic_loop.h"
#include "core/scene/scene.h"
#include "devices/simulated/presets.h"
#include "devices/simulated/simulated_device.h"
#include "tests/support/length.h"
#include "tests/support/rt_guard.h"

// Simulated people who pick parts up and put them together, against the haptic cycle on a scene of its own.

namespace passung::simulated {
namespace {

using scene::AssemblyStep;

constexpr double kPlate = 0.02;          // [m] height of the plate, which stands on the table z = 0
constexpr double kPegLength = 0.04;      // [m]
constexpr double kDepth = 0.015;         // [m] that pegs go in
constexpr double kBlock = 0.015;         // [m]
constexpr double kTolerance = 3e-3;      // [m]
constexpr double kTurn = 0.0873;         // [rad], 5 degrees
constexpr std::int64_t kMost = 120'000;  // ticks

struct Trial {
    std::uint64_t seed = 1;
    std::size_t hands = 1;
    bool bores = true;
    bool on_press = false;
    const char* device = "virtuose6d";
    scene::Geometry geometry = scene::Geometry::ClosedForm;
    double scale = 1.0;                // of the registration
    double turn = 0.4;                 // [rad] of the block about z at its goal
    Vec3 shown_offset = Vec3::Zero();  // of the first peg
    bool guarded = false;
    double bore = kPlate, depth = kDepth;  // [m] of the bores, and how deep pegs go in
    double apart = 0.0;                    // [m] of the middles of two hands along x
    bool keyed = false;                    // the first peg has a key, and fits at one turn only
    double start_turn = 0.0;               // [rad] of that peg about its axis
    double drawn_turn = 0.0;               // [rad] of its goal as it is shown to the person
};

struct Outcome {
    bool finished = false;
    double time = 0.0;          // [s]
    bool picked_first = false;  // a hand has held the first peg
    std::vector<Pose> parts;    // where they lie at the end, as images told
    std::uint64_t hash = 0;
    std::uint64_t told = 0;  // steps that the image says are done
    std::int64_t violations = 0;
    int handed = 0;          // parts that one hand took from the other
    int taken = 0;           // how often a hand closed on the first peg
    double most_turn = 0.0;  // [rad] of the first hand's handle, from its posture at the start
    double left_turn = 0.0;  // [rad] of the first peg about its axis at the end
};

Pose at(double x, double y, double z) { return {Quat::Identity(), Vec3(x, y, z)}; }

/// A table, a plate with two bores beside each other (of two plates), two pegs that stand and a block that lies.
enum Part : std::size_t { kTable, kFirstPlate, kSecondPlate, kFirstPeg, kSecondPeg, kBlockPart };
constexpr double kLift = 2e-4;  // [m] what stands on the table is so far above it

scene::SceneSpec sceneOf(const Trial& trial) {
    scene::SceneSpec spec;
    const shape::Peg peg{0.010, kPegLength, 5e-4};
    const shape::Shape plate = trial.bores
                                   ? shape::Shape(shape::BorePlate{0.04, 0.04, kPlate, 0.0102, trial.bore, 1e-3})
                                   : shape::Shape(shape::Box{0.04, 0.04, kPlate});
    const double z = trial.bores ? kPlate : 0.5 * kPlate;
    spec.parts = {{.name = "table", .geometry = shape::Box{0.5, 0.5, 0.02}, .X_WP = at(0, 0, -0.01)},
                  {.name = "plate 1", .geometry = plate, .X_WP = at(0.0, -0.025, z)},
                  {.name = "plate 2", .geometry = plate, .X_WP = at(0.0, 0.025, z)},
                  {.name = "peg 1", .geometry = peg, .X_WP = at(-0.06, -0.03, kLift), .pickable = true},
                  {.name = "peg 2", .geometry = peg, .X_WP = at(-0.06, 0.03, kLift), .pickable = true},
                  {.name = "block",
                   .geometry = shape::Box{0.02, 0.03, kBlock},
                   .X_WP = at(-0.06, 0.0, 0.5 * kBlock + kLift),
                   .pickable = true}};
    spec.parts[kFirstPeg].shown_offset = trial.shown_offset;
    if (trial.keyed) {
        spec.parts[kFirstPlate].geometry =
            shape::KeyedBorePlate{0.04, 0.04, kPlate, 0.0102, 3.2e-3, 1.6e-3, trial.bore, 5e-4};
        spec.parts[kFirstPeg].geometry = shape::KeyedPeg{0.010, kPegLength, 3e-3, 1.5e-3, 5e-4};
        spec.parts[kFirstPeg].X_WP.q = rotationFromVector({0, 0, trial.start_turn});
    }
    spec.contact.method = scene::ContactMethod::GodObject;
    spec.contact.geometry = trial.geometry;
    spec.contact.stiffness = 1500.0;
    spec.contact.rotational_stiffness = 1.0;
    spec.contact.damping = 2.0;
    spec.limits.max_force = 20.0;
    spec.limits.max_torque = 1.0;
    spec.registration.X_WB.p = Vec3(0, 0, 0.06);
    spec.registration.scale = trial.scale;
    spec.start_gate = {.position_tolerance = 5e-3, .angle_tolerance = 0.2, .hold_ticks = 300, .X_WH = at(0, 0, 0.08)};
    spec.effects.pick = {.reach = 0.004, .button = 1, .on_press = trial.on_press};
    for (std::size_t i = 1; i < trial.hands; ++i) {
        scene::HandSpec hand{spec.limits, spec.registration, spec.start_gate, "hand 2", {}};
        hand.start_gate.X_WH.p += Vec3(0.5 * trial.apart, 0.05, 0.0);
        hand.registration.X_WB.p.x() += 0.5 * trial.apart;
        spec.other_hands.push_back(hand);
    }
    spec.registration.X_WB.p.x() -= 0.5 * trial.apart;
    spec.start_gate.X_WH.p.x() -= 0.5 * trial.apart;
    std::vector<AssemblyStep>& steps = spec.effects.pick.steps;
    steps.resize(3);
    steps[0] = {.part = kFirstPeg, .X_IGoal = at(0, -0.025, kPlate - trial.depth), .folds = 0};
    if (trial.keyed) steps[0].folds = 1;
    steps[1] = {.part = kBlockPart, .X_IGoal = at(0.05, 0.0, 0.5 * kBlock + kLift), .folds = 2};
    steps[1].X_IGoal.q = rotationFromVector({0, 0, trial.turn});
    steps[2] = {.part = kSecondPeg, .X_IGoal = at(0, 0.025, kPlate - trial.depth), .folds = 0, .after = 1};
    for (AssemblyStep& step : steps) {
        step.position_tolerance = kTolerance;
        step.angle_tolerance = kTurn;
    }
    return spec;
}

VisibleTask taskOf(const scene::SceneSpec& spec, const Trial& trial, std::size_t hand) {
    AssembleGoal goal;
    for (const scene::PartSpec& part : spec.parts)
        goal.parts.push_back(
            {.X_W = {part.X_WP.q, part.X_WP.p + part.shown_offset}, .shown_offset = part.shown_offset});
    goal.parts[kFirstPeg].grip = goal.parts[kSecondPeg].grip = Vec3(0.005, 0, 0.8 * kPegLength);
    goal.parts[kBlockPart].grip = Vec3(0, 0, 0.5 * kBlock);
    goal.parts[kBlockPart].below = 0.5 * kBlock;
    for (const AssemblyStep& step : spec.effects.pick.steps)
        goal.steps.push_back({.part = static_cast<std::int32_t>(step.part),
                              .X_IGoal = step.X_IGoal,
                              .folds = step.folds,
                              .insertion = step.part == kBlockPart ? 0.0 : trial.depth,
                              .after = step.after,
                              .hand = trial.hands == 1 || step.part == kFirstPeg ? std::size_t{0} : std::size_t{1}});
    goal.steps[0].X_IGoal.q = rotationFromVector({0, 0, trial.drawn_turn});
    for (std::size_t i = 0; i < trial.hands && trial.apart > 0.0; ++i)
        goal.reaches.push_back(
            {spec.hand(i).registration.X_WB.p, trial.scale * findPreset(trial.device)->workspace_radius.value});
    goal.hand = hand;
    goal.on_press = trial.on_press;
    VisibleTask task;
    task.X_WHeldStart = spec.hand(hand).start_gate.X_WH;
    task.goal = goal;
    return task;
}

/// The simulated device, whose pictures the test sees too; under the guard its read() may allocate nothing.
class Watched final : public loop::HapticDevice {
public:
    Watched(const Trial& trial, const scene::SceneSpec& spec, std::size_t hand)
        : trial_(trial),
          device_(*findPreset(trial.device), HandParams{}, taskOf(spec, trial, hand),
                  {spec.hand(hand).registration.X_WB, trial.scale, spec.registration.X_DH}, trial.seed + 1000 * hand) {}

    const DeviceDescription& description() const override { return device_.description(); }
    DeviceReading read() noexcept override {
        if (!trial_.guarded) return device_.read();
        support::RtGuard guard;
        DeviceReading reading = device_.read();
        violations += guard.violations();
        return reading;
    }
    void command(const Wrench& F_D_B) noexcept override { device_.command(F_D_B); }
    void show(const loop::DisplayedImage& shown) noexcept override {
        image = shown;
        device_.show(shown);
    }

    loop::DisplayedImage image;
    std::int64_t violations = 0;

private:
    const Trial& trial_;
    SimulatedDevice device_;
};

scene::Scene sceneBuilt(const scene::SceneSpec& spec) {
    static scene::PartCache cache;
    auto scene = scene::buildScene(spec, cache);
    if (!scene) ADD_FAILURE() << toString(scene.errors().front());
    return std::move(*scene);
}

/// Truth: the geometry of the task by hand: how far a part's origin is from its goal, and how its axis or sides lie.
bool isThere(const Trial& trial, const Outcome& outcome) {
    const auto near = [&](Part part, const Vec3& p) { return (outcome.parts[part].p - p).norm() <= kTolerance; };
    const auto tilt = [&](Part part) { return std::acos(std::min(1.0, (outcome.parts[part].q * Vec3::UnitZ()).z())); };
    const Vec3 side = outcome.parts[kBlockPart].q * Vec3::UnitX();
    const double turn = std::remainder(std::atan2(side.y(), side.x()) - trial.turn, std::numbers::pi);
    return near(kFirstPeg, {0, -0.025, kPlate - trial.depth}) && near(kSecondPeg, {0, 0.025, kPlate - trial.depth}) &&
           near(kBlockPart, {0.05, 0, 0.5 * kBlock + kLift}) && tilt(kFirstPeg) < kTurn && tilt(kSecondPeg) < kTurn &&
           tilt(kBlockPart) < kTurn && std::abs(turn) < kTurn;
}

Outcome run(const Trial& trial) {
    const scene::SceneSpec spec = sceneOf(trial);
    const scene::Scene scene = sceneBuilt(spec);
    const tick::SceneModels models(scene);
    std::vector<std::unique_ptr<Watched>> devices;
    std::vector<std::unique_ptr<loop::RecordRing>> rings;
    std::vector<loop::HandPort> ports;
    for (std::size_t i = 0; i < trial.hands; ++i) {
        devices.push_back(std::make_unique<Watched>(trial, spec, i));
        rings.push_back(std::make_unique<loop::RecordRing>(16));
        ports.push_back({devices.back().get(), rings.back().get()});
    }
    const std::array turns{tick::SceneTurn{&models[0]}};
    loop::HapticCycle cycle(turns, ports, true, {}, nullptr, false);
    Outcome outcome;
    for (const scene::PartSpec& part : spec.parts) outcome.parts.push_back(part.X_WP);
    std::int64_t since_done = 0;
    TickRecord first;
    bool held_before = false;
    std::int32_t handed = -1;
    Quat q_first = Quat::Identity();
    for (std::int64_t k = 0; k < kMost && since_done < 300; ++k) {
        cycle.run();
        const loop::DisplayedImage& image = devices.front()->image;
        if (image.at_rest.part >= 0) outcome.parts[static_cast<std::size_t>(image.at_rest.part)] = image.at_rest.X_WP;
        bool empty = true;
        for (std::size_t i = 0; i < trial.hands; ++i) {
            std::array<TickRecord, 16> records;
            rings[i]->take(records);
            if (i == 0) first = records[0];
            if (image.held[i] == static_cast<std::int32_t>(kFirstPeg)) outcome.picked_first = true;
            empty = empty && image.held[i] < 0;
            if (i > 0 && image.held[i] >= 0 && image.held[i] == image.held[0] && image.held[i] != handed) {
                handed = image.held[i];
                ++outcome.handed;
            }
        }
        const bool holds = first.held == static_cast<std::int32_t>(kFirstPeg);
        outcome.taken += holds && !held_before ? 1 : 0;
        held_before = holds;
        const auto& q = first.device_quaternion;
        if (k == 1000) q_first = Quat(q[0], q[1], q[2], q[3]);
        if (k > 1000)
            outcome.most_turn =
                std::max(outcome.most_turn, rotationVector(Quat(q[0], q[1], q[2], q[3]) * q_first.conjugate()).norm());
        outcome.told = image.steps_done;
        since_done = image.steps_done == 7 && empty ? since_done + 1 : 0;
        outcome.time = 1e-3 * static_cast<double>(k);
    }
    outcome.finished = since_done > 0 && isThere(trial, outcome);
    const Vec3 key = outcome.parts[kFirstPeg].q * Vec3::UnitX();
    outcome.left_turn = std::atan2(key.y(), key.x());
    outcome.hash = cycle.stateHash();
    for (const auto& device : devices) outcome.violations += device->violations;
    return outcome;
}

struct Way {
    const char* name;
    std::size_t hands;
    bool on_press;
    const char* device;
    scene::Geometry geometry;
    double scale = 1.0;
    double turn = 0.4;
};

class Assemblers : public testing::TestWithParam<Way> {};
INSTANTIATE_TEST_SUITE_P(AssembleHand, Assemblers,
                         testing::Values(Way{"one_hand", 1, false, "virtuose6d", scene::Geometry::ClosedForm},
                                         Way{"two_hands", 2, false, "virtuose6d", scene::Geometry::ClosedForm},
                                         Way{"by_presses_on_surfaces", 1, true, "whi", scene::Geometry::Surface},
                                         // A handle that cannot turn turns no block.
                                         Way{"without_turns", 1, false, "falcon", scene::Geometry::ClosedForm, 3.0,
                                             0.0}),
                         [](const auto& of) { return std::string(of.param.name); });

TEST_P(Assemblers, FinishAllStepsWithinTwoMinutes) {
    // Truth: isThere(), of the poses that parts are left at. PASSUNG_LONG=1: 20 seeds, else 6.
    const Way& way = GetParam();
    const int trials = test::atFullLength() ? 20 : 6;
    int finished = 0;
    std::vector<double> times;
    for (int seed = 1; seed <= trials; ++seed) {
        const Outcome outcome = run({.seed = static_cast<std::uint64_t>(seed),
                                     .hands = way.hands,
                                     .on_press = way.on_press,
                                     .device = way.device,
                                     .geometry = way.geometry,
                                     .scale = way.scale,
                                     .turn = way.turn});
        finished += outcome.finished ? 1 : 0;
        if (!outcome.finished) std::printf("seed %d told %d\n", seed, static_cast<int>(outcome.told));
        times.push_back(outcome.time);
    }
    std::ranges::sort(times);
    std::printf("%s: %d of %d, median %.1f s, longest %.1f s\n", way.name, finished, trials, times[times.size() / 2],
                times.back());
    EXPECT_GE(finished, trials - 1);
}

/// How many of the seeds finish with the keyed peg, whose key has to lie in its keyway, and how.
struct Keyed {
    int finished = 0, trials = 0, least_taken = 1000;
    double most_turn = 0.0;
};
Keyed runKeyed(double start_turn, double drawn_turn) {
    Keyed keyed;
    keyed.trials = test::atFullLength() ? 40 : 6;
    std::vector<double> times;
    for (int i = 0; i < keyed.trials; ++i) {
        const double way = i % 2 == 0 ? 1.0 : -1.0;
        const Outcome outcome = run({.seed = static_cast<std::uint64_t>(i + 1),
                                     .keyed = true,
                                     .start_turn = way * start_turn,
                                     .drawn_turn = way * drawn_turn});
        const bool in = outcome.finished && std::abs(outcome.left_turn) < kTurn;
        keyed.finished += in ? 1 : 0;
        keyed.least_taken = std::min(keyed.least_taken, outcome.taken);
        keyed.most_turn = std::max(keyed.most_turn, outcome.most_turn);
        times.push_back(outcome.time);
        if (!in) std::printf("seed %d told %d turn %.3f\n", i + 1, static_cast<int>(outcome.told), outcome.left_turn);
    }
    std::ranges::sort(times);
    std::printf("keyed, start %.2f, drawn %.2f: %d of %d, median %.1f s, taken %d times or more, turned by %.2f rad\n",
                start_turn, drawn_turn, keyed.finished, keyed.trials, times[times.size() / 2], keyed.least_taken,
                keyed.most_turn);
    return keyed;
}

TEST(AssembleHand, AKeyedPegGoesInWhoseGoalIsDrawnTurnedBy20Degrees) {
    // Truth: the geometry of the keyway: with 0.1 mm of play the key lies in it within 2 degrees or not at all.
    const Keyed keyed = runKeyed(0.0, 20.0 * std::numbers::pi / 180.0);
    EXPECT_GE(20 * keyed.finished, 19 * (keyed.trials - 1));
}

TEST(AssembleHand, WhatLiesTurnedFartherThanAWristReachesIsTakenAnew) {
    // Truth: the device's own readings: the handle never turns by much more than the range of 1.2 rad, so that a part
    // that lies turned by 2.1 rad cannot have come to its goal in one go; one that lies turned by 0.9 rad can.
    const Keyed far = runKeyed(2.1, 0.0), near = runKeyed(0.9, 0.0);
    EXPECT_GE(20 * far.finished, 19 * (far.trials - 1));
    EXPECT_GE(far.least_taken, 2);
    EXPECT_LT(far.most_turn, 1.4);
    EXPECT_EQ(near.least_taken, 1);
}

TEST(AssembleHand, WhatOneHandDoesNotReachTheOtherHandsOver) {
    // Truth: distances by hand. Balls of 75 mm about (-35, 0, 60) and (35, 0, 60) mm: the right hand does not get to
    // the second peg and the block at x = -60, nor the left one to the block's goal at x = 50.
    const int trials = test::atFullLength() ? 20 : 4;
    int finished = 0;
    for (int seed = 1; seed <= trials; ++seed) {
        const Outcome outcome =
            run({.seed = static_cast<std::uint64_t>(seed), .hands = 2, .device = "sigma7", .apart = 0.07});
        finished += outcome.finished && outcome.handed == 2 ? 1 : 0;
        std::printf("seed %d told %d handed %d %.1f s\n", seed, static_cast<int>(outcome.told), outcome.handed,
                    outcome.time);
    }
    EXPECT_GE(finished, trials - 1);
}

TEST(AssembleHand, SameSeedMovesTheSameBitForBitAndAnotherOneElse) {
    // Truth: invariant.
    const Outcome first = run({.seed = 5}), again = run({.seed = 5}), other = run({.seed = 6});
    EXPECT_EQ(first.hash, again.hash);
    EXPECT_EQ(first.time, again.time);
    EXPECT_NE(first.hash, other.hash);
}

TEST(AssembleHand, NobodyPushesOnTheGroundOfAShortBoreUntilTheEnd) {
    // Truth: isThere(). Bores of 5 mm: who looked at the mouth 1 mm too high believes the peg not to be in.
    // PASSUNG_LONG=1: 40 seeds, else 16.
    const int trials = test::atFullLength() ? 40 : 16;
    int finished = 0;
    for (int seed = 1; seed <= trials; ++seed) {
        const Outcome outcome = run({.seed = static_cast<std::uint64_t>(seed), .bore = 5e-3, .depth = 5e-3});
        finished += outcome.finished ? 1 : 0;
        if (!outcome.finished) std::printf("seed %d told %d\n", seed, static_cast<int>(outcome.told));
    }
    EXPECT_EQ(finished, trials);
}

TEST(AssembleHand, NobodyFinishesWithoutABore) {
    // Truth: there is no hole.
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const Outcome outcome = run({.seed = seed, .bores = false});
        EXPECT_FALSE(outcome.finished);
        EXPECT_EQ(outcome.told & 1u, 0u);
    }
}

TEST(AssembleHand, GoesWhereAPartIsSeenAndNotWhereItIs) {
    // Truth: the peg is drawn 15 mm from where it can be touched: farther than a hand reaches.
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Outcome outcome = run({.seed = seed, .shown_offset = Vec3(0, -0.015, 0)});
        EXPECT_FALSE(outcome.picked_first) << seed;
    }
}

TEST(AssembleHand, AllocatesNothingWhenItActs) {
    // Truth: the guard's count.
    if (!support::RtGuard::available()) GTEST_SKIP();
    const Outcome outcome = run({.seed = 2, .guarded = true});
    EXPECT_EQ(outcome.violations, 0);
}

}  // namespace
}  // namespace passung::simulated
