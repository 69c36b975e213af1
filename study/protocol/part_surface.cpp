#include "study/protocol/part_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "core/scene/mesh_source.h"
#include "core/scene/part_mass.h"

namespace passung::protocol {
namespace {

constexpr int kBallSteps = 12;           // of the search for a ball, along each axis
constexpr double kOnSurface = 1e-9;      // of the part's size: rounding
constexpr double kChordPerSize = 0.005;  // of triangles that give a shape's bounds

PartSurface solid(const Vec3& size, double area) { return {size, area, false, "", nullptr, nullptr}; }

PartSurface roundExtent(double diameter, double length) {
    return solid({diameter, diameter, length}, std::numbers::pi * diameter * (0.5 * diameter + length));
}

PartSurface blockExtent(double x, double y, double z) { return solid({x, y, z}, 2.0 * (x * y + y * z + z * x)); }

struct GeometryOf {
    PartSurface operator()(const shape::Sphere& s) const {
        return solid(Vec3::Constant(s.diameter), std::numbers::pi * s.diameter * s.diameter);
    }
    PartSurface operator()(const shape::Box& s) const { return blockExtent(s.width, s.depth, s.height); }
    PartSurface operator()(const shape::Cylinder& s) const { return roundExtent(s.diameter, s.length); }
    PartSurface operator()(const shape::Torus& s) const {
        const double outer = s.diameter + s.tube_diameter;
        return solid({outer, outer, s.tube_diameter},
                     std::numbers::pi * std::numbers::pi * s.diameter * s.tube_diameter);
    }
    PartSurface operator()(const shape::Sheet& s) const {
        PartSurface sheet = solid({s.width, s.depth, 0.0}, s.width * s.depth);
        sheet.sheet = true;
        sheet.not_closed = "it is a sheet";
        return sheet;
    }
    PartSurface operator()(const shape::Peg& s) const { return roundExtent(s.diameter, s.length); }
    PartSurface operator()(const shape::SquarePeg& s) const { return blockExtent(s.width, s.depth, s.length); }
    PartSurface operator()(const shape::KeyedPeg& s) const { return roundExtent(s.diameter, s.length); }
    PartSurface operator()(const shape::ThreadBolt& s) const {
        return solid({s.nominal_diameter, s.nominal_diameter, s.length}, threadArea(s.nominal_diameter, s.length));
    }
    PartSurface operator()(const shape::ThreadNut& s) const {
        const PartSurface round = roundExtent(s.outer_diameter, s.height);
        return solid(round.size, round.area + threadArea(s.nominal_diameter, s.height));
    }
    /// With two ends. Flanks make a thread's surface 1.625 times as large as a cylinder's.
    static double threadArea(double diameter, double length) {
        return std::numbers::pi * diameter * (0.5 * diameter + 1.625 * length);
    }
    template <class Plate>
    PartSurface operator()(const Plate& plate) const {
        return blockExtent(plate.width, plate.depth, plate.height);
    }
};

/// Why a mesh encloses no volume.
std::string whyNotClosed(const importer::MeshReport& report) {
    if (scene::isClosed(report)) return "";
    if (report.kind == importer::SurfaceKind::OpenSheet) return "its mesh is an open sheet";
    const std::size_t holes = std::max(report.holes, report.closed_holes);
    return holes > 0 ? fmt::format("its mesh has {} hole{}", holes, holes == 1 ? "" : "s")
                     : fmt::format("its mesh has {} open edges", report.open_edges_left);
}

std::unique_ptr<PartSurface> asGeometry(importer::ImportedMesh mesh) {
    auto geometry = std::make_unique<PartSurface>();
    geometry->size = mesh.report.size;
    geometry->area = mesh.report.area;
    geometry->sheet = mesh.report.kind == importer::SurfaceKind::OpenSheet;
    geometry->not_closed = whyNotClosed(mesh.report);
    geometry->mesh = std::make_shared<const geometry::TriangleMesh>(std::move(mesh.mesh));
    geometry->tree = std::make_shared<const geometry::TriangleTree>(*geometry->mesh);
    return geometry;
}

}  // namespace

std::string geometryKey(const scene::PartSpec& part) {
    if (const auto* file = std::get_if<scene::MeshFile>(&part.geometry))
        return fmt::format("{} {:a}", file->path, file->metres_per_unit);
    const auto& shape = std::get<shape::Shape>(part.geometry);
    std::string key = shape::kindName(shape);
    for (const double value : shape::dimensions(shape)) key += fmt::format(" {:a}", value);
    return key;
}

const PartSurface* PartGeometries::of(const scene::PartSpec& part) {
    const auto [place, fresh] = geometries_.try_emplace(geometryKey(part));
    if (fresh) {
        if (const auto* shape = std::get_if<shape::Shape>(&part.geometry))
            place->second = std::make_unique<PartSurface>(std::visit(GeometryOf{}, *shape));
        else if (auto mesh = scene::importMeshFile(std::get<scene::MeshFile>(part.geometry), builds_))
            place->second = asGeometry(*std::move(mesh));
        else
            problems_[place->first] = mesh.errors();
    }
    return place->second.get();
}

Errors PartGeometries::problems(const scene::PartSpec& part) {
    of(part);
    const auto known = problems_.find(geometryKey(part));
    return known != problems_.end() ? known->second : Errors{};
}

const std::vector<shape::ThinFeature>& PartGeometries::thin(const scene::PartSpec& part, double radius,
                                                            shape::ThinIn where) {
    const auto [place, fresh] =
        thin_.try_emplace(fmt::format("{} {:a} {}", geometryKey(part), radius, static_cast<int>(where)));
    if (!fresh) return place->second;
    if (const auto* shape = std::get_if<shape::Shape>(&part.geometry))
        return place->second = shape::thinFeatures(*shape, radius, where);
    const PartSurface* geometry = of(part);
    if (geometry == nullptr) return place->second;
    if (geometry->sheet) return place->second = {{shape::FeatureKind::Wall, 0.0, Vec3::Zero()}};
    // Of all radii together, which conditions and their levels may make as many of as they like.
    std::size_t& left = work_left_.try_emplace(geometryKey(part), shape::SearchLimit{}.most_work).first->second;
    shape::SearchLimit limit{.most_work = left};
    place->second = shape::thinFeatures(*geometry->mesh, *geometry->tree, radius, where, &limit);
    left -= std::min(left, limit.work);
    if (limit.left_out > 0) half_searched_.insert(geometryKey(part));
    return place->second;
}

std::optional<geometry::MassProperties> PartGeometries::massOf(const scene::PartSpec& part) {
    const PartSurface* geometry = of(part);
    if (geometry == nullptr || !geometry->not_closed.empty()) return std::nullopt;
    const auto [place, fresh] = unit_masses_.try_emplace(geometryKey(part));
    if (fresh) {
        if (const auto* shape = std::get_if<shape::Shape>(&part.geometry))
            place->second = scene::massOf(*shape, 1.0);
        else
            place->second = geometry::massOf(*geometry->mesh, 1.0);
    }
    auto body = place->second;
    if (!body) return std::nullopt;
    body->mass *= part.density;
    body->inertia *= part.density;
    return body;
}

std::string PartGeometries::notClosed(const scene::PartSpec& part) {
    const PartSurface* geometry = of(part);
    return geometry != nullptr ? geometry->not_closed : "it cannot be read";
}

double PartGeometries::remembered(const std::string& question, const std::function<double()>& reckon) {
    const auto known = remembered_.find(question);
    return known != remembered_.end() ? known->second : remembered_.emplace(question, reckon()).first->second;
}

geometry::Bounds PartGeometries::boundsOf(const scene::PartSpec& part) {
    const PartSurface& geometry = *of(part);
    if (const auto* shape = std::get_if<shape::Shape>(&part.geometry))
        return geometry::boundsOf(shape::tessellate(*shape, kChordPerSize * geometry.longest()));
    return geometry::boundsOf(*geometry.mesh);
}

PartGeometries::Ball PartGeometries::ballAtOrigin(const scene::PartSpec& part) {
    const PartSurface* geometry = of(part);
    if (geometry == nullptr || geometry->sheet) return {};
    const double outside = signedDistance(part, Vec3::Zero());
    if (outside > kOnSurface * geometry->longest()) return {};
    return {Vec3::Zero(), std::max(0.0, -outside)};
}

PartGeometries::Ball PartGeometries::largestBall(const scene::PartSpec& part) {
    const auto [place, fresh] = balls_.try_emplace(geometryKey(part));
    const PartSurface* geometry = of(part);
    if (!fresh || geometry == nullptr || geometry->sheet) return place->second;
    Ball& best = place->second;
    const auto tryAt = [&](const Vec3& p) {
        const double radius = -signedDistance(part, p);
        const bool better = radius > best.radius;
        if (better) best = {p, radius};
        return better;
    };
    const geometry::Bounds bounds = boundsOf(part);
    const Vec3 step = bounds.size() / kBallSteps;
    for (int i = 0; i < kBallSteps; ++i)
        for (int j = 0; j < kBallSteps; ++j)
            for (int k = 0; k < kBallSteps; ++k) tryAt(bounds.low + step.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5)));
    for (Vec3 move = 0.5 * step; move.norm() > 1e-3 * step.norm(); move *= 0.5) {
        const Vec3 from = best.centre;
        for (int axis = 0; axis < 3; ++axis)
            for (const double sign : {1.0, -1.0}) tryAt(from + sign * move[axis] * Vec3::Unit(axis));
    }
    if (!(best.radius > 0.0)) best = {};
    return best;
}

double PartGeometries::signedDistance(const scene::PartSpec& part, const Vec3& p) {
    if (const auto* shape = std::get_if<shape::Shape>(&part.geometry)) return shape::signedDistance(*shape, p);
    const PartSurface& geometry = *of(part);
    const double distance = geometry.tree->closest(p).distance;
    return !geometry.sheet && geometry.tree->inside(p) ? -distance : distance;
}

}  // namespace passung::protocol
