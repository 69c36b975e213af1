#include "core/field/shape_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/field/distance_field.h"
#include "core/field/interpolation.h"
#include "core/scene/part.h"

namespace passung::field {
namespace {

const std::vector<shape::Shape> kShapes{shape::Sphere{0.01},
                                        shape::Box{0.01, 0.015, 0.02},
                                        shape::Cylinder{0.01, 0.015},
                                        shape::Torus{0.02, 0.006},
                                        shape::Sheet{0.02, 0.03},
                                        shape::Peg{0.01, 0.02, 0.001},
                                        shape::SquarePeg{0.01, 0.008, 0.02, 0.001},
                                        shape::KeyedPeg{0.01, 0.02, 0.003, 0.0015, 0.0005},
                                        shape::BorePlate{0.03, 0.03, 0.02, 0.01, 0.015, 0.001},
                                        shape::BorePlate{0.03, 0.03, 0.02, 0.01, 0.02, 0.0},
                                        shape::SquareBorePlate{0.03, 0.03, 0.02, 0.01, 0.008, 0.02, 0.001},
                                        shape::KeyedBorePlate{0.03, 0.03, 0.02, 0.01, 0.003, 0.0015, 0.02, 0.0005},
                                        shape::ThreadBolt{0.01, 0.002, 0.008, 0.001},
                                        shape::ThreadNut{0.01, 0.002, 0.016, 0.008, 0.001}};

SurfaceBlock blockAt(const shape::Shape& shape, const Vec3& low, double cell) {
    SurfaceBlock block;
    for (std::size_t i = 0; i < SurfaceBlock::kAllNodes; ++i)
        block.node[i] = shape::signedDistance(
            shape, low + cell * Vec3(static_cast<double>(i % SurfaceBlock::kNodes),
                                     static_cast<double>(i / SurfaceBlock::kNodes % SurfaceBlock::kNodes),
                                     static_cast<double>(i / (SurfaceBlock::kNodes * SurfaceBlock::kNodes))));
    return block;
}

/// What interpolation errs by at a point of an octant, in cells from its corner.
double errorAt(const shape::Shape& shape, const SurfaceBlock& block, const Vec3& low, double cell, std::size_t octant,
               const Vec3& in_octant) {
    const Vec3 in_block = in_octant + 4.0 * cornerAt(octant);
    const Vec3 whole = in_block.array().floor().min(7.0);
    CornerValues values{};
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3 at = whole + cornerAt(i);
        values[i] = block.node[static_cast<std::size_t>(
            (at.z() * SurfaceBlock::kNodes + at.y()) * SurfaceBlock::kNodes + at.x())];
    }
    return std::abs(trilinearValue(values, in_block - whole) - shape::signedDistance(shape, low + cell * in_block));
}

TEST(ShapeBound, IsNeverBelowTheErrorAtRimsEdgesCornersAndElsewhere) {
    // Truth: closed form, at many points of blocks that lie on every vertex of the shape (of its coarsest triangles:
    // rims, edges, corners, the inside corners of pockets and keyways among them) or anywhere near its faces.
    Random random(1);
    for (const shape::Shape& shape : kShapes) {
        const geometry::TriangleMesh mesh = shape::tessellate(shape, 1e-3);
        double tightest = 1e300;
        for (int turn = 0; turn < 150; ++turn) {
            const double cell = turn % 3 == 0 ? 0.5e-3 : turn % 3 == 1 ? 0.1e-3 : 0.02e-3;
            const auto& t = mesh.triangles[random.below(mesh.triangles.size())];
            const double a = turn % 2 == 0 ? 0.0 : random.uniform();
            Vec3 low = mesh.vertices[t[0]] + a * (mesh.vertices[t[1]] - mesh.vertices[t[0]]);
            low += cell * Vec3(random.uniform(-8, 0), random.uniform(-8, 0), random.uniform(-8, 0));
            const SurfaceBlock block = blockAt(shape, low, cell);
            for (std::size_t octant = 0; octant < 8; ++octant) {
                const double bound = boundInterpolation(shape, block, low, cell, octant, 1.0);
                double worst = 0.0;
                for (int i = 0; i < 100; ++i) {
                    const Vec3 u(random.uniform(0, 4), random.uniform(0, 4), random.uniform(0, 4));
                    worst = std::max(worst, errorAt(shape, block, low, cell, octant, u));
                }
                // A bound of a cell or more says nothing: the Lipschitz constant then says more.
                if (bound < cell) {
                    ASSERT_LE(worst, bound + 1e-15)
                        << shape::kindName(shape) << " cell " << cell << " at " << low.transpose();
                    if (worst > 1e-3 * cell) tightest = std::min(tightest, bound / worst);
                }
            }
        }
        EXPECT_LT(tightest, 6.0) << shape::kindName(shape);
    }
}

/// The bound around a point, cells of half a millimetre.
double boundAround(const shape::Shape& shape, const Vec3& p, double cell) {
    const Vec3 low = p - Vec3::Constant(2.0 * cell);  // the middle of the first octant
    return boundInterpolation(shape, blockAt(shape, low, cell), low, cell, 0, 1.0);
}

TEST(ShapeBound, OfFlatFacesIsNextToNothingAndOfWallsWhatTheirCurvatureMakes) {
    // Truth: derived: ½ t²/R with t half the diagonal of a cell: 3/8 s²/R, and half as much again for radii that are
    // tried in steps of two.
    const double cell = 0.25e-3;
    const shape::Shape plate = shape::BorePlate{0.04, 0.04, 0.02, 0.01, 0.02, 0.0}, box = shape::Box{0.02, 0.02, 0.02};
    EXPECT_LT(boundAround(box, {0.003, 0.002, 0.01}, cell), 1e-3 * cell);
    EXPECT_LT(boundAround(plate, {0.014, 0.002, 0.0}, cell), 1e-3 * cell);
    EXPECT_LT(boundAround(shape::Sheet{0.02, 0.02}, {0.0, 0.0, 0.002}, cell), 1e-3 * cell);
    EXPECT_LT(boundAround(shape::SquareBorePlate{0.04, 0.04, 0.02, 0.01, 0.01, 0.02, 0.0}, {0.005, 0.001, -0.01}, cell),
              1e-3 * cell);
    EXPECT_LT(boundAround(plate, {0.005, 0.0, -0.01}, cell), 1.5 * 0.375 * cell * cell / 0.005);
    EXPECT_LT(boundAround(shape::Sphere{0.02}, {0.006, 0.0, 0.008}, cell), 1.5 * 0.375 * cell * cell / 0.01);
}

TEST(ShapeBound, LetsTheFieldOfAPlateStateMicrometres) {
    // Truth: invariant: on walls and faces; φ is 0 there. The Lipschitz constant alone would say 0.1 mm and more.
    const scene::PartSpec spec{
        .name = "plate", .geometry = shape::Shape(shape::BorePlate{0.04, 0.04, 0.015, 0.02, 0.015, 0.001}), .X_WP = {}};
    const auto part = scene::buildPart(spec, {.field = true, .tolerance = 20e-6});
    ASSERT_TRUE(part);
    Random random(2);
    std::vector<double> bounds;
    for (int i = 0; i < 4000; ++i) {
        const double angle = random.uniform(0.0, 6.2831853), r = i % 2 == 0 ? 0.01 : random.uniform(0.011, 0.019);
        const Vec3 p(r * std::cos(angle), r * std::sin(angle), i % 2 == 0 ? random.uniform(-0.013, -0.002) : 0.0);
        bounds.push_back(part->field->errorBound(p, FieldMode::Trilinear));
        ASSERT_LE(std::abs(part->field->sample(p, FieldMode::Trilinear).phi), bounds.back());
    }
    std::sort(bounds.begin(), bounds.end());
    EXPECT_LT(bounds[bounds.size() / 2], 10e-6);
    EXPECT_LT(bounds[bounds.size() * 9 / 10], 50e-6);
}

}  // namespace
}  // namespace passung::field
