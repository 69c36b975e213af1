#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/field/distance_field.h"
#include "core/scene/part.h"
#include "tests/support/brute_force_mesh.h"
#include "tests/support/length.h"

// The teapot of protocols/thesis_queries as it is: open below, with pieces that pass through each other.

namespace passung::field {
namespace {

constexpr const char* kTeapot = PASSUNG_SOURCE_DIR "/protocols/thesis_queries/teapot.off";

/// The file's triangles, read by nothing of the product.
geometry::TriangleMesh readOff(const std::string& path) {
    std::ifstream in(path);
    std::stringstream text;
    for (std::string line; std::getline(in, line);)
        if (!line.starts_with("#") && line != "OFF") text << line << "\n";
    std::size_t vertices = 0, triangles = 0, none = 0;
    text >> vertices >> triangles >> none;
    geometry::TriangleMesh mesh;
    mesh.vertices.resize(vertices);
    mesh.triangles.resize(triangles);
    for (Vec3& v : mesh.vertices) {
        text >> v.x() >> v.y() >> v.z();
        v *= 1e-3;
    }
    for (auto& t : mesh.triangles) text >> none >> t[0] >> t[1] >> t[2];
    return mesh;
}

/// The product's field of the file: cells of that size, or with a tolerance mixed ones [m].
scene::Part buildTeapot(double cell, double tolerance) {
    scene::PartSpec spec;
    spec.name = "teapot";
    spec.geometry = scene::MeshFile{kTeapot, 1e-3};
    auto part = scene::buildPart(spec, {.field = true, .tolerance = tolerance, .cell = cell});
    if (!part) throw std::runtime_error(toString(part.errors()[0]));
    return std::move(*part);
}

/// Points in the part's box grown by a quarter, then as many within 5 mm of a triangle.
std::vector<Vec3> somePoints(const geometry::TriangleMesh& mesh, std::size_t of_each) {
    Random random(20261130);
    const geometry::Bounds box = geometry::boundsOf(mesh);
    std::vector<Vec3> points;
    const auto any = [&](double size) {
        return Vec3(size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    };
    const Vec3 middle = 0.5 * (box.low + box.high);
    while (points.size() < of_each) points.push_back(middle + 0.625 * any(1.0).cwiseProduct(box.size()));
    while (points.size() < 2 * of_each) {
        const auto& t = mesh.triangles[random.below(mesh.triangles.size())];
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
        const Vec3& a = mesh.vertices[t[0]];
        points.push_back(a + u * (mesh.vertices[t[1]] - a) + v * (mesh.vertices[t[2]] - a) + any(5e-3));
    }
    return points;
}

struct Found {
    std::vector<double> errors;  // ||φ| - distance| [m], ascending
    std::size_t farther = 0;     // more than 1 % of the distance and of a cell
};

Found compare(const DistanceField& field, const geometry::TriangleMesh& raw, const std::vector<Vec3>& points) {
    Found found;
    for (const Vec3& p : points) {
        const double truth = test::distanceToMesh(raw, p);
        const double error = std::abs(std::abs(field.sample(p, FieldMode::Trilinear).phi) - truth);
        found.errors.push_back(error);
        found.farther += error > 0.01 * truth + 0.01 * field.cell() ? 1 : 0;
    }
    std::sort(found.errors.begin(), found.errors.end());
    return found;
}

TEST(Teapot, IsTheThesisTeapotInSize) {
    // Truth: reference: the thesis' box, 236.2 x 115.7 x 147.0 mm (y up there); the package's 992 triangles.
    const geometry::TriangleMesh raw = readOff(kTeapot);
    const Vec3 size = geometry::boundsOf(raw).size();
    EXPECT_EQ(raw.triangles.size(), 992u);
    EXPECT_NEAR(size.x(), 0.2362, 5e-5);
    EXPECT_NEAR(size.y(), 0.1470, 5e-5);
    EXPECT_NEAR(size.z(), 0.1157, 6e-5);
}

TEST(Teapot, OfAHundredPointsTheFieldIsAtNinetyNineWithinOnePercentOfTheExactDistanceOfTheMeshAsItIs) {
    // Truth: independent: the least distance to the file's triangles, all of them, by other formulas than the core's
    // (brute_force_mesh.h), read by a reader of this test; 1 %: of the part's size, 236.2 mm. The sign is not judged:
    // without a floor an inside is a convention. Not at all points: the most is printed.
    // By default the thesis' cells of 2 mm; PASSUNG_LONG=1: finer ones and mixed ones.
    const geometry::TriangleMesh raw = readOff(kTeapot);
    const std::vector<Vec3> points = somePoints(raw, 5000);
    std::vector<std::pair<double, double>> settings{{2e-3, 20e-6}};  // cell, tolerance
    if (test::atFullLength()) settings.insert(settings.end(), {{1e-3, 20e-6}, {0.0, 100e-6}});
    for (const auto& [cell, tolerance] : settings) {
        const scene::Part part = buildTeapot(cell, tolerance);
        const Found found = compare(*part.field, raw, points);
        const auto at = [&](double share) {
            return 1e3 * found.errors[static_cast<std::size_t>(share * static_cast<double>(points.size() - 1))];
        };
        std::printf(
            "cell %.1f mm, tolerance %.0f um: error median %.4f, 99 %% %.3f, 99.9 %% %.3f, most %.3f mm (1 %%: "
            "2.362); %zu of %zu points more than 1 %% of the distance and of a cell off\n",
            1e3 * part.field->cell(), 1e6 * tolerance, at(0.5), at(0.99), at(0.999), at(1.0), found.farther,
            points.size());
        EXPECT_LE(at(0.99), 2.362);
    }
}

}  // namespace
}  // namespace passung::field
