#include "core/geometry/convex_faces.h"

#include <gtest/gtest.h>

#include <time.h>

#include <cmath>
#include <limits>

#include "tests/support/surface_cases.h"

namespace passung::geometry {
namespace {

double areaOf(const ConvexFaces& merged) {
    double area = 0.0;
    for (const ConvexFace& face : merged.faces) {
        Vec3 sum = Vec3::Zero();
        const Vec3& origin = merged.vertices[face.corners[0]];
        for (std::size_t i = 1; i + 1 < face.corners.size(); ++i)
            sum +=
                0.5 * (merged.vertices[face.corners[i]] - origin).cross(merged.vertices[face.corners[i + 1]] - origin);
        area += sum.norm();
    }
    return area;
}

TEST(ConvexFaces, ABoxHasSixFacesHoweverItsSidesAreCut) {
    // Truth: closed form: six sides, 2 (ab + bc + ca) of area.
    const auto box = mergeFlatTriangles(test::boxMesh({0, 0, 0}, {.01, .02, .03}));
    EXPECT_EQ(box.faces.size(), 6u);
    EXPECT_NEAR(areaOf(box), 2.0 * (.01 * .02 + .02 * .03 + .03 * .01), 1e-15);
    const auto cut = mergeFlatTriangles(test::seamedMesh({0, 0, 0}, {.01, .02, .03}, 8));
    EXPECT_LE(cut.faces.size(), 5u + 8u);
    EXPECT_NEAR(areaOf(cut), areaOf(box), 1e-12);
}

TEST(ConvexFaces, AFanOfADiscIsAFewFaces) {
    // Truth: closed form: the area of a regular polygon; a face has 64 corners at most, which 62 triangles with the hub
    // have, or all 60 without it.
    for (const int n : {60, 300}) {
        const auto disc = mergeFlatTriangles(test::fanMesh(test::circleLine(.01, n), {0, 0}, 0, true));
        EXPECT_EQ(disc.faces.size(), static_cast<std::size_t>(n <= 64 ? 1 : (n + 61) / 62)) << n;
        EXPECT_NEAR(areaOf(disc), 0.5 * n * 1e-4 * std::sin(2.0 * std::numbers::pi / n), 1e-15);
    }
}

/// Of this thread, the least of three times [s].
double secondsOf(const TriangleMesh& mesh) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        timespec begin{}, end{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
        EXPECT_FALSE(mergeFlatTriangles(mesh).faces.empty());
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
        least = std::min(least, static_cast<double>(end.tv_sec - begin.tv_sec) +
                                    1e-9 * static_cast<double>(end.tv_nsec - begin.tv_nsec));
    }
    return least;
}

TEST(ConvexFaces, ALargeHubTakesAsLongAsManySmallOnes) {
    // Truth: invariant: as many triangles around one hub and around two thousand. Were the sides of a hub looked
    // through one by one, the large one took forty times as long (planted); a busy machine makes it thrice.
    constexpr int kSides = 60, kHubs = 2000;
    const TriangleMesh one = test::fanMesh(test::circleLine(.01, kSides * kHubs), {0, 0}, 0, true);
    TriangleMesh many;
    for (int i = 0; i < kHubs; ++i)
        test::append(many, test::fanMesh(test::circleLine(.01, kSides), {0, 0}, 0.001 * i, true));
    ASSERT_EQ(one.triangles.size(), many.triangles.size());
    const double large = secondsOf(one), small = secondsOf(many);
    EXPECT_LT(large, 12.0 * small) << large << " s, " << small << " s";
}

TEST(ConvexFaces, CurvedSurfacesKeepTheirTriangles) {
    // Truth: invariant: no two triangles of a bumpy ball lie in a plane, but for those without area at its poles.
    const auto ball = test::bumpyMesh(.01, 12, 0.3);
    EXPECT_GT(mergeFlatTriangles(ball).faces.size(), ball.triangles.size() * 9 / 10);
}

}  // namespace
}  // namespace passung::geometry
