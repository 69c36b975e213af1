#include "study/run/shown_overlap.h"

#include <gtest/gtest.h>

#include <array>

#include "core/scene/part.h"

// The true overlap of what several hands showed.

namespace passung::run {
namespace {

constexpr double mm = 1e-3;

/// Two boxes of 20 mm that can be picked up, 100 mm apart along x, and two hands with nothing.
BuiltScenes twoBoxes() {
    BuiltScenes built;
    scene::Scene& scene = built.scenes.emplace_back();
    for (const double x : {0.0, 100 * mm}) {
        scene::PartSpec box{.name = "box", .geometry = shape::Box{20 * mm, 20 * mm, 20 * mm}, .X_WP = {}};
        box.X_WP.p.x() = x;
        box.pickable = true;
        scene.parts.push_back(std::make_shared<const scene::Part>(*scene::buildPart(box, {})));
        scene.spec.parts.push_back(box);
    }
    scene.spec.other_hands.resize(1);
    scene.spec.effects.pick.reach = 5 * mm;
    scene.held = scene.parts.size();
    built.turns.resize(1);
    return built;
}

TickRecord tickWith(std::int64_t tick, std::int32_t held, double x, bool engaged) {
    TickRecord record;
    record.tick = tick;
    record.held = held;
    record.proxy_position_m = {static_cast<float>(x), 0.0f, 0.0f};
    record.proxy_quaternion = {1.0f, 0.0f, 0.0f, 0.0f};
    if (engaged) record.status |= kEngaged;
    return record;
}

TEST(ShownOverlap, IsOfWhatTheOtherHandHoldsWithWhatTheFirstLaidDownBeforeAllWereEngaged) {
    // Truth: closed form: boxes of 20 mm whose centres are 19 mm apart reach 1 mm into each other. The first hand lays
    // its box down at 50 mm before the other hand is engaged, and then holds nothing.
    const BuiltScenes scenes = twoBoxes();
    std::vector<TickRecord> first;
    std::vector<std::vector<TickRecord>> others(1);
    for (std::int64_t tick = 0; tick < 20; ++tick) {
        first.push_back(
            tickWith(tick, tick < 5 ? 0 : kNoPart, tick < 5 ? 10 * mm * static_cast<double>(tick + 1) : 0.0, true));
        others[0].push_back(tickWith(tick, tick < 12 ? kNoPart : 1, tick < 12 ? 0.0 : 69 * mm, tick >= 10));
    }
    std::vector<measures::TickOverlap> ticks(2);
    ticks[0].tick = 11;
    ticks[1].tick = 12;
    ASSERT_TRUE(ShownOverlap().measure(scenes, first, others, ticks));
    EXPECT_EQ(ticks[0].depth, 0.0) << "nothing is in a hand";
    EXPECT_NEAR(ticks[1].depth, 1 * mm, 1e-6);
}

TEST(ShownOverlap, OfOnePartInTwoHandsIsThatOfTheOtherParts) {
    // Truth: closed form, as above; a part does not overlap itself.
    const BuiltScenes scenes = twoBoxes();
    std::vector<TickRecord> first{tickWith(0, 0, 82 * mm, true)};
    const std::vector<std::vector<TickRecord>> others{{tickWith(0, 0, 82 * mm, true)}};
    std::vector<measures::TickOverlap> ticks(1);
    ASSERT_TRUE(ShownOverlap().measure(scenes, first, others, ticks));
    EXPECT_NEAR(ticks[0].depth, 2 * mm, 1e-6);
}

}  // namespace
}  // namespace passung::run
