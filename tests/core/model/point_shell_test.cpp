#include "core/model/point_shell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/model/shape.h"
#include "core/model/sphere_tree.h"
#include "tests/support/broken_mesh.h"

namespace passung::model {
namespace {

double meshArea(const TriangleMesh& mesh) {
    double area = 0.0;
    for (const auto& t : mesh.triangles) {
        area +=
            0.5 * (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm();
    }
    return area;
}

const std::vector<Shape> kShapes{Sphere{0.02}, Box{0.02, 0.01, 0.03}, Peg{0.01, 0.03, 0.001}, Sheet{0.03, 0.02}};
constexpr double kSpacing = 1e-3;

TEST(PointShell, AreasAddUpToTheSurfaceAndAreaVectorsCloseIt) {
    // Truth: closed form. Σ a = area of the mesh; Σ a n = 0 on a closed surface.
    for (const Shape& shape : kShapes) {
        const TriangleMesh mesh = tessellate(shape, 1e-6);
        const PointShell shell = samplePoints(mesh, kSpacing);
        double area = 0.0;
        Vec3 sum = Vec3::Zero();
        for (const auto& point : shell.points) {
            area += point.area;
            sum += point.area * point.normal;
        }
        EXPECT_NEAR(area, meshArea(mesh), 1e-9 * area) << kindName(shape);
        if (!std::holds_alternative<Sheet>(shape)) {
            EXPECT_LT(sum.norm(), 2e-3 * area) << kindName(shape);
        }
    }
}

TEST(PointShell, EveryPointOfTheSurfaceIsWithinTheCoverRadius) {
    // Truth: independent dense sampling of the shape's triangles (barycentric lattice).
    for (const Shape& shape : kShapes) {
        const TriangleMesh mesh = tessellate(shape, 5e-6);
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
        EXPECT_LE(farthest, shell.cover_radius) << kindName(shape);
        EXPECT_LT(shell.cover_radius, 1.6 * kSpacing) << kindName(shape);
    }
}

TEST(PointShell, KeepsItsSpacingOnFaces) {
    // Truth: invariant of a relaxed Poisson-disk set: no two samples of a face are much closer than the disk radius.
    const PointShell shell = samplePoints(tessellate(Sphere{0.02}, 1e-6), kSpacing);
    for (std::size_t i = 0; i < shell.points.size(); ++i) {
        for (std::size_t j = i + 1; j < shell.points.size(); ++j) {
            ASSERT_GT((shell.points[i].position - shell.points[j].position).norm(), 0.4 * kSpacing);
        }
    }
}

TEST(PointShell, SamplesEveryCornerAndRimOfABox) {
    // Truth: closed form. Eight corners exactly; along each edge no gap wider than half the spacing's disk.
    const PointShell shell = samplePoints(tessellate(Box{0.02, 0.01, 0.03}, 1e-6), kSpacing);
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 c((corner & 1) ? 0.01 : -0.01, (corner & 2) ? 0.005 : -0.005, (corner & 4) ? 0.015 : -0.015);
        double nearest = 1e300;
        for (const auto& point : shell.points) nearest = std::min(nearest, (point.position - c).norm());
        EXPECT_LT(nearest, 1e-12);
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
    for (const Shape& shape : kShapes) {
        const PointShell shell = samplePoints(tessellate(shape, 1e-6), kSpacing);
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

TEST(SphereTree, DoesNotJoinTheTwoSidesOfAThinWall) {
    // Truth: invariant. A wall thinner than the spacing: the points of a leaf face the same way, edge samples apart.
    const SphereTree tree(samplePoints(tessellate(Box{0.02, 0.02, 0.3e-3}, 1e-6), kSpacing));
    for (const SphereNode& node : tree.nodes()) {
        if (!node.leaf) continue;
        const SurfacePoint* first = nullptr;
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const SurfacePoint& point = tree.points()[i];
            if (point.area == 0.0) continue;
            if (first == nullptr) first = &point;
            ASSERT_GT(point.normal.dot(first->normal), -0.5);
        }
    }
}

TEST(PointShell, EveryTriangleHasASampleNearThatFacesItWithin60Degrees) {
    // Truth: invariant. Wavy balls no larger than the disk of a sample, divided by direction alone: relaxed samples
    // turn away from a part of their patch. Triangles are so small that each is one candidate, and a sample lies on the
    // middle of one, which gives its direction.
    for (const double diameter : {0.4e-3, 0.8e-3, 1.2e-3, 1.6e-3, 2.0e-3}) {
        const TriangleMesh mesh = test::wavySphere(diameter, 2.5e-4 * diameter);
        const PointShell shell = samplePoints(mesh, kSpacing);
        std::vector<Vec3> middles, normals;
        for (const auto& t : mesh.triangles) {
            const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
            middles.push_back((a + b + c) / 3.0);
            normals.push_back((b - a).cross(c - a).normalized());
        }
        std::vector<std::size_t> samples;
        for (const auto& point : shell.points)
            for (std::size_t i = 0; i < middles.size(); ++i)
                if (point.area > 0.0 && (middles[i] - point.position).norm() < 1e-12) samples.push_back(i);
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
    const TriangleMesh mesh = tessellate(Sphere{0.02}, 1e-5);
    const PointShell a = samplePoints(mesh, kSpacing), b = samplePoints(mesh, kSpacing);
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); ++i) EXPECT_EQ(a.points[i].position, b.points[i].position);
}

}  // namespace
}  // namespace passung::model
