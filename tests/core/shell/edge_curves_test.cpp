#include "core/shell/edge_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/shape/shape.h"

namespace passung::shell {
namespace {

geometry::TriangleMesh meshOf(const shape::Shape& shape) { return shape::tessellate(shape, 1e-6); }

/// Length of all curves, without what a curve that runs round repeats.
double lengthOf(const EdgeCurves& edges) {
    double sum = 0.0;
    for (const EdgeCurves::Stretch& stretch : edges.stretches())
        for (std::uint32_t i = stretch.first; i < stretch.first + stretch.count; ++i)
            sum += static_cast<double>(edges.gaps()[i]);
    return sum;
}

TEST(EdgeCurves, AreTheEdgesThatStandOut) {
    // Truth: closed form. A box has twelve; a bored plate those twelve and its mouth, not the edge round the bore's
    // floor; a sheet its border; a ball none. 1e-4: chords of the mouth, and lengths are rounded up to floats.
    EXPECT_NEAR(lengthOf(EdgeCurves(meshOf(shape::Box{0.01, 0.02, 0.03}), 1e-3)), 4 * 0.06, 1e-6);
    const double mouth = std::numbers::pi * 0.01;
    EXPECT_NEAR(lengthOf(EdgeCurves(meshOf(shape::BorePlate{0.02, 0.02, 0.02, 0.01, 0.01, 0.0}), 1e-3)),
                12 * 0.02 + mouth, 1e-4 * mouth);
    EXPECT_NEAR(lengthOf(EdgeCurves(meshOf(shape::Sheet{0.01, 0.02}), 1e-3)), 0.06, 1e-6);
    EXPECT_TRUE(EdgeCurves(meshOf(shape::Sphere{0.01}), 1e-3).stretches().empty());
}

TEST(EdgeCurves, HasStationsNoFartherApartThanAskedAndEachInOneStretch) {
    // Truth: invariant.
    constexpr double kSpacing = 0.7e-3;
    const EdgeCurves edges(meshOf(shape::Cylinder{0.02, 0.013}), kSpacing);
    std::vector<int> seen(edges.stations().size(), 0);
    for (const EdgeCurves::Stretch& stretch : edges.stretches()) {
        ASSERT_LE(stretch.count, EdgeCurves::kStretchStations);
        EXPECT_FALSE(stretch.begins || stretch.ends);  // both rims run round
        for (std::uint32_t i = stretch.first; i < stretch.first + stretch.count; ++i) {
            ++seen[i];
            EXPECT_LE(static_cast<double>(edges.gaps()[i]), kSpacing * (1.0 + 1e-6));
            EXPECT_GT(static_cast<double>(edges.gaps()[i]), 0.0);
        }
    }
    // Of each rim the first station and the second stand again at its end; the first and the last are beside others.
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 0), 4);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()) - 4);
}

TEST(EdgeCurves, SpheresHoldTheirStretchesAsFarAsToTheStationsBeside) {
    // Truth: invariant.
    const EdgeCurves edges(meshOf(shape::BorePlate{0.02, 0.02, 0.02, 0.01, 0.01, 1e-3}), 1e-3);
    for (std::size_t i = 0; i < edges.stretches().size(); ++i) {
        const EdgeCurves::Stretch& stretch = edges.stretches()[i];
        const std::uint32_t first = stretch.first - (stretch.begins ? 0 : 1);
        const std::uint32_t last = stretch.first + stretch.count - (stretch.ends ? 1 : 0);
        for (std::uint32_t v = edges.stations()[first]; v <= edges.stations()[last]; ++v)
            EXPECT_LE((edges.vertices()[v] - edges.centres().at(i)).norm(), static_cast<double>(edges.radii()[i]));
    }
}

}  // namespace
}  // namespace passung::shell
