#include "core/surface/surface_proxy.h"

#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <optional>

#include "tests/support/length.h"
#include "tests/support/mesh_crossing.h"
#include "tests/support/rt_guard.h"
#include "tests/support/surface_cases.h"

namespace passung::surface {
namespace {

constexpr int kFullEvery = 25;       // ticks: whose way is looked at between its poses, and whose gap is measured
constexpr double kStiffness = 2000;  // [N/m]

double threadMicroseconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

struct Followed {
    int crossings = 0, between = 0;  // poses at which triangles cross
    int too_high = 0, measured = 0,
        loose = 0;  // gaps told: above the exact one; at rest under a row; and far below it
    int suspended = 0, longest = 0, stuck = 0, meets = 0;
    double grain = 0.0;  // greatest change of the spring's force in a tick [N]
    int too_fast = 0;    // ticks, held by rows before and after, on which the part went farther than it may
    std::vector<double> times;

    double quantile(double share) {
        std::sort(times.begin(), times.end());
        return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
    }
};

/// Poses of the way between those that were accepted in a tick.
int crossingsBetween(test::MeshPairTruth& truth, Pose from, std::span<const Pose> chain) {
    int crossings = 0;
    for (const Pose& to : chain) {
        for (int k = 1; k < 10; ++k) {
            const double t = 0.1 * k;
            crossings += truth.distance({from.q.slerp(t, to.q), from.p + t * (to.p - from.p)}, 1e-9) == 0.0;
        }
        from = to;
    }
    return crossings;
}

Followed follow(const test::SurfaceCase& scene) {
    const ClusterTree held(scene.held), obstacle(scene.obstacle);
    SurfaceProxy proxy(held, obstacle, {.metric = motion::Metric{0.02}});
    test::MeshPairTruth truth(scene.held, scene.obstacle);
    proxy.place(scene.hand(0.0));
    proxy.prepare();
    Followed seen;
    const int judged_every = test::atFullLength() ? 1 : 5;
    int run = 0;
    Vec3 last = Vec3::Zero();
    double reach = 0.0;
    for (const Vec3& v : scene.held.vertices) reach = std::max(reach, v.norm());
    bool was_held = false;
    Pose X_WH_last = scene.hand(0.0);
    for (int tick = 0; tick < scene.ticks; ++tick) {
        const Pose X_WH = scene.hand(1e-3 * tick), before = proxy.pose();
        const double start = threadMicroseconds();
        const SurfaceTick now = proxy.advance(X_WH);
        seen.times.push_back(threadMicroseconds() - start);
        run = now.suspended ? run + 1 : 0;
        seen.longest = std::max(seen.longest, run);
        seen.suspended += now.suspended;
        seen.stuck += now.stuck;
        seen.meets += now.meets;
        const bool is_held = now.active > 0 && !now.suspended;
        const double hand_way = (X_WH.p - X_WH_last.p).norm() + reach * X_WH.q.angularDistance(X_WH_last.q);
        const double most = std::max(SurfaceProxy::kFastestHeld, 1.5 * hand_way);
        seen.too_fast += was_held && is_held && (now.X_WG.p - before.p).norm() > most + 1e-9;
        was_held = is_held;
        X_WH_last = X_WH;
        const Vec3 force = kStiffness * (X_WH.p - now.X_WG.p);
        if (tick > 0) seen.grain = std::max(seen.grain, (force - last).norm());
        last = force;
        const bool full = tick % kFullEvery == 0;
        if (!full && tick % judged_every != 0) continue;
        const double distance = truth.distance(now.X_WG, full ? 2e-5 : 1e-9);
        seen.crossings += distance == 0.0;
        if (!full) continue;
        seen.between += crossingsBetween(truth, before, proxy.chain());
        seen.too_high += now.gap > distance;
        if (now.active == 0 || now.suspended) continue;
        ++seen.measured;
        seen.loose += distance > 1.1 * now.gap + 2e-7;
    }
    return seen;
}

constexpr int kMostSuspended = 2;  // ticks of a case whose work may go on in the next one: 0.1 %

class SurfaceOf : public testing::TestWithParam<test::SurfaceCase> {};

TEST_P(SurfaceOf, TrianglesNeverMeetAndTheGapToldIsProven) {
    // Truth: independent oracle: triangle against triangle (mesh_crossing.h) at every tick (but for PASSUNG_LONG=1:
    // at every fifth), and at nine poses between those that were accepted.
    Followed seen = follow(GetParam());
    std::printf(
        "%-32s processor us median %4.0f p99 %4.0f p99.9 %4.0f; suspended %d (longest %d) stuck %d; step %.2f N\n",
        GetParam().name.c_str(), seen.quantile(0.5), seen.quantile(0.99), seen.quantile(0.999), seen.suspended,
        seen.longest, seen.stuck, seen.grain);
    EXPECT_EQ(seen.crossings, 0);
    EXPECT_EQ(seen.between, 0);
    EXPECT_EQ(seen.meets, 0);
    EXPECT_EQ(seen.too_high, 0);
    EXPECT_EQ(seen.loose, 0);
    EXPECT_GT(seen.measured, 0);
    EXPECT_EQ(seen.too_fast, 0);
    EXPECT_LE(seen.suspended, kMostSuspended);
    EXPECT_EQ(seen.stuck, 0);
}

INSTANTIATE_TEST_SUITE_P(All, SurfaceOf, testing::ValuesIn(test::surfaceCases()), [](const auto& made) {
    std::string name;
    for (const char c : made.param.name)
        if (std::isalnum(static_cast<unsigned char>(c))) name += c;
    return name;
});

TEST(SurfaceProxy, GoesOnWhereFacesOnlyPassEachOther) {
    // Truth: invariant: a hand that moves is followed. On these paths faces that were about to slip past an edge kept
    // the proxy where it was for 30 to 255 ticks, although no way led through them.
    for (const test::SurfaceCase& scene : {test::ringInRing(605), test::scanOnScan(.03, 60, 510)}) {
        const ClusterTree held(scene.held), obstacle(scene.obstacle);
        SurfaceProxy proxy(held, obstacle, {.metric = motion::Metric{std::sqrt(1.0 / 2000.0)}});
        proxy.place(scene.hand(0.0));
        proxy.prepare();
        int stuck = 0;
        for (int tick = 0; tick < 1200; ++tick) stuck += proxy.advance(scene.hand(1e-3 * tick)).stuck;
        EXPECT_EQ(stuck, 0) << scene.name;
    }
}

TEST(SurfaceProxy, AllocatesNothingAndIsTheSameEveryTime) {
    // Truth: invariant.
    const test::SurfaceCase scene = test::dovetail();
    const ClusterTree held(scene.held), obstacle(scene.obstacle);
    SurfaceProxy first(held, obstacle, {.metric = motion::Metric{0.02}}),
        second(held, obstacle, {.metric = motion::Metric{0.02}});
    for (SurfaceProxy* proxy : {&first, &second}) {
        proxy->place(scene.hand(0.0));
        proxy->prepare();
    }
    const support::RtGuard guard;
    int different = 0;
    for (int tick = 0; tick < 1000; ++tick) {
        const Pose X_WH = scene.hand(1e-3 * tick);
        const Pose a = first.advance(X_WH).X_WG, b = second.advance(X_WH).X_WG;
        different += a.p != b.p || a.q.coeffs() != b.q.coeffs();
    }
    EXPECT_EQ(different, 0);
    if (support::RtGuard::available()) {
        EXPECT_EQ(guard.violations(), 0) << guard.describe();
    }
}

#if defined(__x86_64__) && defined(__GNUC__)
/// Are upper halves of vector registers in use? Nothing where the processor does not tell.
std::optional<bool> upperHalvesInUse() {
    if (!__builtin_cpu_supports("avx2")) return {};
    unsigned a = 0xd, b = 0, c = 1, d = 0;  // leaf of the extended state: bit 2, xgetbv tells what is in use
    __asm__ volatile("cpuid" : "+a"(a), "=b"(b), "+c"(c), "=d"(d));
    if (!(a & 4u)) return {};
    unsigned low = 0, high = 0;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(1));
    return (low & 4u) != 0;
}

TEST(SurfaceProxy, LeavesNoUpperHalvesOfRegistersInUse) {
    // Truth: the processor's own account of its state. In use, they make all other code of the thread slower.
    const test::SurfaceCase scene = test::blockOnFin();
    const ClusterTree held(scene.held), obstacle(scene.obstacle);
    SurfaceProxy proxy(held, obstacle, {.metric = motion::Metric{0.02}});
    proxy.place(scene.hand(0.0));
    proxy.prepare();
    if (!upperHalvesInUse()) GTEST_SKIP() << "the processor does not tell";
    int in_use = 0;
    for (int tick = 0; tick < 1000; ++tick) {
        proxy.advance(scene.hand(1e-3 * tick));
        in_use += *upperHalvesInUse();
    }
    EXPECT_EQ(in_use, 0);
}
#endif

TEST(SurfaceProxy, ComesOutOfWhatEnclosesItWhereItIsPlacedInATick) {
    // Truth: closed form: the cube has to go 9 mm, a millimetre a tick; and invariant: neither memory nor more work
    // than the budget, but for a face, whatever the number of faces that are asked.
    const test::SurfaceCase ball = test::scanOnScan(.03, 60);
    const geometry::TriangleMesh cube = test::boxMesh(Vec3::Constant(-.002), Vec3::Constant(.002));
    const geometry::TriangleMesh block = test::boxMesh(Vec3::Constant(-.01), Vec3::Constant(.01));
    constexpr int kBudget = 2000;  // a part of what the scan's faces take
    for (const auto* around : {&block, &ball.obstacle}) {
        const ClusterTree held(cube), obstacle(*around);
        SurfaceProxy proxy(held, obstacle, {.metric = motion::Metric{0.02}, .budget = kBudget});
        test::MeshPairTruth truth(cube, *around);
        const Pose inside{Quat::Identity(), Vec3(.001, 0, .003)};
        proxy.place({Quat::Identity(), Vec3(0, 0, .1)});
        proxy.prepare();
        proxy.advance({Quat::Identity(), Vec3(0, 0, .1)});
        int led = 0, suspended = 0;
        {
            const support::RtGuard guard;
            proxy.place(inside);
            for (int tick = 0; tick < 400; ++tick) {
                const SurfaceTick now = proxy.advance(inside);
                led += now.meets;
                suspended += now.suspended;
            }
            if (support::RtGuard::available()) {
                EXPECT_EQ(guard.violations(), 0) << guard.describe();
            }
        }
        EXPECT_GE(led, 9);
        EXPECT_GT(truth.distance(proxy.pose(), 1e-9), 0.0);
        if (around == &block) {
            EXPECT_NEAR(proxy.pose().p.z(), .012, 1e-5) << "held by the block's top";
        } else {
            EXPECT_GT(proxy.pose().p.norm(), .013) << "the scan's least radius";
            EXPECT_GT(suspended, 3);
        }
    }
}

TEST(SurfaceProxy, AnyBudgetKeepsItOut) {
    // Truth: independent oracle (mesh_crossing.h): whatever work is left for the next tick, nothing crosses.
    const test::SurfaceCase scene = test::blockOnSeams();
    const ClusterTree held(scene.held), obstacle(scene.obstacle);
    test::MeshPairTruth truth(scene.held, scene.obstacle);
    for (const int budget : {100, 1000}) {
        SurfaceProxy proxy(held, obstacle, {.metric = motion::Metric{0.02}, .budget = budget});
        proxy.place(scene.hand(0.0));
        proxy.prepare();
        int suspended = 0;
        for (int tick = 0; tick < 1000; ++tick) {
            suspended += proxy.advance(scene.hand(1e-3 * tick)).suspended;
            ASSERT_GT(truth.distance(proxy.pose(), 1e-9), 0.0) << budget << " " << tick;
        }
        EXPECT_GT(suspended, 0);
        for (int tick = 0; tick < 3000; ++tick) proxy.advance(scene.hand(1.0));
        SurfaceProxy unlimited(held, obstacle, {.metric = motion::Metric{0.02}, .budget = 1'000'000});
        unlimited.place(proxy.pose());
        unlimited.prepare();
        const Vec3 rests = proxy.pose().p;
        for (int tick = 0; tick < 10; ++tick) unlimited.advance(scene.hand(1.0));
        EXPECT_NEAR((unlimited.pose().p - rests).norm(), 0.0, 2e-5) << budget;
    }
}

}  // namespace
}  // namespace passung::surface
