#include "core/surface/pair_forest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace passung::surface {
namespace {

constexpr double kFarthest = 3e-3;  // [m]: the ring of buckets holds this

Vec3 anyDirection(Random& random) {
    const Vec3 n(random.normal(), random.normal(), random.normal());
    return n.normalized();
}

/// The leaves of a forest of `count` pairs, none of them in a list.
std::vector<std::uint32_t> leavesOf(PairForest& forest, std::size_t count) {
    std::vector<std::uint32_t> leaves{forest.takeWaiting(0)};
    while (leaves.size() < count) {
        const std::uint32_t child = forest.trySplit(leaves.front());
        leaves.front() = child;
        leaves.push_back(child + 1);
    }
    return leaves;
}

TEST(PairForest, WakesAllThatMayBeDueAndNoneThatIsFar) {
    // Truth: brute force over all pairs: who is asleep, in which class, until which way.
    Random random(7);
    PairForest forest(4001);
    forest.restart(0);
    const std::vector<std::uint32_t> leaves = leavesOf(forest, 2000);
    const auto lull = [&](std::uint32_t pair) {
        const Vec3 n = anyDirection(random);
        forest.sleep(pair, n, forest.sureOf(NormalClass::of(n)) + random.uniform(PairForest::kBucket, kFarthest));
    };
    for (const std::uint32_t leaf : leaves) lull(leaf);
    std::size_t all = 0;
    for (int round = 0; round < 300; ++round) {
        PerClass nearer;
        // Steps of every size, some over more than all buckets of a class.
        const double step = std::pow(10.0, random.uniform(-7.0, -2.2));
        for (double& way : nearer) way = random.uniform(0.0, step);
        std::size_t woken = 0;
        for (std::size_t c = 0; c < NormalClass::kCount; ++c)
            woken += forest.wake(c, nearer[c] + random.uniform(0.0, 1e-4), leaves.size());
        std::size_t waiting = 0;
        while (forest.hasWaiting(0)) {
            const std::uint32_t pair = forest.takeWaiting(0);
            ++waiting;
            EXPECT_LT(forest.apart(pair), std::max(0.0, forest.sureOf(forest[pair].normals)) + 1e-9);
            forest[pair].now = ClusterPair::Now::Near;
        }
        EXPECT_EQ(waiting, woken);
        all += woken;
        for (const std::uint32_t leaf : leaves) {
            if (forest[leaf].now != ClusterPair::Now::Asleep) continue;
            EXPECT_GE(forest.apart(leaf), std::max(forest.sureOf(forest[leaf].normals), nearer[forest[leaf].normals]));
        }
        forest.travel(0, nearer);
        for (const std::uint32_t leaf : leaves)
            if (forest[leaf].now == ClusterPair::Now::Near) lull(leaf);
    }
    EXPECT_GT(all, 10 * leaves.size());
}

TEST(PairForest, WakesABucketAtLeastAndNoMoreThanAskedFor) {
    // Truth: closed form: four buckets of three pairs each along one normal.
    PairForest forest(101);
    forest.restart(0);
    const std::vector<std::uint32_t> leaves = leavesOf(forest, 12);
    for (std::size_t i = 0; i < leaves.size(); ++i)
        forest.sleep(leaves[i], Vec3::UnitZ(), (0.5 + 100.0 * static_cast<double>(i / 3)) * PairForest::kBucket);
    const std::size_t up = NormalClass::of(Vec3::UnitZ());
    EXPECT_EQ(forest.wake(NormalClass::of(-Vec3::UnitZ()), 1e-3, 100), 0u);
    EXPECT_EQ(forest.wake(up, 1e-3, 1), 3u);
    EXPECT_GE(forest.sureOf(up), 100.0 * PairForest::kBucket);
    EXPECT_EQ(forest.wake(up, 1e-3, 0), 3u);
    EXPECT_EQ(forest.wake(up, 1e-3, 7), 6u);
    EXPECT_EQ(forest.wake(up, 1e-3, 100), 0u);
    EXPECT_GE(forest.sureOf(up), 1e-3 - PairForest::kBucket);
}

TEST(PairForest, KeepsForEachBodyHalfOfItsShareAndGivesBackWhatIsForgotten) {
    // Truth: closed form: 40 blocks of 128 pairs; of five bodies each is sure of four of them. The first takes what is
    // not kept for the others: 24, of which each has room for 64 twos of children, the first one beside its root
    // for 63.
    PairForest forest(40 * 128, 5);
    const auto fill = [&](std::size_t body) {
        forest.restart(body);
        std::size_t twos = 0;
        for (std::uint32_t at = forest.takeWaiting(body); (at = forest.trySplit(at)) != ClusterPair::kNoPair;) {
            EXPECT_EQ(forest[at].body, body);
            ++twos;
        }
        return twos;
    };
    for (int round = 0; round < 3; ++round) {
        EXPECT_EQ(fill(0), 24u * 64 - 1);
        for (std::size_t body = 1; body < 5; ++body) EXPECT_EQ(fill(body), 4u * 64 - 1);
        EXPECT_EQ(forest.inUse(), 2 * (24 * 64 - 1 + 4 * (4 * 64 - 1)) + 5);
        forest.sleep(1, Vec3::UnitZ(), 1e-4);
        for (std::size_t body = 0; body < 5; ++body) forest.clear(body);
        EXPECT_EQ(forest.inUse(), 0u);
        EXPECT_EQ(forest.wake(NormalClass::of(Vec3::UnitZ()), 1e-3, 10), 0u) << "who slept is forgotten";
    }
}

}  // namespace
}  // namespace passung::surface
