#include "core/model/mesh_block.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/base/random.h"
#include "core/model/interpolation.h"
#include "core/model/shape.h"

namespace passung::model {
namespace {

Vec3 placeOf(std::size_t i, std::size_t side) {
    return {static_cast<double>(i % side), static_cast<double>(i / side % side),
            static_cast<double>(i / (side * side))};
}

struct Case {
    Shape shape;
    double cell;
};

/// Fine and coarse cells, sharp edges, needles (a bore's sides) and faces that lie on nodes.
const std::vector<Case> kCases{{Sphere{0.03}, 0.4e-3},
                               {Torus{0.04, 0.012}, 1.5e-3},
                               {Box{0.02, 0.03, 0.04}, 1e-3},
                               {BorePlate{0.06, 0.06, 0.03, 0.0202, 0.025, 0.001}, 0.7e-3}};

/// Calls `check(low, block)` for blocks around the surface; every fourth begins at a corner of the part's box.
template <class Check>
void atSomeBlocks(const TriangleMesh& mesh, const MeshBlockSampler& sampler, double cell, const Check& check) {
    Random random(3);
    const auto block = std::make_unique<SurfaceBlock>();
    for (int i = 0; i < 16; ++i) {
        const Vec3& vertex = mesh.vertices[random.below(mesh.vertices.size())];
        const Vec3 shift(random.uniform(), random.uniform(), random.uniform());
        const Vec3 low = i % 4 == 0 ? Vec3(boundsOf(mesh).low - cell * Vec3(4.0, 4.0, 4.0))
                                    : Vec3(vertex - SurfaceBlock::kCells * cell * shift);
        sampler.sample(low, cell, *block);
        check(low, *block);
    }
}

TEST(MeshBlock, DistancesAndSignsAreThoseOfTheTreeAtEveryNodeAndCentre) {
    // Truth: TriangleTree (distance and winding number, tested on their own) at each point.
    for (const Case& c : kCases) {
        const TriangleMesh mesh = tessellate(c.shape, 5e-6);
        const auto tree = std::make_shared<const TriangleTree>(mesh);
        const double rounding = 1e-13;  // some hundred roundings of a coordinate of 0.1 m
        atSomeBlocks(mesh, MeshBlockSampler(tree, true), c.cell, [&](const Vec3& low, const SurfaceBlock& block) {
            for (std::size_t i = 0; i < SurfaceBlock::kAllNodes; ++i) {
                const Vec3 p = low + c.cell * placeOf(i, SurfaceBlock::kNodes);
                const double d = tree->closest(p).distance;
                ASSERT_NEAR(std::abs(block.node[i]), d, rounding) << kindName(c.shape);
                if (d > 1e-9) {
                    ASSERT_EQ(block.node[i] < 0.0, tree->inside(p)) << kindName(c.shape) << " " << p.transpose();
                }
            }
            for (std::size_t i = 0; i < SurfaceBlock::kAllCells; ++i) {
                const Vec3 p = low + c.cell * (placeOf(i, SurfaceBlock::kCells) + Vec3::Constant(0.5));
                ASSERT_NEAR(block.centre[i], tree->closest(p).distance, rounding) << kindName(c.shape);
            }
        });
    }
}

TEST(MeshBlock, DistanceTurnsInNoCellByMoreThanItsSlack) {
    // Truth: TriangleTree; the slack k claims |interpolant - φ| ≤ k Σ w |corner - p| in the cell.
    Random random(11);
    double tightest = 1.0;
    for (const Case& c : kCases) {
        const TriangleMesh mesh = tessellate(c.shape, 5e-6);
        const auto tree = std::make_shared<const TriangleTree>(mesh);
        atSomeBlocks(mesh, MeshBlockSampler(tree, true), c.cell, [&](const Vec3& low, const SurfaceBlock& block) {
            for (std::size_t i = 0; i < SurfaceBlock::kAllCells; ++i) {
                const Vec3 place = placeOf(i, SurfaceBlock::kCells);
                const Vec3 u(random.uniform(), random.uniform(), random.uniform());
                const Corners w = trilinearWeights(u);
                double value = 0.0, way = 0.0;
                for (std::size_t k = 0; k < 8; ++k) {
                    const Vec3 node = place + cornerAt(k);
                    value += w[k] * block.node[static_cast<std::size_t>(node.z() * 81.0 + node.y() * 9.0 + node.x())];
                    way += w[k] * c.cell * (cornerAt(k) - u).norm();
                }
                const Vec3 p = low + c.cell * (place + u);
                const double d = tree->closest(p).distance, phi = tree->inside(p) ? -d : d;
                ASSERT_LE(std::abs(value - phi), block.slack[i] * way + 1e-12) << kindName(c.shape);
                tightest = std::min(tightest, block.slack[i]);
            }
        });
    }
    EXPECT_LT(tightest, 1e-6);  // flat faces: linear
}

TEST(MeshBlock, ClaimsNothingAboutTheTurnOfTheDistanceWhereSolidsOverlap) {
    // Truth: invariant (faces inside a union have φ falling on both sides).
    TriangleMesh mesh = tessellate(Box{0.02, 0.02, 0.02}, 1e-6);
    const TriangleMesh other = tessellate(Box{0.02, 0.02, 0.02}, 1e-6);
    const auto shift = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& v : other.vertices) mesh.vertices.push_back(v + Vec3(0.011, 0.003, 0.002));
    for (const Triangle& t : other.triangles) mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    const auto tree = std::make_shared<const TriangleTree>(mesh);
    const auto block = std::make_unique<SurfaceBlock>();
    // Around x = 0.001, the second box's face inside the first.
    MeshBlockSampler(tree, true).sample(Vec3(-0.003, -0.004, -0.004), 1e-3, *block);
    for (const double slack : block->slack) EXPECT_EQ(slack, 1.0);
    for (const double phi : block->node) EXPECT_LE(phi, 0.0);
}

}  // namespace
}  // namespace passung::model
