#include "core/scene/assembly.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/random.h"
#include "core/tick/step.h"
#include "core/tick/tick_state.h"
#include "tests/support/contact_way.h"
#include "tests/support/scenes.h"

// Steps of an assembly: when they are done, and what is taken back.

namespace passung {
namespace {

using scene::AssemblyStep;
using shape::Box;
using test::at;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr std::uint32_t kClose = 1u, kUndo = 2u;

Pose turned(const Vec3& v, const Vec3& p = Vec3::Zero()) { return {rotationFromVector(v), p}; }

TEST(Assembly, TurnsThatMakeNoDifferenceAreNoError) {
    // Truth: a turn about z by an angle a and a tilt by b apart from it: the angle between the axes is b; of n folds
    // what is left of a is a less the nearest multiple of a full turn over n, and of two turns about axes across each
    // other the angle is 2 acos(cos(a/2) cos(b/2)).
    Random random(7);
    for (int i = 0; i < 2000; ++i) {
        const double a = random.uniform(-0.5 * kTurn, 0.5 * kTurn), b = random.uniform(0.0, 1.0);
        const double across = random.uniform(0.0, kTurn);
        const int folds = static_cast<int>(random.below(9));
        const Pose goal{rotationFromVector({random.normal(), random.normal(), random.normal()}),
                        {random.normal(), random.normal(), random.normal()}};
        const Quat tilt = rotationFromVector(b * Vec3(std::cos(across), std::sin(across), 0.0));
        const Pose part = goal * Pose{tilt * rotationFromVector({0, 0, a}), {0.003, 0.004, 0.0}};
        const scene::GoalError error = scene::goalError(part, goal, folds);
        EXPECT_NEAR(error.position, 0.005, 1e-15);
        const double left = folds == 0 ? 0.0 : std::remainder(a, kTurn / folds);
        const double truth = 2.0 * std::acos(std::min(1.0, std::cos(0.5 * left) * std::cos(0.5 * b)));
        EXPECT_NEAR(error.angle, truth, 1e-7) << folds;
    }
}

TEST(Assembly, AStepComesAfterThoseThatItIsAfterAndCirclesAreFound) {
    // Truth: by hand.
    std::vector<AssemblyStep> steps(4);
    steps[0].after = scene::stepBit(2);
    steps[2].after = scene::stepBit(3);
    EXPECT_EQ(scene::orderOf(steps), (std::vector<std::size_t>{1, 3, 2, 0}));
    steps[3].after = scene::stepBit(0);
    EXPECT_EQ(scene::orderOf(steps), (std::vector<std::size_t>{1}));
}

/// Three cubes of 10 mm in the air, hands that hold nothing, the first button closes, the second takes back.
scene::SceneSpec cubes(std::size_t hands = 1) {
    scene::SceneSpec spec = test::scene(Box{1, 1, 1}, {}, Box{1, 1, 1}, {}, scene::ContactMethod::GodObject);
    spec.parts = {{.name = "table", .geometry = Box{0.4, 0.4, 0.02}, .X_WP = at(0, 0, -0.05)}};
    for (int i = 0; i < 3; ++i)
        spec.parts.push_back({.name = "cube " + std::to_string(i),
                              .geometry = Box{0.01, 0.01, 0.01},
                              .X_WP = at(0.05 * i, 0, 0),
                              .pickable = true});
    spec.effects.pick = {.reach = 0.004, .button = 1, .undo_button = 2};
    spec.contact.geometry = scene::Geometry::ClosedForm;
    for (std::size_t i = 1; i < hands; ++i)
        spec.other_hands.push_back({spec.limits, spec.registration, spec.start_gate, "hand " + std::to_string(i)});
    return spec;
}

AssemblyStep step(std::size_t part, const Pose& goal, scene::StepSet after = 0) {
    AssemblyStep made;
    made.part = part;
    made.X_IGoal = goal;
    made.after = after;
    return made;
}

class Person {
public:
    explicit Person(const scene::SceneSpec& spec)
        : bench_(spec), outputs_(spec.handCount()), readings_(spec.handCount()) {}

    /// The hand's point goes there in a few ticks with these buttons.
    void go(const Pose& X, std::uint32_t buttons, std::size_t hand = 0) {
        const Pose from = readings_[hand].X_BD;
        for (int i = 1; i <= 40; ++i) {
            const double share = i / 40.0;
            readings_[hand] = {.X_BD = {from.q.slerp(share, X.q), from.p + share * (X.p - from.p)}, .buttons = buttons};
            tick();
        }
    }
    void press(std::uint32_t buttons, std::size_t hand = 0) {
        readings_[hand].buttons = buttons;
        tick();
        tick();
    }
    /// Takes the part where it is and lets it go with its origin there.
    void carry(std::size_t part, const Pose& to, std::size_t hand = 0) {
        go(bench_.wholeState().X_WP[part], 0, hand);
        press(kClose, hand);
        go(to, kClose, hand);
        press(kClose, hand);
        press(0, hand);
    }
    scene::StepSet done() const { return outputs_.front().steps_done; }
    std::int32_t held(std::size_t hand = 0) const { return outputs_[hand].held; }
    tick::TickState& state() { return bench_.wholeState(); }

private:
    void tick() { tick::step(bench_.whole(), bench_.wholeState(), readings_, outputs_); }

    test::Bench bench_;
    std::vector<tick::TickOutput> outputs_;
    std::vector<DeviceReading> readings_;
};

TEST(Assembly, AStepIsDoneWhenItsPartIsLetGoWithinBothTolerancesOfItsGoal) {
    // Truth: closed form; nothing is touched, so the part is where the hand asks it to be, within what the record's
    // single precision rounds.
    for (const bool there : {false, true}) {
        auto spec = cubes();
        spec.effects.pick.steps = {step(1, at(0, 0.1, 0.05))};
        spec.effects.pick.steps[0].position_tolerance = 0.002;
        spec.effects.pick.steps[0].angle_tolerance = 0.05;
        for (const bool by_angle : {false, true}) {
            Person person(spec);
            const double share = there ? 0.999 : 1.001;
            const Pose to = by_angle ? turned({0.05 * share, 0, 0}, {0, 0.1, 0.05}) : at(0, 0.1, 0.05 + 0.002 * share);
            person.carry(1, to);
            EXPECT_EQ(person.done(), there ? 1u : 0u);
            person.press(kClose);
            EXPECT_EQ(person.held(), there ? -1 : 1) << "a step that is done locks its part";
        }
    }
}

TEST(Assembly, NothingIsDoneBeforeWhatItIsAfterAndAllThatWaitedIsDoneThen) {
    // Truth: the rule of pick.h.
    auto spec = cubes();
    const Pose first = at(0, 0.1, 0), second = at(0, 0.15, 0), third = at(0, 0.2, 0);
    spec.effects.pick.steps = {step(1, first), step(2, second, 1), step(3, third, 2)};
    Person person(spec);
    person.carry(3, third);
    EXPECT_EQ(person.done(), 0u);
    person.carry(2, second);
    EXPECT_EQ(person.done(), 0u);
    person.carry(1, first);
    EXPECT_EQ(person.done(), 7u);
}

TEST(Assembly, GoalsGoWithThePartThatTheyAreIn) {
    // Truth: the product of the two poses: of where the first part was laid, and of the goal in its frame.
    auto spec = cubes();
    spec.effects.pick.steps = {step(1, at(0, 0.1, 0)), step(2, at(0, 0, 0.02), 1)};
    spec.effects.pick.steps[0].position_tolerance = 0.02;
    spec.effects.pick.steps[0].angle_tolerance = 0.5;
    spec.effects.pick.steps[1].into = 1;
    const Pose off = turned({0.2, 0, 0}, {0.005, 0.11, 0.0});
    Person person(spec);
    person.carry(1, off);
    EXPECT_EQ(person.done(), 1u);
    person.carry(2, at(0, 0.1, 0.02));
    EXPECT_EQ(person.done(), 1u) << "there the goal would be if the first part lay where it was asked to be";
    person.carry(2, off * at(0, 0, 0.02));
    EXPECT_EQ(person.done(), 3u);
}

TEST(Assembly, TheUndoButtonTakesBackTheStepThatWasDoneLast) {
    // Truth: the rule of pick.h.
    auto spec = cubes();
    spec.effects.pick.steps = {step(1, at(0, 0.1, 0)), step(2, at(0, 0.15, 0))};
    Person person(spec);
    person.carry(2, at(0, 0.15, 0));
    person.carry(1, at(0, 0.1, 0));
    EXPECT_EQ(person.done(), 3u);
    person.press(kUndo);
    EXPECT_EQ(person.done(), 2u);
    person.press(kUndo);
    EXPECT_EQ(person.done(), 2u) << "held down it takes back no more";
    person.press(0);
    person.press(kClose);
    EXPECT_EQ(person.held(), 1) << "what was taken back can be taken";
    person.press(0);
    EXPECT_EQ(person.done(), 3u) << "and be done again where it lies";
    person.press(kUndo);
    person.press(0);
    person.press(kUndo);
    person.press(0);
    person.press(kUndo);
    EXPECT_EQ(person.done(), 0u);
}

TEST(Assembly, WhatDoesNotLockIsTakenOutAgainAndIsDoneNoMore) {
    // Truth: the rule of pick.h.
    auto spec = cubes(2);
    spec.effects.pick.steps = {step(1, at(0, 0.1, 0)), step(2, at(0, 0.15, 0), 1)};
    spec.effects.pick.steps[0].locks = false;
    Person person(spec);
    person.carry(1, at(0, 0.1, 0));
    EXPECT_EQ(person.done(), 1u);
    person.press(kClose);
    EXPECT_EQ(person.held(), 1);
    EXPECT_EQ(person.done(), 0u);
    person.carry(2, at(0, 0.15, 0), 1);
    EXPECT_EQ(person.done(), 0u);
    person.press(0);
    EXPECT_EQ(person.done(), 3u);
}

TEST(Assembly, WhatIsWrongWithAStepIsSaid) {
    // Truth: one rule broken at a time.
    const auto keyOf = [](auto change) {
        auto spec = cubes();
        auto& steps = spec.effects.pick.steps;
        steps = {step(1, at(0, 0.1, 0)), step(2, at(0, 0.15, 0), 1)};
        steps[1].into = 1;
        change(spec);
        const auto problems = scene::problemsOf(steps, spec);
        return problems.empty() ? std::string() : std::to_string(problems[0].step) + std::string(problems[0].key);
    };
    const auto ofStep = [&](auto change) { return keyOf([&](scene::SceneSpec& s) { change(s.effects.pick.steps); }); };
    using Steps = std::vector<AssemblyStep>;
    EXPECT_EQ(ofStep([](Steps&) {}), "");
    EXPECT_EQ(ofStep([](Steps& s) { s[0].part = 0; }), "0part");
    EXPECT_EQ(ofStep([](Steps& s) { s[0].part = 9; }), "0part");
    EXPECT_EQ(ofStep([](Steps& s) { s[1].part = 1; }), "1part");
    EXPECT_EQ(ofStep([](Steps& s) { s[1].into = 9; }), "1into");
    EXPECT_EQ(ofStep([](Steps& s) { s[1].into = 2; }), "1into");
    EXPECT_EQ(ofStep([](Steps& s) { s[1].into = 3; }), "1into");
    EXPECT_EQ(ofStep([](Steps& s) { s[1].after = 0; }), "1into");
    EXPECT_EQ(ofStep([](Steps& s) { s[0].locks = false; }), "1into");
    EXPECT_EQ(ofStep([](Steps& s) { s[0].after = 2; }), "0after");
    EXPECT_EQ(ofStep([](Steps& s) { s[0].after = 4; }), "0after");
    EXPECT_EQ(ofStep([](Steps& s) { s[0].position_tolerance = 0.0; }), "0position_tolerance");
    EXPECT_EQ(ofStep([](Steps& s) { s[0].angle_tolerance = std::nan(""); }), "0angle_tolerance");
    EXPECT_EQ(ofStep([](Steps& s) { s[0].folds = -1; }), "0folds");
    EXPECT_EQ(ofStep([](Steps& s) { s[0].X_IGoal = at(0, 0, 0); }), "0position");
    EXPECT_EQ(ofStep([](Steps& s) { s.resize(64, s[0]); }), "63part");
    EXPECT_EQ(keyOf([](scene::SceneSpec& s) { s.parts[1].pickable = false; }), "0part");
    auto spec = cubes();
    EXPECT_TRUE(spec.validate().empty());
    spec.effects.pick.steps = {step(0, at(0, 0, 0.1))};
    ASSERT_EQ(spec.validate().size(), 1u);
    EXPECT_EQ(spec.validate()[0].key, "effects: pick: step 1: part");
}

}  // namespace
}  // namespace passung
