#include "core/tick/stage.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "core/base/random.h"
#include "core/tick/hand_state.h"
#include "core/tick/step.h"
#include "tests/support/every_effect.h"
#include "tests/support/fields.h"
#include "tests/support/scenes.h"

// What a stage declares is what it does. That it cannot say otherwise: undeclared_access.cmake.

namespace passung {
namespace {

using tick::HandState;
using tick::StageList;
using tick::StageOf;
using tick::TickFrame;

constexpr int kTimes = 1000;

template <class Part, class... Argument>
constexpr bool writes(const StageOf<Argument...>&) {
    return (std::is_same_v<Argument, Part&> || ...);
}
template <class Part, class... Argument>
constexpr bool reads(const StageOf<Argument...>&) {
    return (std::is_same_v<Argument, const Part&> || ...);
}

/// Calls `f` with each part of a whole.
template <class... Part, class F>
void eachPart(tick::Parts<Part...>& whole, F f) {
    (f(static_cast<Part&>(whole)), ...);
}

/// A held box beside and above a plate, and what the stages of one kind need.
scene::SceneSpec boxOverPlate(scene::ContactMethod method) {
    auto spec = test::scene(shape::Box{0.01, 0.01, 0.01}, {Quat::Identity(), Vec3(0, 0, 0.01)},
                            shape::Box{0.03, 0.03, 0.01}, Pose{}, method);
    spec.parts.push_back(
        {.name = "post", .geometry = shape::Cylinder{0.004, 0.01}, .X_WP = {Quat::Identity(), Vec3(0.01, 0, 0.01)}});
    spec.contact.spacing = 2.5e-3;
    spec.contact.damping = 2.0;
    spec.contact.rotational_damping = 0.001;
    spec.limits.max_force = 3.0;
    spec.limits.max_speed = 2.0;
    spec.limits.quantum = 1e-5;
    test::addEveryEffect(spec);
    return spec;
}

/// The same with the post in a hand of its own.
scene::SceneSpec besideAnother(scene::SceneSpec spec) {
    spec.parts.back().held = true;
    spec.parts.back().hand = 1;
    spec.other_hands.push_back({spec.limits, spec.registration, spec.start_gate});
    spec.effects.keep_apart = test::everyEffect().keep_apart;
    return spec;
}

/// Two hands that may hold the box together.
scene::SceneSpec inTwoHands() {
    auto spec = besideAnother(boxOverPlate(scene::ContactMethod::GodObject));
    spec.parts.front().pickable = spec.parts.back().pickable = true;
    spec.effects.pick.reach = 0.01;
    spec.effects.guidance.share = 0.0;  // its way is that of one part
    return spec;
}

/// Scenes that have every stage between them.
std::vector<scene::SceneSpec> scenesOfAllStages() {
    using enum scene::ContactMethod;
    auto free = boxOverPlate(GodObject);
    free.parts.resize(1);
    auto penalty = boxOverPlate(Penalty);
    penalty.contact.variant = scene::PenaltyVariant::AreaWeighted;
    penalty.limits.delay_ticks = 3;
    penalty.start_gate = {0.1, 3.0, 5};
    auto tool = boxOverPlate(Penalty);
    tool.contact.coupling = scene::PenaltyCoupling::Virtual;
    tool.display_wrench = false;
    auto god_object = boxOverPlate(GodObject);
    for (auto& part : god_object.parts) part.friction = part.sliding_friction = 0.3;
    god_object.contact.proxy_filter = 50.0;
    god_object.contact.two_way = true;
    auto heuristic = boxOverPlate(GodObjectHeuristic);
    heuristic.contact.proxy_filter = 50.0;
    auto budget = heuristic;
    budget.contact.budget_nodes = 60;
    auto closed_form = boxOverPlate(GodObject);
    closed_form.contact.geometry = scene::Geometry::ClosedForm;
    closed_form.contact.proxy_filter = 50.0;
    auto surface = boxOverPlate(GodObject);
    surface.contact.geometry = scene::Geometry::Surface;
    return {free,
            penalty,
            tool,
            god_object,
            heuristic,
            budget,
            closed_form,
            surface,
            besideAnother(boxOverPlate(GodObject)),
            besideAnother(closed_form),
            besideAnother(surface)};
}

/// A hand that presses, slides and turns; samples are lost, lie, and lie for long.
DeviceReading readingAt(int tick, Random& random) {
    const double t = tick * kTickSeconds;
    DeviceReading reading{{rotationFromVector(0.1 * Vec3(std::sin(9 * t), std::cos(7 * t), std::sin(5 * t))),
                           Vec3(0.006 * std::sin(11 * t), 0.004 * std::sin(6 * t), 0.01 + 0.004 * std::cos(17 * t))}};
    reading.fresh = random.below(20) != 0;
    reading.buttons = tick % 300 > 240 ? 2u : tick % 170 > 120 ? 4u : 0u;  // the clutch, the second scale
    if (random.below(60) == 0 || tick % 500 > 490) reading.X_BD.p.x() += 0.3;
    if (tick == 0) reading.X_BD.p.z() = 0.3;  // a false first sample: relocated soon after
    return reading;
}

/// What step() does before the stages of a hand beside another one, whose part goes to and fro and pushes; now and then
/// it is let go.
void moveOther(const tick::HandModel& model, HandState& state, int tick) {
    if (!model.meetsHands()) return;
    const std::uint32_t other = model.moving.back();
    state.carried[0] = {other, state.X_WO[other], tick % 100 == 99};
    state.carried_count = 1;
    state.X_WO[other].p.x() = 0.01 + 0.004 * std::sin(0.02 * tick);
    state.X_WG_begin = state.X_WG;
    state.from_hands[other] = {{Vec3(0.1, 0.2, 0.3), Vec3(0.001, 0.002, 0.003)}, 0.4};
}

/// Holds the part elsewhere than at its origin.
void holdAside(const tick::HandModel& model, HandState& state) {
    state.p_GC = Vec3(0.004, -0.002, 0.003);
    state.X_DG = {rotationFromVector(Vec3(0.1, -0.2, 0.3)), Vec3(0.002, 0.001, -0.003)};
    tick::measureBy(model, std::array{state.p_GC}, state);
}

struct Checker {
    const tick::HandModel& model;
    Random& random;
    std::map<std::string, int>& times;
    HandState state_a, state_b;
    TickFrame frame_a, frame_b;

    /// Runs `stage` from `state` and `frame` as they are, and with random bits in all that it does not declare to
    /// read: the same bits in what it writes, no other bits in what it does not.
    template <const auto& stage>
    void check(const HandState& state, const TickFrame& frame) {
        int& count = times[std::string(stage.card.name) + (model.hasNodeBudget() ? " under a budget" : "")];
        if (count >= kTimes) return;
        ++count;
        state_a = state_b = state;
        frame_a = frame_b = frame;
        std::map<std::string, std::vector<std::uint64_t>> before;
        const auto prepare = [&]<class Part>(Part& part) {
            if (!writes<Part>(stage) && !reads<Part>(stage)) test::scramble(part, random);
            if constexpr (std::is_same_v<Part, tick::QueryMemory>) test::scramble(part.scratch, random);
            if (!writes<Part>(stage)) before[typeid(Part).name()] = test::bitsOf(part);
        };
        eachPart(state_b, prepare);
        eachPart(frame_b, prepare);
        stage(model, state_a, frame_a);
        stage(model, state_b, frame_b);
        const auto compare = [&]<class Part>(Part& part) {
            if constexpr (std::is_same_v<Part, tick::QueryMemory>) {
                if (writes<Part>(stage)) return;  // nobody looks at what is left there
            }
            const std::string name = typeid(Part).name();
            if (!writes<Part>(stage)) {
                ASSERT_EQ(test::bitsOf(part), before[name]) << stage.card.name << " wrote " << name;
            } else {
                ASSERT_EQ(test::bitsOf(part), bitsAfter<Part>())
                    << stage.card.name << " read what it does not say: " << name;
            }
        };
        eachPart(state_b, compare);
        eachPart(frame_b, compare);
    }

    /// What `Part` became where nothing was scrambled.
    template <class Part>
    std::vector<std::uint64_t> bitsAfter() const {
        if constexpr (std::is_base_of_v<Part, HandState>)
            return test::bitsOf(static_cast<const Part&>(state_a));
        else
            return test::bitsOf(static_cast<const Part&>(frame_a));
    }

    /// That one of all stages which `run` is.
    template <const auto&... stage>
    void checkThat(StageList<stage...>, void (*run)(const tick::HandModel&, HandState&, TickFrame&) noexcept,
                   const HandState& state, const TickFrame& frame) {
        ((run == tick::runStage<stage> ? check<stage>(state, frame) : void()), ...);
    }
};

template <const auto&... stage>
std::vector<std::string> namesOf(StageList<stage...>) {
    return {stage.card.name...};
}

/// Where step() asks the part to be.
Pose targetOf(const tick::HandModel& model, HandState& state, const TickFrame& frame) {
    if (!model.hasInertia()) return state.X_WR;
    state.pull = tick::pullOf(model, std::array{state.p_GC}, tick::momentumOf(model, state, state.X_WG));
    state.pull.springs[0].X_WT = tick::drawnTo(model, state, state.p_GC, state.X_WR, state.X_WG);
    return frame.relocated ? frame.X_WH : state.pull.restFrom(state.metric, state.X_WG);
}

/// Ticks of a hand with this model, stage by stage as step() runs them.
void checkTicks(const tick::HandModel& model, HandState& state, Random& random, std::map<std::string, int>& times) {
    Checker checker{model, random, times, state, state, {}, {}};
    for (int i = 0; i < 1200; ++i) {
        TickFrame frame;
        frame.reading = readingAt(i, random);
        moveOther(model, state, i);
        for (const tick::Stage& stage : model.stages) {
            if (!stage.senses) state.X_WT = targetOf(model, state, frame);
            state.work = model.hasSurfaces() ? tick::kSurfaceBudget : tick::kFieldBudget;
            if (!state.engaged && !stage.before_start) continue;
            checker.checkThat(tick::AllStages{}, stage.run, state, frame);
            if (testing::Test::HasFatalFailure()) return;
            stage.run(model, state, frame);
        }
    }
}

TEST(Stage, ReadsAndWritesWhatItDeclaresAndNothingElse) {
    // Truth: invariant. The ticks are those of step(), stage by stage.
    std::map<std::string, int> times;
    Random random(3);
    for (int round = 0; round < 2; ++round) {
        for (const auto& spec : scenesOfAllStages()) {
            test::Bench bench(spec);
            if (round == 1) holdAside(bench.model(), bench.state());
            checkTicks(bench.model(), bench.state(), random, times);
            if (HasFatalFailure()) return;
        }
        const test::Bench bench(inTwoHands());
        const tick::HandModel& follower = bench.whole().hand(1, 0, true);
        HandState state = tick::makeHandState(follower);
        state.X_WShared = {Quat::Identity(), Vec3(0.001, 0, 0.01)};
        state.shared_pressures[0] = 0.7;
        state.shared = round == 1;
        checkTicks(follower, state, random, times);
        if (HasFatalFailure()) return;
    }
    for (const std::string& name : namesOf(tick::AllStages{})) EXPECT_EQ(times[name], kTimes) << name;
}

/// How many of a scene's stages write each part, by whether it is handed on.
struct Writers {
    std::string part;
    bool handed_on = false, only_read = false;
    int count = 0;
};

template <const auto&... stage>
std::vector<Writers> writersOf(StageList<stage...>, const std::vector<tick::Stage>& stages) {
    std::vector<Writers> all;
    const auto add = [&]<class Part>(Part&) {
        Writers writers{typeid(Part).name(), tick::declared::kHandedOn<Part>, tick::declared::kOnlyRead<Part>, 0};
        for (const tick::Stage& entry : stages)
            writers.count += ((entry.run == tick::runStage<stage> && writes<Part>(stage)) + ...);
        all.push_back(writers);
    };
    HandState state;
    TickFrame frame;
    eachPart(state, add);
    eachPart(frame, add);
    return all;
}

TEST(Stage, IsTheOnlyOneOfItsSceneToWriteWhatItOwns) {
    // Truth: invariant. What several stages of a scene write says that it is handed on, and all is written by somebody.
    std::set<std::string> written;
    for (const auto& spec : scenesOfAllStages()) {
        const test::Bench bench(spec);
        for (const Writers& part : writersOf(tick::AllStages{}, bench.model().stages)) {
            EXPECT_LE(part.count, part.handed_on ? 100 : 1) << part.part;
            if (part.count > 0 || part.only_read) written.insert(part.part);
        }
    }
    for (const Writers& part : writersOf(tick::AllStages{}, {})) EXPECT_TRUE(written.contains(part.part)) << part.part;
}

}  // namespace
}  // namespace passung
