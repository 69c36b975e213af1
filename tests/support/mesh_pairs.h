#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "analysis/truth/mesh_oracle.h"
#include "core/base/random.h"
#include "core/scene/part.h"
#include "tests/support/off_file.h"

namespace passung::test {

/// A sphere with seeded bumps of up to a tenth of its diameter: a closed mesh without symmetry.
inline geometry::TriangleMesh bumpyBall(double diameter) {
    geometry::TriangleMesh mesh = shape::tessellate(shape::Sphere{diameter}, 3e-3 * diameter);
    for (Vec3& v : mesh.vertices) {
        const Vec3 d = v.normalized();
        v += 0.05 * diameter * (std::sin(7 * d.x() + 1) + std::cos(5 * d.y() - 2 * d.z())) * d;
    }
    return mesh;
}

/// A part from a mesh file, so that import, tree and winding number are part of what is tested.
inline scene::Part meshPart(const geometry::TriangleMesh& mesh, const std::string& name, double cell, double spacing) {
    const auto path =
        std::filesystem::temp_directory_path() / ("passung_" + name + "_" + std::to_string(getpid()) + ".off");
    writeOff(path.string(), mesh);
    scene::PartSpec spec;
    spec.name = name;
    spec.geometry = scene::MeshFile{path.string(), 1.0};
    auto part = scene::buildPart(spec, {.field = true, .shell = true, .cell = cell, .spacing = spacing});
    std::filesystem::remove(path);
    if (!part) ADD_FAILURE() << toString(part.errors().front());
    return std::move(*part);
}

/// Two parts and what is true about them, by means that share nothing with the query (but the triangles).
struct MeshPair {
    MeshPair(std::string name_, scene::Part field_, scene::Part shell_)
        : name(std::move(name_)), field(std::move(field_)), shell(std::move(shell_)), oracle(field.mesh, shell.mesh) {}

    std::string name;
    scene::Part field, shell;
    truth::MeshOracle oracle;  // A: field, B: shell

    /// The distance from which no pose lets the parts touch.
    double reach() const { return 0.5 * (boundsOf(field.mesh).size().norm() + boundsOf(shell.mesh).size().norm()); }
};

/// Bounds of min φ over a surface [m].
struct TrueInterval {
    double low = 0.0, high = 0.0;
};

/// What the two directions of a query seek, for one pose.
struct PairTruth {
    truth::Relation relation = truth::Relation::Apart;
    TrueInterval shell_in_field, field_in_shell;
};

/// Where a surface lies outside the other solid, FCL's distance of the surfaces; where it reaches in, the depth by
/// branch and bound over all of it.
inline PairTruth truthOf(const MeshPair& pair, const Pose& X_FS, double resolution) {
    using truth::Relation;
    PairTruth result;
    result.relation = *pair.oracle.relation(X_FS);
    const bool intersect = result.relation == Relation::SurfacesIntersect;
    const double separation = intersect ? 0.0 : *pair.oracle.separation(X_FS);
    const auto inward = [&](const truth::ExactMesh& solid, const truth::ExactMesh& surface, const Pose& X) {
        const truth::DeepestPoint deepest = truth::deepestPoint(solid, surface, X, resolution);
        return TrueInterval{-deepest.depth - deepest.uncertainty, -deepest.depth};
    };
    const bool b_inward = intersect || result.relation == Relation::BInsideA;
    const bool a_inward = intersect || result.relation == Relation::AInsideB;
    result.shell_in_field =
        b_inward ? inward(pair.oracle.a(), pair.oracle.b(), X_FS) : TrueInterval{separation, separation};
    result.field_in_shell =
        a_inward ? inward(pair.oracle.b(), pair.oracle.a(), X_FS.inverse()) : TrueInterval{separation, separation};
    return result;
}

inline Vec3 randomDirection(Random& random) {
    return Vec3(random.normal(), random.normal(), random.normal()).normalized();
}

inline Quat randomTurn(Random& random) {
    return Quat(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
}

/// A pose of B within `spread` [m] of first contact along a random line (bisected with FCL).
inline Pose poseNearContact(const MeshPair& pair, double spread, Random& random) {
    const Quat q = randomTurn(random);
    const Vec3 direction = randomDirection(random);
    double inner = 0.0, outer = pair.reach();
    for (int i = 0; i < 12; ++i) {
        const double middle = 0.5 * (inner + outer);
        (*pair.oracle.relation({q, middle * direction}) != truth::Relation::Apart ? inner : outer) = middle;
    }
    return {q, (outer + random.uniform(-spread, spread)) * direction};
}

/// A pose of B anywhere around A and inside it.
inline Pose poseAnywhere(const MeshPair& pair, Random& random) {
    const Quat q = randomTurn(random);
    return {q, 0.7 * pair.reach() * random.uniform() * randomDirection(random)};
}

/// For a message: enough digits to repeat the query.
inline std::string toText(const Pose& pose) {
    std::ostringstream text;
    text.precision(17);
    text << "p " << pose.p.transpose() << " q(xyzw) " << pose.q.coeffs().transpose();
    return text.str();
}

}  // namespace passung::test
