#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>

#include "core/field/distance_field.h"
#include "tests/bench/contact_scene.h"
#include "tests/bench/method.h"
#include "tests/bench/stopwatch.h"

namespace passung::bench {

namespace {

class VdbLevelSet : public LevelSet {
public:
    explicit VdbLevelSet(openvdb::FloatGrid::Ptr grid) : grid_(std::move(grid)) {}

    void sample(const Pose& X, std::span<const Vec3> points, std::span<double> phi) const override {
        const openvdb::FloatGrid::ConstAccessor accessor = grid_->getConstAccessor();
        const openvdb::math::Transform& transform = grid_->transform();
        const Mat3 turn = X.q.toRotationMatrix();
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3 p = turn * points[i] + X.p;
            const openvdb::Vec3d index = transform.worldToIndex(openvdb::Vec3d(p.x(), p.y(), p.z()));
            phi[i] = static_cast<double>(openvdb::tools::BoxSampler::sample(accessor, index));
        }
    }

    double memoryBytes() const override { return static_cast<double>(grid_->memUsage()); }

private:
    openvdb::FloatGrid::Ptr grid_;
};

class AllPoints : public Method {
public:
    AllPoints(std::unique_ptr<LevelSet> field, std::span<const shell::SurfacePoint> points)
        : field_(std::move(field)), points_(points.begin(), points.end()), phi_(points.size()) {
        for (const auto& point : points_) positions_.push_back(point.position);
    }

    Answer at(const Pose& X_FS) override {
        field_->sample(X_FS, positions_, phi_);
        Answer answer;
        answer.contacts = 0.0;
        answer.signed_distance = phi_[0];
        answer.wrench = {};
        for (std::size_t i = 0; i < points_.size(); ++i) {
            answer.signed_distance = std::min(answer.signed_distance, phi_[i]);
            if (!(phi_[i] < 0.0)) continue;
            answer.contacts += 1.0;
            const Vec3 force = X_FS.q * (kAreaStiffness * phi_[i] * points_[i].area * points_[i].normal);
            answer.wrench.force += force;
            answer.wrench.torque += (X_FS.q * points_[i].position).cross(force);
        }
        return answer;
    }

private:
    std::unique_ptr<LevelSet> field_;
    std::vector<shell::SurfacePoint> points_;
    std::vector<Vec3> positions_;
    std::vector<double> phi_;
};

}  // namespace

std::unique_ptr<LevelSet> buildLevelSet(const geometry::TriangleMesh& mesh, double cell, double band_cells) {
    openvdb::initialize();
    std::vector<openvdb::Vec3s> vertices;
    std::vector<openvdb::Vec3I> triangles;
    for (const Vec3& v : mesh.vertices)
        vertices.emplace_back(static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()));
    for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    return std::make_unique<VdbLevelSet>(openvdb::tools::meshToSignedDistanceField<openvdb::FloatGrid>(
        *openvdb::math::Transform::createLinearTransform(cell), vertices, triangles, {}, static_cast<float>(band_cells),
        static_cast<float>(band_cells)));
}

Candidate openvdbPoints(const geometry::TriangleMesh& field, double cell, std::span<const shell::SurfacePoint> points) {
    Candidate result{.name = "OpenVDB all points"};
    const WallClock watch;
    auto level_set = buildLevelSet(field, cell, 4.0);
    result.build_s = watch.seconds();
    result.memory_bytes = level_set->memoryBytes();
    result.method = std::make_unique<AllPoints>(std::move(level_set), points);
    return result;
}

}  // namespace passung::bench
