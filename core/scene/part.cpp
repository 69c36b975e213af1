#include "core/scene/part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <limits>
#include <memory>

#include "core/base/random.h"
#include "core/field/distance_field.h"
#include "core/field/interpolation.h"
#include "core/field/mesh_block.h"
#include "core/field/shape_bound.h"
#include "core/geometry/cluster_tree.h"
#include "core/geometry/triangle_tree.h"
#include "core/scene/mesh_source.h"
#include "core/scene/number_text.h"
#include "core/shell/edge_curves.h"
#include "core/shell/shell_bytes.h"

namespace passung::scene {

namespace {

constexpr double kSurfaceChord = 1e-6;                  // [m]: of the triangles of a shape's surface
constexpr std::size_t kMostSurfaceTriangles = 200'000;  // of a shape: beyond, they become coarser
constexpr double kBandCells = 4.0;                      // bricks reach this many (largest) cells from the surface
constexpr double kUniformBandCells = 2.0;  // so far reach cells of one size that was asked for, then larger ones
// Where the distances of two perpendicular faces meet, interpolation errs by at most 0.29 cells: at this many
// tolerances refinement may end.
constexpr double kRidgeCells = 3.2;
constexpr double kLargestShare = 1.0 / 72;  // of the longest side: refinement begins there where the cell is smaller
constexpr double kChordShare = 0.05;        // of the tolerance: the mesh of a shape must not spoil what the field holds
constexpr double kCoarsestShare = 1.0 / 32;        // of the longest side: chooseCell begins there
constexpr double kCoarsestSheetShare = 1.0 / 256;  // of a sheet, whose zero level lies a cell in front of it
constexpr double kFinestShare = 1.0 / 1024;        // chooseCell stops there
constexpr std::size_t kErrorProbes = 400;
constexpr int kMostTries = 4000;  // to find so many points
constexpr double kProbeQuantile = 0.9;

std::string inMillimetres(double metres) { return number("%.3g mm", 1e3 * metres); }

Errors keyedByPart(const PartSpec& spec, Errors errors) {
    for (auto& error : errors) error.key = "part " + spec.name;
    return errors;
}

/// A point within `reach` of the surface.
Vec3 pointNear(const geometry::TriangleMesh& mesh, double reach, Random& random) {
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

/// What trilinear interpolation of cells of edge `cell`, placed at random around points near the zero level, errs by at
/// the quantile kProbeQuantile [m].
double probedError(const field::DistanceSource& source, const geometry::TriangleMesh& mesh, double cell) {
    const auto signedAt = [&](const Vec3& p) {
        const double d = source.distance(p);
        return !source.open_sheet && source.inside(p) ? -d : d;
    };
    // The zero level of a sheet lies one cell in front of it: cells that the sheet cuts, where the distance has a kink,
    // are behind that.
    const double reach = source.open_sheet ? 2.0 * cell : cell;
    const double nearest = source.open_sheet ? cell : 0.0;
    Random random(1);
    std::vector<double> errors;
    for (int tried = 0; errors.size() < kErrorProbes && tried < kMostTries; ++tried) {
        const Vec3 p = pointNear(mesh, reach, random);
        const Vec3 u(random.uniform(), random.uniform(), random.uniform());
        const double truth = signedAt(p);
        if (std::abs(truth) < nearest) continue;
        field::CornerValues corners{};
        for (std::size_t c = 0; c < 8; ++c) corners[c] = signedAt(p + cell * (field::cornerAt(c) - u));
        errors.push_back(std::abs(field::trilinearValue(corners, u) - truth));
    }
    if (errors.empty()) return std::numeric_limits<double>::infinity();
    const auto quantile =
        errors.begin() + static_cast<std::ptrdiff_t>(kProbeQuantile * static_cast<double>(errors.size()));
    std::nth_element(errors.begin(), quantile, errors.end());
    return *quantile;
}

}  // namespace

field::DistanceSource exactSource(const Part& part) {
    field::DistanceSource source;
    source.bounds = geometry::boundsOf(part.mesh);
    source.area = part.report.area;
    if (part.shape) {
        const shape::Shape shape = *part.shape;
        source.open_sheet = std::holds_alternative<shape::Sheet>(shape);
        source.closed = !source.open_sheet;
        source.error_bound = [shape](const field::SurfaceBlock& block, const Vec3& low, double cell, std::size_t octant,
                                     double reach) {
            return field::boundInterpolation(shape, block, low, cell, octant, reach);
        };
        source.distance = [shape](const Vec3& p) { return std::abs(shape::signedDistance(shape, p)); };
        source.inside = [shape](const Vec3& p) { return shape::signedDistance(shape, p) < 0.0; };
        return source;
    }
    // Shared by the two functions, which may be copied.
    const auto tree = std::make_shared<const geometry::TriangleTree>(part.mesh);
    source.open_sheet = part.report.kind == importer::SurfaceKind::OpenSheet;
    source.closed = part.report.kind == importer::SurfaceKind::Solid;
    source.distance = [tree](const Vec3& p) { return tree->closest(p).distance; };
    source.nearest_within = [tree](const Vec3& p, double limit) {
        const geometry::ClosestPoint found = tree->closest(p, limit);
        return field::DistanceSource::Nearest{found.distance, found.point};
    };
    source.inside = [tree](const Vec3& p) { return tree->inside(p); };
    if (source.closed || source.open_sheet) {
        const field::MeshBlockSampler sampler(tree, source.closed, part.report.crossing_triangles == 0);
        source.block = [sampler](const Vec3& low, double cell, field::SurfaceBlock& block) {
            sampler.sample(low, cell, block);
        };
        source.distance_to = [sampler](const Vec3& p, std::span<const std::uint32_t> triangles) {
            return sampler.distance(p, triangles);
        };
    }
    return source;
}

double chooseCell(const field::DistanceSource& source, const geometry::TriangleMesh& mesh, double tolerance) {
    const double longest = source.bounds.size().maxCoeff();
    double cell = longest * (source.open_sheet ? kCoarsestSheetShare : kCoarsestShare);
    if (!source.open_sheet) {
        const double ridge = kRidgeCells * tolerance;
        cell = std::ldexp(ridge, static_cast<int>(std::floor(std::log2(cell / ridge))));
    }
    while (cell > kFinestShare * longest && probedError(source, mesh, cell) > tolerance) cell *= 0.5;
    return cell;
}

std::size_t fieldBytes(const Part& part) { return part.field ? part.field->memoryBytes() : 0; }

std::optional<std::string> tooManyPoints(const Vec3& size, double area, double spacing) {
    const double points = area / (spacing * spacing);
    if (!(points > kMaxShellPoints)) return std::nullopt;
    const auto length = [&](int axis) { return number("%.4g", 1e3 * size[axis]); };
    const double enough = 1.005 * std::sqrt(area / kMaxShellPoints);  // rounded to three digits, still enough
    return "points " + inMillimetres(spacing) + " apart on a part of " + length(0) + " x " + length(1) + " x " +
           length(2) + " mm are about " + number("%.2g", points) + ", more than " + number("%.2g", kMaxShellPoints) +
           ": check its unit, or choose a spacing of at least " + inMillimetres(enough);
}

namespace {

/// `cell` and its doublings, up to kLargestShare of the part.
double largestCell(const field::DistanceSource& source, double cell) {
    while (2.0 * cell <= kLargestShare * source.bounds.size().maxCoeff()) cell *= 2.0;
    return cell;
}

void tell(BuildStore* store, const Part& part, const std::string& what, double share = 0.0) {
    if (store != nullptr) store->building({part.name, what, share});
}

Result<field::DistanceField> buildField(const Part& part, const PartNeeds& needs, BuildStore* store) {
    tell(store, part, "distance field");
    field::DistanceSource source = exactSource(part);
    field::FieldAccuracy accuracy;
    accuracy.told = [&](int level, double share) {
        tell(store, part, "distance field, level " + std::to_string(level + 1), share);
    };
    if (needs.cell > 0.0) {
        accuracy.largest_cell = largestCell(source, needs.cell);
        return field::DistanceField::build(source, needs.cell, kUniformBandCells * needs.cell, accuracy);
    }
    source.landmarks = part.mesh.vertices;
    double cell = chooseCell(source, part.mesh, needs.tolerance);
    accuracy.tolerance = needs.tolerance;
    accuracy.depth = needs.depth > 0.0 ? needs.depth : kDepthTolerances * needs.tolerance;
    accuracy.largest_cell = largestCell(source, cell);
    // Whole bricks along the longest side: see DistanceField::build.
    const double bricks = source.bounds.size().maxCoeff() / (field::DistanceField::kBrickCells * accuracy.largest_cell);
    const double shrink = bricks / std::ceil(bricks);
    cell *= shrink;
    accuracy.largest_cell *= shrink;
    const double band = std::max(kBandCells * accuracy.largest_cell, accuracy.depth);
    return field::DistanceField::build(source, cell, band, accuracy);
}

/// What decides the bits of a field or shell: their format, the geometry, what was asked for.
std::string storeKey(const char* what, const Part& part, std::initializer_list<double> values) {
    std::string key = std::string(what) + " " + std::to_string(kKeptFormat) + " ";
    const auto append = [&](double value) { key += number("%a ", value); };
    if (part.shape) {
        key += std::string(shape::kindName(*part.shape)) + " ";
        for (const double value : shape::dimensions(*part.shape)) append(value);
    }
    char hash[24];
    std::snprintf(hash, sizeof hash, "%016llx ", static_cast<unsigned long long>(geometry::contentHash(part.mesh)));
    key += hash + std::to_string(part.mesh.vertices.size()) + " " + std::to_string(part.mesh.triangles.size()) + " " +
           std::to_string(static_cast<int>(part.report.kind)) + " ";
    for (const double value : values) append(value);
    return key;
}

/// What the store holds under `key`, read by `from`; if it cannot be, a note says so and nothing is returned.
template <class Read>
auto loaded(BuildStore* store, const std::string& key, Part& part, const Read& from) -> decltype(from({})) {
    if (store == nullptr) return std::nullopt;
    const auto bytes = store->load(storeName(key));
    if (!bytes) return std::nullopt;
    if (const auto content = unsealed(key, *bytes))
        if (auto value = from(*content)) return value;
    part.report.notes.push_back("What an earlier run had kept of this part was damaged or foreign: built anew.");
    return std::nullopt;
}

Result<field::DistanceField> fieldOf(Part& part, const PartNeeds& needs, BuildStore* store) {
    const std::string key = storeKey("field", part, {needs.tolerance, needs.cell, needs.depth});
    if (auto field = loaded(store, key, part, &field::DistanceField::fromBytes)) return std::move(*field);
    auto field = buildField(part, needs, store);
    if (field && store != nullptr) store->keep(storeName(key), sealed(key, field->toBytes()));
    return field;
}

/// What surfaces of `part` are made of.
geometry::TriangleMesh surfaceTriangles(const Part& part) {
    if (!part.shape) return part.mesh;
    for (double chord = kSurfaceChord;; chord *= 2.0)
        if (auto mesh = shape::tessellate(*part.shape, chord); mesh.triangles.size() <= kMostSurfaceTriangles)
            return mesh;
}

shell::PointShell shellOf(Part& part, const PartNeeds& needs, BuildStore* store) {
    const std::string key = storeKey("shell", part, {needs.spacing});
    if (auto shell = loaded(store, key, part, &shell::shellFrom)) return std::move(*shell);
    tell(store, part, "points");
    shell::PointShell shell = shell::samplePoints(part.mesh, needs.spacing);
    if (store != nullptr) store->keep(storeName(key), sealed(key, toBytes(shell)));
    return shell;
}

}  // namespace

Result<Part> buildPart(const PartSpec& spec, const PartNeeds& needs, BuildStore* store) {
    Part part;
    part.name = spec.name;
    if (const auto* shape = std::get_if<shape::Shape>(&spec.geometry)) {
        if (auto errors = shape::validate(*shape); !errors.empty()) return errors;
        part.shape = *shape;
        const double asked = kChordShare * needs.tolerance;
        part.chord_error = shape::chordError(*shape, asked);
        importer::ImportedMesh checked = importer::repairMesh(shape::tessellate(*shape, asked));
        part.mesh = std::move(checked.mesh);
        part.report = std::move(checked.report);
        part.report.format = shape::kindName(*shape);
    } else {
        const auto& file = std::get<MeshFile>(spec.geometry);
        tell(store, part, "mesh");
        auto imported = importMeshFile(file, store);
        if (!imported) return imported.errors();
        part.mesh = std::move(imported->mesh);
        part.report = std::move(imported->report);
    }
    if (needs.shell) {
        if (const auto excess = tooManyPoints(part.report.size, part.report.area, needs.spacing))
            return keyedByPart(spec, {Error{.message = *excess}});
    }
    if (needs.field) {
        auto field = fieldOf(part, needs, store);
        if (!field) return keyedByPart(spec, field.errors());
        part.field = std::make_shared<const field::DistanceField>(std::move(*field));
        if (!part.field->refined())
            part.report.notes.push_back("The field exceeds its tolerance at edges: it would need more than " +
                                        std::to_string(field::FieldAccuracy::kFieldBytes >> 20) + " MiB.");
        if (part.field->sheetOffset() > 0.0)
            part.report.notes.push_back("The sheet is felt " + inMillimetres(part.field->sheetOffset()) +
                                        " in front of its surface, on both sides.");
    }
    if (needs.clusters) tell(store, part, "triangles");
    if (needs.clusters) part.clusters = std::make_shared<const geometry::ClusterTree>(surfaceTriangles(part));
    if (needs.shell) {
        part.shell.emplace(shellOf(part, needs, store), part.mesh);
        part.edges = std::make_shared<const shell::EdgeCurves>(part.mesh, shell::kEdgeShare * needs.spacing);
    }
    return part;
}

}  // namespace passung::scene
