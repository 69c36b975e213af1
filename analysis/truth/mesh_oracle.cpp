#include "analysis/truth/mesh_oracle.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <vector>

namespace passung::truth {
namespace {

using FclSurface = fcl::BVHModel<fcl::OBBRSSd>;

// FCL's distance leaves the face out of a triangle whose doubled area squared is below 1e-15: in metres, of edges below
// 0.2 mm. Then it says 0 of triangles that are apart, or takes an edge for the nearest. Its lengths are therefore
// smaller units; a power of two, so that nothing is rounded by it.
constexpr double kPerMetre = 65536.0;

std::unique_ptr<FclSurface> surfaceOf(const geometry::TriangleMesh& mesh) {
    std::vector<Vec3> vertices;
    vertices.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) vertices.push_back(kPerMetre * v);
    std::vector<fcl::Triangle> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const geometry::Triangle& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    auto surface = std::make_unique<FclSurface>();
    surface->beginModel();
    surface->addSubModel(vertices, triangles);
    surface->endModel();
    return surface;
}

fcl::Transform3d transformOf(const Pose& pose) {
    fcl::Transform3d transform = fcl::Transform3d::Identity();
    transform.linear() = pose.q.toRotationMatrix();
    transform.translation() = kPerMetre * pose.p;
    return transform;
}

Error notFinite() { return {.message = "pose of B in A: every component must be finite"}; }

}  // namespace

struct MeshOracle::Surfaces {
    std::unique_ptr<FclSurface> a, b;
};

const char* toString(Relation relation) {
    switch (relation) {
        case Relation::Apart:
            return "apart";
        case Relation::SurfacesIntersect:
            return "surfaces intersect";
        case Relation::BInsideA:
            return "B inside A";
        case Relation::AInsideB:
            return "A inside B";
    }
    return "";
}

MeshOracle::MeshOracle(const geometry::TriangleMesh& a, const geometry::TriangleMesh& b)
    : surfaces_(std::make_unique<Surfaces>()), exact_a_(a), exact_b_(b) {
    surfaces_->a = surfaceOf(a);
    surfaces_->b = surfaceOf(b);
}

MeshOracle::~MeshOracle() = default;
MeshOracle::MeshOracle(MeshOracle&&) noexcept = default;
MeshOracle& MeshOracle::operator=(MeshOracle&&) noexcept = default;

Result<bool> MeshOracle::surfacesIntersect(const Pose& X_AB) const {
    if (!isFinite(X_AB)) return notFinite();
    const fcl::CollisionRequestd request(1, false);
    fcl::CollisionResultd result;
    return fcl::collide(surfaces_->a.get(), fcl::Transform3d::Identity(), surfaces_->b.get(), transformOf(X_AB),
                        request, result) > 0;
}

Result<double> MeshOracle::separation(const Pose& X_AB) const {
    if (!isFinite(X_AB)) return notFinite();
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    fcl::distance(surfaces_->a.get(), fcl::Transform3d::Identity(), surfaces_->b.get(), transformOf(X_AB), request,
                  result);
    return std::max(0.0, result.min_distance / kPerMetre);
}

Result<Relation> MeshOracle::relation(const Pose& X_AB) const {
    const Result<bool> intersect = surfacesIntersect(X_AB);
    if (!intersect) return intersect.errors();
    if (*intersect) return Relation::SurfacesIntersect;
    if (exact_a_.contains(X_AB * exact_b_.triangles().front()[0])) return Relation::BInsideA;
    if (exact_b_.contains(X_AB.inverse() * exact_a_.triangles().front()[0])) return Relation::AInsideB;
    return Relation::Apart;
}

Result<DeepestPoint> MeshOracle::depth(const Pose& X_AB, double resolution) const {
    if (!isFinite(X_AB)) return notFinite();
    return deepestPoint(exact_a_, exact_b_, X_AB, resolution);
}

}  // namespace passung::truth
