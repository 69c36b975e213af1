#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "analysis/truth/mesh_oracle.h"
#include "core/base/random.h"
#include "core/model/part.h"
#include "core/tick/part_query.h"

namespace passung {
namespace {

/// A sphere of 20 mm with seeded bumps of up to 2 mm: a closed mesh without symmetry.
model::TriangleMesh bumpyBall() {
    model::TriangleMesh mesh = model::tessellate(model::Sphere{0.02}, 20e-6);
    for (Vec3& v : mesh.vertices) {
        const Vec3 d = v.normalized();
        v += 1e-3 * (std::sin(7 * d.x() + 1) + std::cos(5 * d.y() - 2 * d.z())) * d;
    }
    return mesh;
}

/// A part from a mesh file, so that import, tree and winding number are part of what is tested.
model::Part meshPart(const model::TriangleMesh& mesh, const char* name) {
    const auto path =
        std::filesystem::temp_directory_path() / (std::string("passung_") + name + std::to_string(getpid()) + ".off");
    std::ofstream out(path);
    out.precision(17);
    out << "OFF\n" << mesh.vertices.size() << " " << mesh.triangles.size() << " 0\n";
    for (const Vec3& v : mesh.vertices) out << v.x() << " " << v.y() << " " << v.z() << "\n";
    for (const auto& t : mesh.triangles) out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
    out.close();
    model::PartSpec spec;
    spec.name = name;
    spec.geometry = model::MeshFile{path.string(), 1.0};
    auto part = model::buildPart(spec, {.field = true, .shell = true, .cell = 0.4e-3, .spacing = 0.7e-3});
    std::filesystem::remove(path);
    if (!part) ADD_FAILURE() << toString(part.errors().front());
    return std::move(*part);
}

struct Pair {
    const char* name;
    model::Part field, shell;
};

/// Half of the poses anywhere around, half near first contact (bisected along a random line by FCL).
Pose randomPose(const truth::MeshOracle& oracle, double reach, bool near_contact, Random& random) {
    const Quat q = rotationFromVector(1.5 * Vec3(random.normal(), random.normal(), random.normal()));
    const Vec3 direction = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    if (!near_contact) return {q, reach * random.uniform() * direction};
    double inner = 0.0, outer = 3.0 * reach;
    for (int i = 0; i < 12; ++i) {
        const double middle = 0.5 * (inner + outer);
        const auto touching = oracle.relation({q, middle * direction});
        (*touching != truth::Relation::Apart ? inner : outer) = middle;
    }
    return {q, (outer + random.uniform(-2e-3, 2e-3)) * direction};
}

TEST(QueryAgainstFcl, AgreesOnSurfaceIntersectionAndSeparationWithinTheStatedBound) {
    // Truth: independent program (FCL 0.7, collide and distance of BVH OBBRSS models); containment without surface
    // intersection, which FCL calls free, by independent ray parity.
    std::vector<Pair> pairs;
    pairs.push_back({"bumpy ball in bumpy ball", meshPart(bumpyBall(), "ball_a"), meshPart(bumpyBall(), "ball_b")});
    pairs.push_back(
        {"peg and bore plate",
         meshPart(model::tessellate(model::BorePlate{0.03, 0.03, 0.015, 0.0104, 0.012, 0.5e-3}, 5e-6), "plate"),
         meshPart(model::tessellate(model::Peg{0.01, 0.02, 0.5e-3}, 5e-6), "peg")});
    pairs.push_back({"box and small cylinder", meshPart(model::tessellate(model::Box{0.03, 0.02, 0.025}, 5e-6), "box"),
                     meshPart(model::tessellate(model::Cylinder{0.006, 0.009}, 5e-6), "cylinder")});
    Random random(2026);
    for (auto& pair : pairs) {
        const truth::MeshOracle oracle(pair.field.mesh, pair.shell.mesh);
        tick::PartQuery query(pair.field, pair.shell, {});
        const double reach = 0.5 * (boundsOf(pair.field.mesh).size().norm() + boundsOf(pair.shell.mesh).size().norm());
        int undecided = 0, intersecting = 0, contained = 0, apart = 0;
        std::vector<double> bounds;
        for (int i = 0; i < 800; ++i) {
            const Pose X_FS = randomPose(oracle, 0.7 * reach, i % 2 == 0, random);
            const auto r = query.at(X_FS);
            const auto relation = oracle.relation(X_FS);
            ASSERT_TRUE(relation);
            bounds.push_back(r.error_bound);
            const auto place = [&] {
                ::testing::Message m;
                m << pair.name << " pose " << X_FS.p.transpose() << " q " << X_FS.q.coeffs().transpose() << " distance "
                  << r.signed_distance << " ± " << r.error_bound << " FCL says " << truth::toString(*relation);
                return m;
            };
            if (*relation == truth::Relation::Apart) {
                const auto separation = oracle.separation(X_FS);
                ASSERT_LE(std::abs(r.signed_distance - *separation), r.error_bound) << place();
            } else if (*relation == truth::Relation::SurfacesIntersect) {
                ASSERT_LE(r.signed_distance, r.error_bound) << place();
            } else if (*relation == truth::Relation::BInsideA) {
                ASSERT_LE(r.signed_distance, r.error_bound) << place();
            } else {  // A inside B: B's surface lies outside A
                ASSERT_GE(r.signed_distance, -r.error_bound) << place();
            }
            intersecting += *relation == truth::Relation::SurfacesIntersect ? 1 : 0;
            contained += *relation == truth::Relation::BInsideA || *relation == truth::Relation::AInsideB ? 1 : 0;
            apart += *relation == truth::Relation::Apart ? 1 : 0;
            undecided += std::abs(r.signed_distance) <= r.error_bound ? 1 : 0;
        }
        std::sort(bounds.begin(), bounds.end());
        std::printf(
            "%-26s apart %d, intersecting %d, contained %d; within the bound of touching %d; bound median %.2f mm\n",
            pair.name, apart, intersecting, contained, undecided, bounds[400] * 1e3);
        EXPECT_GT(apart, 100) << pair.name;
        EXPECT_GT(intersecting, 100) << pair.name;
        EXPECT_LT(undecided, 500) << pair.name << ": a bound that decides nothing proves nothing";
    }
}

TEST(QueryAgainstExactDepth, DeepestPointIsWithinTheStatedBoundOfDenseGeometry) {
    // Truth: independent dense geometry (branch and bound over the whole surface, exact distances, ray parity).
    const model::Part plate =
        meshPart(model::tessellate(model::BorePlate{0.03, 0.03, 0.015, 0.0104, 0.012, 0.5e-3}, 5e-6), "plate2");
    const model::Part ball = meshPart(bumpyBall(), "ball2");
    const truth::MeshOracle oracle(plate.mesh, ball.mesh);
    tick::PartQuery query(plate, ball, {});
    Random random(7);
    int tried = 0;
    for (int i = 0; i < 400 && tried < 60; ++i) {
        const Pose X_FS = randomPose(oracle, 0.02, true, random);
        if (*oracle.relation(X_FS) != truth::Relation::SurfacesIntersect) continue;
        ++tried;
        const auto truth = oracle.depth(X_FS, 5e-6);
        ASSERT_TRUE(truth);
        const auto r = query.at(X_FS);
        ASSERT_LE(std::abs(-r.signed_distance - truth->depth), r.error_bound + truth->uncertainty)
            << X_FS.p.transpose() << " q " << X_FS.q.coeffs().transpose();
    }
    EXPECT_EQ(tried, 60);
}

}  // namespace
}  // namespace passung
