#include "tests/bench/part_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "analysis/truth/exact_mesh.h"
#include "core/base/random.h"
#include "core/field/distance_field.h"
#include "core/scene/timed_store.h"
#include "study/run/files/disk_store.h"
#include "tests/bench/ours.h"
#include "tests/support/broken_mesh.h"

namespace passung::bench {

namespace {

constexpr double kBore = 10e-3, kPeg = 9.9e-3, kPlate = 40e-3, kHeight = 20e-3;
constexpr double kReach = 0.2e-3;  // from the surface
constexpr std::size_t kBorePoints = 60'000;
constexpr std::uint32_t kPegPoints = 6'000;
constexpr std::size_t kSignPoints = 4'000;
constexpr double kDefectTolerance = 100e-6;
constexpr std::uint64_t kSeed = 20260302;

Vec3 jitter(Random& random, double size) {
    return size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

/// Points within kReach of the plate's surface: by turns anywhere on its triangles, on the bore's wall, at its rims.
std::vector<Vec3> pointsNearBore(const shape::Shape& shape, const geometry::TriangleMesh& mesh, Random& random) {
    std::vector<Vec3> points;
    while (points.size() < kBorePoints) {
        const auto& t = mesh.triangles[random.below(mesh.triangles.size())];
        const double angle = 2.0 * std::numbers::pi * random.uniform();
        const Vec3 wall(0.5 * kBore * std::cos(angle), 0.5 * kBore * std::sin(angle), -kHeight * random.uniform());
        const Vec3 rim(wall.x(), wall.y(), random.below(2) == 0 ? 0.0 : -kHeight);
        const Vec3 middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
        const std::array<Vec3, 3> seeds{middle, wall, rim};
        const Vec3 p = seeds[points.size() % 3] + jitter(random, kReach);
        if (std::abs(signedDistance(shape, p)) <= kReach) points.push_back(p);
    }
    return points;
}

/// How many points on the mantle of a peg in the bore's middle, evenly along a spiral, the field takes for inside.
double falseContacts(const field::DistanceField& field) {
    double count = 0.0;
    for (std::uint32_t i = 0; i < kPegPoints; ++i) {
        const double angle = std::numbers::pi * (3.0 - std::sqrt(5.0)) * i;  // the golden angle
        const Vec3 p(0.5 * kPeg * std::cos(angle), 0.5 * kPeg * std::sin(angle), -kHeight * (i + 0.5) / kPegPoints);
        if (field.sample(p, field::FieldMode::Trilinear).phi < 0.0) count += 1.0;
    }
    return count;
}

Result<Row> boreRow(double tolerance) {
    scene::PartSpec spec;
    spec.name = "bore";
    spec.geometry = shape::Shape{shape::BorePlate{kPlate, kPlate, kHeight, kBore, kHeight, 0.0}};
    const auto kept = run::openDiskStore();
    scene::TimedStore timed(kept.get());
    const auto part = scene::buildPart(spec, {.field = true, .tolerance = tolerance}, &timed);
    if (!part) return part.errors();
    Random random(kSeed);
    const std::vector<Vec3> points = pointsNearBore(*part->shape, part->mesh, random);
    std::vector<double> errors;
    for (const Vec3& p : points)
        errors.push_back(
            kUm * std::abs(part->field->sample(p, field::FieldMode::Trilinear).phi - signedDistance(*part->shape, p)));
    Row row{.group = kBoreGroup,
            .method = "passung field",
            .settings = fmt::format("tolerance {:g} um (cell {:.3g} mm)", kUm * tolerance, 1e3 * part->field->cell()),
            .ours = true};
    row.samples = points.size();
    row.distance_error_um = summarise(errors);
    row.contacts_mean = falseContacts(*part->field);
    row.memory_MB = 1e-6 * static_cast<double>(part->field->memoryBytes());
    row.build_s = timed.seconds();
    return row;
}

struct Defect {
    std::string name;
    geometry::TriangleMesh mesh;
};

std::vector<Defect> defects(const geometry::TriangleMesh& bunny, bool few) {
    std::vector<Defect> all;
    const Vec3 back = bunny.vertices[0];
    const auto patch = [&](double radius) { return test::patchAround(bunny, back, radius); };
    all.push_back({"hole of radius 10 mm", test::withHole(bunny, patch(10e-3))});
    if (few) return all;
    all.push_back({"hole of radius 5 mm", test::withHole(bunny, patch(5e-3))});
    all.push_back({"hole of radius 2 mm", test::withHole(bunny, patch(2e-3))});
    all.push_back({"2 % of triangles missing", test::withHole(bunny, test::someOf(bunny, 0.02, 11))});
    all.push_back({"patch of radius 5 mm flipped", test::withFlipped(bunny, patch(5e-3))});
    all.push_back({"5 % of triangles flipped", test::withFlipped(bunny, test::someOf(bunny, 0.05, 12))});
    all.push_back({"5 % of triangles duplicated", test::withDuplicates(bunny, test::someOf(bunny, 0.05, 13))});
    return all;
}

}  // namespace

Result<std::vector<Row>> partRows(const geometry::TriangleMesh& bunny, const Extent& extent) {
    std::vector<Row> rows;
    if (extent.wanted(kBoreGroup, "passung field")) {
        for (const double tolerance : {20e-6, 10e-6, 5e-6}) {
            if (extent.few_settings && tolerance != 20e-6) continue;
            const auto row = boreRow(tolerance);
            if (!row) return row.errors();
            rows.push_back(*row);
        }
    }
    if (!extent.wanted(kDefectGroup, "passung field")) return rows;
    Random random(kSeed);
    const truth::ExactMesh exact(bunny);
    std::vector<Vec3> points;
    std::vector<double> truth;
    while (points.size() < kSignPoints) {
        const auto& v = bunny.vertices[random.below(bunny.vertices.size())];
        const Vec3 p = v + jitter(random, 20e-3);
        const double phi = exact.signedDistance(p);
        if (std::abs(phi) < 1e-3 || std::abs(phi) > 20e-3) continue;
        points.push_back(p);
        truth.push_back(phi);
    }
    for (Defect& defect : defects(bunny, extent.few_settings)) {
        PartStore store(std::move(defect.mesh));
        const auto built = store.get(kDefectTolerance, 0.0);
        if (!built) return built.errors();
        const field::DistanceField& field = *(*built)->part.field;
        double wrong = 0.0;
        std::vector<double> errors;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double phi = field.sample(points[i], field::FieldMode::Trilinear).phi;
            errors.push_back(kUm * std::abs(phi - truth[i]));
            wrong += (phi < 0.0) != (truth[i] < 0.0) ? 1.0 : 0.0;
        }
        Row row{.group = kDefectGroup, .method = "passung field", .settings = defect.name, .ours = true};
        row.samples = points.size();
        row.distance_error_um = summarise(errors);
        row.wrong_signs_percent = 100.0 * wrong / static_cast<double>(points.size());
        row.memory_MB = 1e-6 * static_cast<double>(field.memoryBytes());
        row.build_s = (*built)->field_s;
        rows.push_back(row);
    }
    return rows;
}

}  // namespace passung::bench
