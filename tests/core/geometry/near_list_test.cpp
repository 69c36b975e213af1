#include "core/geometry/near_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "tests/support/rt_guard.h"

namespace passung::geometry {
namespace {

Vec3 anyVector(Random& random, double size) {
    return size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

Quat anyRotation(Random& random) {
    return Quat(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
}

Bounds anyBox(Random& random, double offset) {
    Bounds box;
    const Vec3 middle = anyVector(random, offset);
    const Vec3 half = Vec3(0.025, 0.025, 0.025) + anyVector(random, 0.022);
    box.low = middle - half;
    box.high = middle + half;
    return box;
}

std::vector<NearPart> anyParts(Random& random, std::size_t count, double room) {
    std::vector<NearPart> parts;
    for (std::size_t i = 0; i < count; ++i)
        parts.push_back({anyBox(random, 0.02), {anyRotation(random), anyVector(random, room)}, random.below(100) == 0});
    return parts;
}

/// Boxes whose origin lies outside: turns take their points along.
Bounds heldBox() {
    Bounds held;
    held.low = Vec3(-0.01, -0.01, 0.05);
    held.high = Vec3(0.01, 0.01, 0.15);
    return held;
}

/// Smooth, turning in place, standing still, and with jumps, by turns.
Pose nextPose(const Pose& X, int i, Random& random) {
    const int phase = i / 200 % 5;
    if (phase == 1) return {rotationFromVector(Vec3(0.01, 0.02, 0.004)) * X.q, X.p};
    if (phase == 2) return X;
    if (phase == 3 && i % 20 == 0) return {anyRotation(random), anyVector(random, 0.3)};
    if (phase == 4) return {rotationFromVector(anyVector(random, 0.05)) * X.q, X.p + anyVector(random, 2e-3)};
    const double t = 1e-3 * i;
    return {X.q, 0.3 * Vec3(std::sin(2.0 * t), std::cos(3.1 * t), std::sin(1.3 * t))};
}

TEST(NearList, NoPointOfTheBoxesIsNearerThanTheGap) {
    // Truth: closed form, the distance of points of both boxes: corners, and anywhere.
    Random random(3);
    for (int round = 0; round < 40; ++round) {
        const Bounds held = heldBox();
        const auto parts = anyParts(random, 8, 0.15);
        const NearList list(held, parts);
        const Pose X{anyRotation(random), anyVector(random, 0.1)};
        const auto pointOf = [&](const Bounds& box) {
            const auto along = [&] { return random.below(3) == 0 ? random.uniform() : double(random.below(2)); };
            return Vec3(box.low + Vec3(along(), along(), along()).cwiseProduct(box.size()));
        };
        for (std::uint32_t i = 0; i < parts.size(); ++i) {
            const double gap = list.gap(i, X);
            for (int k = 0; k < 300; ++k)
                ASSERT_GE((X * pointOf(held) - parts[i].X_WP * pointOf(parts[i].box)).norm(), gap - 1e-12);
        }
    }
}

TEST(NearList, KeysFindThosePartsThatALookAtEachFinds) {
    // Truth: brute force, a look at every part, on smooth and jumping ways, near and far, turning in place too.
    for (const std::uint64_t seed : {1, 2, 3}) {
        Random random(seed);
        const auto parts = anyParts(random, 300, 0.5);
        NearList by_keys(heldBox(), parts), by_each = by_keys;
        by_each.searchBy(NearList::Search::Each);
        Pose X;
        std::size_t found = 0;
        for (int i = 0; i < 3000; ++i) {
            X = nextPose(X, i, random);
            for (const double reach : {1e-3, std::pow(10.0, random.uniform(-5.0, -0.5)), 0.0}) {
                const auto near = by_keys.within(X, reach);
                const auto all = by_each.within(X, reach);
                ASSERT_TRUE(std::equal(near.begin(), near.end(), all.begin(), all.end())) << i << ' ' << reach;
                ASSERT_TRUE(std::is_sorted(near.begin(), near.end()));
                for (std::uint32_t k = 0; k < parts.size(); ++k) {
                    const bool is_near = parts[k].moves || !(by_keys.gap(k, X) > reach);
                    ASSERT_EQ(std::binary_search(near.begin(), near.end(), k), is_near) << i;
                }
                found += near.size();
            }
        }
        EXPECT_GT(found, 20'000u);
        EXPECT_LT(by_keys.looks(), by_each.looks() / 4);
    }
}

TEST(NearList, LooksOnlyAtPartsThatTheMotionSinceMayHaveBroughtNear) {
    // Truth: closed form. A part that is g away is looked at after every way of about g; 100 µm a look among parts at
    // 0.1 m and beyond are at most 1e-4 / 0.1 looks at each. Standing still looks at none.
    Random random(5);
    std::vector<NearPart> parts;
    while (parts.size() < 10'000) {
        NearPart part{anyBox(random, 0.0), {anyRotation(random), anyVector(random, 2.0)}, false};
        if (part.X_WP.p.norm() > 0.35) parts.push_back(part);
    }
    NearList list(heldBox(), parts);
    const auto way = [](int i) { return Pose{Quat::Identity(), {1e-4 * (i % 200), 0, 0}}; };
    for (int i = 0; i < 200; ++i) list.within(way(i), 1e-3);
    const std::uint64_t before = list.looks();
    for (int i = 0; i < 199; ++i) EXPECT_TRUE(list.within(way(i), 1e-3).empty());
    EXPECT_LT(static_cast<double>(list.looks() - before), 199 * 1e-4 / 0.1 * 10'000);
    const std::uint64_t then = list.looks();
    for (int i = 0; i < 100; ++i) list.within(way(198), 1e-3);
    EXPECT_EQ(list.looks(), then);
}

TEST(NearList, FewPartsAreNearAlways) {
    // Truth: definition.
    Random random(6);
    const auto parts = anyParts(random, NearList::kAll, 5.0);
    NearList list(heldBox(), parts);
    EXPECT_TRUE(list.hasAll());
    EXPECT_EQ(list.within(Pose{}, 0.0).size(), parts.size());
    EXPECT_EQ(list.looks(), 0u);
}

TEST(NearList, APoseThatIsNotFiniteMakesAllDue) {
    // Truth: invariant: what is not known to be far is looked at, then and later.
    Random random(7);
    const auto parts = anyParts(random, 50, 0.3);
    NearList list(heldBox(), parts), each = list;
    each.searchBy(NearList::Search::Each);
    list.within(Pose{}, 1e-3);
    list.within({Quat::Identity(), Vec3(std::nan(""), 0, 0)}, 1e-3);
    for (int i = 0; i < 20; ++i) {
        const Pose X{anyRotation(random), anyVector(random, 0.2)};
        const auto near = list.within(X, 0.02), all = each.within(X, 0.02);
        EXPECT_TRUE(std::equal(near.begin(), near.end(), all.begin(), all.end()));
    }
}

TEST(NearList, AllocatesNothing) {
    // Truth: invariant.
    if (!support::RtGuard::available()) GTEST_SKIP() << "a sanitizer owns the allocator";
    Random random(8);
    NearList list(heldBox(), anyParts(random, 400, 0.4));
    Pose X;
    const support::RtGuard guard;
    for (int i = 0; i < 2000; ++i) {
        X = nextPose(X, i, random);
        list.within(X, i % 3 == 0 ? 1.0 : 1e-3);
    }
    EXPECT_EQ(guard.violations(), 0) << guard.describe();
}

}  // namespace
}  // namespace passung::geometry
