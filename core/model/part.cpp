#include "core/model/part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/base/random.h"
#include "core/model/triangle_tree.h"

namespace passung::model {

namespace {

constexpr double kBandCells = 4.0;    // bricks reach this many cells from the surface
constexpr double kChordShare = 0.05;  // of the tolerance: the mesh of a shape must not spoil what the field holds
constexpr double kFinestShare = 1.0 / 1024;  // of the longest side: chooseCell stops there
constexpr int kErrorProbes = 400;
constexpr double kProbeQuantile = 0.9;

/// A surface that is not closed and has no side that most of its triangles agree to call inside.
bool isOpenSheet(const TriangleMesh& mesh, const MeshReport& report, const TriangleTree& tree) {
    if (report.watertight) return false;
    const double step = 1e-3 * boundsOf(mesh).size().norm();
    std::size_t inside = 0, tried = 0;
    const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / 500);
    for (std::size_t i = 0; i < mesh.triangles.size(); i += stride) {
        const auto& t = mesh.triangles[i];
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        const Vec3 behind = (a + b + c) / 3.0 - step * (b - a).cross(c - a).normalized();
        inside += tree.inside(behind) ? 1 : 0;
        ++tried;
    }
    return 2 * inside < tried;
}

/// A point within `reach` of the surface.
Vec3 pointNear(const TriangleMesh& mesh, double reach, Random& random) {
    const auto& t = mesh.triangles[random.below(mesh.triangles.size())];
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3 offset(random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach));
    return a + u * (mesh.vertices[t[1]] - a) + v * (mesh.vertices[t[2]] - a) + offset;
}

}  // namespace

DistanceSource exactSource(const Part& part) {
    DistanceSource source;
    source.bounds = boundsOf(part.mesh);
    if (part.shape) {
        const Shape shape = *part.shape;
        source.open_sheet = std::holds_alternative<Sheet>(shape);
        source.distance = [shape](const Vec3& p) { return std::abs(signedDistance(shape, p)); };
        source.inside = [shape](const Vec3& p) { return signedDistance(shape, p) < 0.0; };
        return source;
    }
    // Shared by the two functions, which may be copied.
    const auto tree = std::make_shared<const TriangleTree>(part.mesh);
    source.open_sheet = isOpenSheet(part.mesh, part.report, *tree);
    source.distance = [tree](const Vec3& p) { return tree->closest(p).distance; };
    source.inside = [tree](const Vec3& p) { return tree->inside(p); };
    return source;
}

double chooseCell(const DistanceSource& source, const TriangleMesh& mesh, double tolerance) {
    const double longest = source.bounds.size().maxCoeff();
    double cell = longest / 32.0;
    const auto signedAt = [&](const Vec3& p) {
        const double d = source.distance(p);
        return !source.open_sheet && source.inside(p) ? -d : d;
    };
    for (; cell > kFinestShare * longest; cell *= 0.5) {
        Random random(1);
        std::vector<double> errors;
        for (int i = 0; i < kErrorProbes; ++i) {
            const Vec3 p = pointNear(mesh, cell, random);
            const Vec3 u(random.uniform(), random.uniform(), random.uniform());
            double interpolated = 0.0;
            for (int c = 0; c < 8; ++c) {
                const Vec3 corner((c & 1) ? 1.0 : 0.0, (c & 2) ? 1.0 : 0.0, (c & 4) ? 1.0 : 0.0);
                double w = 1.0;
                for (int axis = 0; axis < 3; ++axis) w *= corner[axis] > 0.5 ? u[axis] : 1.0 - u[axis];
                interpolated += w * signedAt(p + cell * (corner - u));
            }
            errors.push_back(std::abs(interpolated - signedAt(p)));
        }
        const auto quantile = errors.begin() + static_cast<std::ptrdiff_t>(kProbeQuantile * kErrorProbes);
        std::nth_element(errors.begin(), quantile, errors.end());
        if (*quantile <= tolerance) break;
    }
    return cell;
}

Result<Part> buildPart(const PartSpec& spec, const PartNeeds& needs) {
    Part part;
    part.name = spec.name;
    if (const auto* shape = std::get_if<Shape>(&spec.geometry)) {
        if (auto errors = validate(*shape); !errors.empty()) return errors;
        part.shape = *shape;
        part.chord_error = kChordShare * needs.tolerance;
        ImportedMesh checked = repairMesh(tessellate(*shape, part.chord_error));
        part.mesh = std::move(checked.mesh);
        part.report = std::move(checked.report);
        part.report.format = kindName(*shape);
    } else {
        const auto& file = std::get<MeshFile>(spec.geometry);
        auto imported = importMesh(file.path, file.metres_per_unit);
        if (!imported) return imported.errors();
        part.mesh = std::move(imported->mesh);
        part.report = std::move(imported->report);
    }
    if (needs.field) {
        const DistanceSource source = exactSource(part);
        const double cell = needs.cell > 0.0 ? needs.cell : chooseCell(source, part.mesh, needs.tolerance);
        auto field = DistanceField::build(source, cell, kBandCells * cell);
        if (!field) {
            Errors errors = field.errors();
            for (auto& error : errors) error.key = "part " + spec.name;
            return errors;
        }
        part.field = std::move(*field);
    }
    if (needs.shell) part.shell.emplace(samplePoints(part.mesh, needs.spacing));
    return part;
}

}  // namespace passung::model
