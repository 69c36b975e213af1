#include "core/scene/part_mass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/scene/number_text.h"

namespace passung::scene {

namespace {

using geometry::MassProperties;

constexpr double kChordPerDiameter = 5e-6;  // of triangles where there is no closed form

/// A cone's part between the heights `low` and `high`, of radius `r_low` and `r_high` there, axis z. Its integrands are
/// polynomials of degree 4 in z at most, of which Gauss's rule of three points is exact.
MassProperties frustum(double low, double r_low, double high, double r_high, double density) {
    const double half = 0.5 * (high - low), middle = 0.5 * (high + low);
    double volume = 0.0, first = 0.0, second = 0.0, across = 0.0;
    for (const auto& [t, weight] : {std::pair{-std::sqrt(0.6), 5.0 / 9}, {0.0, 8.0 / 9}, {std::sqrt(0.6), 5.0 / 9}}) {
        const double r = 0.5 * ((1.0 - t) * r_low + (1.0 + t) * r_high);
        const double slice = weight * half * std::numbers::pi * r * r;
        volume += slice;
        first += slice * half * t;  // from the middle
        second += slice * half * half * t * t;
        across += 0.25 * slice * r * r;  // ∫ x² = ∫ y²
    }
    if (!(volume > 0.0)) return {};
    const double z = first / volume, along = second - first * z;
    return {density * volume, Vec3(0, 0, middle + z),
            density * Vec3(across + along, across + along, 2.0 * across).asDiagonal().toDenseMatrix()};
}

MassProperties block(const Vec3& size, const Vec3& centre, double density) {
    const double mass = density * size.prod();
    const Vec3 square = size.cwiseAbs2();
    return {mass, centre, mass / 12.0 * (square.sum() * Mat3::Identity() - Mat3(square.asDiagonal()))};
}

MassProperties withoutHole(const MassProperties& body, const MassProperties& hole) {
    return geometry::together(body, {-hole.mass, hole.centre, -hole.inertia});
}

struct MassOf {
    double density;

    using Mass = std::optional<MassProperties>;
    Mass operator()(const shape::Sphere& s) const {
        const double r = 0.5 * s.diameter, mass = density * 4.0 / 3.0 * std::numbers::pi * r * r * r;
        return MassProperties{mass, Vec3::Zero(), 0.4 * mass * r * r * Mat3::Identity()};
    }
    Mass operator()(const shape::Box& s) const { return block({s.width, s.depth, s.height}, Vec3::Zero(), density); }
    Mass operator()(const shape::Cylinder& s) const {
        return frustum(-0.5 * s.length, 0.5 * s.diameter, 0.5 * s.length, 0.5 * s.diameter, density);
    }
    /// Pappus; its inertia is the textbook's.
    Mass operator()(const shape::Torus& s) const {
        const double R = 0.5 * s.diameter, r = 0.5 * s.tube_diameter;
        const double mass = density * 2.0 * std::numbers::pi * std::numbers::pi * R * r * r;
        const double side = 0.5 * R * R + 0.625 * r * r;
        return MassProperties{mass, Vec3::Zero(),
                              mass * Vec3(side, side, R * R + 0.75 * r * r).asDiagonal().toDenseMatrix()};
    }
    Mass operator()(const shape::Sheet&) const { return std::nullopt; }
    Mass operator()(const shape::Peg& s) const {
        const double r = 0.5 * s.diameter, c = s.chamfer;
        const MassProperties body = frustum(c, r, s.length, r, density);
        return c > 0.0 ? geometry::together(body, frustum(0.0, r - c, c, r, density)) : body;
    }
    Mass operator()(const shape::BorePlate& s) const {
        const double r = 0.5 * s.bore_diameter, c = s.chamfer, deep = std::min(s.bore_depth, s.height);
        const MassProperties plate = block({s.width, s.depth, s.height}, {0, 0, -0.5 * s.height}, density);
        const MassProperties bored = withoutHole(plate, frustum(-deep, r, -c, r, density));
        return c > 0.0 ? withoutHole(bored, frustum(-c, r, 0.0, r + c, density)) : bored;
    }
    // Flat faces alone: triangles are exact.
    Mass operator()(const shape::SquarePeg& s) const { return ofTriangles(s, s.width); }
    Mass operator()(const shape::SquareBorePlate& s) const { return ofTriangles(s, s.width); }
    Mass operator()(const shape::KeyedPeg& s) const { return ofTriangles(s, s.diameter); }
    Mass operator()(const shape::KeyedBorePlate& s) const { return ofTriangles(s, s.bore_diameter); }
    Mass operator()(const shape::ThreadBolt& s) const { return ofTriangles(s, s.nominal_diameter); }
    Mass operator()(const shape::ThreadNut& s) const { return ofTriangles(s, s.nominal_diameter); }

    Mass ofTriangles(const shape::Shape& shape, double diameter) const {
        return geometry::massOf(shape::tessellate(shape, kChordPerDiameter * diameter), density);
    }
};

}  // namespace

std::optional<MassProperties> massOf(const shape::Shape& shape, double density) {
    return std::visit(MassOf{density}, shape);
}

std::optional<MassProperties> massOf(const Part& part, double density) {
    if (part.shape) return massOf(*part.shape, density);
    if (!isClosed(part.report)) return std::nullopt;
    return geometry::massOf(part.mesh, density);
}

bool isClosed(const importer::MeshReport& report) {
    return report.kind == importer::SurfaceKind::Solid && report.closed_holes == 0;
}

std::optional<HeldWeight> weigh(const SceneSpec& scene, const geometry::MassProperties& body) {
    const double g = scene.effects.weight.gravity.norm();
    if (!(g > 0.0) || !(body.mass > 0.0)) return std::nullopt;
    HeldWeight weight;
    weight.body = body;
    weight.force = body.mass * g;
    weight.torque = weight.force * body.centre.norm();
    weight.has_proxy = scene.parts.size() > 1 && !scene.contact.rendersAtHand();
    if (!weight.has_proxy) return weight;
    weight.sag = weight.force / scene.contact.stiffness;
    const double K_phi = scene.contact.rotational_stiffness;
    weight.turn = K_phi > 0.0 ? weight.torque / K_phi : 0.0;
    return weight;
}

std::string describe(const HeldWeight& weight) {
    const std::string weighs =
        "of " +
        (weight.body.mass < 1.0 ? number("%.3g g", 1e3 * weight.body.mass) : number("%.3g kg", weight.body.mass)) +
        " weighs " + number("%.3g N", weight.force) + ", up to " + number("%.3g Nm", weight.torque) +
        " about its origin; in the air it ";
    if (!weight.has_proxy) return weighs + "is where the hand is";
    return weighs + "hangs " + number("%.3g mm", 1e3 * weight.sag) + " from the hand, turned by up to " +
           number("%.2g deg", 180.0 / std::numbers::pi * weight.turn);
}

}  // namespace passung::scene
