#include "core/import/self_intersection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/import/mesh_import.h"
#include "core/shape/shape.h"
#include "tests/support/broken_mesh.h"
#include "tests/support/mesh_crossing.h"

namespace passung::importer {
namespace {

geometry::TriangleMesh together(geometry::TriangleMesh a, const geometry::TriangleMesh& b, const Vec3& offset) {
    const auto base = static_cast<std::uint32_t>(a.vertices.size());
    for (const Vec3& v : b.vertices) a.vertices.push_back(v + offset);
    for (const geometry::Triangle& t : b.triangles) a.triangles.push_back({base + t[0], base + t[1], base + t[2]});
    return a;
}

TEST(SelfIntersection, FindsNoneInSoundShapes) {
    // Truth: invariant (a shape's surface passes through itself nowhere), at three sizes.
    for (const double scale : {1e-6, 1.0, 1e6}) {
        for (const shape::Shape& shape : {shape::Shape(shape::Box{0.02, 0.03, 0.04}), shape::Shape(shape::Sphere{0.02}),
                                          shape::Shape(shape::Peg{0.02, 0.05, 0.001}),
                                          shape::Shape(shape::BorePlate{0.06, 0.05, 0.03, 0.0202, 0.03, 0.001})}) {
            geometry::TriangleMesh mesh = shape::tessellate(shape, 2e-5);
            for (Vec3& v : mesh.vertices) v *= scale;
            EXPECT_EQ(crossingsOf(mesh).triangles, 0u) << shape::kindName(shape);
        }
        geometry::TriangleMesh wavy = test::wavySphere(0.08, 2e-5);
        for (Vec3& v : wavy.vertices) v *= scale;
        EXPECT_EQ(crossingsOf(wavy).triangles, 0u);
    }
}

TEST(SelfIntersection, CountsTheTrianglesOfTwoSpikesThatCross) {
    // Truth: closed form. One triangle stands upright in another: both cross. Moved aside by more than its width: none.
    geometry::TriangleMesh mesh;
    mesh.vertices = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0), Vec3(1, 1, -1), Vec3(1.2, 1, 1), Vec3(0.8, 1, 1)};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    EXPECT_EQ(crossingsOf(mesh).triangles, 2u);
    for (std::size_t v = 3; v < 6; ++v) mesh.vertices[v].y() += 3.0;
    EXPECT_EQ(crossingsOf(mesh).triangles, 0u);
}

/// Of all pairs, each looked at; triangles that share a corner touch there, so that only the edges away from it count.
Crossings crossingsOfAllPairs(const geometry::TriangleMesh& mesh) {
    const auto passes = [&](const geometry::Triangle& a, const geometry::Triangle& b) {
        const test::Corners3 through{mesh.vertices[b[0]], mesh.vertices[b[1]], mesh.vertices[b[2]]};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = a[k], to = a[(k + 1) % 3];
            if (std::count(b.begin(), b.end(), from) + std::count(b.begin(), b.end(), to) > 0) continue;
            if (test::passesThrough(mesh.vertices[from], mesh.vertices[to], through)) return true;
        }
        return false;
    };
    Crossings all;
    std::vector<char> crossing(mesh.triangles.size(), 0);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (std::size_t k = i + 1; k < mesh.triangles.size(); ++k)
            if (passes(mesh.triangles[i], mesh.triangles[k]) || passes(mesh.triangles[k], mesh.triangles[i])) {
                crossing[i] = crossing[k] = 1;
                all.pairs += 2;
            }
    all.triangles = static_cast<std::size_t>(std::count(crossing.begin(), crossing.end(), 1));
    return all;
}

TEST(SelfIntersection, FindsWhatEveryPairLookedAtGives) {
    // Truth: brute force over all pairs by tests/support/mesh_crossing.h. Triangles of all sizes from 1/10 000 on in
    // heaps of all sizes, a third of them hinged to the one before by a corner or an edge.
    Random random(5);
    const auto point = [&](const Vec3& middle, double size) {
        return Vec3(middle + size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    };
    std::size_t found = 0;
    for (int round = 0; round < 20; ++round) {
        geometry::TriangleMesh mesh;
        for (std::uint32_t i = 0; i < 400; ++i) {
            const double size = std::pow(10.0, random.uniform(-4.0, 0.0));
            const Vec3 middle = point(Vec3::Zero(), std::pow(10.0, random.uniform(-4.0, 0.0)));
            const std::uint32_t shared =
                i > 0 && random.uniform() < 0.33 ? 1 + static_cast<std::uint32_t>(random.below(2)) : 0;
            geometry::Triangle triangle{};
            for (std::uint32_t k = 0; k < 3; ++k) {
                if (k < shared) {
                    triangle[k] = mesh.triangles.back()[k];
                    continue;
                }
                triangle[k] = static_cast<std::uint32_t>(mesh.vertices.size());
                mesh.vertices.push_back(point(middle, size));
            }
            mesh.triangles.push_back(triangle);
        }
        const Crossings all = crossingsOfAllPairs(mesh), now = crossingsOf(mesh);
        EXPECT_EQ(now.pairs, all.pairs) << "round " << round;
        EXPECT_EQ(now.triangles, all.triangles) << "round " << round;
        found += all.pairs;
    }
    EXPECT_GT(found, 1000u);
}

TEST(SelfIntersection, CountsEachPairTwiceWhereverItLies) {
    // Truth: closed form: from either side. Pairs far from each other, one triangle upright in the other, of any size.
    Random random(6);
    constexpr int kPairs = 500;
    for (int round = 0; round < 40; ++round) {
        geometry::TriangleMesh mesh;
        for (int i = 0; i < kPairs; ++i) {
            const double size = std::pow(10.0, random.uniform(-2.0, 0.0));
            const Vec3 at = 8.0 * Vec3(i % 8, i / 8 % 8, i / 64) +
                            Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
            for (const Vec3& p :
                 {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0), Vec3(1, 1, -1), Vec3(1.2, 1, 1), Vec3(0.8, 1, 1)})
                mesh.vertices.push_back(at + 0.5 * size * p);
            mesh.triangles.push_back({base, base + 1, base + 2});
            mesh.triangles.push_back({base + 3, base + 4, base + 5});
        }
        const Crossings found = crossingsOf(mesh);
        EXPECT_EQ(found.pairs, 2u * kPairs);
        EXPECT_EQ(found.triangles, 2u * kPairs);
    }
}

TEST(SelfIntersection, CountsNoTouch) {
    // Truth: closed form. Two boxes that share a face, an edge or a corner touch; pushed 1 mm into each other at an
    // angle of none of their axes they cross.
    const geometry::TriangleMesh box = shape::tessellate(shape::Box{0.02, 0.03, 0.04}, 1.0);
    EXPECT_EQ(crossingsOf(together(box, box, Vec3(0.02, 0.0, 0.0))).triangles, 0u);
    EXPECT_EQ(crossingsOf(together(box, box, Vec3(0.02, 0.03, 0.0))).triangles, 0u);
    EXPECT_EQ(crossingsOf(together(box, box, Vec3(0.02, 0.03, 0.04))).triangles, 0u);
    EXPECT_GT(crossingsOf(together(box, box, Vec3(0.019, 0.029, 0.039))).triangles, 0u);
}

TEST(SelfIntersection, IsToldByTheReport) {
    // Truth: closed form. Two balls of 20 mm, 15 mm apart, overlap: what either encloses is inside.
    const geometry::TriangleMesh ball = shape::tessellate(shape::Sphere{0.02}, 4e-5);
    const ImportedMesh repaired = repairMesh(together(ball, ball, Vec3(0.015, 0.0003, 0.0007)));
    EXPECT_GT(repaired.report.crossing_triangles, 20u);
    EXPECT_EQ(repaired.report.kind, SurfaceKind::Solid);
    bool told = false;
    for (const std::string& note : repaired.report.notes)
        told = told || note.find("triangles pass through each other; left") != std::string::npos;
    EXPECT_TRUE(told);
}

}  // namespace
}  // namespace passung::importer
