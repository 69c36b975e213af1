#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>

#include "tests/bench/method.h"
#include "tests/bench/stopwatch.h"

namespace passung::bench {

namespace {

// Bullet is made for lengths of about 0.05 to 10: centimetres, a margin of 0.1 mm.
constexpr btScalar kUnitsPerMetre = 100;
constexpr btScalar kMargin = btScalar(0.01);

btVector3 scaled(const Vec3& p) {
    return {static_cast<btScalar>(p.x()) * kUnitsPerMetre, static_cast<btScalar>(p.y()) * kUnitsPerMetre,
            static_cast<btScalar>(p.z()) * kUnitsPerMetre};
}

struct GimpactBody {
    explicit GimpactBody(const geometry::TriangleMesh& mesh) {
        for (const auto& t : mesh.triangles)
            triangles.addTriangle(scaled(mesh.vertices[t[0]]), scaled(mesh.vertices[t[1]]),
                                  scaled(mesh.vertices[t[2]]));
        shape = std::make_unique<btGImpactMeshShape>(&triangles);
        shape->setMargin(kMargin);
        shape->updateBound();
        object.setCollisionShape(shape.get());
    }
    btTriangleMesh triangles;
    std::unique_ptr<btGImpactMeshShape> shape;
    btCollisionObject object;
};

class GimpactContacts : public Method {
public:
    GimpactContacts(const geometry::TriangleMesh& field, const geometry::TriangleMesh& shell)
        : dispatcher_(&configuration_),
          world_(&dispatcher_, &broadphase_, &configuration_),
          field_(field),
          shell_(shell) {
        btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
        world_.addCollisionObject(&field_.object);
        world_.addCollisionObject(&shell_.object);
    }
    ~GimpactContacts() override {
        world_.removeCollisionObject(&shell_.object);
        world_.removeCollisionObject(&field_.object);
    }

    Answer at(const Pose& X_FS) override {
        const btQuaternion q(static_cast<btScalar>(X_FS.q.x()), static_cast<btScalar>(X_FS.q.y()),
                             static_cast<btScalar>(X_FS.q.z()), static_cast<btScalar>(X_FS.q.w()));
        shell_.object.setWorldTransform(btTransform(q, scaled(X_FS.p)));
        // Poses are not a motion: a manifold kept from the last one would be wrong here.
        for (int i = 0; i < dispatcher_.getNumManifolds(); ++i)
            dispatcher_.getManifoldByIndexInternal(i)->clearManifold();
        world_.performDiscreteCollisionDetection();
        Answer answer;
        answer.contacts = 0.0;
        btScalar deepest = 0;
        for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
            const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(i);
            answer.contacts += manifold.getNumContacts();
            for (int k = 0; k < manifold.getNumContacts(); ++k)
                deepest = std::min(deepest, manifold.getContactPoint(k).getDistance());
        }
        if (answer.contacts > 0.0) answer.signed_distance = static_cast<double>(deepest / kUnitsPerMetre);
        return answer;
    }

private:
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broadphase_;
    btCollisionWorld world_;
    GimpactBody field_, shell_;
};

}  // namespace

Candidate bulletGimpact(const geometry::TriangleMesh& field, const geometry::TriangleMesh& shell) {
    Candidate result{.name = "Bullet GImpact", .settings = "float, unit 1 cm, margin 0.1 mm"};
    const double before = heapBytes();
    const Stopwatch watch;
    result.method = std::make_unique<GimpactContacts>(field, shell);
    result.build_s = watch.seconds();
    result.memory_bytes = heapBytes() - before;
    return result;
}

}  // namespace passung::bench
