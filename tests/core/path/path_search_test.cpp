#include "core/path/search/path_search.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "core/scene/scene.h"
#include "core/shape/shape.h"

// Paths that no straight pull finds, and places that no path leads out of; judged by the separating axes of boxes.

namespace passung::path {
namespace {

constexpr double kMm = 1e-3;
constexpr double kTouch = 2e-6;  // [m]: deeper is an overlap
constexpr double kDense = 2e-4;  // between judged poses [m]

struct Block {
    Vec3 size;
    Pose X;
};

Block block(const Vec3& low, const Vec3& high) {
    return {kMm * (high - low), {Quat::Identity(), kMm * 0.5 * (low + high)}};
}

/// A corridor of 11 x 11 mm, 30 mm along x, then along y to its mouth at y = 40 mm. `closed`: without a mouth.
std::vector<Block> corridor(bool closed) {
    std::vector<Block> walls{block({-10, -10, -10}, {60, 60, 0}), block({-10, -10, 11}, {60, 60, 21}),
                             block({-10, -10, 0}, {0, 21, 11}),   block({0, -10, 0}, {40, 0, 11}),
                             block({0, 11, 0}, {19, 40, 11}),     block({30, 0, 0}, {40, 40, 11})};
    if (closed) walls.push_back(block({0, 40, 0}, {40, 50, 11}));
    return walls;
}

/// How far two boxes overlap at most, by the least of their separating axes; below 0 they are apart [m].
double overlapOf(const Block& a, const Block& b) {
    const Mat3 R_a = a.X.q.toRotationMatrix(), R_b = b.X.q.toRotationMatrix();
    std::vector<Vec3> axes;
    for (int i = 0; i < 3; ++i) {
        axes.insert(axes.end(), {R_a.col(i), R_b.col(i)});
        for (int k = 0; k < 3; ++k)
            if (const Vec3 cross = R_a.col(i).cross(R_b.col(k)); cross.norm() > 1e-6)
                axes.push_back(cross.normalized());
    }
    double least = 1.0;
    for (const Vec3& axis : axes) {
        const auto half = [&axis](const Mat3& R, const Vec3& size) {
            return 0.5 * (R.transpose() * axis).cwiseAbs().dot(size);
        };
        least = std::min(least, half(R_a, a.size) + half(R_b, b.size) - std::abs(axis.dot(b.X.p - a.X.p)));
    }
    return least;
}

class PathSearch : public testing::Test {
protected:
    scene::PartSpec specOf(const Block& of, bool held) {
        return {.name = "block " + std::to_string(++made_),
                .geometry = shape::Shape(shape::Box{of.size.x(), of.size.y(), of.size.z()}),
                .X_WP = of.X,
                .held = held};
    }

    /// The path of a cube of 10 mm; nothing if none is found.
    std::optional<std::vector<Pose>> find(const std::vector<Block>& walls, const Pose& start, const Pose& goal,
                                          double seconds) {
        scene::PartCache cache;
        std::vector<std::shared_ptr<const scene::Part>> parts;
        std::vector<RestingPart> standing;
        for (const Block& wall : walls) {
            parts.push_back(*cache.get(specOf(wall, false), {}));
            standing.push_back({parts.back().get(), wall.X});
        }
        const auto cube = *cache.get(specOf({Vec3::Constant(10 * kMm), start}, true), {});
        const FreeRoom room(*cube, standing, true);
        return findPath(room, start, goal, {seconds});
    }

    int made_ = 0;
};

void expectFree(const std::vector<Pose>& path, const std::vector<Block>& walls) {
    int judged = 0;
    double deepest = -1.0;
    for (std::size_t i = 1; i < path.size(); ++i) {
        const double way = wayBetween(path[i - 1], path[i], 9 * kMm);
        const int steps = 1 + static_cast<int>(way / kDense);
        for (int step = 0; step <= steps; ++step, ++judged) {
            const Pose X = poseBetween(path[i - 1], path[i], static_cast<double>(step) / steps);
            for (const Block& wall : walls) deepest = std::max(deepest, overlapOf({Vec3::Constant(10 * kMm), X}, wall));
        }
    }
    EXPECT_GT(judged, 400);
    EXPECT_LE(deepest, kTouch);
}

TEST_F(PathSearch, GoesRoundABendThatNoStraightPullLeadsOutOf) {
    // Truth: separating axes of boxes at dense poses; from the corridor's end no way leads straight to the mouth.
    const std::vector<Block> walls = corridor(false);
    const Pose inside{Quat::Identity(), Vec3(5.5, 5.5, 5.5) * kMm}, outside{Quat::Identity(), Vec3(24, 120, 5.5) * kMm};
    seedSearches(3);
    const auto path = find(walls, outside, inside, 240.0);
    ASSERT_TRUE(path);
    EXPECT_LT((path->front().p - outside.p).norm() + (path->back().p - inside.p).norm(), 1e-12);
    EXPECT_GT(path->size(), 3u);
    expectFree(*path, walls);
}

TEST_F(PathSearch, FindsNoneOutOfAClosedCorridor) {
    // Truth: by construction; a cube of 10 mm passes no wall.
    const Pose inside{Quat::Identity(), Vec3(5.5, 5.5, 5.5) * kMm}, outside{Quat::Identity(), Vec3(24, 120, 5.5) * kMm};
    EXPECT_FALSE(find(corridor(true), outside, inside, 2.0));
}

TEST_F(PathSearch, GoesRoundAWallThatStandsInTheStraightWay) {
    // Truth: as above.
    const std::vector<Block> walls{block({-5, -60, -60}, {5, 60, 60})};
    const Pose start{Quat::Identity(), Vec3(-40, 0, 0) * kMm}, goal{Quat::Identity(), Vec3(40, 0, 0) * kMm};
    const auto path = find(walls, start, goal, 20.0);
    ASSERT_TRUE(path);
    expectFree(*path, walls);
}

}  // namespace
}  // namespace passung::path
