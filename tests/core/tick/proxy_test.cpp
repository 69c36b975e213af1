#include "core/tick/proxy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/base/random.h"
#include "core/tick/god_object.h"
#include "core/tick/god_object_heuristic.h"
#include "core/tick/proxy_way.h"
#include "tests/support/scenes.h"

namespace passung::tick {
namespace {

using scene::ContactMethod;

/// What a method's margins are [per cell], and how much of the scene's tolerance they may use up.
struct Method {
    ContactMethod method;
    ProxyMargins share;
    double most;  // accepted overlap, per tolerance
};
constexpr std::array kMethods{Method{ContactMethod::GodObjectHeuristic, {kKeep, kRelieve, kAccept}, 1.0},
                              Method{ContactMethod::GodObject, {kKept, kRelieved, kAccepted}, 0.5}};

/// A block over a table whose top is z = 0.
scene::SceneSpec blockOnTable(ContactMethod method, double cell, double tolerance) {
    auto spec = test::scene(shape::Box{0.02, 0.02, 0.01}, {Quat::Identity(), Vec3(0, 0, 0.0052)},
                            shape::Box{0.06, 0.06, 0.02}, {Quat::Identity(), Vec3(0, 0, -0.01)}, method);
    spec.contact.cell = cell;
    spec.contact.tolerance = tolerance;
    return spec;
}

/// Deepest overlap of the block in any tick, while the hand goes 2 mm down and rests there; the last one.
struct Overlap {
    double most = 0.0, last = 0.0;
};
Overlap pressed(const scene::SceneSpec& spec) {
    test::Bench bench(spec);
    Overlap overlap;
    for (int i = 0; i < 120; ++i) {
        const auto out = bench.step(Pose{Quat::Identity(), Vec3(0, 0, 0.0052 - 2.2e-5 * std::min(i, 100))});
        overlap.last = 0.005 - out.X_WG.p.z();
        overlap.most = std::max(overlap.most, overlap.last);
    }
    return overlap;
}

TEST(Proxy, OverlapsByNoMoreThanTheToleranceWhateverTheCell) {
    // Truth: closed form. A face on a plane, whose distance the field holds exactly but for its numbers of 16 bits in a
    // brick that spans 14 cells. Shares of so large a cell would keep 4 um (god object) and 20 um (heuristic).
    constexpr double kCell = 2e-3, kTolerance = 3e-6, kQuantum = 14 * kCell / 65536;
    for (const Method& m : kMethods) {
        const Overlap found = pressed(blockOnTable(m.method, kCell, kTolerance));
        EXPECT_LE(found.most, m.most * kTolerance + kQuantum);
        EXPECT_NEAR(found.last, m.share.keep / m.share.accept * m.most * kTolerance, kQuantum);
    }
}

TEST(Proxy, OverlapsByAShareOfTheCellWhereTheToleranceIsWide) {
    // Truth: closed form, the same; a share of so small a cell is less than the tolerance allows.
    constexpr double kCell = 0.25e-3, kTolerance = 100e-6, kQuantum = 14 * kCell / 65536;
    for (const Method& m : kMethods) {
        const Overlap found = pressed(blockOnTable(m.method, kCell, kTolerance));
        EXPECT_LE(found.most, m.share.accept * kCell + kQuantum);
        EXPECT_NEAR(found.last, m.share.keep * kCell, kQuantum);
    }
}

// A block whose lower left edge goes round the upper right edge of a table, along y:
//
//        +--------+          the table fills x < 0, z < 0; the block's edge is at (x, z)
//        | block  |
//        (x,z)----+
//   ---------+
//    table   |

constexpr double kBlock = 0.01, kTable = 0.03;

scene::SceneSpec blockOverEdge(double tolerance) {
    auto spec = test::scene(shape::Box{kBlock, kBlock, kBlock}, {Quat::Identity(), Vec3::Zero()},
                            shape::Box{kTable, kTable, kTable}, {Quat::Identity(), Vec3(-kTable / 2, 0, -kTable / 2)},
                            ContactMethod::GodObject);
    spec.contact.cell = 0.0;
    spec.contact.tolerance = tolerance;
    spec.contact.rotational_stiffness = 1000.0;  // so stiff that the block does not tilt
    return spec;
}

Pose edgeAt(double x, double z) { return {Quat::Identity(), Vec3(x + kBlock / 2, 0.001, z + kBlock / 2)}; }

/// Overlap of block and table with the block's edge at (x, z).
double overlapAt(double x, double z) { return std::max(0.0, std::min(-x, -z)); }

Vec3 edgeOf(const Pose& X) { return X.p - Vec3(kBlock / 2, 0, kBlock / 2); }

TEST(Proxy, CutsNoCornerBetweenTwoTicks) {
    // Truth: closed form. The block lies on the table near its edge; within a tick or two the hand draws it over the
    // edge and beside the table. On the straight line between two ticks' poses it overlaps no more than it may at their
    // ends, but for the field's tolerance, since the field is what tells of the corner, and, of a fast way, what may be
    // between two of the places that are looked at: half their distance.
    constexpr double kTolerance = 4e-6;
    auto spec = blockOverEdge(kTolerance);
    spec.parts[0].X_WP = edgeAt(-0.2e-3, 10e-6);
    test::Bench bench(spec);
    Random random(31);
    double deepest = 0.0;
    int round = 0;
    for (int run = 0; run < 500; ++run) {
        bench.state() = makeHandState(bench.model());
        const double from = random.uniform(-0.3e-3, -20e-6);
        const Vec3 to(random.uniform(0.0, 0.6e-3), 0.0, random.uniform(-1.5e-3, -0.1e-3));
        Vec3 before = edgeOf(spec.parts[0].X_WP);
        for (int i = 0; i < 20; ++i) {
            const double there = std::clamp(0.5 * (i - 9), 0.0, 1.0);
            const Vec3 hand =
                Vec3(from, 0, -20e-6) + (run % 2 == 0 ? std::ceil(there) : there) * (to - Vec3(from, 0, 0));
            const Vec3 now = edgeOf(bench.step(edgeAt(hand.x(), hand.z())).X_WG);
            const double unseen = 0.5 * (now - before).norm() / (kPlaces + 1);
            for (int k = 1; k < 16; ++k) {
                const Vec3 p = before + k / 16.0 * (now - before);
                deepest = std::max(deepest, overlapAt(p.x(), p.z()));
                ASSERT_LE(overlapAt(p.x(), p.z()), 0.5 * kTolerance + kTolerance + unseen) << run << ", " << i;
            }
            before = now;
        }
        round += before.z() < -50e-6 ? 1 : 0;
    }
    std::printf("deepest %.2f um, %d of 500 came round; cell %.3f mm\n", 1e6 * deepest, round,
                1e3 * bench.model().finest_cell);
    EXPECT_GT(round, 450);
}

}  // namespace
}  // namespace passung::tick
