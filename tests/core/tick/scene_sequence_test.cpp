#include "core/tick/scene_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/replay/replayer.h"
#include "tests/support/rt_guard.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

constexpr int kHold = 5;  // ticks that the start gate asks for

/// A ball pressed 2 mm into a table by penalty, behind a start gate that lets the pressed pose count.
scene::SceneSpec pressed(double stiffness) {
    auto spec = test::scene(shape::Sphere{0.02}, {Quat::Identity(), Vec3(0, 0, 0.012)}, shape::Box{0.06, 0.06, 0.02},
                            {Quat::Identity(), Vec3(0, 0, -0.01)}, scene::ContactMethod::Penalty);
    spec.contact.cell = 1e-3;
    spec.contact.stiffness = stiffness;
    spec.start_gate = {0.01, 1.0, kHold};
    return spec;
}
const Pose kPressed{Quat::Identity(), Vec3(0, 0, 0.008)};

TEST(SceneSequence, RendersEachSceneForItsPeriodsAndClosesTheGateBetween) {
    // Truth: closed form. The gate opens at the sixth tick of a turn (more than 5 held); 10 periods later the next
    // scene takes over; a missed cycle counts. The same depth at twice the stiffness is twice the force.
    const test::Bench soft(pressed(500.0)), hard(pressed(1000.0));
    tick::SceneSequence scenes(std::array{tick::SceneTurn{&soft.whole(), 10}, tick::SceneTurn{&hard.whole()}});
    std::vector<double> force;
    std::vector<bool> engaged;
    for (int k = 0; k < 40; ++k) {
        EXPECT_EQ(scenes.tick(), k);
        DeviceReading reading{kPressed};
        if (k == 8) reading.periods = 3;  // two missed cycles: the turn ends two ticks sooner
        const auto output = scenes.step(reading);
        force.push_back(output.F_D_B.force.z());
        engaged.push_back((output.frame.status & kEngaged) != 0);
    }
    for (std::size_t k = 0; k < 40; ++k) {
        const bool first = k >= 5 && k < 13, second = k >= 18;
        EXPECT_EQ(engaged[k], first || second) << k;
        EXPECT_TRUE(first || second || force[k] == 0.0) << k;
    }
    EXPECT_GT(force[12], 0.5);
    EXPECT_NEAR(force[39], 2.0 * force[12], 1e-9 * force[39]);
}

TEST(SceneSequence, TheLastSceneStays) {
    // Truth: invariant
    const test::Bench soft(pressed(500.0));
    tick::SceneSequence scenes(std::array{tick::SceneTurn{&soft.whole(), 10}});
    for (int k = 0; k < 100; ++k) scenes.step({kPressed});
    EXPECT_NE(scenes.step({kPressed}).frame.status & kEngaged, 0u);
}

TEST(SceneSequence, OneSceneIsTheTickItself) {
    // Truth: invariant: the bits of step() and of its hash
    test::Bench bench(pressed(500.0));
    tick::SceneSequence scenes(std::array{tick::SceneTurn{&bench.whole()}});
    for (int k = 0; k < 50; ++k) EXPECT_EQ(scenes.step({kPressed}).F_D_B.force, bench.step(kPressed).F_D_B.force);
    EXPECT_EQ(scenes.hash(), bench.wholeState().hash);
    EXPECT_EQ(scenes.tick(), bench.wholeState().tick);
}

TEST(SceneModels, StayWhereTheyAreAndAreThoseOfTheirScenes) {
    // Truth: invariant: the bits of a tick do not depend on who keeps its model, nor on the whole being moved.
    test::Bench soft(pressed(500.0)), hard(pressed(1000.0));
    tick::SceneModels built(std::array{soft.scene(), hard.scene()});
    const tick::TickModel* second = &built[1];
    const tick::SceneModels models = std::move(built);
    ASSERT_EQ(models.size(), 2u);
    EXPECT_EQ(second, &models[1]);
    ASSERT_EQ(models.stages(1).size(), hard.model().stages.size());
    for (std::size_t i = 0; i < models.stages(1).size(); ++i)
        EXPECT_STREQ(models.stages(1)[i].name, hard.model().stages[i].name);
    tick::SceneSequence scenes(std::array{tick::SceneTurn{&models[1]}});
    for (int k = 0; k < 50; ++k) EXPECT_EQ(scenes.step({kPressed}).F_D_B.force, hard.step(kPressed).F_D_B.force);
}

TEST(SceneModels, TellWhatASceneDoesWithoutAndWhy) {
    // Truth: table: an effect is among the stages when the scene names it, else among those that it does without; no
    // stage is in both.
    const auto has = [](const auto& list, std::string_view name) {
        return std::any_of(list.begin(), list.end(), [&](const auto& stage) { return stage.name == name; });
    };
    scene::SceneSpec plain = pressed(500.0), loud = pressed(500.0);
    loud.effects.transients.amplitude = 1.0;
    const test::Bench without(plain), with(loud);
    for (const bool named : {false, true}) {
        const tick::SceneModels models(named ? with.scene() : without.scene());
        const auto stages = models.stages(0);
        const auto spared = models.spared(0);
        EXPECT_EQ(has(stages, "contact transients"), named);
        EXPECT_EQ(has(spared, "contact transients"), !named);
        EXPECT_GT(spared.size(), 5u);
        for (const tick::SparedStage& stage : spared) {
            EXPECT_FALSE(has(stages, stage.name)) << stage.name;
            EXPECT_NE(std::string(stage.reason), "") << stage.name;
        }
    }
}

TEST(SceneSequence, TheHashTellsOfWhatCameBeforeAChangeOfScenes) {
    // Truth: invariant: two runs that differ in one tick of the first scene only end with different hashes.
    const test::Bench soft(pressed(500.0)), hard(pressed(1000.0));
    const auto hashAfter = [&](double x) {
        tick::SceneSequence scenes(std::array{tick::SceneTurn{&soft.whole(), 10}, tick::SceneTurn{&hard.whole()}});
        for (int k = 0; k < 40; ++k) scenes.step({k == 7 ? Pose{kPressed.q, kPressed.p + Vec3(x, 0, 0)} : kPressed});
        return scenes.hash();
    };
    EXPECT_EQ(hashAfter(0.0), hashAfter(0.0));
    EXPECT_NE(hashAfter(0.0), hashAfter(1e-4));
}

TEST(SceneSequence, AllocatesNothingWhenScenesChange) {
    // Truth: invariant, counted by interposed functions
    if (!support::RtGuard::available()) GTEST_SKIP() << "the sanitizer owns the interposed functions";
    const test::Bench soft(pressed(500.0)), hard(pressed(1000.0));
    tick::SceneSequence scenes(std::array{tick::SceneTurn{&soft.whole(), 10}, tick::SceneTurn{&hard.whole()}});
    support::RtGuard guard;
    for (int k = 0; k < 100; ++k) scenes.step({kPressed});
    EXPECT_EQ(guard.violations(), 0) << guard.describe();
}

TEST(SceneSequence, AReplayFindsTheChangeOfScenesAgain) {
    // Truth: invariant: recorded inputs give the recorded outputs and the same hash; with a change one tick later not
    const test::Bench soft(pressed(500.0)), hard(pressed(1000.0));
    const auto turns = [&](std::int64_t periods) {
        return std::array{tick::SceneTurn{&soft.whole(), periods}, tick::SceneTurn{&hard.whole()}};
    };
    tick::SceneSequence scenes(turns(10));
    std::vector<TickRecord> records;
    for (int k = 0; k < 40; ++k) {
        const DeviceReading reading{kPressed};
        records.push_back(tick::makeRecord(k, reading, scenes.step(reading)));
    }
    const auto report = replay::replay(turns(10), records);
    EXPECT_FALSE(report.first_difference);
    EXPECT_EQ(report.state_hash, scenes.hash());
    const auto other = replay::replay(turns(11), records);
    ASSERT_TRUE(other.first_difference);
    EXPECT_EQ(other.first_difference->tick, 15);
}

}  // namespace
}  // namespace passung
