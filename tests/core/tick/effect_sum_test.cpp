#include "core/tick/effect_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <set>
#include <string>
#include <typeinfo>
#include <vector>

#include "core/base/random.h"
#include "core/tick/hand_state.h"
#include "core/tick/step.h"
#include "tests/support/every_effect.h"
#include "tests/support/scenes.h"

// Effects are independent: one more changes no bit of what another adds, unless the stages' declarations lead there.

namespace passung {
namespace {

using tick::StageList;
using tick::StageOf;

/// An effect beside contact: how a scene gets it, whose stages are its own, and what it adds.
struct Effect {
    std::string name;
    void (*add)(scene::SceneSpec&);
    std::set<std::string> stages;
    const Wrench& (*added)(const tick::TickFrame&);  // null: it adds nothing of its own
};

const std::vector<Effect>& effects() {
    static const scene::Effects every = test::everyEffect();
    using Spec = scene::SceneSpec;
    using Frame = tick::TickFrame;
    static const std::vector<Effect> all{
        {"transients",
         [](Spec& s) { s.effects.transients = every.transients; },
         {"contact transients"},
         [](const Frame& f) -> const Wrench& { return f.of_transients; }},
        {"weight",
         [](Spec& s) {
             s.effects.weight = every.weight;
             s.parts.front().density = 7850.0;
         },
         {"weight", "weight in the hand"},
         [](const Frame& f) -> const Wrench& { return f.of_weight; }},
        {"viscosity",
         [](Spec& s) { s.effects.viscosity = every.viscosity; },
         {"viscosity"},
         [](const Frame& f) -> const Wrench& { return f.of_viscosity; }},
        {"guidance",
         [](Spec& s) { s.effects.guidance = every.guidance; },
         {"guidance"},
         [](const Frame& f) -> const Wrench& { return f.of_guidance; }},
        {"snap",
         [](Spec& s) { s.effects.snap = every.snap; },
         {"snap"},
         [](const Frame& f) -> const Wrench& { return f.of_snap; }},
        {"inertia",
         [](Spec& s) {
             s.effects.inertia = every.inertia;
             s.parts.front().density = 7850.0;
         },
         {"inertia"},
         [](const Frame& f) -> const Wrench& { return f.of_inertia; }},
        {"keep_apart",
         [](Spec& s) {
             s.effects.keep_apart = every.keep_apart;
             s.parts.push_back({.name = "other",
                                .geometry = shape::Box{0.01, 0.01, 0.01},
                                .X_WP = {Quat::Identity(), Vec3(0.03, 0, 0.02)},
                                .held = true,
                                .hand = 1});
             s.other_hands.push_back({s.limits, s.registration, s.start_gate});
         },
         {"keeping apart"},
         [](const Frame& f) -> const Wrench& { return f.of_keep_apart; }},
        {"navigation",
         [](Spec& s) { s.effects.navigation = every.navigation; },
         {"navigation", "sign of contact", "clutched wrench"},
         nullptr},
        {"passivity controller",
         [](Spec& s) { s.effects.passivity_damping = every.passivity_damping; },
         {"passivity controller"},
         nullptr},
    };
    return all;
}

/// What a stage declares, by the names of the parts.
struct Declared {
    std::string stage;
    std::set<std::string> reads, writes;
};

template <class Part, class... Argument>
constexpr bool writes(const StageOf<Argument...>&) {
    return (std::is_same_v<Argument, Part&> || ...);
}
template <class Part, class... Argument>
constexpr bool touches(const StageOf<Argument...>&) {
    return (std::is_same_v<std::remove_cvref_t<Argument>, Part> || ...);
}

template <const auto& stage, class... Part>
void note(tick::Parts<Part...>*, Declared& declared) {
    ((touches<Part>(stage) ? void(declared.reads.insert(typeid(Part).name())) : void()), ...);
    ((writes<Part>(stage) ? void(declared.writes.insert(typeid(Part).name())) : void()), ...);
}

template <class... Part>
std::set<std::string> namesOf(tick::Parts<Part...>*) {
    return {typeid(Part).name()...};
}

/// The stages of a scene in their order.
template <const auto&... stage>
std::vector<Declared> declaredOf(StageList<stage...>, const tick::HandModel& model) {
    std::vector<Declared> all;
    const auto add = [&]<const auto & one>(const tick::Stage& entry) {
        if (entry.run != tick::runStage<one>) return;
        Declared& declared = all.emplace_back();
        declared.stage = entry.name;
        note<one>(static_cast<tick::HandState*>(nullptr), declared);
        note<one>(static_cast<tick::TickFrame*>(nullptr), declared);
    };
    for (const tick::Stage& entry : model.stages) (add.template operator()<stage>(entry), ...);
    return all;
}

/// True if what the stages of `from` write may come, from part to part and tick to tick, to those of `to`. What step()
/// itself hands on: where the held part is asked to go, from where the hand is, what hangs there and how that moves.
bool leads(const std::vector<Declared>& stages, const Effect& from, const Effect& to) {
    const std::set<std::string> frame = namesOf(static_cast<tick::TickFrame*>(nullptr));
    const std::string target = typeid(tick::HeldTarget).name();
    std::set<std::string> changed;
    for (std::size_t before = ~std::size_t{0}; before != changed.size();) {
        before = changed.size();
        // Parts of the frame begin anew in each tick.
        std::set<std::string> now;
        for (const std::string& part : changed)
            if (!frame.contains(part)) now.insert(part);
        for (const Declared& stage : stages) {
            bool reached = from.stages.contains(stage.stage);
            for (const std::string& part : stage.reads) reached = reached || now.contains(part);
            if (!reached) continue;
            if (to.stages.contains(stage.stage)) return true;
            now.insert(stage.writes.begin(), stage.writes.end());
            for (const std::type_info* part :
                 {&typeid(tick::Hang), &typeid(tick::HandSample), &typeid(tick::Moving), &typeid(tick::Stretch)})
                if (now.contains(part->name())) now.insert(target);
        }
        changed.insert(now.begin(), now.end());
    }
    return false;
}

/// A box that is pressed on a plate, slid and lifted, among samples that are late or lost.
scene::SceneSpec boxOverPlate() {
    auto spec = test::scene(shape::Box{0.01, 0.01, 0.01}, {Quat::Identity(), Vec3(0, 0, 0.01)},
                            shape::Box{0.03, 0.03, 0.01}, Pose{}, scene::ContactMethod::GodObject);
    spec.contact.geometry = scene::Geometry::ClosedForm;
    spec.contact.damping = 2.0;
    spec.limits.quantum = 1e-5;
    return spec;
}

DeviceReading readingAt(int tick, Random& random) {
    const double t = tick * kTickSeconds;
    DeviceReading reading{{rotationFromVector(0.1 * Vec3(std::sin(9 * t), std::cos(7 * t), std::sin(5 * t))),
                           Vec3(0.006 * std::sin(11 * t), 0.004 * std::sin(6 * t), 0.01 + 0.004 * std::cos(17 * t))}};
    reading.fresh = random.below(20) != 0;
    reading.buttons = tick % 300 > 240 ? 2u : tick % 170 > 120 ? 4u : 0u;
    return reading;
}

/// The first hand's output; a second one rests.
tick::TickOutput step(test::Bench& bench, const DeviceReading& reading) {
    std::vector<DeviceReading> readings(bench.whole().hands.size(), reading);
    if (readings.size() > 1) readings[1] = DeviceReading{bench.scene().spec.parts.back().X_WP};
    std::vector<tick::TickOutput> outputs(readings.size());
    tick::step(bench.whole(), bench.wholeState(), readings, outputs);
    return outputs.front();
}

/// Bits of what `effect` added, tick by tick.
std::vector<std::uint64_t> addedBits(const scene::SceneSpec& spec, const Effect& effect) {
    test::Bench bench(spec);
    Random random(4);
    std::vector<std::uint64_t> bits;
    for (int i = 0; i < 1500; ++i) {
        const auto output = step(bench, readingAt(i, random));
        const Wrench& added = effect.added(output.frame);
        for (const Vec3& v : {added.force, added.torque})
            for (const double x : v) bits.push_back(std::bit_cast<std::uint64_t>(x));
    }
    return bits;
}

TEST(EffectSum, NoEffectChangesABitOfAnotherUnlessTheDeclarationsLeadThere) {
    // Truth: invariant. Every pair of effects; what leads from one to another is printed, and is what effect_sum.h
    // says.
    std::set<std::string> edges, changes;
    for (const Effect& one : effects()) {
        if (one.added == nullptr) continue;
        auto alone = boxOverPlate();
        one.add(alone);
        const auto bits = addedBits(alone, one);
        EXPECT_NE(std::count_if(bits.begin(), bits.end(), [](std::uint64_t b) { return b << 1 != 0; }), 0) << one.name;
        for (const Effect& other : effects()) {
            if (&one == &other) continue;
            auto both = alone;
            other.add(both);
            const test::Bench bench(both);
            const bool led = leads(declaredOf(tick::AllStages{}, bench.model()), other, one);
            const bool same = addedBits(both, one) == bits;
            std::printf("%-20s -> %-12s %s, %s\n", other.name.c_str(), one.name.c_str(), led ? "leads there" : "apart",
                        same ? "no bit changes" : "changes it");
            if (led) edges.insert(other.name + " -> " + one.name);
            if (!same) changes.insert(other.name + " -> " + one.name);
        }
    }
    std::set<std::string> found{"weight -> transients", "weight -> inertia", "inertia -> transients"};
    // A stage may read what it hands on: from pushes and wrench to the proxy, and by it to the hand's first sample.
    std::set<std::string> declared;
    for (const Effect& one : effects()) {
        if (one.added == nullptr) continue;
        found.insert("navigation -> " + one.name);
        for (const std::string from : {"transients", "weight", "inertia"})
            if (from != one.name) declared.insert(from + " -> " + one.name);
    }
    EXPECT_EQ(changes, found);
    declared.insert(found.begin(), found.end());
    EXPECT_EQ(edges, declared);
}

TEST(EffectSum, AddsWhatEachSaysToTheContactAndNothingElse) {
    // Truth: invariant: the wrench of a scene with all of them less that of the same scene with none, where none of
    // them leads to the contact: all but the weight. To rounding.
    auto none = boxOverPlate();
    auto all = none;
    all.effects.transients = test::everyEffect().transients;
    all.effects.viscosity = test::everyEffect().viscosity;
    all.effects.guidance = test::everyEffect().guidance;
    all.effects.snap = test::everyEffect().snap;
    all.effects.record = true;
    test::Bench with(all), without(none);
    Random random(4), again(4);
    double most = 0.0;
    for (int i = 0; i < 1500; ++i) {
        const auto a = with.step(readingAt(i, random)), b = without.step(readingAt(i, again));
        const Wrench &t = a.frame.of_transients, &v = a.frame.of_viscosity, &g = a.frame.of_guidance;
        const Wrench& s = a.frame.of_snap;
        ASSERT_EQ(a.frame.effects, 0b11101u);
        const Vec3 force = t.force + v.force + g.force + s.force, torque = t.torque + v.torque + g.torque + s.torque;
        EXPECT_LT((a.frame.F_H_W.force - b.frame.F_H_W.force - force).norm(), 1e-9) << i;
        EXPECT_LT((a.frame.F_H_W.torque - b.frame.F_H_W.torque - torque).norm(), 1e-9) << i;
        most = std::max(most, t.force.norm());
        // And records tell it.
        const TickRecord record = tick::makeRecord(i, DeviceReading{}, a);
        EXPECT_EQ(record.effects, 0b11101u);
        for (int axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<std::size_t>(axis);
            EXPECT_EQ(record.effect_wrench[0][at], static_cast<float>(t.force[axis]));
            EXPECT_EQ(record.effect_wrench[1][at], 0.0f);
            EXPECT_EQ(record.effect_wrench[2][at + 3], static_cast<float>(v.torque[axis]));
            EXPECT_EQ(record.effect_wrench[3][at], static_cast<float>(g.force[axis]));
            EXPECT_EQ(record.effect_wrench[4][at + 3], static_cast<float>(s.torque[axis]));
        }
    }
    EXPECT_GT(most, 0.01);
}

TEST(EffectSum, TellsNothingWhereTheSceneDoesNotAsk) {
    // Truth: invariant.
    auto spec = boxOverPlate();
    spec.effects.viscosity = test::everyEffect().viscosity;
    test::Bench bench(spec);
    Random random(4);
    for (int i = 0; i < 100; ++i) {
        const auto output = bench.step(readingAt(i, random));
        EXPECT_EQ(output.frame.effects, 0u);
        const TickRecord record = tick::makeRecord(i, DeviceReading{}, output);
        EXPECT_EQ(record.effects, 0u);
        EXPECT_EQ(record.effect_wrench, TickRecord{}.effect_wrench);
    }
}

}  // namespace
}  // namespace passung
