#include "core/import/seam_split.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/import/mesh_import.h"
#include "core/shape/shape.h"
#include "tests/support/broken_mesh.h"
#include "tests/support/brute_force_mesh.h"

namespace passung::importer {
namespace {

using geometry::Triangle;
using geometry::TriangleMesh;

/// A nut as exchange files give it: each face with vertices of its own along the rims that it shares with others, where
/// they lie on the others' edges, up to `gap` beside them. Hexagon 7 mm across its corners, 3.2 mm high, a wavy bore (a
/// thread without pitch) of 2 mm radius.
struct Nut {
    double gap;
    Random random{17};
    TriangleMesh mesh{};

    std::uint32_t add(const Vec3& p) {
        mesh.vertices.push_back(p);
        return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    }

    /// `n` points along each side of a polygon, the first of them its corner; the others moved by up to the gap.
    std::vector<std::uint32_t> rim(const std::vector<Vec3>& corners, int n) {
        std::vector<std::uint32_t> points;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Vec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
            points.push_back(add(a));
            for (int k = 1; k < n; ++k) {
                const Vec3 off(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
                points.push_back(add(a + (b - a) * (k / static_cast<double>(n)) + 0.5 * gap * off));
            }
        }
        return points;
    }

    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool turned) {
        mesh.triangles.push_back(turned ? Triangle{a, c, b} : Triangle{a, b, c});
    }

    /// Between two rims with n and m points to a corner: both are walked around at once.
    void band(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b, bool turned) {
        for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
            const auto at = [](const auto& rim, std::size_t k) { return rim[k % rim.size()]; };
            if (j == b.size() || (i < a.size() && (i + 1) * b.size() <= (j + 1) * a.size())) {
                triangle(at(a, i), at(a, i + 1), at(b, j), turned);
                ++i;
            } else {
                triangle(at(a, i), at(b, j + 1), at(b, j), turned);
                ++j;
            }
        }
    }
};

std::vector<Vec3> ring(double radius, double z, int corners) {
    std::vector<Vec3> points;
    for (int k = 0; k < corners; ++k) {
        const double angle = 2.0 * M_PI * k / corners;
        points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    return points;
}

constexpr int kCorners = 24;  // of the bore
constexpr double kHeight = 3.2e-3;

double boreAt(int level) { return 2e-3 + (level % 2 == 1 ? 0.2e-3 : 0.0); }

/// `pieces`: on an edge of a rim that a band has for itself.
TriangleMesh nut(double gap, int pieces) {
    Nut nut{gap};
    constexpr int kLevels = 8;
    for (int level = 0; level < kLevels; ++level) {
        const double low = kHeight * level / kLevels, high = kHeight * (level + 1) / kLevels;
        nut.band(nut.rim(ring(boreAt(level), low, kCorners), level % 2 == 0 ? pieces : 1),
                 nut.rim(ring(boreAt(level + 1), high, kCorners), level % 2 == 0 ? 1 : pieces + 1), true);
    }
    nut.band(nut.rim(ring(3.5e-3, 0.0, 6), 1), nut.rim(ring(3.5e-3, kHeight, 6), pieces + 2), false);
    for (const double z : {0.0, kHeight})
        nut.band(nut.rim(ring(3.5e-3, z, 6), pieces), nut.rim(ring(boreAt(0), z, kCorners), 1), z == 0.0);
    return nut.mesh;
}

/// By prisms and frusta.
double nutVolume() {
    const auto area = [](double r, int n) { return 0.5 * n * r * r * std::sin(2.0 * M_PI / n); };
    const double a = area(boreAt(0), kCorners), b = area(boreAt(1), kCorners);
    return kHeight * (area(3.5e-3, 6) - (a + b + std::sqrt(a * b)) / 3.0);
}

TEST(SeamSplit, MakesANutWithSeamsWatertightAndTurnsNoneOfItsTriangles) {
    // Truth: closed form (volume of a prism less frusta); every rim is a seam: vertices on the neighbour's edges,
    // exactly or up to 2e-15 mm, a nanometre or half the tolerance beside them.
    for (const double gap : {0.0, 2e-18, 1e-9, 3e-9})
        for (const bool inside_out : {false, true}) {
            const TriangleMesh written = inside_out ? test::insideOut(nut(gap, 3)) : nut(gap, 3);
            const ImportedMesh mended = repairMesh(written);
            const MeshReport& r = mended.report;
            EXPECT_TRUE(r.watertight) << gap;
            EXPECT_EQ(r.kind, SurfaceKind::Solid) << gap;
            EXPECT_EQ(r.turned_triangles + r.turned_patches, 0u) << gap;
            EXPECT_EQ(r.turned_inside_out, inside_out);
            EXPECT_EQ(r.closing_triangles + r.boundary_edges, 0u) << gap;
            EXPECT_GT(r.split_edges, 200u);
            EXPECT_NEAR(r.volume, nutVolume(), 1e-12 * nutVolume() + gap * r.area);
            EXPECT_NEAR(test::volume(mended.mesh), nutVolume(), 1e-12 * nutVolume() + gap * r.area);
            const test::EdgeCount edges = test::countEdges(mended.mesh);
            EXPECT_EQ(edges.open + edges.crowded, 0u);
        }
}

TEST(SeamSplit, MovesNoVertexAndKeepsTheSurface) {
    // Truth: invariant. The pieces of a triangle lie on it: the area stays, and so do all vertices.
    TriangleMesh mesh = nut(0.0, 4);
    const TriangleMesh before = mesh;
    const auto areaOf = [](const TriangleMesh& m) {
        double area = 0.0;
        for (const Triangle& t : m.triangles)
            area += 0.5 * (m.vertices[t[1]] - m.vertices[t[0]]).cross(m.vertices[t[2]] - m.vertices[t[0]]).norm();
        return area;
    };
    EXPECT_GT(splitSeams(mesh, 1e-9), 0u);
    ASSERT_EQ(mesh.vertices.size(), before.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) EXPECT_EQ(mesh.vertices[i], before.vertices[i]);
    EXPECT_NEAR(areaOf(mesh), areaOf(before), 1e-12 * areaOf(before));
}

TEST(SeamSplit, SplitsAllSidesOfATriangleAtAllVerticesThatLieOnThem) {
    // Truth: closed form. A triangle, around it strips that end on its sides 0 to 3 times: none of its sides stays
    // open.
    for (int n0 = 0; n0 < 4; ++n0)
        for (int n1 = 0; n1 < 4; ++n1)
            for (int n2 = 0; n2 < 4; ++n2) {
                TriangleMesh mesh;
                mesh.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.3, 0.8, 0), Vec3(0.4, 0.3, 1)};
                mesh.triangles = {{0, 2, 1}};
                const std::array<int, 3> n{n0, n1, n2};
                for (std::uint32_t side = 0; side < 3; ++side) {
                    std::uint32_t last = side;
                    for (int k = 1; k <= n[side] + 1; ++k) {
                        std::uint32_t next = (side + 1) % 3;
                        if (k <= n[side]) {
                            const Vec3 a = mesh.vertices[side], b = mesh.vertices[next];
                            next = static_cast<std::uint32_t>(mesh.vertices.size());
                            mesh.vertices.push_back(a + (b - a) * (k / (n[side] + 1.0)));
                        }
                        mesh.triangles.push_back({last, next, 3});
                        last = next;
                    }
                }
                EXPECT_EQ(splitSeams(mesh, 1e-9), static_cast<std::size_t>(n0 + n1 + n2));
                const test::EdgeCount edges = test::countEdges(mesh);
                EXPECT_EQ(edges.open + edges.crowded, 0u);
                EXPECT_NEAR(test::volume(mesh), 0.8 / 6.0, 1e-12);
            }
}

TEST(SeamSplit, LeavesAGapBeyondTheTolerance) {
    // Truth: invariant. The tolerance is a millionth of the size; a vertex 1 um beside an edge of an 8 mm part is not
    // on it.
    const ImportedMesh mended = repairMesh(nut(1e-6, 3));
    EXPECT_FALSE(mended.report.watertight);
    EXPECT_GT(mended.report.boundary_edges, 0u);
}

TEST(SeamSplit, TurnsNothingOfANutWhoseSeamsAreTooWideToBeJoined) {
    // Truth: the file as written, which is right. Seams of 1 um part bore, faces and sides from each other; no piece's
    // surroundings tell which way it faces better than the file.
    const TriangleMesh written = nut(1e-6, 3);
    const ImportedMesh mended = repairMesh(written);
    EXPECT_EQ(mended.report.turned_triangles + mended.report.turned_patch_triangles, 0u);
    EXPECT_FALSE(mended.report.turned_inside_out);
    EXPECT_NE(mended.report.kind, SurfaceKind::OpenSheet);
}

TEST(SeamSplit, ClosedPiecesThatShareAnEdgeFaceAsTheirVolumeSays) {
    // Truth: closed form. Two boxes meet along an edge, which has four triangles; the smaller is inside out.
    constexpr double kEdge = 1.0 / 32.0;  // [m]; coordinates are whole in binary
    TriangleMesh mesh = shape::tessellate(shape::Box{kEdge, kEdge, kEdge}, 1.0);
    const TriangleMesh other = test::insideOut(shape::tessellate(shape::Box{kEdge / 2, kEdge / 2, kEdge}, 1.0));
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& v : other.vertices) mesh.vertices.emplace_back(v + 0.75 * kEdge * Vec3(1.0, 1.0, 0.0));
    for (const Triangle& t : other.triangles) mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
    const ImportedMesh mended = repairMesh(mesh);
    EXPECT_EQ(mended.report.non_manifold_edges, 1u);
    EXPECT_EQ(mended.report.turned_patches, 1u);
    EXPECT_NEAR(mended.report.volume, 1.25 * kEdge * kEdge * kEdge, 1e-15);
}

}  // namespace
}  // namespace passung::importer
