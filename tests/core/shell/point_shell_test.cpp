#include "core/shell/point_shell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/base/single_precision.h"
#include "core/geometry/triangle_distance.h"
#include "core/shape/shape.h"
#include "core/shell/enclosing_ball.h"
#include "core/shell/sphere_tree.h"
#include "tests/support/broken_mesh.h"

namespace passung::shell {
namespace {

double meshArea(const geometry::TriangleMesh& mesh) {
    double area = 0.0;
    for (const auto& t : mesh.triangles) {
        area +=
            0.5 * (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm();
    }
    return area;
}

const std::vector<shape::Shape> kShapes{shape::Sphere{0.02}, shape::Box{0.02, 0.01, 0.03},
                                        shape::Peg{0.01, 0.03, 0.001}, shape::Sheet{0.03, 0.02}};
constexpr double kSpacing = 1e-3;

TEST(PointShell, AreasAddUpToTheSurfaceAndAreaVectorsCloseIt) {
    // Truth: closed form. Σ a = area of the mesh; Σ a n = 0 on a closed surface.
    for (const shape::Shape& shape : kShapes) {
        const geometry::TriangleMesh mesh = shape::tessellate(shape, 1e-6);
        const PointShell shell = samplePoints(mesh, kSpacing);
        double area = 0.0;
        Vec3 sum = Vec3::Zero();
        for (const auto& point : shell.points) {
            area += point.area;
            sum += point.area * point.normal;
        }
        EXPECT_NEAR(area, meshArea(mesh), 1e-9 * area) << shape::kindName(shape);
        if (!std::holds_alternative<shape::Sheet>(shape)) {
            EXPECT_LT(sum.norm(), 2e-3 * area) << shape::kindName(shape);
        }
    }
}

TEST(PointShell, EveryPointOfTheSurfaceIsWithinTheCoverRadius) {
    // Truth: independent dense sampling of the shape's triangles (barycentric lattice).
    for (const shape::Shape& shape : kShapes) {
        const geometry::TriangleMesh mesh = shape::tessellate(shape, 5e-6);
        const PointShell shell = samplePoints(mesh, kSpacing);
        double farthest = 0.0;
        for (const auto& t : mesh.triangles) {
            for (int i = 0; i <= 4; ++i) {
                for (int j = 0; j <= 4 - i; ++j) {
                    const Vec3 p =
                        (i * mesh.vertices[t[0]] + j * mesh.vertices[t[1]] + (4 - i - j) * mesh.vertices[t[2]]) / 4;
                    double nearest = 1e300;
                    for (const auto& point : shell.points)
                        nearest = std::min(nearest, (point.position - p).squaredNorm());
                    farthest = std::max(farthest, std::sqrt(nearest));
                }
            }
        }
        EXPECT_LE(farthest, shell.cover_radius) << shape::kindName(shape);
        EXPECT_LT(shell.cover_radius, 1.6 * kSpacing) << shape::kindName(shape);
    }
}

TEST(PointShell, KeepsItsSpacingOnFaces) {
    // Truth: invariant of a relaxed Poisson-disk set: no two samples of a face are much closer than the disk radius.
    const PointShell shell = samplePoints(shape::tessellate(shape::Sphere{0.02}, 1e-6), kSpacing);
    for (std::size_t i = 0; i < shell.points.size(); ++i) {
        for (std::size_t j = i + 1; j < shell.points.size(); ++j) {
            ASSERT_GT((shell.points[i].position - shell.points[j].position).norm(), 0.4 * kSpacing);
        }
    }
}

TEST(PointShell, SamplesEveryCornerAndRimOfABox) {
    // Truth: closed form. Eight corners exactly, rounded to floats; along each edge no gap wider than half the
    // spacing's disk.
    const PointShell shell = samplePoints(shape::tessellate(shape::Box{0.02, 0.01, 0.03}, 1e-6), kSpacing);
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 exact((corner & 1) ? 0.01 : -0.01, (corner & 2) ? 0.005 : -0.005, (corner & 4) ? 0.015 : -0.015);
        const Vec3 c = roundedToFloat(exact);
        double nearest = 1e300;
        for (const auto& point : shell.points) nearest = std::min(nearest, (point.position - c).norm());
        EXPECT_EQ(nearest, 0.0);
    }
    for (double x = -0.01; x <= 0.01; x += 1e-4) {
        double nearest = 1e300;
        for (const auto& point : shell.points) {
            nearest = std::min(nearest, (point.position - Vec3(x, 0.005, 0.015)).norm());
        }
        EXPECT_LT(nearest, 0.75 * kSpacing);
    }
}

TEST(SphereTree, EverySphereHoldsAllPointsBelowAndEveryLevelTheWholeSurface) {
    // Truth: invariant, checked by descending from every node.
    for (const shape::Shape& shape : kShapes) {
        const PointShell shell = samplePoints(shape::tessellate(shape, 1e-6), kSpacing);
        const SphereTree tree(shell);
        ASSERT_EQ(tree.points().size(), shell.points.size());
        std::vector<int> seen(tree.points().size(), 0);
        std::vector<std::pair<std::uint32_t, std::vector<std::uint32_t>>> stack;  // node, its ancestors
        double root_area = 0.0;
        for (std::uint32_t r = 0; r < tree.roots().size(); ++r) {
            stack.push_back({r, {r}});
            root_area += tree.nodes()[r].area;
        }
        EXPECT_NEAR(root_area, tree.totalArea(), 1e-9 * tree.totalArea());
        while (!stack.empty()) {
            const auto [index, ancestors] = stack.back();
            stack.pop_back();
            const SphereNode& node = tree.nodes()[index];
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                if (!node.leaf) {
                    auto chain = ancestors;
                    chain.push_back(i);
                    stack.push_back({i, chain});
                    continue;
                }
                ++seen[i];
                for (const std::uint32_t a : ancestors) {
                    const SphereNode& above = tree.nodes()[a];
                    ASSERT_LE((tree.points()[i].position - above.centre).norm(), above.radius * (1 + 1e-9));
                }
            }
        }
        for (const int count : seen) ASSERT_EQ(count, 1);
    }
}

/// The points below each node, as the tree lays them out.
std::vector<std::pair<std::uint32_t, std::uint32_t>> pointsBelow(const SphereTree& tree) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> below(tree.nodes().size());
    for (std::size_t i = below.size(); i-- > 0;) {
        const SphereNode& node = tree.nodes()[i];
        below[i] = node.leaf ? std::pair(node.first, node.first + node.count)
                             : std::pair(below[node.first].first, below[node.first + node.count - 1].second);
    }
    return below;
}

TEST(SphereTree, NoClusterJoinsTheTwoSidesOfAThinWall) {
    // Truth: invariant. A wall thinner than the spacing: all points on faces below any node but the roots face within
    // 120° of each other.
    for (const shape::Shape& shape :
         {shape::Shape(shape::Box{0.02, 0.02, 0.3e-3}), shape::Shape(shape::Peg{0.01, 0.03, 0.001})}) {
        const SphereTree tree(samplePoints(shape::tessellate(shape, 1e-6), kSpacing));
        const auto below = pointsBelow(tree);
        for (std::size_t k = tree.roots().size(); k < below.size(); ++k) {
            const auto [begin, end] = below[k];
            for (std::uint32_t i = begin; i < end; ++i) {
                for (std::uint32_t j = begin; j < i; ++j) {
                    const SurfacePoint &a = tree.points()[i], &b = tree.points()[j];
                    if (a.area > 0.0 && b.area > 0.0) {
                        ASSERT_GT(a.normal.dot(b.normal), -0.5 - 1e-6) << shape::kindName(shape);
                    }
                }
            }
        }
    }
}

TEST(SphereTree, EveryNodeCarriesTheAreaVectorOfItsPointsAndOneOfThemStandsForThem) {
    // Truth: invariant, sums over the points below.
    const SphereTree tree(samplePoints(shape::tessellate(shape::Shape(shape::Peg{0.01, 0.03, 0.001}), 1e-6), kSpacing));
    const auto below = pointsBelow(tree);
    for (std::size_t k = 0; k < below.size(); ++k) {
        const SphereNode& node = tree.nodes()[k];
        double area = 0.0;
        Vec3 vector = Vec3::Zero();
        bool member = false;
        for (std::uint32_t i = below[k].first; i < below[k].second; ++i) {
            area += tree.points()[i].area;
            vector += tree.points()[i].area * tree.points()[i].normal;
            member = member || tree.points()[i].position == node.point;
        }
        ASSERT_TRUE(member);
        ASSERT_NEAR(node.area, area, 1e-12 * tree.totalArea());
        ASSERT_LT((node.facing_area * node.normal - vector).norm(), 1e-12 * tree.totalArea());
        ASSERT_LE(node.facing_area, node.area * (1.0 + 1e-12));
    }
}

TEST(SphereTree, ChildrenFollowLevelByLevelAndLeavesAreSmall) {
    // Truth: invariant. Breadth first: the children of the nodes, in order, are all other nodes, in order; the points
    // of the leaves fill the shell. The arrays by axis hold the same numbers.
    const auto at = [](const FloatPositions& positions, std::size_t i) {
        return Eigen::Vector3f(positions.x(i, 1)[0], positions.y(i, 1)[0], positions.z(i, 1)[0]).cast<double>().eval();
    };
    const SphereTree tree(samplePoints(shape::tessellate(shape::Shape(shape::Sphere{0.04}), 1e-6), 0.5e-3));
    std::size_t next = tree.roots().size();
    std::size_t points = 0;
    for (const SphereNode& node : tree.nodes()) {
        if (node.leaf) {
            EXPECT_LE(node.count, SphereTree::kLeafPoints);
            points += node.count;
            continue;
        }
        EXPECT_EQ(node.first, next);
        EXPECT_LE(node.count, SphereTree::kChildren);
        next += node.count;
    }
    EXPECT_EQ(next, tree.nodes().size());
    EXPECT_EQ(points, tree.points().size());
    for (std::size_t i = 0; i < tree.points().size(); ++i)
        ASSERT_EQ(at(tree.positions(), i), tree.points()[i].position);
    for (std::size_t i = 0; i < tree.nodes().size(); ++i) ASSERT_EQ(at(tree.centres(), i), tree.nodes()[i].centre);
}

TEST(EnclosingBall, IsTheSmallestOfRandomPointsAndOfKnownSolids) {
    // Truth: closed form of a cube, a segment and one point; else an invariant: a ball is smallest if and only if no
    // direction leads away from all points on its surface, tried in many directions.
    const auto ballOf = [](const std::vector<Vec3>& places) {
        std::vector<SurfacePoint> points;
        for (const Vec3& p : places) points.push_back({p, Vec3::UnitZ(), 0.0});
        return enclosingBall(points);
    };
    std::vector<Vec3> cube;
    for (int i = 0; i < 8; ++i) cube.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
    EXPECT_NEAR(ballOf(cube).radius, std::sqrt(0.75), 1e-9);
    EXPECT_NEAR(ballOf({Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0.5, 0.1, 0)}).radius, 1.0, 1e-9);
    EXPECT_LT(ballOf({Vec3(1, 2, 3)}).radius, 1e-9);
    Random random(7);
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<Vec3> places;
        const int count = 2 + static_cast<int>(random.below(40));
        for (int i = 0; i < count; ++i)
            places.emplace_back(random.normal(), random.normal(), trial % 3 == 0 ? 0.0 : random.normal());
        const Ball ball = ballOf(places);
        std::vector<Vec3> holding;
        for (const Vec3& p : places) {
            ASSERT_LE((p - ball.centre).norm(), ball.radius);
            if ((p - ball.centre).norm() > ball.radius * (1.0 - 1e-9)) holding.push_back(p - ball.centre);
        }
        for (int i = 0; i < 200; ++i) {
            const Vec3 d = Vec3(random.normal(), random.normal(), random.normal()).normalized();
            const bool better = std::all_of(holding.begin(), holding.end(),
                                            [&](const Vec3& p) { return p.dot(d) > 1e-6 * ball.radius; });
            ASSERT_FALSE(better) << "trial " << trial;
        }
    }
}

TEST(PointShell, CoordinatesAreFloatsAndLieOnTheSurfaceUpToTheirRounding) {
    // Truth: closed form of a box, whose triangles lie exactly in its faces.
    const shape::Shape box = shape::Box{0.02, 0.01, 0.03};
    const PointShell shell = samplePoints(shape::tessellate(box, 1e-6), kSpacing);
    EXPECT_LT(shell.rounding, 1e-8);
    double farthest = 0.0;
    for (const auto& point : shell.points) {
        EXPECT_EQ(point.position, roundedToFloat(point.position));
        farthest = std::max(farthest, std::abs(shape::signedDistance(box, point.position)));
    }
    EXPECT_LE(farthest, shell.rounding);
    EXPECT_GT(farthest, 0.0);
}

TEST(PointShell, SumsOverPatchesAreExactForWhatChangesLinearly) {
    // Truth: closed form. On a face z = h of a box: ∫ x dA = 0 and ∫ x² dA = w³d/12. A point at the middle of its patch
    // makes the first exact up to the rounding of floats; a patch about one spacing s wide leaves of the second about
    // its own moment, s²/12 per area (twice that is allowed).
    const double w = 0.02, d = 0.01;
    const PointShell shell = samplePoints(shape::tessellate(shape::Box{w, d, 0.03}, 1e-6), kSpacing);
    double area = 0.0, first = 0.0, second = 0.0;
    for (const auto& point : shell.points) {
        if (!(point.normal.z() > 0.99)) continue;
        area += point.area;
        first += point.area * (point.position.x() + 0.3 * point.position.y());
        second += point.area * point.position.x() * point.position.x();
    }
    EXPECT_NEAR(area, w * d, 1e-9 * area);
    EXPECT_NEAR(first, 0.0, 1e-7 * area * w);
    EXPECT_NEAR(second, w * w * w * d / 12.0, area * kSpacing * kSpacing / 6.0);
}

TEST(PointShell, EveryTriangleHasASampleNearThatFacesItWithin60Degrees) {
    // Truth: invariant. Wavy balls no larger than the disk of a sample, divided by direction alone: relaxed samples
    // turn away from a part of their patch. Triangles are so small that each is one candidate, and a sample lies on
    // one, up to its rounding, which gives its direction; on an edge of two, either.
    for (const double diameter : {0.4e-3, 0.8e-3, 1.2e-3, 1.6e-3, 2.0e-3}) {
        const geometry::TriangleMesh mesh = test::wavySphere(diameter, 2.5e-4 * diameter);
        const PointShell shell = samplePoints(mesh, kSpacing);
        std::vector<Vec3> middles, normals;
        for (const auto& t : mesh.triangles) {
            const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
            middles.push_back((a + b + c) / 3.0);
            normals.push_back((b - a).cross(c - a).normalized());
        }
        std::vector<std::size_t> samples;
        for (const auto& point : shell.points)
            for (std::size_t i = 0; i < middles.size(); ++i) {
                const auto& t = mesh.triangles[i];
                const Vec3 on = geometry::closestOnTriangle(point.position, mesh.vertices[t[0]], mesh.vertices[t[1]],
                                                            mesh.vertices[t[2]]);
                if (point.area > 0.0 && (on - point.position).norm() <= shell.rounding) samples.push_back(i);
            }
        ASSERT_GT(samples.size(), 4u);
        for (std::size_t i = 0; i < middles.size(); ++i) {
            const bool faced = std::any_of(samples.begin(), samples.end(), [&](std::size_t s) {
                return normals[s].dot(normals[i]) > 0.5 - 1e-9 && (middles[s] - middles[i]).norm() < 1.5 * kSpacing;
            });
            ASSERT_TRUE(faced) << "ball of " << diameter << " at " << middles[i].transpose();
        }
    }
}

TEST(PointShell, IsTheSameEveryTime) {
    // Truth: invariant (fixed seed).
    const geometry::TriangleMesh mesh = shape::tessellate(shape::Sphere{0.02}, 1e-5);
    const PointShell a = samplePoints(mesh, kSpacing), b = samplePoints(mesh, kSpacing);
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); ++i) EXPECT_EQ(a.points[i].position, b.points[i].position);
}

TEST(SphereTree, EveryPointLiesOnItsTriangleAndInOneGroupThatWeighsTheSame) {
    // Truth: invariant.
    for (const shape::Shape& shape : {shape::Shape(shape::Peg{0.01, 0.03, 0.001}),
                                      shape::Shape(shape::BorePlate{0.03, 0.03, 0.01, 0.01, 0.01, 0.001})}) {
        const geometry::TriangleMesh mesh = shape::tessellate(shape, 1e-6);
        const PointShell shell = samplePoints(mesh, 0.7e-3);
        const SphereTree tree(shell, mesh);
        for (const SurfacePoint& p : tree.points()) {
            ASSERT_LT(p.triangle, mesh.triangles.size());
            const auto& t = mesh.triangles[p.triangle];
            const Vec3 on =
                geometry::closestOnTriangle(p.position, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
            ASSERT_LT((on - p.position).norm(), tree.rounding() * (1.0 + 1e-9));
        }
        const auto first = tree.groupPoints();
        std::size_t next = 0;
        for (std::size_t g = 0; g + 1 < first.size(); ++g) {
            ASSERT_EQ(first[g], next);
            next = first[g + 1];
            ASSERT_GT(next, first[g]);
            ASSERT_LE(next, first[g] + SphereTree::kGroupPoints);
            Vec3 vector = Vec3::Zero();
            for (std::size_t i = first[g]; i < next; ++i) {
                const SurfacePoint& point = tree.points()[i];
                vector += point.area * point.normal;
                ASSERT_LE((point.position - tree.groupPositions().at(g)).norm(),
                          static_cast<double>(tree.groupRadii()[g]));
                // Floats: half a unit in the last place of a number up to 1.
                ASSERT_LT((tree.facings()[i].normal.cast<double>() - point.normal).norm(), 1e-7);
                ASSERT_NEAR(static_cast<double>(tree.facings()[i].area), point.area, 1e-7 * point.area);
            }
            const Facing& facing = tree.groupFacings()[g];
            const Vec3 weighs = static_cast<double>(facing.area) * facing.normal.cast<double>();
            ASSERT_LT((weighs - vector).norm(), 3e-7 * vector.norm() + 1e-20);
        }
        ASSERT_EQ(next, tree.points().size());
        for (const SphereNode& node : tree.nodes())
            if (node.leaf) {
                ASSERT_EQ(first[node.first_group], node.first);
            }
    }
}

}  // namespace
}  // namespace passung::shell
