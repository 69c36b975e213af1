#include "study/measures/assembly_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "study/measures/measures.h"

// What is told of an assembly's steps from the records of all hands.

namespace passung::measures {
namespace {

constexpr std::size_t kBase = 0, kPin = 1, kLid = 2;

Pose at(double x, double y, double z) { return {Quat::Identity(), {x, y, z}}; }

/// A base that rests, a pin that belongs 10 mm over it, and a lid that belongs 20 mm over the pin, after it.
scene::SceneSpec spec(std::size_t hands = 1) {
    scene::SceneSpec spec;
    spec.parts.resize(3);
    spec.parts[kPin].X_WP = at(0.1, 0, 0);
    spec.parts[kLid].X_WP = at(0.2, 0, 0);
    spec.parts[kPin].pickable = spec.parts[kLid].pickable = true;
    spec.other_hands.resize(hands - 1);
    spec.effects.pick.reach = 0.01;
    spec.effects.pick.steps.resize(2);
    scene::AssemblyStep &pin = spec.effects.pick.steps[0], &lid = spec.effects.pick.steps[1];
    pin.part = kPin;
    pin.into = kBase;
    pin.X_IGoal = at(0, 0, 0.01);
    lid.part = kLid;
    lid.into = kPin;
    lid.X_IGoal = at(0, 0, 0.02);
    lid.after = scene::stepBit(0);
    return spec;
}

class Told {
public:
    explicit Told(std::size_t hands = 1) : watch(spec(hands)), hands_(hands) {
        for (TickRecord& record : hands_) {
            record.held = kNoPart;
            record.proxy_quaternion = {1, 0, 0, 0};
        }
    }

    /// A tick with this part in the hand, its origin there.
    void tick(std::int32_t part, const Vec3& p, std::uint64_t done = 0, double force = 0.0, std::size_t hand = 0) {
        TickRecord& record = hands_[hand];
        record.held = part;
        record.proxy_position_m = {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
        record.force_N = {0, 0, static_cast<float>(force)};
        std::vector<const TickRecord*> all;
        for (TickRecord& each : hands_) {
            each.steps_done = done;
            all.push_back(&each);
        }
        std::vector<StepChange> changes;
        watch.follow(all, time_++, changes);
        for (const StepChange& change : changes) {
            constexpr const char* kWhat[] = {"", "let go", "order", "undone"};
            log += std::to_string(change.step) +
                   (change.what == StepChange::What::State ? stepStateName(change.state)
                                                           : kWhat[static_cast<int>(change.what)]) +
                   " ";
        }
    }
    std::string log;
    AssemblyWatch watch;

private:
    std::vector<TickRecord> hands_;
    std::int64_t time_ = 100;
};

TEST(AssemblyWatch, TellsAStepFromStateToState) {
    // Truth: by hand, from the bounds in assembly_watch.h: picked up to 5 mm from where it was taken, near within 10
    // tolerances (10 mm), inserted within one.
    Told told;
    told.tick(kNoPart, {0, 0, 0});
    told.tick(kPin, {0.1, 0, 0});
    told.tick(kPin, {0.1, 0, 0.004}, 0, 3.0);
    told.tick(kPin, {0.1, 0, 0.006}, 0, -5.0);
    told.tick(kPin, {0, 0, 0.0205});
    told.tick(kPin, {0, 0, 0.0195});
    told.tick(kPin, {0, 0, 0.0205});
    told.tick(kPin, {0, 0, 0.0109});
    EXPECT_EQ(told.log, "0picked 0carried 0near 0inserted ");
    told.log.clear();
    told.tick(kNoPart, {0, 0, 0.1}, 1);
    EXPECT_EQ(told.log, "0let go 0idle 0locked ");
    EXPECT_FALSE(told.watch.allDone());
    const StepResult pin = told.watch.results(100)[0];
    EXPECT_EQ(pin.picked, 1);
    EXPECT_EQ(pin.done, 8);
    EXPECT_EQ(pin.place, 1);
    EXPECT_EQ(pin.picks, 1);
    EXPECT_EQ(pin.drops, 0);
    EXPECT_EQ(pin.held_periods, 7);
    EXPECT_NEAR(pin.path, 0.006 + std::hypot(0.1, 0.0145) + 0.001 + 0.001 + 0.0096, 1e-8);
    EXPECT_NEAR(pin.peak_force, 5.0, 1e-6);
    EXPECT_NEAR(pin.position_error, 0.0009, 1e-9);
    EXPECT_EQ(told.watch.results(100)[1].place, 0);
}

TEST(AssemblyWatch, CountsDropsErrorsOfOrderUndosAndTakingAgain) {
    // Truth: by hand. The lid is put where it belongs once the pin is; before, the goal is over where the pin lies.
    Told told;
    told.tick(kLid, {0.2, 0, 0});
    told.tick(kLid, {0.15, 0, 0});
    told.tick(kNoPart, {0.15, 0, 0});  // dropped
    told.tick(kLid, {0.15, 0, 0});
    told.tick(kLid, {0.1, 0, 0.02});  // over the pin, which lies at its start
    told.tick(kNoPart, {0, 0, 0});    // too early
    EXPECT_EQ(told.watch.results(100)[1].drops, 1);
    EXPECT_EQ(told.watch.results(100)[1].order_errors, 1);
    EXPECT_EQ(told.watch.results(100)[1].picks, 2);
    told.tick(kPin, {0.1, 0, 0});
    told.tick(kPin, {0, 0, 0.01});
    told.tick(kNoPart, {0, 0, 0}, 1);
    told.tick(kLid, {0.1, 0, 0.02}, 1);
    told.tick(kLid, {0, 0, 0.03}, 1);
    told.tick(kNoPart, {0, 0, 0}, 3);
    EXPECT_TRUE(told.watch.allDone());
    EXPECT_EQ(told.watch.results(100)[1].place, 2);
    told.tick(kNoPart, {0, 0, 0}, 1);
    EXPECT_FALSE(told.watch.allDone());
    EXPECT_EQ(told.watch.results(100)[1].undos, 1);
    EXPECT_FALSE(told.watch.results(100)[1].done);

    TrialContext context;
    context.start_tick = 0;
    context.end_tick = 5;
    context.form = AssemblyFacts{told.watch.results(100)};
    std::vector<TickRecord> records(6);
    for (std::size_t i = 0; i < records.size(); ++i) records[i].tick = static_cast<std::int64_t>(i);
    std::map<std::string, std::optional<double>> values;
    for (const Value& value : computeMeasures(records, context)) values[value.name] = value.value;
    EXPECT_EQ(values["steps_done"], 1.0);
    EXPECT_EQ(values["order_errors"], 1.0);
    EXPECT_EQ(values["drops"], 1.0);
    EXPECT_EQ(values["regrasps"], 2.0);
    EXPECT_EQ(values["undos"], 1.0);
}

TEST(AssemblyWatch, APartThatGoesFromHandToHandIsTakenOnce) {
    // Truth: by hand: two hands on it for two ticks, then the second alone; its way counts once.
    Told told(2);
    told.tick(kPin, {0.1, 0, 0});
    told.tick(kPin, {0.1, 0, 0.01}, 0, 0.0, 1);
    told.tick(kPin, {0.1, 0, 0.02});
    told.tick(kNoPart, {0, 0, 0});
    told.tick(kPin, {0.1, 0, 0.05}, 0, 0.0, 1);
    told.tick(kNoPart, {0, 0, 0}, 0, 0.0, 1);
    const StepResult pin = told.watch.results(100)[0];
    EXPECT_EQ(pin.picks, 1);
    EXPECT_EQ(pin.hands, 3u);
    EXPECT_EQ(pin.drops, 1);
    EXPECT_EQ(told.log, "0picked 0carried 0let go 0idle ");
}

TEST(AssemblyWatch, AWayInHandsIsComparedWithAFreePathOfStepsThatAreDone) {
    // Truth: by hand. The pin goes 90 mm along x, 20 mm up, 10 mm along x and 10 mm down, 130 mm of the protocol's
    // 104; the lid 60 mm of 240 and is not done; without a path there is no ratio.
    Told told;
    for (const Vec3& p : {Vec3(0.1, 0, 0), Vec3(0.01, 0, 0), Vec3(0.01, 0, 0.02), Vec3(0, 0, 0.02), Vec3(0, 0, 0.01)})
        told.tick(kPin, p);
    told.tick(kNoPart, {0, 0, 0}, 1);
    told.tick(kLid, {0.2, 0, 0}, 1);
    told.tick(kLid, {0.14, 0, 0}, 1);
    std::vector<StepResult> steps = told.watch.results(100);
    EXPECT_FALSE(steps[0].pathRatio());
    TrialContext context;
    context.end_tick = 5;
    std::vector<TickRecord> records(6);
    for (std::size_t i = 0; i < records.size(); ++i) records[i].tick = static_cast<std::int64_t>(i);
    const auto ofTrial = [&] {
        context.form = AssemblyFacts{steps};
        std::optional<double> ratio;
        for (const Value& value : computeMeasures(records, context))
            if (value.name == "path_ratio") ratio = value.value;
        return ratio;
    };
    EXPECT_FALSE(ofTrial());
    steps[0].free_path = 0.104;
    steps[1].free_path = 0.240;
    EXPECT_NEAR(steps[0].pathRatio().value(), 1.25, 1e-6);
    EXPECT_FALSE(steps[1].pathRatio());
    EXPECT_NEAR(ofTrial().value(), 1.25, 1e-6);
    steps[1].done = 7;
    EXPECT_NEAR(ofTrial().value(), 190.0 / 344.0, 1e-6);  // longer paths weigh more
}

}  // namespace
}  // namespace passung::measures
