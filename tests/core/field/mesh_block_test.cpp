#include "core/field/mesh_block.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/base/random.h"
#include "core/field/interpolation.h"
#include "core/import/self_intersection.h"
#include "core/shape/shape.h"

namespace passung::field {
namespace {

Vec3 placeOf(std::size_t i, std::size_t side) {
    return {static_cast<double>(i % side), static_cast<double>(i / side % side),
            static_cast<double>(i / (side * side))};
}

struct Case {
    shape::Shape shape;
    double cell;
};

/// Fine and coarse cells, sharp edges, needles (a bore's sides) and faces that lie on nodes.
const std::vector<Case> kCases{{shape::Sphere{0.03}, 0.4e-3},
                               {shape::Torus{0.04, 0.012}, 1.5e-3},
                               {shape::Box{0.02, 0.03, 0.04}, 1e-3},
                               {shape::BorePlate{0.06, 0.06, 0.03, 0.0202, 0.025, 0.001}, 0.7e-3}};

/// Calls `check(low, block)` for blocks around the surface; every fourth begins at a corner of the part's box.
template <class Check>
void atSomeBlocks(const geometry::TriangleMesh& mesh, const MeshBlockSampler& sampler, double cell,
                  const Check& check) {
    Random random(3);
    const auto block = std::make_unique<SurfaceBlock>();
    for (int i = 0; i < 16; ++i) {
        const Vec3& vertex = mesh.vertices[random.below(mesh.vertices.size())];
        const Vec3 shift(random.uniform(), random.uniform(), random.uniform());
        const Vec3 low = i % 4 == 0 ? Vec3(geometry::boundsOf(mesh).low - cell * Vec3(4.0, 4.0, 4.0))
                                    : Vec3(vertex - SurfaceBlock::kCells * cell * shift);
        sampler.sample(low, cell, *block);
        check(low, *block);
    }
}

TEST(MeshBlock, DistancesAndSignsAreThoseOfTheTreeAtEveryNodeAndInEveryCell) {
    // Truth: TriangleTree (distance and winding number, tested on their own) at each point, and at one of each cell
    // from the triangles that it names.
    Random random(7);
    for (const Case& c : kCases) {
        const geometry::TriangleMesh mesh = shape::tessellate(c.shape, 5e-6);
        const auto tree = std::make_shared<const geometry::TriangleTree>(mesh);
        const double rounding = 1e-13;  // some hundred roundings of a coordinate of 0.1 m
        const MeshBlockSampler sampler(tree, true, true);
        atSomeBlocks(mesh, sampler, c.cell, [&](const Vec3& low, const SurfaceBlock& block) {
            for (std::size_t i = 0; i < SurfaceBlock::kAllNodes; ++i) {
                const Vec3 p = low + c.cell * placeOf(i, SurfaceBlock::kNodes);
                const double d = tree->closest(p).distance;
                ASSERT_NEAR(std::abs(block.node[i]), d, rounding) << shape::kindName(c.shape);
                if (d > 1e-9) {
                    ASSERT_EQ(block.node[i] < 0.0, tree->inside(p)) << shape::kindName(c.shape) << " " << p.transpose();
                }
            }
            for (std::size_t i = 0; i < SurfaceBlock::kAllCells; ++i) {
                const Vec3 p = low + c.cell * (placeOf(i, SurfaceBlock::kCells) + Vec3::Constant(0.5));
                ASSERT_NEAR(block.centre[i], tree->closest(p).distance, rounding) << shape::kindName(c.shape);
                const Vec3 in =
                    p + 0.5 * c.cell * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
                ASSERT_NEAR(sampler.distance(in, block.trianglesOf(i)), tree->closest(in).distance, rounding)
                    << shape::kindName(c.shape);
            }
        });
    }
}

TEST(MeshBlock, DistanceTurnsInNoCellByMoreThanItsSlack) {
    // Truth: TriangleTree; the slack k claims |interpolant - φ| ≤ k Σ w |corner - p| in the cell.
    Random random(11);
    double tightest = 1.0;
    for (const Case& c : kCases) {
        const geometry::TriangleMesh mesh = shape::tessellate(c.shape, 5e-6);
        const auto tree = std::make_shared<const geometry::TriangleTree>(mesh);
        atSomeBlocks(mesh, MeshBlockSampler(tree, true, true), c.cell, [&](const Vec3& low, const SurfaceBlock& block) {
            for (std::size_t i = 0; i < SurfaceBlock::kAllCells; ++i) {
                const Vec3 place = placeOf(i, SurfaceBlock::kCells);
                const Vec3 u(random.uniform(), random.uniform(), random.uniform());
                const CornerValues w = trilinearWeights(u);
                double value = 0.0, way = 0.0;
                for (std::size_t k = 0; k < 8; ++k) {
                    const Vec3 node = place + cornerAt(k);
                    value += w[k] * block.node[static_cast<std::size_t>(node.z() * 81.0 + node.y() * 9.0 + node.x())];
                    way += w[k] * c.cell * (cornerAt(k) - u).norm();
                }
                const Vec3 p = low + c.cell * (place + u);
                const double d = tree->closest(p).distance, phi = tree->inside(p) ? -d : d;
                ASSERT_LE(std::abs(value - phi), block.slack[i] * way + 1e-12) << shape::kindName(c.shape);
                tightest = std::min(tightest, block.slack[i]);
            }
        });
    }
    EXPECT_LT(tightest, 1e-6);  // flat faces: linear
}

/// Two boxes: a second one that overlaps the first, or lies inside it.
geometry::TriangleMesh twoBoxes(double second, const Vec3& shift) {
    geometry::TriangleMesh mesh = shape::tessellate(shape::Box{0.02, 0.02, 0.02}, 1e-6);
    const geometry::TriangleMesh other = shape::tessellate(shape::Box{second, second, second}, 1e-6);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& v : other.vertices) mesh.vertices.push_back(v + shift);
    for (const geometry::Triangle& t : other.triangles)
        mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    return mesh;
}

TEST(MeshBlock, SlackHoldsWhereSolidsOverlapOrContainEachOther) {
    // Truth: TriangleTree; between the faces inside a union φ falls on both sides. Blocks end everywhere between them.
    Random random(5);
    for (const geometry::TriangleMesh& mesh :
         {twoBoxes(0.02, Vec3(0.0085, 0.003, 0.002)), twoBoxes(0.0138, Vec3::Zero()),
          twoBoxes(0.0138, Vec3(0.03, 0.0, 0.0))}) {
        const bool apart = mesh.vertices.back().x() > 0.03;
        const auto tree = std::make_shared<const geometry::TriangleTree>(mesh);
        const MeshBlockSampler sampler(tree, true, importer::crossingsOf(mesh).triangles == 0);
        const auto block = std::make_unique<SurfaceBlock>();
        int linear = 0;
        for (int i = 0; i < 60; ++i) {
            const double cell = i % 2 == 0 ? 1e-3 : 0.3e-3;
            Vec3 low;
            for (int axis = 0; axis < 3; ++axis) low[axis] = random.uniform(-0.012, 0.022) - 4.0 * cell;
            sampler.sample(low, cell, *block);
            for (std::size_t k = 0; k < SurfaceBlock::kAllCells; ++k) {
                const Vec3 place = placeOf(k, SurfaceBlock::kCells);
                const Vec3 u(random.uniform(), random.uniform(), random.uniform());
                const CornerValues w = trilinearWeights(u);
                double value = 0.0, way = 0.0;
                for (std::size_t c = 0; c < 8; ++c) {
                    const Vec3 node = place + cornerAt(c);
                    value += w[c] * block->node[static_cast<std::size_t>(node.z() * 81.0 + node.y() * 9.0 + node.x())];
                    way += w[c] * cell * (cornerAt(c) - u).norm();
                }
                const Vec3 p = low + cell * (place + u);
                const double d = tree->closest(p).distance, phi = tree->inside(p) ? -d : d;
                ASSERT_LE(std::abs(value - phi), block->slack[k] * way + 1e-12) << p.transpose();
                linear += block->slack[k] < 1e-6 ? 1 : 0;
            }
        }
        EXPECT_EQ(linear > 1000, apart) << linear;  // what holds everywhere is claimed of the boxes apart only
    }
}

TEST(MeshBlock, WorksFarFromTheOriginWhereCoordinatesAreCoarse) {
    // Truth: TriangleTree. At 64 m the spacing of numbers doubles: corners of a cube round to different sides.
    geometry::TriangleMesh mesh = shape::tessellate(shape::Box{0.0426, 0.03, 0.02}, 1e-6);
    Random random(9);
    for (int i = 0; i < 60; ++i) {
        geometry::TriangleMesh moved = mesh;
        const Vec3 shift(64.0 - 0.0213 * random.uniform(), 64.0 * random.uniform(), 0.01);
        for (Vec3& v : moved.vertices) v += shift;
        const auto tree = std::make_shared<const geometry::TriangleTree>(moved);
        const MeshBlockSampler sampler(tree, true, true);
        const auto block = std::make_unique<SurfaceBlock>();
        const Vec3 low =
            geometry::boundsOf(moved).low - 1e-4 * Vec3(random.uniform(), random.uniform(), random.uniform());
        sampler.sample(low, 0.376e-3, *block);
        for (std::size_t k = 0; k < SurfaceBlock::kAllNodes; k += 7)
            ASSERT_NEAR(std::abs(block->node[k]),
                        tree->closest(low + 0.376e-3 * placeOf(k, SurfaceBlock::kNodes)).distance, 1e-12);
    }
}

}  // namespace
}  // namespace passung::field
