#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>

#include "tests/bench/method.h"
#include "tests/bench/stopwatch.h"

namespace passung::bench {

namespace {

using Surface = fcl::BVHModel<fcl::OBBRSSd>;

void fill(Surface& surface, const geometry::TriangleMesh& mesh) {
    std::vector<fcl::Triangle> triangles;
    for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    surface.beginModel();
    surface.addSubModel(mesh.vertices, triangles);
    surface.endModel();
}

fcl::Transform3d transformOf(const Pose& pose) {
    fcl::Transform3d transform = fcl::Transform3d::Identity();
    transform.linear() = pose.q.toRotationMatrix();
    transform.translation() = pose.p;
    return transform;
}

struct Pair {
    Surface field, shell;
};

/// Every pair of triangles that meet. The depth of a contact belongs to its pair of triangles: it is reported because
/// it is all there is.
class AllContacts : public Method {
public:
    explicit AllContacts(std::unique_ptr<Pair> pair) : pair_(std::move(pair)) {}
    Answer at(const Pose& X_FS) override {
        result_.clear();
        fcl::collide(&pair_->field, fcl::Transform3d::Identity(), &pair_->shell, transformOf(X_FS), request_, result_);
        Answer answer;
        answer.contacts = static_cast<double>(result_.numContacts());
        double depth = 0.0;
        for (std::size_t i = 0; i < result_.numContacts(); ++i)
            depth = std::max(depth, result_.getContact(i).penetration_depth);
        if (result_.numContacts() > 0) answer.signed_distance = -depth;
        return answer;
    }

private:
    std::unique_ptr<Pair> pair_;
    fcl::CollisionRequestd request_{1'000'000, true};
    fcl::CollisionResultd result_;
};

class Distance : public Method {
public:
    explicit Distance(std::unique_ptr<Pair> pair) : pair_(std::move(pair)) {}
    Answer at(const Pose& X_FS) override {
        result_.clear();
        fcl::distance(&pair_->field, fcl::Transform3d::Identity(), &pair_->shell, transformOf(X_FS), request_, result_);
        Answer answer;
        answer.signed_distance = std::max(0.0, result_.min_distance);
        return answer;
    }

private:
    std::unique_ptr<Pair> pair_;
    fcl::DistanceRequestd request_{true};  // nearest points too: ours gives them
    fcl::DistanceResultd result_;
};

template <class M>
Candidate candidate(const char* name, const geometry::TriangleMesh& field, const geometry::TriangleMesh& shell) {
    Candidate result{.name = name, .settings = "BVH of OBBRSS, double"};
    const double before = heapBytes();
    auto pair = std::make_unique<Pair>();
    const Stopwatch watch;
    fill(pair->field, field);
    fill(pair->shell, shell);
    result.build_s = watch.seconds();
    result.memory_bytes = heapBytes() - before;
    result.method = std::make_unique<M>(std::move(pair));
    return result;
}

}  // namespace

Candidate fclAllContacts(const geometry::TriangleMesh& field, const geometry::TriangleMesh& shell) {
    return candidate<AllContacts>("FCL all contacts", field, shell);
}

Candidate fclDistance(const geometry::TriangleMesh& field, const geometry::TriangleMesh& shell) {
    return candidate<Distance>("FCL distance", field, shell);
}

}  // namespace passung::bench
