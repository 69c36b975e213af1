#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "core/base/random.h"
#include "tests/support/rt_guard.h"
#include "tests/support/scenes.h"

// Scenes of many parts: what of them is near changes no bit of what is felt, only what it takes.

namespace passung {
namespace {

using geometry::NearList;
using scene::ContactMethod;
using scene::Geometry;

constexpr std::size_t kParts = 500;

/// A box among boxes, balls and cylinders of a few sizes, around it up to `room` away [m].
scene::SceneSpec amongParts(Geometry geometry, ContactMethod method, std::size_t count, double room,
                            std::uint64_t seed) {
    auto spec = test::scene(shape::Box{0.02, 0.016, 0.03}, {Quat::Identity(), Vec3(0, 0, 0.04)},
                            shape::Box{0.06, 0.06, 0.02}, Pose{}, method);
    spec.contact.geometry = geometry;
    spec.contact.cell = 1e-3;
    spec.contact.spacing = 4e-3;
    Random random(seed);
    const std::array<shape::Shape, 3> shapes{shape::Box{0.02, 0.03, 0.01}, shape::Sphere{0.024},
                                             shape::Cylinder{0.016, 0.03}};
    while (spec.parts.size() < count + 1) {
        const Vec3 p = room * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const Quat q(random.normal(), random.normal(), random.normal(), random.normal());
        if ((p - Vec3(0, 0, 0.04)).norm() < 0.05) continue;
        spec.parts.push_back({.name = "part " + std::to_string(spec.parts.size()),
                              .geometry = shapes[random.below(3)],
                              .X_WP = {q.normalized(), p}});
    }
    return spec;
}

/// From the start on, smooth and turning; presses parts in its way. `jumps`: at times to and fro in every tick.
Pose handAt(int i, std::uint64_t seed, bool jumps) {
    const double t = 1e-3 * i, s = static_cast<double>(seed), ramp = std::min(1.0, i / 400.0);
    const auto wave = [&](double rate, double phase) { return ramp * std::sin(rate * t + phase * s); };
    const double jump = jumps && i / 400 % 3 == 2 ? 0.012 * wave(900.0, 0.3) : 0.0;
    return {rotationFromVector(Vec3(0.8 * wave(3, 1), 0.9 * wave(2, 2), 1.5 * wave(1.7, 3))),
            Vec3(0.09 * wave(2.1, 4) + jump, 0.09 * wave(1.6, 5), 0.04 + 0.07 * wave(2.7, 6))};
}

void searchBy(tick::HandState& state, NearList::Search search) {
    state.solver.near().searchBy(search);
    state.near_hand.searchBy(search);
    state.around_proxy.near.searchBy(search);
    state.around_hand.near.searchBy(search);
}

bool same(const Vec3& a, const Vec3& b) {
    const auto bits = [](const Vec3& v, int i) { return std::bit_cast<std::uint64_t>(v[i]); };
    return bits(a, 0) == bits(b, 0) && bits(a, 1) == bits(b, 1) && bits(a, 2) == bits(b, 2);
}

struct Kind {
    Geometry geometry;
    ContactMethod method;
};
constexpr std::array kKinds{
    Kind{Geometry::ClosedForm, ContactMethod::GodObject}, Kind{Geometry::ClosedForm, ContactMethod::GodObjectHeuristic},
    Kind{Geometry::Field, ContactMethod::GodObject}, Kind{Geometry::Field, ContactMethod::GodObjectHeuristic},
    Kind{Geometry::Field, ContactMethod::Penalty}};

TEST(ManyParts, AnswersAreThoseOfALookAtEachPartsBox) {
    // Truth: brute force, a look at every part's box at every pose: the same hash of all outputs, on smooth and jumping
    // ways.
    for (const Kind& kind : kKinds)
        for (const std::uint64_t seed : {1, 2}) {
            const auto spec = amongParts(kind.geometry, kind.method, kParts, 0.25, seed);
            test::Bench by_keys(spec), by_each(spec);
            searchBy(by_each.state(), NearList::Search::Each);
            int touched = 0;
            for (int i = 0; i < 1800; ++i) {
                const Pose X = handAt(i, seed, true);
                touched += by_keys.step(X).frame.contacts > 0 ? 1 : 0;
                by_each.step(X);
                ASSERT_EQ(by_keys.wholeState().hash, by_each.wholeState().hash) << i;
            }
            EXPECT_GT(touched, 50);
        }
}

TEST(ManyParts, WhatIsNotQueriedChangesNoBitOfForceAndPose) {
    // Truth: brute force, a contact query of every part's field in every tick. So few parts and such slow ways that no
    // tick's work is suspended (which more queries would be).
    for (const Kind& kind : kKinds) {
        if (kind.geometry != Geometry::Field) continue;
        const auto spec = amongParts(kind.geometry, kind.method, 14, 0.09, 4);
        test::Bench by_keys(spec), by_all(spec);
        searchBy(by_all.state(), NearList::Search::All);
        int touched = 0;
        std::uint64_t fewer = 0;
        for (int i = 0; i < 2400; ++i) {
            const Pose X = handAt(i / 2, 4, false);
            const auto keys = by_keys.step(X), all = by_all.step(X);
            touched += keys.frame.contacts > 0 ? 1 : 0;
            ASSERT_EQ(all.frame.status & kSuspended, 0u) << i;
            ASSERT_TRUE(same(keys.F_D_B.force, all.F_D_B.force)) << i << ' ' << static_cast<int>(kind.method);
            ASSERT_TRUE(same(keys.F_D_B.torque, all.F_D_B.torque)) << i;
            ASSERT_TRUE(same(keys.X_WG.p, all.X_WG.p)) << i;
            ASSERT_EQ(keys.frame.contacts, all.frame.contacts) << i;
            fewer += all.frame.nodes_visited - keys.frame.nodes_visited;
        }
        EXPECT_GT(touched, 100);
        EXPECT_GT(fewer, 2400u);
    }
}

TEST(ManyParts, NoPartIsEnteredThatWasNotLookedAt) {
    // Truth: brute force. At every pose of the proxy's ways, jumps of the hand included, no part of all overlaps it by
    // more than closed forms keep, by searches that know nothing of who is near.
    const auto spec = amongParts(Geometry::ClosedForm, ContactMethod::GodObject, kParts, 0.25, 2);
    test::Bench bench(spec), judge(spec);
    int touched = 0;
    for (int i = 0; i < 2400; ++i) {
        touched += bench.step(handAt(i, 2, true)).frame.contacts > 0 ? 1 : 0;
        for (const Pose& X : bench.state().solver.way())
            for (closed_form::ContactSearch& search : judge.state().at_hand)
                ASSERT_LE(search.overlapAt(X, judge.state().search).depth, closed_form::kKeptOverlap) << i;
    }
    EXPECT_GT(touched, 100);
}

TEST(ManyParts, LooksDoNotGrowWithPartsOutOfReach) {
    // Truth: count. 4 000 parts more, none nearer than 0.3 m, are looked at by 2 boxes a tick or less: a part that is g
    // away once in a way of g, at 0.2 m/s.
    for (const Kind& kind : {kKinds[0], kKinds[2]}) {
        auto spec = amongParts(kind.geometry, kind.method, 8, 0.2, 3);
        auto more = spec;
        Random random(4);
        while (more.parts.size() < 4000) {
            const Vec3 p = 2.0 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            if (p.norm() < 0.4) continue;
            more.parts.push_back({.name = "far " + std::to_string(more.parts.size()),
                                  .geometry = shape::Shape{shape::Sphere{0.02}},
                                  .X_WP = {Quat::Identity(), p}});
        }
        test::Bench few(spec), many(more);
        const auto looks = [](test::Bench& bench) {
            tick::HandState& state = bench.state();
            return state.solver.near().looks() + state.near_hand.looks() + state.around_proxy.near.looks() +
                   state.around_hand.near.looks();
        };
        std::uint64_t before = 0;
        constexpr int kTicks = 2400;
        for (int i = 0; i < kTicks; ++i) {
            const Pose X = handAt(i, 3, false);
            const auto a = few.step(X), b = many.step(X);
            ASSERT_TRUE(same(a.F_D_B.force, b.F_D_B.force)) << i;
            if (i == 0) before = looks(many) - looks(few);
        }
        const double a_tick = static_cast<double>(looks(many) - looks(few) - before) / kTicks;
        std::printf("%s: %.2f looks a tick at 4000 parts out of reach\n",
                    kind.geometry == Geometry::Field ? "field" : "closed form", a_tick);
        EXPECT_LT(a_tick, 2.0);
    }
}

/// Counts what is built.
class CountedStore : public scene::BuildStore {
public:
    std::optional<std::string> load(const std::string&) override { return std::nullopt; }
    void keep(const std::string&, std::string_view) override { ++kept; }
    int kept = 0;
};

TEST(ManyParts, EqualGeometryIsBuiltOnce) {
    // Truth: pointers, and counts. Parts of one shape share mesh, field, clusters and solid: the plate's shape, three
    // others and the held one's. Fields are built of four of them, of the held one a shell.
    for (const Geometry geometry : {Geometry::ClosedForm, Geometry::Surface, Geometry::Field}) {
        CountedStore store;
        scene::PartCache cache(&store);
        const auto scene = scene::buildScene(amongParts(geometry, ContactMethod::GodObject, 200, 0.5, 5), cache);
        ASSERT_TRUE(scene);
        std::vector<const scene::Part*> built;
        for (const auto& part : scene->parts) built.push_back(part.get());
        std::sort(built.begin(), built.end());
        EXPECT_EQ(std::unique(built.begin(), built.end()) - built.begin(), 5);
        EXPECT_EQ(store.kept, geometry == Geometry::Field ? 5 : 0);
        if (geometry != Geometry::ClosedForm) continue;
        const tick::World world = tick::makeWorld(*scene);
        EXPECT_EQ(world.solids.size(), 5u);
        for (std::size_t i = 1; i < world.bodies.size(); ++i)
            for (std::size_t k = 1; k < i; ++k)
                EXPECT_EQ(world.bodies[i].solid == world.bodies[k].solid, scene->parts[i] == scene->parts[k]);
    }
}

TEST(ManyParts, ManifoldsDoNotGrowWithTheirNumber) {
    // Truth: count.
    const auto capacity = [](std::size_t parts) {
        test::Bench bench(amongParts(Geometry::Field, ContactMethod::GodObject, parts, 0.5, 6));
        return bench.state().manifold.capacity();
    };
    EXPECT_EQ(capacity(500), capacity(2));
}

TEST(ManyParts, ATickAmongThemAllocatesNothing) {
    // Truth: invariant.
    if (!support::RtGuard::available()) GTEST_SKIP() << "a sanitizer owns the allocator";
    for (const Kind& kind : kKinds) {
        test::Bench bench(amongParts(kind.geometry, kind.method, 100, 0.15, 7));
        const support::RtGuard guard;
        for (int i = 0; i < 1000; ++i) bench.step(handAt(i, 7, true));
        EXPECT_EQ(guard.violations(), 0) << guard.describe();
    }
}

}  // namespace
}  // namespace passung
