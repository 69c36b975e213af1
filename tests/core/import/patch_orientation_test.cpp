#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/triangle_tree.h"
#include "core/import/mesh_import.h"
#include "tests/support/broken_mesh.h"
#include "tests/support/brute_force_mesh.h"

namespace passung::importer {
namespace {

geometry::TriangleMesh ball(double diameter, const Vec3& centre = Vec3::Zero()) {
    geometry::TriangleMesh mesh = shape::tessellate(shape::Sphere{diameter}, 2e-3 * diameter);
    for (Vec3& v : mesh.vertices) v += centre;
    return mesh;
}

geometry::TriangleMesh together(geometry::TriangleMesh a, const geometry::TriangleMesh& b) {
    const auto base = static_cast<std::uint32_t>(a.vertices.size());
    a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
    for (const geometry::Triangle& t : b.triangles) a.triangles.push_back({base + t[0], base + t[1], base + t[2]});
    return a;
}

bool inside(const geometry::TriangleMesh& mesh, const Vec3& p) { return test::windingNumber(mesh, p) > 0.5; }

bool says(const MeshReport& report, const std::string& words) {
    return std::any_of(report.notes.begin(), report.notes.end(),
                       [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

TEST(PatchOrientation, TurnsAnInsideOutShellBesideASoundOne) {
    // Truth: closed form (two balls apart; either may be the one that is inside out, the larger or the smaller).
    const Vec3 apart(0.03, 0.0, 0.0);
    for (const double diameter : {0.01, 0.03}) {
        for (const bool first : {true, false}) {
            const geometry::TriangleMesh a = ball(0.02), b = ball(diameter, apart);
            const ImportedMesh repaired =
                repairMesh(first ? together(test::insideOut(a), b) : together(a, test::insideOut(b)));
            EXPECT_EQ(repaired.report.kind, SurfaceKind::Solid);
            EXPECT_EQ(repaired.report.turned_patches, 1u);
            EXPECT_NEAR(repaired.report.volume, test::volume(a) + test::volume(b), 1e-12);
            EXPECT_TRUE(inside(repaired.mesh, Vec3::Zero()));
            EXPECT_TRUE(inside(repaired.mesh, apart));
            // The larger one says whether the file as a whole is inside out.
            EXPECT_EQ(repaired.report.turned_inside_out, first == (diameter < 0.02));
            EXPECT_TRUE(says(repaired.report, "1 piece without a common edge faced against the rest"));
        }
    }
}

TEST(PatchOrientation, KeepsACavityAndWhatLiesInIt) {
    // Truth: closed form. A ball of 20 mm with a hollow of 12 mm that holds a ball of 6 mm; the file may give them in
    // any order.
    const geometry::TriangleMesh outer = ball(0.02), hollow = test::insideOut(ball(0.012)), core = ball(0.006);
    for (const geometry::TriangleMesh& mesh :
         {together(together(outer, hollow), core), together(together(core, hollow), outer)}) {
        const ImportedMesh repaired = repairMesh(mesh);
        EXPECT_EQ(repaired.report.kind, SurfaceKind::Solid);
        EXPECT_EQ(repaired.report.turned_patches, 0u);
        EXPECT_EQ(repaired.report.cavities, 1u);
        EXPECT_EQ(repaired.report.nested_solids, 0u);
        EXPECT_TRUE(says(repaired.report, "faces inwards: a cavity"));
        EXPECT_TRUE(inside(repaired.mesh, Vec3(0.008, 0.0, 0.0)));
        EXPECT_FALSE(inside(repaired.mesh, Vec3(0.0045, 0.0, 0.0)));
        EXPECT_TRUE(inside(repaired.mesh, Vec3::Zero()));
    }
}

TEST(PatchOrientation, TurnsASolidWithItsCavityTogether) {
    // Truth: closed form (a ball with a hollow, all triangles inside out).
    const geometry::TriangleMesh sound = together(ball(0.02), test::insideOut(ball(0.012)));
    const ImportedMesh repaired = repairMesh(test::insideOut(sound));
    EXPECT_TRUE(repaired.report.turned_inside_out);
    EXPECT_EQ(repaired.report.turned_patches, 0u);
    EXPECT_EQ(repaired.report.cavities, 1u);
    EXPECT_NEAR(repaired.report.volume, test::volume(sound), 1e-15);
    EXPECT_TRUE(inside(repaired.mesh, Vec3(0.008, 0.0, 0.0)));
    EXPECT_FALSE(inside(repaired.mesh, Vec3::Zero()));
}

TEST(PatchOrientation, SaysThatASolidLiesWithinASolid) {
    // Truth: closed form (two balls, one in the other, both facing outwards: no cavity).
    const ImportedMesh repaired = repairMesh(together(ball(0.02), ball(0.012)));
    EXPECT_EQ(repaired.report.nested_solids, 1u);
    EXPECT_EQ(repaired.report.cavities, 0u);
    EXPECT_TRUE(inside(repaired.mesh, Vec3::Zero()));
    EXPECT_TRUE(says(repaired.report, "solid within solid"));
}

TEST(PatchOrientation, TurnsAnIslandThatAGapCutsOff) {
    // Truth: closed form. A cap of 6 mm radius on a ball of 20 mm is cut off by a gap of some 1.5 mm and turned: the
    // repaired mesh is the one without the turn.
    const geometry::TriangleMesh whole = ball(0.02);
    const Vec3 pole(0.01, 0.0, 0.0);
    const auto cap = test::patchAround(whole, pole, 6e-3), wider = test::patchAround(whole, pole, 7.5e-3);
    std::vector<std::size_t> gap;
    std::set_difference(wider.begin(), wider.end(), cap.begin(), cap.end(), std::back_inserter(gap));
    ASSERT_GT(gap.size(), 10u);
    const ImportedMesh sound = repairMesh(test::withHole(whole, gap));
    const ImportedMesh turned = repairMesh(test::withHole(test::withFlipped(whole, cap), gap));
    EXPECT_EQ(sound.report.turned_patches, 0u);
    EXPECT_EQ(turned.report.turned_patches, 1u);
    EXPECT_EQ(turned.report.turned_patch_triangles, cap.size());
    for (int i = 0; i < 40; ++i) EXPECT_EQ(inside(turned.mesh, i * 5e-4 * Vec3::UnitX()), i * 5e-4 < 0.0097) << i;
}

TEST(PatchOrientation, TurnsOneInFiveOfTrianglesThatShareNoEdges) {
    // Truth: closed form of the ball. Every triangle stands alone, 20 um off; one in five is turned. From 1 mm to the
    // surface on, at most one point in a thousand may have the wrong sign.
    geometry::TriangleMesh mesh = test::unshared(ball(0.02));
    Random random(8);
    for (Vec3& v : mesh.vertices) v += 20e-6 * Vec3(random.normal(), random.normal(), random.normal());
    std::size_t turned = 0;
    for (geometry::Triangle& t : mesh.triangles) {
        if (random.uniform() >= 0.2) continue;
        std::swap(t[0], t[1]);
        ++turned;
    }
    const ImportedMesh repaired = repairMesh(mesh);
    EXPECT_EQ(repaired.report.kind, SurfaceKind::HoledSolid);
    EXPECT_NEAR(static_cast<double>(repaired.report.turned_patches), static_cast<double>(turned),
                0.05 * static_cast<double>(turned));
    const geometry::TriangleTree tree(repaired.mesh);
    int wrong = 0;
    for (int i = 0; i < 10000; ++i) {
        const Vec3 p = random.uniform(0.0, 0.03) * Vec3(random.normal(), random.normal(), random.normal()).normalized();
        if (std::abs(p.norm() - 0.01) < 1e-3) continue;
        wrong += tree.inside(p) != (p.norm() < 0.01) ? 1 : 0;
    }
    EXPECT_LE(wrong, 10);
}

TEST(PatchOrientation, LeavesAnOpenSheetBesideASolidAsItIs) {
    // Truth: invariant (a sheet has no right way to face).
    geometry::TriangleMesh sheet = shape::tessellate(shape::Sheet{0.01, 0.01}, 1.0);
    for (Vec3& v : sheet.vertices) v += Vec3(0.0, 0.0, 0.02);
    for (const geometry::TriangleMesh& s : {sheet, test::insideOut(sheet)})
        EXPECT_EQ(repairMesh(together(ball(0.02), s)).report.turned_patches, 0u);
}

}  // namespace
}  // namespace passung::importer
