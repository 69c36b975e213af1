#include "core/shell/disk_subset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include "core/base/random.h"

namespace passung::shell {
namespace {

constexpr double kRadius = 0.07;

/// Points in a unit cube that face anywhere; every tenth has no normal.
struct Cloud {
    std::vector<Vec3> positions, normals;
    std::vector<std::uint32_t> order;

    explicit Cloud(int count, std::uint64_t seed) {
        Random random(seed);
        for (int i = 0; i < count; ++i) {
            positions.emplace_back(random.uniform(), random.uniform(), random.uniform());
            const Vec3 n(random.normal(), random.normal(), random.normal());
            normals.push_back(i % 10 == 0 ? Vec3(Vec3::Zero()) : Vec3(n.normalized()));
        }
        order.resize(positions.size());
        std::iota(order.begin(), order.end(), 0u);
        shuffle(order, random);
    }
    double distance(std::uint32_t i, std::uint32_t j) const { return (positions[i] - positions[j]).norm(); }
    bool alike(std::uint32_t i, std::uint32_t j) const { return normals[i].dot(normals[j]) > std::cos(M_PI / 3.0); }
};

TEST(DiskSubset, KeepsItsDistanceAmongPointsThatFaceAlike) {
    // Truth: invariant, all pairs.
    const Cloud cloud(4000, 1);
    const auto chosen = diskSubset(cloud.positions, cloud.normals, kRadius, cloud.order);
    for (std::size_t a = 0; a < chosen.size(); ++a)
        for (std::size_t b = a + 1; b < chosen.size(); ++b)
            if (cloud.alike(chosen[a], chosen[b])) {
                ASSERT_GE(cloud.distance(chosen[a], chosen[b]), kRadius);
            }
}

TEST(DiskSubset, LeavesNoTriedPointWithoutAChosenOneThatFacesIt) {
    // Truth: invariant, all pairs; also where only some of the points are tried.
    const Cloud cloud(4000, 2);
    const std::vector<std::uint32_t> some(cloud.order.begin(), cloud.order.begin() + 1500);
    for (const auto& tried : {cloud.order, some}) {
        const auto chosen = diskSubset(cloud.positions, cloud.normals, kRadius, tried);
        const std::set<std::uint32_t> taken(chosen.begin(), chosen.end());
        EXPECT_EQ(taken.size(), chosen.size());
        EXPECT_LT(taken.size(), tried.size());
        for (const std::uint32_t i : tried) {
            const bool held = taken.count(i) > 0 || std::any_of(chosen.begin(), chosen.end(), [&](std::uint32_t j) {
                                  return cloud.alike(i, j) && cloud.distance(i, j) < kRadius;
                              });
            ASSERT_TRUE(held) << i;
        }
    }
}

TEST(DiskSubset, TriesThePointsInTheOrderGiven) {
    // Truth: closed form. Of two points too close to each other the first in the order stays.
    const std::vector<Vec3> positions{Vec3(0, 0, 0), Vec3(0.01, 0, 0)}, normals(2, Vec3::UnitZ());
    using Order = std::vector<std::uint32_t>;
    EXPECT_EQ(diskSubset(positions, normals, kRadius, Order{0, 1}), (Order{0}));
    EXPECT_EQ(diskSubset(positions, normals, kRadius, Order{1, 0}), (Order{1}));
}

TEST(DiskSubset, LetsTwoSidesOfAThinWallBe) {
    // Truth: closed form. Points back to back, however close, are both taken, and neither is given to the other.
    const std::vector<Vec3> positions{Vec3(0, 0, 0), Vec3(0, 0, -1e-6)}, normals{Vec3::UnitZ(), -Vec3::UnitZ()};
    const std::vector<std::uint32_t> both{0, 1}, upper{0};
    EXPECT_EQ(diskSubset(positions, normals, kRadius, both), both);
    EXPECT_EQ(assignNearest(positions, normals, kRadius, upper), (std::vector<std::uint32_t>{0, kNoPoint}));
}

TEST(DiskSubset, AssignsTheNearestChosenPointThatFacesAlikeOrNone) {
    // Truth: independent search over all chosen points; half of them are dropped so that some points have none.
    const Cloud cloud(4000, 3);
    auto chosen = diskSubset(cloud.positions, cloud.normals, kRadius, cloud.order);
    chosen.resize(chosen.size() / 2);
    const auto nearest = assignNearest(cloud.positions, cloud.normals, kRadius, chosen);
    int none = 0;
    for (std::uint32_t i = 0; i < nearest.size(); ++i) {
        double best = kRadius;
        std::uint32_t expected = kNoPoint;
        for (std::uint32_t k = 0; k < chosen.size(); ++k) {
            if (!cloud.alike(i, chosen[k]) || !(cloud.distance(i, chosen[k]) < best)) continue;
            best = cloud.distance(i, chosen[k]);
            expected = k;
        }
        ASSERT_EQ(nearest[i], expected) << i;
        none += expected == kNoPoint ? 1 : 0;
    }
    EXPECT_GT(none, 100);
}

TEST(PointBuckets, VisitEveryPointWithinTheRadiusAndNoneTwice) {
    // Truth: independent search over all points; a radius of up to three buckets.
    const Cloud cloud(1500, 4);
    for (const double radius : {0.2, 0.03, 0.01}) {
        for (const double edge : {radius, 0.4 * radius}) {
            PointBuckets buckets(cloud.positions, edge);
            for (std::uint32_t i = 0; i < cloud.positions.size(); ++i) buckets.insert(cloud.positions[i], i);
            for (const Vec3& p : cloud.positions) {
                std::multiset<std::uint32_t> visited;
                buckets.visitWithin(p, radius, [&](std::uint32_t i, double squared) {
                    visited.insert(i);
                    return squared;
                });
                for (std::uint32_t i = 0; i < cloud.positions.size(); ++i) {
                    ASSERT_LE(visited.count(i), 1u);
                    if ((cloud.positions[i] - p).norm() <= radius * (1.0 - 1e-12)) {
                        ASSERT_EQ(visited.count(i), 1u);
                    }
                }
            }
        }
    }
}

TEST(PointBuckets, HoldPointsAlongALongThinLine) {
    // Truth: closed form. A line of a million bucket edges would take too many blocks: buckets grow instead.
    const std::vector<Vec3> line{Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(0.5, 0.5, 0.5)};
    PointBuckets buckets(line, 1e-6);
    for (std::uint32_t i = 0; i < line.size(); ++i) buckets.insert(line[i], i);
    int found = 0;
    buckets.visitWithin(line[2], 1e-6, [&](std::uint32_t i, double squared) {
        found += i == 2 ? 1 : 0;
        return squared;
    });
    EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace passung::shell
